#!/usr/bin/env python3
"""Queries: the same bits as a loop in C++, at little more time; masks of failures; threads.

usage: queries_test.py REFERENCE_LOOP
"""

import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import time
import unittest
import warnings

from common import arguments, main, numpy, random_poses, sixdof

REFERENCE = arguments(1)
A, B = "torus-knot-2k", "bumpy-sphere-2k"
COUNT = 10_000
# Of the time of a loop in C++, whose queries take some microseconds: the overhead is about a tenth of a microsecond, and
# the rest is for a machine that does other work.
MOST_TIME = 1.5


def fields(answers):
    """Numbers of all poses in the order of the reference loop."""
    if isinstance(answers, sixdof.Distances):
        parts = [answers.distance[:, None], answers.points_a, answers.points_b]
    else:
        parts = [answers.penalty[:, None], answers.force, answers.torque, answers.reference]
    return numpy.ma.concatenate(parts, axis=1)


class Bits(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def loop(self, algorithm, kind, poses):
        """Answers and ns per query of the loop in C++."""
        poses.tofile(self.folder / "poses")
        done = subprocess.run([REFERENCE, algorithm, A, B, kind, self.folder / "poses", self.folder / "answers"],
                              capture_output=True, text=True, check=True)
        return numpy.fromfile(self.folder / "answers").reshape(len(poses), -1), float(done.stdout)

    def test_same_bits(self):
        poses = random_poses(500, 1.0)
        for algorithm, kind in (("exact", "distance"), ("exact", "respond"), ("vps", "respond"), ("ist", "distance"),
                                ("fcl-rss", "distance"), ("ode", "respond")):
            if algorithm not in sixdof.algorithms():
                continue
            with self.subTest(algorithm=algorithm, kind=kind):
                wanted, _ = self.loop(algorithm, kind, poses)
                got = fields(getattr(sixdof.prepare(algorithm, A, B), kind)(poses))
                there = ~numpy.ma.getmaskarray(got)
                self.assertEqual(numpy.asarray(got)[there].tobytes(), wanted[there].tobytes())
                self.assertGreater(there.mean(), 0.1)

    def test_same_bits_with_threads(self):
        poses = random_poses(2_000, 1.0)
        pair = sixdof.prepare("exact", A, B)
        for kind in ("distance", "respond"):
            one, two = (fields(getattr(pair, kind)(poses, threads=threads)) for threads in (1, 2))
            self.assertFalse(numpy.ma.is_masked(one))
            self.assertEqual(one.tobytes(), two.tobytes())

    def test_little_overhead(self):
        poses = random_poses(COUNT, 1.0)
        pair = sixdof.prepare("exact", A, B)
        least = min(timed(pair.distance, poses) for _ in range(3))
        _, wanted = self.loop("exact", "distance", poses)
        print(f"exact: {least:.0f} ns a query from Python, {wanted:.0f} ns in C++")
        nothing = min(timed(sixdof.prepare("null", A, B).distance, poses) for _ in range(3))
        print(f"null: {nothing:.0f} ns a query from Python: the overhead")
        self.assertLess(nothing, (MOST_TIME - 1) * wanted)
        self.assertLess(least, 2 * MOST_TIME * wanted)


def timed(ask, poses):
    start = time.perf_counter_ns()
    ask(poses)
    return (time.perf_counter_ns() - start) / len(poses)


class Answers(unittest.TestCase):
    def setUp(self):
        self.pair = sixdof.prepare("exact", A, B)

    def test_shapes_follow_the_poses(self):
        poses = random_poses(6, 1.0)
        for shape in ((6,), (2, 3), (1, 6), (0,)):
            some = poses[:int(numpy.prod(shape))].reshape(*shape, 4, 4)
            self.assertEqual(self.pair.distance(some).points_a.shape, (*shape, 3))
            self.assertEqual(self.pair.respond(some).force.shape, (*shape, 3))
            self.assertEqual(self.pair.collide(some).colliding.shape, shape)
        one = self.pair.distance(poses[4])
        self.assertEqual(one.distance.shape, ())
        self.assertEqual(float(one.distance), self.pair.distance(poses).distance[4])

    def test_answers_agree_with_each_other(self):
        poses = random_poses(300, 1.5)
        distances, collisions, responses = (ask(poses) for ask in (self.pair.distance, self.pair.collide,
                                                                   self.pair.respond))
        self.assertTrue(collisions.colliding.any() and not collisions.colliding.all())
        apart = ~collisions.colliding
        self.assertTrue((distances.distance[apart] > 0).all())
        self.assertTrue((responses.volume[apart] == 0).all())
        self.assertTrue((responses.volume[~apart] > 0).any())
        gaps = numpy.linalg.norm(distances.points_a - distances.points_b, axis=1)
        # Rounding of coordinates of about 1.
        numpy.testing.assert_allclose(gaps[apart], distances.distance[apart], rtol=1e-12, atol=1e-12)
        self.assertTrue((distances.triangles_b < len(self.pair.b.triangles)).all())
        numpy.testing.assert_array_equal(numpy.asarray(distances), distances.distance)
        # The points lie in their triangles' boxes, those of B once moved back.
        back = numpy.linalg.inv(poses)
        own = numpy.einsum("nij,nj->ni", back[:, :3, :3], distances.points_b) + back[:, :3, 3]
        corners = self.pair.b.vertices[self.pair.b.triangles[distances.triangles_b]]
        self.assertTrue((own >= corners.min(axis=1) - 1e-12).all() and (own <= corners.max(axis=1) + 1e-12).all())

    def test_no_silent_nan(self):
        poses = random_poses(30, 1.0)
        poses[7, 1, 3] = numpy.nan
        poses[9, 0, 0] = numpy.inf
        for kind, values in (("distance", ("distance", "points_a", "triangles_b")), ("collide", ("colliding",)),
                             ("respond", ("penalty", "volume", "force"))):
            with self.assertWarnsRegex(sixdof.FailedQueries, r"exact: 2 of 30 .*poses\[7\]: the pose is not finite"):
                answers = getattr(self.pair, kind)(poses)
            self.assertEqual(list(numpy.flatnonzero(~answers.ok)), [7, 9])
            self.assertEqual(answers.status[9], "non_finite")
            self.assertEqual(answers.status[8], "ok")
            self.assertEqual(answers.words, {7: "the pose is not finite", 9: "the pose is not finite"})
            for name in values:
                array = getattr(answers, name)
                self.assertTrue(array.mask[7].all() and array.mask[9].all())
                self.assertEqual(array.mask.any(axis=tuple(range(1, array.ndim))).sum(), 2)
            self.assertIn("2 non_finite", repr(answers))

    def test_what_an_algorithm_does_not_answer(self):
        with self.assertWarnsRegex(sixdof.FailedQueries, "2 unsupported"):
            answers = sixdof.prepare("vps", A, B).distance(random_poses(2, 1.0))
        self.assertFalse(answers.ok.any())
        self.assertEqual(answers.status[0], "unsupported")

    def test_absent_volumes_and_points_are_masked(self):
        poses = random_poses(40, 0.3)
        if "ode" in sixdof.algorithms():
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                volumes = sixdof.prepare("ode", A, B).respond(poses).volume
            self.assertTrue(volumes.mask.all())
        self.assertFalse(numpy.ma.isMaskedArray(self.pair.respond(poses).volume))

    def test_bad_poses_are_named(self):
        poses = random_poses(5, 1.0)
        bent, scaled = poses.copy(), poses.copy()
        bent[3, 3, 0] = 0.1
        scaled[2, :3, :3] *= 1.001
        mirrored = poses @ numpy.diag([1.0, 1.0, -1.0, 1.0])
        for wrong, words in ((bent, r"poses\[3\]: the last row"), (scaled, r"poses\[2\]: .* not a rotation"),
                             (mirrored, r"poses\[0\]"), (poses[:, :3], r"poses: the shape is \(5, 3, 4\)"),
                             ("poses", "poses: ")):
            with self.assertRaisesRegex(sixdof.BadArgument, words):
                self.pair.distance(wrong)
        with self.assertRaisesRegex(sixdof.BadArgument, "threads: -1"):
            self.pair.distance(poses, threads=-1)


class Algorithms(unittest.TestCase):
    def test_every_algorithm_answers(self):
        poses = random_poses(3, 0.5)
        for name, info in sixdof.algorithms().items():
            if info.runtime or name == "cgal":
                continue
            with self.subTest(name=name):
                pair = sixdof.prepare(name, "cone-100", "torus-100")
                for kind in info.answers:
                    more = {"cast": [numpy.full(3, 0.2)]}.get(kind, [])  # a translation
                    self.assertEqual(getattr(pair, kind)(poses, *more).ok.shape, (3,))
                self.assertGreaterEqual(pair.footprint()["bytes"], 0)

    def test_parameters(self):
        pair = sixdof.prepare("ist", "cone-300", spheres=50)
        self.assertIn("spheres=50", pair.settings)
        self.assertIn("warm_start=on", sixdof.prepare("exact", "cone-300", warm_start=True).settings)
        for words, parameters in (("ist: sphres: no such parameter", {"sphres": 3}), ("ist: .*spheres", {"spheres": -1})):
            with self.assertRaisesRegex(sixdof.BadArgument, words):
                sixdof.prepare("ist", "cone-300", **parameters)
        with self.assertRaisesRegex(sixdof.BadArgument, "algorithm exakt: no such algorithm"):
            sixdof.prepare("exakt", "cone-300")

    def test_a_process_of_its_own(self):
        poses = random_poses(50, 1.0)
        poses[4, 0, 3] = numpy.nan
        here, there = (sixdof.prepare("exact", A, B, isolate=isolate) for isolate in (False, True))
        for kind in ("distance", "respond"):
            with self.assertWarns(sixdof.FailedQueries):
                one, two = (getattr(pair, kind)(poses) for pair in (here, there))
            self.assertEqual(list(one.status), list(two.status))
            self.assertEqual(numpy.ma.filled(fields(one), 0).tobytes(), numpy.ma.filled(fields(two), 0).tobytes())
        slow = sixdof.prepare("brute-force", "torus-10k", isolate=True, query_timeout=0.01)
        with self.assertWarnsRegex(sixdof.FailedQueries, "timed_out"):
            self.assertEqual(slow.distance(random_poses(1, 9.0)).status[0], "timed_out")

    def test_a_copy_is_prepared_once(self):
        mesh = sixdof.load("torus-1k")
        copies = [sixdof.prepare("exact", mesh, other).footprint()["bytes"] for other in (mesh, sixdof.load("torus-1k"))]
        self.assertLess(copies[0], copies[1])


class Threads(unittest.TestCase):
    def test_each_thread_has_its_own_query(self):
        pair = sixdof.prepare("exact", A, B)
        poses = random_poses(4_000, 0.5)
        pair.respond(poses)
        self.assertEqual(pair._prepared.prepared, 1)
        pair.respond(poses, threads=0)
        self.assertLessEqual(pair._prepared.prepared, 2 * len(os.sched_getaffinity(0)))
        if len(os.sched_getaffinity(0)) > 1:
            self.assertGreater(pair._prepared.prepared, 1)

    def test_other_threads_run_meanwhile(self):
        pair = sixdof.prepare("exact", A, B)
        poses = random_poses(5_000, 0.5)
        seen, done = 0, threading.Event()

        def ask():
            pair.respond(poses)
            done.set()

        worker = threading.Thread(target=ask)
        worker.start()
        while not done.is_set():
            seen += 1
        worker.join()
        # Were the lock of the interpreter held, this loop would turn no more than a few times.
        self.assertGreater(seen, 1_000)

    def test_one_pair_from_two_threads(self):
        pair = sixdof.prepare("exact", A, B)
        poses = random_poses(500, 1.0)
        wanted = pair.distance(poses).distance
        got = [None] * 4

        def ask(place):
            got[place] = pair.distance(poses).distance

        workers = [threading.Thread(target=ask, args=(place,)) for place in range(len(got))]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        for distances in got:
            self.assertEqual(distances.tobytes(), wanted.tobytes())

    def test_ctrl_c_ends_a_call(self):
        pair = sixdof.prepare("brute-force", "torus-2k")
        poses = random_poses(3_000, 1.0)  # minutes
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            pair.distance(poses)


if __name__ == "__main__":
    main()
