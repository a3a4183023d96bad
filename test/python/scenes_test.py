#!/usr/bin/env python3
"""Scenes of many bodies: made, from arrays, saved; their answers against those of pairs.

usage: scenes_test.py
"""

import pathlib
import tempfile
import unittest

from common import main, numpy, random_poses, sixdof

BODIES, FRAMES, MARGIN = 8, 4, 0.3


class Scenes(unittest.TestCase):
    def own(self):
        """Eight bodies of two shapes; the first is fixed, the others move a little."""
        start = random_poses(BODIES, 1.0, seed=5)
        steps = numpy.random.default_rng(6).normal(size=(FRAMES, BODIES, 3)) * 0.02
        steps[0], steps[:, 0] = 0, 0
        poses = numpy.repeat(start[None], FRAMES, axis=0)
        poses[:, :, :3, 3] += steps.cumsum(axis=0)
        self.mesh_of = [k % 2 for k in range(BODIES)]
        return sixdof.scene(["cone-100", "torus-100"], self.mesh_of, poses, fixed=[k == 0 for k in range(BODIES)],
                            margin=MARGIN, name="own"), poses

    def test_arrays_go_in_and_come_out(self):
        scene, poses = self.own()
        self.assertEqual((scene.name, scene.frames, scene.margin), ("own", FRAMES, MARGIN))
        numpy.testing.assert_allclose(scene.poses(), poses, atol=1e-14)  # through quaternions
        numpy.testing.assert_array_equal(scene.mesh_of, self.mesh_of)
        self.assertEqual(list(numpy.flatnonzero(scene.fixed)), [0])
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "scene.h5"
            scene.save(file)
            again = sixdof.load_scene(file)
        numpy.testing.assert_array_equal(again.poses(), scene.poses())
        self.assertEqual([mesh.hash for mesh in again.meshes], [mesh.hash for mesh in scene.meshes])

    def test_answers_are_those_of_pairs(self):
        scene, _ = self.own()
        poses = scene.poses()
        near, score = scene.play("near")
        touching, _ = scene.play("touching", "all-pairs")
        self.assertEqual((score["missed"], score["wrong"]), (0, 0))
        self.assertGreater(score["true_pairs"], FRAMES)
        for frame in range(FRAMES):
            found = {tuple(pair): gap for pair, gap in zip(near[frame].pairs.tolist(), near[frame].distance)}
            touch = {tuple(pair) for pair in touching[frame].pairs.tolist()}
            for a in range(BODIES):
                for b in range(a + 1, BODIES):
                    pair = sixdof.prepare("exact", scene.meshes[scene.mesh_of[a]], scene.meshes[scene.mesh_of[b]])
                    relative = numpy.linalg.inv(poses[frame, a]) @ poses[frame, b]
                    gap = float(pair.distance(relative).distance)
                    self.assertEqual(gap <= MARGIN, (a, b) in found)
                    if (a, b) in found:
                        self.assertAlmostEqual(found[a, b], gap, delta=1e-12)  # roundings of the relative pose
                    self.assertEqual(bool(pair.collide(relative).colliding), (a, b) in touch)

    def test_wrenches(self):
        scene, _ = self.own()
        answers, _ = scene.play("wrenches")
        bodies = sum(len(answer.body) for answer in answers)
        self.assertGreater(bodies, 0)
        for answer in answers:
            self.assertEqual(answer.force.shape, (len(answer.body), 3))
            # Forces of a pair are opposite; roundings of areas of about 1.
            self.assertLess(abs(answer.force.sum(axis=0)).max(), 1e-12)

    def test_families_and_algorithms(self):
        scene = sixdof.make_scene("cube", bodies=30, frames=3, seed=4)
        self.assertEqual((len(scene.ids), scene.frames), (30, 3))
        self.assertIn("cube", sixdof.scene_families())
        for name, info in sixdof.scene_algorithms().items():
            for question in info["questions"]:
                with self.subTest(name=name, question=question):
                    answers, score = scene.play(question, name)
                    self.assertEqual(len(answers), 3)
                    self.assertEqual(score["missed"], 0)

    def test_meshes_that_deform(self):
        scene = sixdof.make_scene("bump", frames=4, amplitude=0.1, triangles=400)
        vertices = scene.vertices(0)
        self.assertEqual(vertices.shape, (4, len(scene.meshes[0].vertices), 3))
        moved = numpy.linalg.norm(vertices - vertices[0], axis=2).max(axis=1)
        self.assertEqual(moved[0], 0.0)
        self.assertTrue((numpy.diff(moved) > 0.0).all())
        self.assertTrue((scene.vertices(1) == scene.vertices(1)[0]).all())
        _, score = scene.play("near", "exact-refit")
        self.assertEqual((score["missed"], score["wrong"]), (0, 0))
        self.assertIn("crumple", sixdof.scene_families())
        with self.assertRaisesRegex(sixdof.BadArgument, "mesh: 9 of"):
            scene.vertices(9)

    def test_words_of_errors(self):
        still = random_poses(2, 1.0)[None]
        for words, call in (
                (r"poses: the shape is \(1, 2, 4, 4\), not \(frames, 3", lambda: sixdof.scene(["cone-100"], [0] * 3, still)),
                (r"mesh_of\[1\]: 4 of 1 meshes", lambda: sixdof.scene(["cone-100"], [0, 4], still)),
                (r"meshes\[0\]: ", lambda: sixdof.scene(["cnoe-100"], [0, 0], still)),
                ("fixed: 1 flags for 2 bodies", lambda: sixdof.scene(["cone-100"], [0, 0], still, fixed=[True])),
                ("colour: no parameter of scenes; they are bodies", lambda: sixdof.make_scene("cube", colour=3)),
                ("cubes", lambda: sixdof.make_scene("cubes")),
                ("touch", lambda: sixdof.make_scene("cube", bodies=3).play("touch"))):
            with self.assertRaisesRegex(sixdof.BadArgument, words):
                call()
        with self.assertRaisesRegex(sixdof.BadFile, "none.h5"):
            sixdof.load_scene("none.h5")


if __name__ == "__main__":
    main()
