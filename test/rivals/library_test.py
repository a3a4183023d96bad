#!/usr/bin/env python3
"""One library of bench/rivals/ on bodies with closed forms: boxes, and spheres whose nearest points are vertices.

usage: library_test.py NAME RIVALS

Skipped where bench/rivals/setup has not installed the library.
"""

import math
import pathlib
import sys
import tempfile
import unittest

from conversation import Mesh, Program, end, load_setup

NAME, RIVALS = sys.argv[1], pathlib.Path(sys.argv[2])
del sys.argv[1:]
# Some libraries compute in single precision: some roundings of coordinates of size 3.
SINGLE = 3e-6
LOW, HIGH = (-1.0, -0.8, -0.6), (1.0, 0.8, 0.6)  # of both boxes
YAW = 0.7


def box():
    corners = [[(LOW, HIGH)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return corners, [t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])]


def sphere(halvings):
    """An octahedron of radius 1, refined: the six ends of the axes are vertices."""
    vertices = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    triangles = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(halvings):
        middles, finer = {}, []

        def middle(i, j):
            key = (min(i, j), max(i, j))
            if key not in middles:
                sums = [p + q for p, q in zip(vertices[i], vertices[j])]
                middles[key] = len(vertices)
                vertices.append(tuple(x / math.hypot(*sums) for x in sums))
            return middles[key]

        for a, b, c in triangles:
            p, q, r = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, p, r), (p, b, q), (r, q, c), (p, q, r)]
        triangles = finer
    return vertices, triangles


def pose(translation, axis, angle):
    """Rotation about x (0) or z (2)."""
    c, s = math.cos(angle), math.sin(angle)
    rotation = [1, 0, 0, 0, c, -s, 0, s, c] if axis == 0 else [c, -s, 0, s, c, 0, 0, 0, 1]
    return rotation + list(translation)


def inverse(X):
    rotation = [X[0], X[3], X[6], X[1], X[4], X[7], X[2], X[5], X[8]]
    return rotation + [-sum(rotation[3 * i + k] * X[9 + k] for k in range(3)) for i in range(3)]


def point(X, p):
    return [sum(X[3 * i + k] * p[k] for k in range(3)) + X[9 + i] for i in range(3)]


class Library(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        setup = load_setup(RIVALS)
        if not setup.is_ready(NAME):
            raise unittest.SkipTest("not set up")
        cls.commands = {each: setup.json.loads(setup.ready_file(each).read_text())["command"]
                        for each in setup.programs(NAME)}
        cls.rival = setup.recipe(NAME)

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        (self.folder / "progress").write_bytes(bytes(8))

    def each_setting(self, shape):
        """For every program and every value of its `profile`: prepared pairs in both orders of A and B."""
        a, b = (Mesh(self.folder, name, *shape) for name in "ab")
        for name, command in self.commands.items():
            with Program(command) as program:
                hello = program.hello()
                choices = [each["choices"] for each in hello["parameters"] if each["name"] == "profile"]
                for profile in choices[0] if choices else [None]:
                    for first, second in ((a, b), (b, a)):
                        settings = {"profile": profile} if profile else {}
                        reply = program.prepare(first, second, str(self.folder / "progress"), **settings)
                        self.assertTrue(reply.get("prepared"), reply)
                        self.now = f"{name}, profile {profile}, A is {first.place['name']}"  # for messages
                        yield program, hello["answers"], hello, first is a

    def test_hello(self):
        for name, command in self.commands.items():
            with Program(command) as program:
                hello = program.hello()
                self.assertEqual(hello["name"], name)
                self.assertEqual(hello["version"], self.rival["version"])

    def check(self, program, answers, X, gap):
        """A gap below 0 is an overlap."""
        if "collide" in answers:
            self.assertEqual(program.ask("collide", X).get("collide"), gap < 0.0, self.now)
        if "distance" not in answers:
            return
        reply = program.ask("distance", X)
        self.assertAlmostEqual(reply["distance"], max(gap, 0.0), delta=SINGLE, msg=f"{self.now}: {reply}")
        if gap > 0.0 and "a" in reply:
            self.assertAlmostEqual(math.dist(reply["a"], reply["b"]), gap, delta=SINGLE, msg=self.now)

    def test_boxes_with_faces_in_parallel_planes(self):
        for gap in (0.37, 0.011, -0.05, -0.4):
            X = pose((0.1, -0.2, HIGH[2] - LOW[2] + gap), 2, YAW)
            for program, answers, _, in_order in self.each_setting(box()):
                self.check(program, answers, X if in_order else inverse(X), gap)

    def test_closest_points_are_in_the_frame_of_a(self):
        X = pose((2.7, 0.3, 0.2), 0, YAW)
        for program, answers, _, in_order in self.each_setting(sphere(3)):
            reply = program.ask("distance", X) if "distance" in answers and in_order else {}
            if "a" in reply:
                self.assertLess(math.hypot(*reply["a"]), 1.0 + SINGLE, self.now)
                self.assertLess(math.dist(reply["b"], X[9:]), 1.0 + SINGLE, self.now)

    def test_spheres_with_vertices_opposite(self):
        for gap in (1.3, 0.02, -0.1):
            X = pose((2.0 + gap, 0.0, 0.0), 0, YAW)
            for program, answers, _, in_order in self.each_setting(sphere(3)):
                self.check(program, answers, X if in_order else inverse(X), gap)

    def cast(self, program, X, translation, rotation=(0.0, 0.0, 0.0)):
        """About B's origin, which is the centre of its box."""
        return program.say({"do": "ask", "query": "cast", "pose": X, "translation": list(translation),
                            "rotation": list(rotation), "reference": [0.0, 0.0, 0.0]})

    def test_first_contact_of_boxes_that_stay_parallel(self):
        gap = 0.37
        X = pose((0.1, -0.2, HIGH[2] - LOW[2] + gap), 2, YAW)
        for program, answers, _, in_order in self.each_setting(box()):
            if "cast" not in answers or not in_order:
                continue
            for rotation in ((0.0, 0.0, 0.0), (0.0, 0.0, 1.3), (0.0, 0.0, -4.0)):
                reply = self.cast(program, X, (0.02, 0.05, -1.0), rotation)
                self.assertAlmostEqual(reply["t"], gap, delta=SINGLE, msg=f"{self.now}: {reply}")
                if "a" in reply:
                    self.assertAlmostEqual(reply["a"][2], HIGH[2], delta=SINGLE, msg=f"{self.now}: {reply}")
                    self.assertAlmostEqual(reply["b"][2], HIGH[2], delta=SINGLE, msg=f"{self.now}: {reply}")
                if "normal" in reply:
                    self.assertAlmostEqual(reply["normal"][2], 1.0, delta=SINGLE, msg=f"{self.now}: {reply}")
                for away in ((0.02, 0.05, 1.0), (0.02, 0.05, -0.9 * gap)):
                    self.assertIs(self.cast(program, X, away, rotation)["hit"], False, self.now)
            touching = self.cast(program, pose((0.9, 0.3, 0.4), 2, YAW), (1.0, 0.0, 0.0))
            self.assertEqual((touching["hit"], touching["t"]), (True, 0), self.now)

    def test_the_force_leads_out(self):
        X = pose((1.1, 1.0, 0.7), 2, YAW)
        for program, answers, hello, in_order in self.each_setting(sphere(3)):
            if "respond" not in answers:
                continue
            pair = X if in_order else inverse(X)
            self.assertNotEqual(hello["law"], "none")
            reply = program.ask("respond", pair)
            away = [x / math.hypot(*pair[9:]) for x in pair[9:]]
            along = sum(f * x for f, x in zip(reply["force"], away))
            # A known failure of a library's profile stands in its recipe, and in FINDINGS.md.
            known = [least for profile, least in self.rival.get("force_along", {}).items() if f"profile {profile}," in self.now]
            self.assertGreater(along, min([0.8, *known]) * math.hypot(*reply["force"]), f"{self.now}: {reply}")
            for least in known:
                self.assertLess(along, 0.8 * math.hypot(*reply["force"]), f"{self.now}: no longer a known failure")
            self.assertGreater(reply["penalty"], 0.0)
            for got, expected in zip(reply["reference"], point(pair, (0.0, 0.0, 0.0))):
                self.assertAlmostEqual(got, expected, delta=SINGLE)
            apart = program.ask("respond", pose((4.0, 0.1, 0.2), 2, YAW))
            self.assertEqual((apart["force"], apart["penalty"]), ([0, 0, 0], 0), self.now)


if __name__ == "__main__":
    end(unittest.main(exit=False))
