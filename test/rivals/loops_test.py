#!/usr/bin/env python3
"""The server loops of bench/rivals/ in a scripted conversation. Each serves a probe with the same answers: distance is
t_x + the sum of A's coordinates + that of B's indices; t_y tells how a query fails.

usage: loops_test.py python|javascript|rust RIVALS WORK
"""

import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

from conversation import Mesh, Program, end

LANGUAGE, RIVALS, WORK = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
del sys.argv[1:]
HERE = pathlib.Path(__file__).resolve().parent
A = [[0.1, 0.2, 0.3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0 / 3.0]]
B = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]
SUM = sum(sum(row) for row in A) + 18
ROUNDING = 1e-14  # the loops may add in another order


def pose(x, command=0.0):
    return [1, 0, 0, 0, 1, 0, 0, 0, 1, x, command, 0.0]


def probe():
    """Command line of the probe. Raises SkipTest where the language is missing."""
    if LANGUAGE == "python":
        return ["env", f"PYTHONPATH={RIVALS / 'python'}", sys.executable, "-B", HERE / "probe.py"]
    if LANGUAGE == "javascript":
        node = shutil.which("node") or shutil.which("nodejs")
        if not node:
            raise unittest.SkipTest("node is not installed")
        return [node, HERE / "probe.js", RIVALS / "javascript/sixdof_rival.js"]
    cargo = shutil.which("cargo")
    if not cargo:
        raise unittest.SkipTest("cargo is not installed")
    for name, source in (("rust", RIVALS / "rust"), ("probe", HERE / "probe_rust")):
        shutil.copytree(source, WORK / name, dirs_exist_ok=True, ignore=shutil.ignore_patterns("target", "Cargo.lock"))
    built = subprocess.run([cargo, "build", "--quiet"], cwd=WORK / "probe", capture_output=True, text=True, check=False)
    if any(words in built.stderr for words in ("failed to download", "failed to get", "Could not resolve", "failed to fetch")):
        raise unittest.SkipTest("cargo cannot fetch serde_json and libc")
    if built.returncode != 0:
        raise AssertionError(built.stderr)
    return [WORK / "probe/target/debug/probe"]


class Loop(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.command = [str(word) for word in probe()]

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.progress = self.folder / "progress"
        self.progress.write_bytes(bytes(8))
        self.a, self.b = Mesh(scratch.name, "a", A, B), Mesh(scratch.name, "b", A, B)
        self.program = Program(self.command)
        self.program.__enter__()
        self.addCleanup(self.program.__exit__)

    def prepare(self, a=None, b=None, **settings):
        return self.program.prepare(a or self.a, b or self.b, str(self.progress), **settings)

    def time(self, poses, each=True, passes=2, query="distance"):
        return self.program.say({"do": "time", "query": query, "passes": passes, "each": each, "evict_bytes": 1 << 16,
                                 "poses": poses})

    def begun(self):
        return struct.unpack("Q", self.progress.read_bytes())[0]

    def can_tell_progress(self):
        return "progress" in self.program.hello()["can"]

    def test_hello(self):
        hello = self.program.hello()
        self.assertEqual({key: hello[key] for key in ("protocol", "name", "version", "summary", "answers")},
                         {"protocol": 1, "name": "probe", "version": "1.0", "summary": "a probe",
                          "answers": ["collide", "distance", "cast", "contacts"]})
        self.assertEqual(hello["depth"], "point")
        self.assertEqual(hello["parameters"][0]["choices"], ["none", "bad_mesh", "bad_argument"])
        self.assertIn("time", hello["can"])
        self.assertIn("error", self.program.say({"do": "hello", "protocol": 2}))

    def test_answers_have_all_digits(self):
        prepared = self.prepare()
        self.assertTrue(prepared["prepared"])
        self.assertEqual((prepared["bytes"], prepared["counts"]["things"]), (12, 3))
        self.assertGreaterEqual(prepared["ns"], 0)
        self.assertGreaterEqual(prepared["cpu_ns"], 0)
        x = 0.1 + 0.2
        reply = self.program.ask("distance", pose(x))
        self.assertAlmostEqual(reply["distance"], x + SUM, delta=ROUNDING)
        self.assertEqual((reply["a"], reply["b"]), ([x, 0, 0], [0, 0, 0]))
        self.assertGreaterEqual(reply["ns"], 0)
        self.assertIs(self.program.ask("collide", pose(-1.0))["collide"], True)
        self.assertIs(self.program.ask("collide", pose(1.0))["collide"], False)

    def ask_contacts(self, x, most, command=0.0):
        return self.program.say({"do": "ask", "query": "contacts", "pose": pose(x, command), "most": most})

    def test_contacts(self):
        self.assertEqual(self.ask_contacts(0.1, 2)["kind"], "bad_argument", "nothing is prepared")
        self.prepare()
        x = 0.1 + 0.2
        reply = self.ask_contacts(x, 2)
        self.assertEqual((reply["points"], reply["normals"], reply["depths"]),
                         ([[x, 0, 0], [x, 1, 0]], [[0, 0.6, 0.8]] * 2, [x, x]))
        self.assertGreaterEqual(reply["ns"], 0)
        self.assertEqual(self.ask_contacts(x, 0)["points"], [])
        self.assertEqual(self.ask_contacts(x, 1, 2)["status"], "non_finite")
        self.assertEqual(self.ask_contacts("inf", 1)["status"], "non_finite")
        self.assertEqual(self.time([pose(0.1)], query="contacts")["kind"], "bad_argument", "they are never asked by time")

    def test_another_pair_takes_the_place_of_the_first(self):
        if "again" not in self.program.hello()["can"]:
            self.skipTest("the loop prepares one pair")
        self.prepare()
        Mesh(str(self.folder), "a", [[2 * x for x in row] for row in A], B)  # in the same file
        self.prepare()
        self.assertAlmostEqual(self.program.ask("distance", pose(0.0))["distance"], 2 * SUM - 18, delta=ROUNDING)

    def test_copies_are_recognised(self):
        self.prepare(b=self.a)
        self.assertEqual(self.program.ask("distance", pose(0.0))["b"], [0, 0, 1])

    def test_failed_queries(self):
        self.prepare()
        for command, status, words in ((1, "failed", "gave up"), (2, "non_finite", ""), (4, "failed", "a library throws")):
            reply = self.program.ask("distance", pose(0.5, command))
            self.assertEqual(reply["status"], status, reply)
            self.assertIn(words, reply["words"])
            self.assertNotIn("distance", reply)
        self.assertEqual(self.program.ask("respond", pose(0.5))["status"], "unsupported")
        self.assertEqual(self.program.ask("distance", pose("nan"))["status"], "non_finite")
        self.assertEqual(self.program.ask("distance", pose("-inf"))["status"], "non_finite")
        self.assertEqual(self.program.ask("collide", pose("nan"))["status"], "non_finite", "no answer is made up")
        self.assertEqual([each[:2] for each in self.time([pose("inf")], query="collide")["failed"]], [[0, "non_finite"]])
        self.assertIn("distance", self.program.ask("distance", pose(0.5)))

    def cast(self, translation, rotation, command=0.0):
        return self.program.say({"do": "ask", "query": "cast", "pose": pose(0.5, command), "translation": translation,
                                 "rotation": rotation, "reference": [0.1, 0.2, 0.3]})

    def test_casts(self):
        self.assertEqual(self.cast([0.25, 1, 2], [0, 0, 0])["kind"], "bad_argument", "nothing is prepared")
        self.prepare()
        reply = self.cast([1.0 / 3.0, 1, 2], [0.5, 0.25, -1])
        self.assertGreaterEqual(reply.pop("ns"), 0)
        self.assertEqual(reply, {"hit": True, "t": 1.0 / 3.0, "a": [0.1, 0.2, 0.3], "b": [0.5, 0.25, -1], "normal": [0, 0, 1]})
        none = self.cast([0.25, 1, 2], [0, 0, 1])
        self.assertIs(none["hit"], False)
        self.assertNotIn("t", none)
        self.assertEqual(self.cast([0.25, 1, 2], [0, 0, 0], 1)["status"], "failed")
        self.assertEqual(self.cast([0.25, 1, 2], [0, 0, 0], 2)["status"], "non_finite")
        for wrong in (["nan", 1, 2], [0.25, "inf", 2]):
            self.assertEqual(self.cast(wrong, [0, 0, 0])["status"], "non_finite")
            self.assertEqual(self.cast([0.25, 1, 2], wrong)["status"], "non_finite")
        self.assertIn("error", self.cast([0.25, 1], [0, 0, 0]))
        self.assertIn("distance", self.program.ask("distance", pose(0.5)))

    def test_what_a_library_prints_is_no_reply(self):
        self.prepare()
        self.assertAlmostEqual(self.program.ask("distance", pose(0.5, 3))["distance"], 0.5 + SUM, delta=ROUNDING)

    def test_refusals(self):
        self.assertEqual(self.program.ask("distance", pose(1.0))["kind"], "bad_argument")
        self.assertEqual(self.prepare(mode="bad_mesh"), {"error": "a bad mesh", "kind": "bad_mesh"})
        self.assertEqual(self.prepare(mode="bad_argument"), {"error": "a bad argument", "kind": "bad_argument"})
        short = Mesh(self.folder, "short", A, B)
        short.place["vertex_count"] += 1
        self.assertEqual(self.prepare(a=short)["kind"], "error")
        self.assertIn("error", self.program.ask("distance", pose(1.0)), "nothing is prepared after a refusal")
        self.prepare()
        self.assertEqual(self.program.ask("weight", pose(1.0))["kind"], "bad_argument")
        for nonsense in ("no JSON", '{"do": "dance"}', '{"do": "ask", "query": "distance", "pose": [1, 2]}'):
            self.assertIn("error", self.program.say(nonsense))
        self.assertIn("distance", self.program.ask("distance", pose(1.0)))

    def test_times_of_each_query(self):
        self.prepare()
        poses = [pose(0.1), pose(0.2, 1), pose(0.3), pose(0.4, 2)]
        reply = self.time(poses)
        self.assertEqual((len(reply["once_ns"]), len(reply["least_ns"])), (4, 4))
        for once, least in zip(reply["once_ns"], reply["least_ns"]):
            self.assertTrue(0 <= least <= once)
        self.assertEqual([each[:2] for each in reply["failed"]], [[1, "failed"], [3, "non_finite"]])
        if self.can_tell_progress():
            self.assertEqual(self.begun(), 8)

    def test_times_of_all_passes(self):
        self.prepare()
        reply = self.time([pose(0.1), pose(0.2, 4), pose(0.3)], each=False, passes=5)
        self.assertGreater(reply["wall_ns"], 0)
        self.assertGreaterEqual(reply["cpu_ns"], 0)
        if self.can_tell_progress():
            self.assertEqual(self.begun(), 15)

    def test_times_of_what_is_not_answered(self):
        self.prepare()
        self.assertEqual([each[:2] for each in self.time([pose(0.1)], query="respond")["failed"]], [[0, "unsupported"]])
        self.assertGreaterEqual(self.time([pose(0.1)], query="respond", each=False)["wall_ns"], 0)

    def test_long_lines(self):
        self.prepare()
        reply = self.time([pose(0.1 * i + 1.0 / 3.0) for i in range(4096)], passes=1)
        self.assertEqual(len(reply["once_ns"]), 4096)
        self.assertEqual(reply["failed"], [])


if __name__ == "__main__":
    end(unittest.main(exit=False))
