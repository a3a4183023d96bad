"""Coal's Python binding: trees of oriented boxes with rectangle-swept spheres (BVHModelOBBRSS), surfaces only.

profile=default: requests as constructed, one contact with its points. profile=tuned follows Coal's developers: contacts
off ("Make sure to turn that off for maximum performances", https://github.com/coal-library/coal/issues/857), functors and
the cached guess of GJK ("much more efficient by deploying caching mechanisms and functors",
https://github.com/coal-library/coal/issues/376). lib/sixdof/algorithm/coal/ is the same in C++, without Python's cost.
"""

import math

import coal
import numpy
import sixdof_rival


def model(mesh):
    vertices, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    vertices.extend(list(mesh.vertices))
    triangles.extend([coal.Triangle(*map(int, each)) for each in mesh.triangles])
    tree = coal.BVHModelOBBRSS()
    tree.beginModel(len(triangles), len(vertices))
    tree.addSubModel(vertices, triangles)
    tree.endModel()
    if tree.build_state != coal.BVHBuildState.BVH_BUILD_STATE_PROCESSED:
        raise sixdof_rival.BadMesh(f"{mesh.name}: Coal cannot build a tree")
    return tree


class Query:
    def __init__(self, a, b, settings):
        self.a = model(a)
        self.b = self.a if b is a else model(b)
        self.tuned = settings["profile"] == "tuned"
        self.at_a = coal.Transform3s.Identity()
        self.collide_request, self.distance_request = coal.CollisionRequest(), coal.DistanceRequest()
        for request in (self.collide_request, self.distance_request):
            request.gjk_tolerance = float(settings["gjk_tolerance"])
        if self.tuned:
            self.compute_collision = coal.ComputeCollision(self.a, self.b)
            self.compute_distance = coal.ComputeDistance(self.a, self.b)
            self.collide_request.enable_contact = False
            for request in (self.collide_request, self.distance_request):
                request.gjk_initial_guess = coal.GJKInitialGuess.CachedGuess

    def empty(self, pose):
        coal.CollisionResult()
        return coal.Transform3s(pose[:9].reshape(3, 3), pose[9:])

    def collide(self, pose):
        at_b = coal.Transform3s(pose[:9].reshape(3, 3), pose[9:])
        result = coal.CollisionResult()
        if self.tuned:
            self.compute_collision(self.at_a, at_b, self.collide_request, result)
            self.collide_request.updateGuess(result)
        else:
            coal.collide(self.a, self.at_a, self.b, at_b, self.collide_request, result)
        return result.isCollision()

    def distance(self, pose):
        at_b = coal.Transform3s(pose[:9].reshape(3, 3), pose[9:])
        result = coal.DistanceResult()
        if self.tuned:
            self.compute_distance(self.at_a, at_b, self.distance_request, result)
            self.distance_request.updateGuess(result)
        else:
            coal.distance(self.a, self.at_a, self.b, at_b, self.distance_request, result)
        gap = result.min_distance
        if gap > 1e300:
            raise sixdof_rival.Failed("no distance was found")
        if gap <= 0.0:
            return 0.0
        a, b = result.getNearestPoint1(), result.getNearestPoint2()
        return (gap, a, b) if math.isfinite(a[0] + b[0]) else gap

    def contacts(self, pose, most):
        """Coal stops its search once it has so many; its depth is a signed distance, negative inside."""
        if most == 0:
            return [], [], []  # Coal throws
        request, result = coal.CollisionRequest(), coal.CollisionResult()
        request.num_max_contacts, request.enable_contact = most, True
        request.gjk_tolerance = self.collide_request.gjk_tolerance
        coal.collide(self.a, self.at_a, self.b, coal.Transform3s(pose[:9].reshape(3, 3), pose[9:]), request, result)
        found = [result.getContact(i) for i in range(min(most, result.numContacts()))]
        return [c.pos for c in found], [c.normal for c in found], [-c.penetration_depth for c in found]

    def footprint(self):
        trees = [self.a] if self.b is self.a else [self.a, self.b]
        return 0, {"nodes": sum(tree.getNumBVs() for tree in trees), "triangles": sum(tree.num_tris for tree in trees)}


sixdof_rival.serve(
    Query, name="coal", version=coal.__version__, answers=["collide", "distance", "contacts"], depth="triangles",
    summary="Coal from Python, trees of OBB and RSS; surfaces only", limits=["collide_of_surfaces"],
    parameters=[sixdof_rival.choice("profile", "requests as constructed, or as Coal's developers advise", "default",
                                    ["default", "tuned"]),
                {"name": "gjk_tolerance", "meaning": "gap at which two triangles touch; Coal's default", "unit": "length",
                 "default": "1e-06", "low": 1e-15, "high": 1}])
