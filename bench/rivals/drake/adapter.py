"""Drake: the convex hulls of both meshes. Its proximity queries take a mesh of triangles as its hull.

collide: HasCollisions(). distance: ComputeSignedDistancePairClosestPoints(), 0 where hulls overlap. respond: hydroelastic
contact of a compliant A and a rigid B (https://drake.mit.edu/doxygen_cxx/group__hydroelastic__user__guide.html). A's
pressure is its modulus, here 1, times a field that is 0 on the boundary of the hull and 1 at its middle, linear in each
tetrahedron between. The force is the sum of pressure x area x normal at the centroids of the polygons where B's hull cuts
A's, as in Drake's own discrete solver; the penalty is the sum of pressure x area. Its law is that of a depth, with a field
of its own in place of the depth. B's surface makes the force: there is none where A is inside B. The sum is a loop in Python,
which takes most of the time of respond.
No profiles: Drake's documentation advises no settings for single queries.
"""

import importlib.metadata

import numpy
import sixdof_rival
from pydrake.common import MemoryFile
from pydrake.geometry import (AddCompliantHydroelasticProperties, AddRigidHydroelasticProperties, Convex, FramePoseVector,
                              GeometryFrame, GeometryInstance, HydroelasticContactRepresentation, InMemoryMesh,
                              ProximityProperties, SceneGraph)
from pydrake.math import RigidTransform, RotationMatrix

RESOLUTION, MODULUS = 1.0, 1.0  # a hull is not tessellated, so the resolution is not used


def hull(mesh):
    lines = ["v {!r} {!r} {!r}".format(*map(float, v)) for v in mesh.vertices]
    lines += ["f {} {} {}".format(*(t + 1)) for t in mesh.triangles.astype(int)]
    return Convex(InMemoryMesh(mesh_file=MemoryFile("\n".join(lines) + "\n", ".obj", mesh.name)), 1.0)


class Query:
    def __init__(self, a, b, settings):
        scene = self.scene = SceneGraph()
        self.source = scene.RegisterSource("pair")
        self.frame_b = scene.RegisterFrame(self.source, GeometryFrame("b"))
        compliant, rigid = ProximityProperties(), ProximityProperties()
        AddCompliantHydroelasticProperties(RESOLUTION, MODULUS, compliant)
        AddRigidHydroelasticProperties(RESOLUTION, rigid)
        try:
            at_a = GeometryInstance(RigidTransform(), hull(a), "a")
            at_a.set_proximity_properties(compliant)
            at_b = GeometryInstance(RigidTransform(), hull(b), "b")
            at_b.set_proximity_properties(rigid)
            self.a = scene.RegisterAnchoredGeometry(self.source, at_a)
            self.b = scene.RegisterGeometry(self.source, self.frame_b, at_b)
            self.context = scene.CreateDefaultContext()
            self.empty(numpy.eye(3, 4).ravel()[[0, 1, 2, 4, 5, 6, 8, 9, 10, 3, 7, 11]])
            self.ask().ComputeContactSurfaces(HydroelasticContactRepresentation.kPolygon)
        except RuntimeError as e:
            raise sixdof_rival.BadMesh(f"{a.name}, {b.name}: {e}") from None
        self.centre_b = b.box_centre()

    def empty(self, pose):
        poses = FramePoseVector()
        poses.set_value(self.frame_b, RigidTransform(RotationMatrix(pose[:9].reshape(3, 3)), pose[9:]))
        self.scene.get_source_pose_port(self.source).FixValue(self.context, poses)

    def ask(self):
        return self.scene.get_query_output_port().Eval(self.context)

    def collide(self, pose):
        self.empty(pose)
        return self.ask().HasCollisions()

    def distance(self, pose):
        self.empty(pose)
        pair = self.ask().ComputeSignedDistancePairClosestPoints(self.a, self.b)
        if pair.distance <= 0.0:
            return 0.0
        on_b = pose[:9].reshape(3, 3) @ pair.p_BCb + pose[9:]
        return pair.distance, pair.p_ACa, on_b

    def contacts(self, pose, most):
        """One of the deepest penetration; in the middle between the bodies."""
        self.empty(pose)
        pairs = self.ask().ComputePointPairPenetration()[:most]
        towards_b = [1.0 if pair.id_B == self.b else -1.0 for pair in pairs]  # nhat_BA_W leads from id_B to id_A
        return ([0.5 * (pair.p_WCa + pair.p_WCb) for pair in pairs],
                [-sign * pair.nhat_BA_W for sign, pair in zip(towards_b, pairs)], [pair.depth for pair in pairs])

    def respond(self, pose):
        self.empty(pose)
        reference = numpy.array(sixdof_rival.moved(pose, self.centre_b))
        force, torque, penalty = numpy.zeros(3), numpy.zeros(3), 0.0
        for surface in self.ask().ComputeContactSurfaces(HydroelasticContactRepresentation.kPolygon):
            mesh, pressure = surface.poly_mesh_W(), surface.poly_e_MN()
            faces = range(mesh.num_faces())
            centroid = numpy.array([surface.centroid(i) for i in faces])
            area = numpy.array([surface.area(i) for i in faces])
            normal = numpy.array([surface.face_normal(i) for i in faces])  # out of N and into M
            value = numpy.array([pressure.EvaluateCartesian(i, p) for i, p in zip(faces, centroid)])
            towards_b = 1.0 if surface.id_M() == self.b else -1.0
            each = (towards_b * value * area)[:, None] * normal
            force += each.sum(0)
            torque += numpy.cross(centroid - reference, each).sum(0)
            penalty += float(value @ area)
        return {"penalty": penalty, "force": force, "torque": torque, "reference": reference}


sixdof_rival.serve(Query, name="drake", version=importlib.metadata.version("drake"), body="convex_hull", law="depth",
                   answers=["collide", "distance", "respond", "contacts"], depth="bodies",
                   limits=["own_direction", "distance_of_bodies"],
                   summary="Drake from Python: convex hulls, hydroelastic force of a compliant A on a rigid B")
