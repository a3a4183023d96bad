"""Manifold: the intersection of both solids by Boolean operation, in double precision (Mesh64).

collide: the intersection is not empty; bodies, not surfaces. respond: its volume, and minus the gradient of it, from the
triangles of the intersection that lie on B (algorithm/volume_response.h has the formulas); Manifold tells by
`run_original_id` which these are. Triangles of equal planes are merged within its tolerance, so volumes have relative
errors of some 1e-12. `min_gap` is not asked for distances: it needs a search length in advance.
No profiles: its documentation advises no settings for this use.
"""

import importlib.metadata

import manifold3d
import numpy
import sixdof_rival


def solid(mesh):
    number = manifold3d.Manifold.reserve_ids(1)
    triangles = mesh.triangles.astype(numpy.uint64)
    built = manifold3d.Manifold(manifold3d.Mesh64(
        vert_properties=numpy.ascontiguousarray(mesh.vertices, dtype=numpy.float64), tri_verts=triangles,
        run_index=numpy.array([0, triangles.size], dtype=numpy.uint64),
        run_original_id=numpy.array([number], dtype=numpy.uint32)))
    if built.status() != manifold3d.Error.NoError:
        raise sixdof_rival.BadMesh(f"{mesh.name}: {built.status()}")
    return built, number


class Query:
    def __init__(self, a, b, settings):
        (self.a, _), (self.b, self.number_b) = solid(a), solid(b)
        self.centre_b = b.box_centre()

    def empty(self, pose):
        return self.b.transform(numpy.column_stack((pose[:9].reshape(3, 3), pose[9:])))

    def intersection(self, pose):
        product = self.a ^ self.empty(pose)
        if product.status() != manifold3d.Error.NoError:
            raise sixdof_rival.Failed(f"intersection: {product.status()}")
        return product

    def collide(self, pose):
        return not self.intersection(pose).is_empty()

    def respond(self, pose):
        product = self.intersection(pose)
        reference = numpy.array(sixdof_rival.moved(pose, self.centre_b))
        force = torque = numpy.zeros(3)
        volume = 0.0
        if not product.is_empty():
            mesh = product.to_mesh64()
            p, q, r = numpy.moveaxis(mesh.vert_properties[:, :3][mesh.tri_verts] - reference, 1, 0)
            area = 0.5 * numpy.cross(q - p, r - p)
            volume = numpy.einsum("ij,ij", p, area) / 3
            of_b = numpy.zeros(len(area), dtype=bool)
            for begin, end, number in zip(mesh.run_index, mesh.run_index[1:], mesh.run_original_id):
                of_b[begin // 3:end // 3] = number == self.number_b
            if of_b.any() and not of_b.all():
                force = -area[of_b].sum(axis=0)
                torque = -numpy.cross((p + q + r)[of_b] / 3, area[of_b]).sum(axis=0)
        return {"penalty": volume, "volume": volume, "force": force, "torque": torque, "reference": reference}

    def footprint(self):
        return 0, {"triangles": self.a.num_tri() + self.b.num_tri()}


sixdof_rival.serve(Query, name="manifold", version=importlib.metadata.version("manifold3d"),
                   summary="Manifold from Python: the solids' intersection", answers=["collide", "respond"], law="volume")
