"""python-fcl, the binding of FCL 0.7 with its own build of the library: BVHModel (trees of OBBRSS); surfaces only.

The same questions as `fcl-obbrss`, which is Debian's build from C++: their answers must agree. CollisionRequest() as
constructed (one contact, no points; for contacts with points, as many as are asked for); DistanceRequest with nearest points. No
profiles: none are published.
"""

import importlib.metadata

import fcl
import numpy
import sixdof_rival


def model(mesh):
    tree = fcl.BVHModel()
    tree.beginModel(len(mesh.vertices), len(mesh.triangles))
    tree.addSubModel(mesh.vertices.astype(numpy.float64), mesh.triangles.astype(numpy.int64))
    tree.endModel()
    return tree


class Query:
    def __init__(self, a, b, settings):
        tree_a = model(a)
        tree_b = tree_a if b is a else model(b)
        self.a, self.b = (fcl.CollisionObject(tree, fcl.Transform()) for tree in (tree_a, tree_b))
        self.collide_request = fcl.CollisionRequest()
        self.distance_request = fcl.DistanceRequest(enable_nearest_points=True)

    def empty(self, pose):
        self.b.setTransform(fcl.Transform(pose[:9].reshape(3, 3), pose[9:]))

    def collide(self, pose):
        self.empty(pose)
        return fcl.collide(self.a, self.b, self.collide_request, fcl.CollisionResult()) > 0

    def distance(self, pose):
        self.empty(pose)
        result = fcl.DistanceResult()
        gap = fcl.distance(self.a, self.b, self.distance_request, result)
        return (gap, *result.nearest_points) if gap > 0.0 else 0.0

    def contacts(self, pose, most):
        """FCL stops its search once it has so many."""
        if most == 0:
            return [], [], []  # FCL warns on standard output
        self.empty(pose)
        result = fcl.CollisionResult()
        fcl.collide(self.a, self.b, fcl.CollisionRequest(num_max_contacts=most, enable_contact=True), result)
        found = result.contacts[:most]
        return [c.pos for c in found], [c.normal for c in found], [c.penetration_depth for c in found]


sixdof_rival.serve(Query, name="python-fcl", version=importlib.metadata.version("python-fcl"),
                   summary="FCL from Python, trees of OBB and RSS; surfaces only", answers=["collide", "distance", "contacts"],
                   limits=["collide_of_surfaces"], depth="triangles")
