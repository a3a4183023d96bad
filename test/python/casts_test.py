#!/usr/bin/env python3
"""First contacts of moving bodies: arrays of motions, masks, and classes of a user's own.

usage: casts_test.py MANIFEST
"""

import unittest

from common import arguments, main, numpy, random_poses, sixdof

MANIFEST = arguments(1)
A, B = "torus-1k", "bumpy-sphere-2k"
CLOSE = 1e-8  # of A's size: the resolution of a contact, 1e-10 of motions of some lengths, with room


class Marching(sixdof.Algorithm):
    """Conservative advancement on exact distances, in Python."""

    STEPS = 400

    def prepare(self):
        self.pair = sixdof.prepare("exact", self.a, self.b)

    def cast(self, motion):
        speed = numpy.linalg.norm(motion.translation) + numpy.linalg.norm(motion.rotation) * self.b.diagonal
        t = 0.0
        for _ in range(self.STEPS):
            gap = self.pair.distance(motion.pose_at(t))
            if gap.distance <= CLOSE * self.a.diagonal:
                return {"t": t, "a": gap.points_a, "b": gap.points_b, "normal": None}
            t += float(gap.distance) / speed
            if t > 1.0:
                return None
        raise sixdof.NoAnswer("too many steps")


class Halfway(sixdof.Algorithm):
    """Says that everything meets in the middle."""

    def cast(self, motion):
        return 0.5


def motions(count, seed=1):
    """Generic starts around A, translations towards it and past it, and rotations."""
    a = sixdof.load(A)
    draw = numpy.random.default_rng(seed)
    starts = random_poses(count, 1.0, seed)
    outwards = draw.normal(size=(count, 3))
    outwards /= numpy.linalg.norm(outwards, axis=1, keepdims=True)
    starts[:, :3, 3] = 1.6 * a.diagonal * outwards
    translation = a.diagonal * (-1.5 * outwards + 0.6 * draw.normal(size=(count, 3)))
    return starts, translation, draw.normal(size=(count, 3))


class Casts(unittest.TestCase):
    def setUp(self):
        self.pair = sixdof.prepare("exact", A, B)
        self.size = self.pair.a.diagonal

    def motion(self, arrays, place):
        return sixdof.Motion(*(array[place] for array in arrays), self.pair.b.center)

    def test_contacts_are_where_distances_end(self):
        arrays = motions(40)
        answers = self.pair.cast(*arrays)
        self.assertTrue(answers.ok.all())
        self.assertTrue(answers.hit.any() and not answers.hit.all())
        self.assertEqual(list(numpy.ma.getmaskarray(answers.t)), list(~answers.hit))
        for place, hit in enumerate(answers.hit):
            motion = self.motion(arrays, place)
            t = float(answers.t[place]) if hit else 1.0
            before = self.pair.distance(numpy.stack([motion.pose_at(s) for s in numpy.linspace(0, t, 30)[:-1]]))
            self.assertTrue((before.distance > 0).all(), place)
            if hit:
                self.assertLess(float(self.pair.distance(motion.pose_at(t)).distance), CLOSE * self.size)
                gap = numpy.linalg.norm(answers.points_a[place] - answers.points_b[place])
                self.assertLess(gap, CLOSE * self.size)
                self.assertAlmostEqual(numpy.linalg.norm(answers.normal[place]), 1.0)

    def test_arguments_are_broadcast(self):
        starts, translation, rotation = motions(6)
        one = self.pair.cast(starts, translation[0])
        self.assertEqual(one.hit.shape, (6,))
        zero = self.pair.cast(starts, translation[0], numpy.zeros(3), reference=self.pair.b.center)
        self.assertEqual(numpy.ma.filled(one.t, -1).tobytes(), numpy.ma.filled(zero.t, -1).tobytes())
        grid = self.pair.cast(starts[:, None], translation[None, :4], rotation[0])
        self.assertEqual((grid.t.shape, grid.points_a.shape), ((6, 4), (6, 4, 3)))
        self.assertEqual(self.pair.cast(starts[3], translation[2], rotation[0]).hit, grid.hit[3, 2])
        self.assertEqual(self.pair.cast(starts[:0], translation[:0]).t.shape, (0,))
        for wrong, words in (((starts, translation[:4]), "do not fit"), ((starts, [1, 2]), r"translation: .*\(2,\)"),
                             ((starts[0, 0], translation[0]), "poses: "), ((starts, "x"), "translation: ")):
            with self.assertRaisesRegex(sixdof.BadArgument, words):
                self.pair.cast(*wrong)

    def test_a_start_in_contact_is_at_zero(self):
        inside = numpy.identity(4)
        inside[:3, 3] = self.pair.a.center - self.pair.b.center
        inside[0, 3] += 0.3 * self.size
        self.assertTrue(self.pair.collide(inside).colliding)
        self.assertEqual(float(self.pair.cast(inside, [0.1, 0.2, 0.3]).t), 0.0)

    def test_no_silent_nan(self):
        arrays = motions(8)
        arrays[1][3, 0] = numpy.nan
        arrays[2][5, 2] = numpy.inf
        with self.assertWarnsRegex(sixdof.FailedQueries, "exact: 2 of 8 poses have no answer"):
            answers = self.pair.cast(*arrays)
        self.assertEqual(list(numpy.flatnonzero(~answers.ok)), [3, 5])
        self.assertEqual(list(answers.status[[3, 5]]), ["non_finite"] * 2)
        self.assertTrue(answers.t.mask[3] and answers.hit.mask[5])
        with self.assertWarns(sixdof.FailedQueries):
            self.assertEqual(sixdof.prepare("ist", A, B, spheres=100).cast(*motions(1)).status[0], "unsupported")

    def test_threads_and_processes_change_no_bit(self):
        arrays = motions(60)
        wanted = numpy.ma.filled(self.pair.cast(*arrays).t, -1)
        self.assertEqual(numpy.ma.filled(self.pair.cast(*arrays, threads=2).t, -1).tobytes(), wanted.tobytes())
        there = sixdof.prepare("exact", A, B, isolate=True)
        self.assertEqual(numpy.ma.filled(there.cast(*arrays).t, -1).tobytes(), wanted.tobytes())

    def test_algorithms_say_that_they_answer(self):
        known = sixdof.algorithms()
        self.assertIn("cast", known["exact"].answers)
        self.assertNotIn("cast", known["vps"].answers)


class Own(unittest.TestCase):
    def test_a_class_agrees_with_exact(self):
        arrays = motions(12)
        exact, mine = (sixdof.prepare(each, A, B).cast(*arrays) for each in ("exact", Marching))
        both = exact.hit & mine.ok & mine.hit
        self.assertTrue(both.any())
        self.assertEqual(list(exact.hit[mine.ok]), list(mine.hit[mine.ok]))
        # A gap of CLOSE may take long to close where B passes A closely.
        numpy.testing.assert_allclose(mine.t[both], exact.t[both], atol=1e-3)
        self.assertTrue(numpy.ma.getmaskarray(mine.normal).all(), "it gives none")

    def test_a_time_alone_is_an_answer_and_nan_is_none(self):
        answers = sixdof.prepare(Halfway, A, B).cast(*motions(3))
        self.assertEqual(list(answers.t), [0.5] * 3)
        self.assertTrue(numpy.ma.getmaskarray(answers.points_a).all())
        arrays = motions(2)
        arrays[1][1, 1] = numpy.nan
        with self.assertWarnsRegex(sixdof.FailedQueries, "the motion is not finite"):
            self.assertEqual(list(sixdof.prepare(Halfway, A, B).cast(*arrays).status), ["ok", "non_finite"])

    def test_a_motion_turns_about_its_point(self):
        draw = numpy.random.default_rng(5)
        start, point = random_poses(1, 2.0)[0], draw.normal(size=3)
        motion = sixdof.Motion(start, draw.normal(size=3), draw.normal(size=3), point)
        numpy.testing.assert_allclose(motion.pose_at(0.0), start, atol=1e-14)
        for t in (0.25, 1.0):
            pose = motion.pose_at(t)
            numpy.testing.assert_allclose(pose[:3, :3].T @ pose[:3, :3], numpy.identity(3), atol=1e-14)
            moved = start[:3, :3] @ point + start[:3, 3] + t * motion.translation
            numpy.testing.assert_allclose(pose[:3, :3] @ point + pose[:3, 3], moved, atol=1e-14)
            turned = pose[:3, :3] @ start[:3, :3].T
            self.assertAlmostEqual(numpy.trace(turned), 1.0 + 2.0 * numpy.cos(t * numpy.linalg.norm(motion.rotation)))
            numpy.testing.assert_allclose(turned @ motion.rotation, motion.rotation, atol=1e-14)

    def test_rows_of_casts(self):
        results = sixdof.bench(Halfway, pairs=["torus-1k"], manifest=MANIFEST, sample=32, budget=6, queries=["cast"],
                               options=["--benchmark_min_time=0.000001"])
        rows = [row for row in results.rows if row["algorithm"] == "halfway"]
        self.assertEqual(len(rows), 12)
        self.assertTrue(all(row["query"] == "cast" and row["failed"] == 0 for row in rows))
        self.assertTrue(any(row["mismatch"] > 0 for row in rows))
        self.assertTrue(all(row["mismatch"] == 0 for row in results.rows if row["algorithm"] == "exact"))


if __name__ == "__main__":
    main()
