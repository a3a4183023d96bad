"""MuJoCo, two programs: the convex hulls of both meshes (no argument), or signed distance fields on octrees ("sdf").

hull: mj_collision() for yes/no, mj_geomDistance() for distances. sdf: contacts that a descent from `initpoints` points finds
where both fields are negative (https://mujoco.readthedocs.io/en/stable/computation/index.html, SDFs); they become a
response by the rule of algorithm/contact_wrench.h. Bodies are solids in both. Vertices are single precision.
A query sets the pose of B's free joint and updates kinematics, as a step of MuJoCo does. No profiles: its documentation
advises no settings for this use.
"""

import sys

import mujoco
import numpy
import sixdof_rival

SDF = sys.argv[1:] == ["sdf"]


def is_closed(mesh):
    """Every edge belongs to two triangles: else there is no inside."""
    edges = numpy.sort(mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    return bool((numpy.unique(edges, axis=0, return_counts=True)[1] == 2).all())


def compile_pair(a, b, settings):
    for mesh in (a, b) if SDF else ():
        if not is_closed(mesh):
            raise sixdof_rival.BadMesh(f"{mesh.name}: not closed, so it has no signed distance")
    spec = mujoco.MjSpec()
    kind = mujoco.mjtGeom.mjGEOM_SDF if SDF else mujoco.mjtGeom.mjGEOM_MESH
    body = spec.worldbody.add_body()
    body.add_freejoint()
    # Only geometry is asked for: a small body must not be refused for its mass or volume.
    body.explicitinertial, body.mass, body.inertia = True, 1.0, [1.0, 1.0, 1.0]
    for name, mesh, parent in (("a", a, spec.worldbody), ("b", b, body)):
        spec.add_mesh(name=name, uservert=mesh.vertices.ravel().tolist(), userface=mesh.triangles.ravel().tolist(),
                      inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL)
        parent.add_geom(name=name, type=kind, meshname=name)
    if SDF:
        spec.option.sdf_initpoints = int(settings["initpoints"])
    try:
        return spec.compile()
    except ValueError as e:
        raise sixdof_rival.BadMesh(f"{a.name}, {b.name}: {e}") from None


class Query:
    def __init__(self, a, b, settings):
        self.model = compile_pair(a, b, settings)
        self.data = mujoco.MjData(self.model)
        self.quaternion = numpy.zeros(4)
        self.centre_b = b.box_centre()
        # Longer than any gap of poses that matter: MuJoCo cuts distances there.
        self.longest = 1e3 * float(numpy.ptp(numpy.vstack((a.vertices, b.vertices)), axis=0).max())

    def empty(self, pose):
        mujoco.mju_mat2Quat(self.quaternion, pose[:9])
        self.data.qpos[:3] = pose[9:]
        self.data.qpos[3:] = self.quaternion
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)

    def collide(self, pose):
        self.empty(pose)
        mujoco.mj_collision(self.model, self.data)
        return self.data.ncon > 0

    def distance(self, pose):
        self.empty(pose)
        points = numpy.zeros(6)
        gap = mujoco.mj_geomDistance(self.model, self.data, 0, 1, self.longest, points)
        return (gap, points[:3], points[3:]) if gap > 0.0 else 0.0

    def respond(self, pose):
        self.collide(pose)
        reference = numpy.array(sixdof_rival.moved(pose, self.centre_b))
        contacts = self.data.contact
        if len(contacts.dist) == 0:
            return {"penalty": 0.0, "force": numpy.zeros(3), "torque": numpy.zeros(3), "reference": reference}
        depth = numpy.maximum(0.0, -contacts.dist)
        force = depth[:, None] * self.normals()
        torque = numpy.cross(contacts.pos - reference, force)
        return {"penalty": depth.max(), "force": force.mean(axis=0), "torque": torque.mean(axis=0), "reference": reference}

    def normals(self):
        contacts = self.data.contact
        towards_b = numpy.where(contacts.geom[:, :1] == 0, 1.0, -1.0)  # the normal leads from the first geom to the second
        return towards_b * contacts.frame.reshape(-1, 9)[:, :3]

    def contacts(self, pose, most):
        """MuJoCo cannot be told a number: the first that it finds."""
        if not self.collide(pose):
            return [], [], []
        contacts = self.data.contact
        return contacts.pos[:most], self.normals()[:most], -contacts.dist[:most]

    def footprint(self):
        return mujoco.mj_sizeModel(self.model), {"vertices": self.model.nmeshvert}


if SDF:
    points = {"name": "initpoints", "meaning": "points from which contacts are searched", "unit": "1", "default": "40",
              "low": 1, "high": 100000, "integer": True, "sweep": ["10", "40", "160", "640"]}
    sixdof_rival.serve(Query, name="mujoco-sdf", version=mujoco.__version__, law="contacts",
                       answers=["collide", "respond", "contacts"], depth="point", limits=["own_direction"],
                       summary="MuJoCo from Python: signed distance fields of both meshes", parameters=[points])
else:
    sixdof_rival.serve(Query, name="mujoco", version=mujoco.__version__, answers=["collide", "distance", "contacts"],
                       depth="bodies", body="convex_hull", limits=["distance_of_bodies"],
                       summary="MuJoCo from Python: convex hulls of both meshes")
