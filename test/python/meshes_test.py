#!/usr/bin/env python3
"""Meshes from files, arrays and objects, and to arrays; poses; words of errors.

usage: meshes_test.py
"""

import pathlib
import pickle
import tempfile
import unittest

from common import main, numpy, random_poses, sixdof

TETRAHEDRON = ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


class Meshes(unittest.TestCase):
    def test_arrays_go_in_and_come_out(self):
        mesh = sixdof.mesh(*TETRAHEDRON, name="corner")
        self.assertEqual(mesh.name, "corner")
        self.assertEqual(mesh.vertices.dtype, numpy.float64)
        self.assertEqual(mesh.triangles.dtype, numpy.uint32)
        numpy.testing.assert_array_equal(mesh.vertices, TETRAHEDRON[0])
        numpy.testing.assert_array_equal(mesh.faces, TETRAHEDRON[1])
        self.assertTrue(mesh.solid and mesh.closed)
        self.assertEqual(mesh.why_not_solid, "")
        self.assertAlmostEqual(mesh.volume, 1 / 6, delta=1e-15)  # a few roundings
        numpy.testing.assert_array_equal(mesh.box, [[0, 0, 0], [1, 1, 1]])
        numpy.testing.assert_array_equal(mesh.center, [0.5, 0.5, 0.5])
        self.assertIn("4 triangles", repr(mesh))
        with self.assertRaises(ValueError):
            mesh.vertices[0, 0] = 1.0

    def test_arrays_outlive_their_mesh(self):
        vertices = sixdof.mesh(*TETRAHEDRON).vertices
        numpy.testing.assert_array_equal(vertices, TETRAHEDRON[0])

    def test_any_layout_and_type(self):
        wanted = sixdof.mesh(*TETRAHEDRON).hash
        vertices, triangles = map(numpy.array, TETRAHEDRON)
        for points, faces in ((numpy.asfortranarray(vertices), triangles.astype(numpy.int16)),
                              (vertices.astype(numpy.float32), triangles.astype(numpy.uint64)),
                              (numpy.repeat(vertices, 2, axis=0)[::2], triangles[::-1][::-1])):
            self.assertEqual(sixdof.mesh(points, faces).hash, wanted)

    def test_objects_with_vertices_and_faces(self):
        class Like:
            vertices, faces = map(numpy.array, TETRAHEDRON)

        self.assertEqual(sixdof.mesh(Like()).hash, sixdof.mesh(*TETRAHEDRON).hash)
        self.assertEqual(sixdof.prepare("exact", Like(), "cone-100").a.hash, sixdof.mesh(*TETRAHEDRON).hash)

    def test_files_keep_all_bits(self):
        mesh = sixdof.load("bumpy-sphere-500")
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "part.ply"
            mesh.save(file)
            for name in (file, str(file)):
                self.assertEqual(sixdof.load(name).hash, mesh.hash)

    def test_meshes_go_to_other_processes(self):
        mesh = sixdof.load("bumpy-sphere-500")
        again = pickle.loads(pickle.dumps(mesh))
        self.assertEqual((again.hash, again.name), (mesh.hash, mesh.name))

    def assert_raises(self, kind, words, call, *arguments, **more):
        with self.assertRaises(kind) as raised:
            call(*arguments, **more)
        self.assertIn(words, str(raised.exception))
        self.assertIsInstance(raised.exception, sixdof.Error)

    def test_errors_name_the_argument_and_the_file(self):
        vertices, triangles = TETRAHEDRON
        self.assert_raises(sixdof.BadFile, "none.obj: ", sixdof.load, pathlib.Path("none.obj"))
        self.assert_raises(OSError, "no/such.stl: ", sixdof.load, "no/such.stl")
        self.assert_raises(sixdof.BadArgument, "torus", sixdof.load, "torsu-1k")
        self.assert_raises(sixdof.BadArgument, "name_or_file: ", sixdof.load, 7)
        self.assert_raises(sixdof.BadMesh, "vertices: the shape is (4, 2)", sixdof.mesh, numpy.zeros((4, 2)), triangles)
        self.assert_raises(sixdof.BadMesh, "triangles: the type is float64", sixdof.mesh, vertices, [[0.0, 1.0, 2.0]])
        self.assert_raises(sixdof.BadMesh, "vertex index 4 of 4", sixdof.mesh, vertices, [[0, 1, 4]])
        self.assert_raises(sixdof.BadMesh, "triangles[1]: ", sixdof.mesh, vertices, [[0, 1, 2], [0, 1, -1]])
        self.assert_raises(sixdof.BadMesh, "vertices", sixdof.mesh, [[0, 0, 0], [1, 2]], triangles)
        self.assert_raises(ValueError, "vertex 3", sixdof.mesh, [*vertices[:3], [0, 0, float("nan")]], triangles)
        self.assert_raises(sixdof.BadArgument, "triangles: missing", sixdof.mesh, vertices)
        self.assert_raises(sixdof.BadFile, "b: none.ply: ", sixdof.prepare, "exact", "cone-100", "none.ply")
        self.assert_raises(sixdof.BadArgument, "a: int is no mesh", sixdof.prepare, "exact", 1)
        self.assert_raises(sixdof.BadMesh, "not closed", sixdof.prepare, "ist", sixdof.mesh(vertices, triangles[:3]))


class Poses(unittest.TestCase):
    def test_matrices_are_rotations(self):
        poses = random_poses(20, 2.0)
        rotations = poses[:, :3, :3]
        products = rotations @ numpy.swapaxes(rotations, 1, 2)
        self.assertLess(abs(products - numpy.identity(3)).max(), 1e-14)  # roundings of entries of at most 1
        self.assertLess(abs(numpy.linalg.det(rotations) - 1).max(), 1e-14)

    def test_a_known_turn(self):
        turn = sixdof.pose([numpy.sqrt(0.5), 0, 0, numpy.sqrt(0.5)], [1, 2, 3])  # 90 degrees about z
        numpy.testing.assert_allclose(turn @ [1, 0, 0, 1], [1, 3, 3, 1], atol=1e-15)
        self.assertEqual(sixdof.pose([1, 0, 0, 0], numpy.zeros((5, 2, 3))).shape, (5, 2, 4, 4))

    def test_bad_ones(self):
        for words, quaternion, translation in (("quaternion: the shape", [1, 0, 0], [0, 0, 0]),
                                               ("translation: the shape", [1, 0, 0, 0], [0, 0]),
                                               ("quaternion: not of norm 1", [1, 1, 0, 0], [0, 0, 0])):
            with self.assertRaisesRegex(sixdof.BadArgument, words):
                sixdof.pose(quaternion, translation)


if __name__ == "__main__":
    main()
