#!/usr/bin/env python3
"""Algorithms of a user's own: asked here, and measured by sixdof-bench wherever their class was defined.

usage: bench_test.py MANIFEST
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from common import arguments, environment, main, numpy, random_poses, sixdof

MANIFEST = arguments(1)
SAMPLE = 32
QUICK = {"manifest": MANIFEST, "sample": SAMPLE, "budget": 4, "buckets": ["distance/05"],
         "options": ["--benchmark_min_time=0.000001"]}

# A class that asks the library for its answers, so that they are right. It uses a name of its module.
SOURCE = """
import sixdof

SCALE = 1.0

class Asking(sixdof.Algorithm):
    '''Asks exact.'''
    parameters = (sixdof.parameter("factor", 1.0, low=0.5, high=2.0),)

    def prepare(self):
        print("a line on standard output")
        self.pair = sixdof.prepare("exact", self.a, self.b)

    def distance(self, pose):
        answer = self.pair.distance(pose)
        return SCALE * self.settings["factor"] * answer.distance, answer.points_a, answer.points_b

    def collide(self, pose):
        return self.pair.collide(pose).colliding
"""
CALL = f"""
import json
{{imports}}
results = sixdof.bench({{name}}, pairs=["torus-1k"], manifest={MANIFEST!r}, sample={SAMPLE}, budget=4,
                       queries=["distance", "collide"], buckets=["distance/05"],
                       options=["--benchmark_min_time=0.000001"])
print(json.dumps([[row["name"], row["failed"], row["mismatch"], row["judged"]] for row in results.rows]))
"""


class Faulty(sixdof.Algorithm):
    """Raises, or says that there is no answer."""

    version = "2.5"

    def distance(self, pose):
        if pose[0, 0] > 0.1:
            return 1 / 0
        if pose[0, 0] < -0.1:
            raise sixdof.NoAnswer("no convergence", "non_finite")
        return 0.0


class Dying(sixdof.Algorithm):
    """Ends its process at some poses."""

    def distance(self, pose):
        if pose[0, 0] > 0.1:
            os._exit(3)
        return 0.0


class Silent(sixdof.Algorithm):
    """Never has an answer."""

    def distance(self, pose):
        raise sixdof.NoAnswer("not today")


class Cells(sixdof.Algorithm):
    """A response of a constant force along the line of the centres."""

    law = "depth"

    def prepare(self):
        self.empty = len(self.a.triangles) == 0

    def respond(self, pose):
        force = pose[:3, :3] @ self.b.center + pose[:3, 3] - self.a.center
        return {"penalty": 1.0, "force": force, "torque": numpy.zeros(3)}


class Where(unittest.TestCase):
    """Where a class is defined."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def check(self, *words, folder=None, **more):
        done = subprocess.run([sys.executable, *words], capture_output=True, text=True, check=False, env=environment(),
                              cwd=folder or self.folder, **more)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = {row[0].partition("/pair")[0]: row[1:] for row in json.loads(done.stdout.splitlines()[-1])}
        for query in ("distance", "collide"):
            self.assertEqual(rows[f"{query}/algorithm:asking"], [0, 0, SAMPLE])
            self.assertEqual(rows[f"{query}/algorithm:exact"], [0, 0, SAMPLE])

    def test_script_without_a_guard(self):
        script = self.folder / "my script.py"
        script.write_text(SOURCE + CALL.format(imports="", name="Asking"))
        self.check(script)

    def test_module_beside_a_script(self):
        (self.folder / "mine.py").write_text(SOURCE)
        script = self.folder / "run.py"
        script.write_text(CALL.format(imports="import mine, sixdof", name="mine.Asking"))
        self.check(script, folder="/")

    def test_module_run_as_program(self):
        package = self.folder / "tools"
        package.mkdir()
        (package / "__init__.py").write_text("")
        (package / "helper.py").write_text("SCALE = 1.0\n")
        text = SOURCE.replace("SCALE = 1.0", "from tools.helper import SCALE")
        (package / "run.py").write_text(text + CALL.format(imports="", name="Asking"))
        self.check("-m", "tools.run")

    def test_standard_input(self):
        self.check("-", input=SOURCE + CALL.format(imports="", name="Asking"))

    def test_cells_of_a_notebook(self):
        cells = [SOURCE, CALL.format(imports="", name="Asking")]
        self.check("-c", f"for i, cell in enumerate({cells!r}): exec(compile(cell, f'<cell {{i}}>', 'exec'), globals())")

    def test_class_made_by_a_function(self):
        def make(offset):
            class Made(sixdof.Algorithm):
                name = "asking"

                def prepare(self):
                    self.pair = sixdof.prepare("exact", self.a, self.b)

                def distance(self, pose):
                    return self.pair.distance(pose).distance + offset
            return Made

        results = sixdof.bench(make(1.0), pairs=["torus-1k"], queries=["distance"], **QUICK)
        rows = {row["algorithm"]: row for row in results.rows}
        self.assertEqual(rows["asking"]["mismatch"], SAMPLE)
        self.assertAlmostEqual(rows["asking"]["error_max"] * sixdof.load("torus-1k").diagonal, 1.0, delta=1e-9)


class Measured(unittest.TestCase):
    def test_failures_are_counted_with_words(self):
        rows = {row["algorithm"]: row for row in
                sixdof.bench(Faulty, pairs=["torus-1k"], queries=["distance"], **QUICK).rows}
        self.assertGreater(rows["faulty"]["failed"], 0)
        self.assertLess(rows["faulty"]["failed"], SAMPLE)
        self.assertRegex(rows["faulty"]["label"], r"ZeroDivisionError: division by zero \(bench_test.py:\d+\)|no convergence")
        self.assertEqual(rows["exact"]["failed"], 0)

    def test_a_process_that_ends(self):
        rows = {row["algorithm"]: row for row in
                sixdof.bench(Dying, pairs=["torus-1k"], queries=["distance"], **QUICK).rows}
        self.assertGreater(rows["dying"]["crashed"], 0)
        self.assertEqual(rows["exact"]["failed"], 0)

    def test_a_row_without_any_answer(self):
        with self.assertWarnsRegex(sixdof.FailedQueries, "1 rows could not be run: .*silent.*not today"):
            results = sixdof.bench(Silent, pairs=["torus-1k"], queries=["distance"], **QUICK)
        self.assertIn("not today", "".join(row["error"] for row in results.rows))

    def test_meshes_of_ones_own_and_the_table(self):
        cone = sixdof.load("cone-100")
        mesh = sixdof.mesh(1.5 * cone.vertices, cone.triangles, name="my cone")
        with tempfile.TemporaryDirectory() as folder:
            results = sixdof.bench([Cells, "exact"], [(mesh, "torus-100")], out=folder, sample=SAMPLE, budget=5,
                                   queries=["respond", "prepare"], options=["--benchmark_min_time=0.000001"])
            self.assertEqual({row["pair"] for row in results.rows}, {"my-cone-torus-100"})
            self.assertEqual({row["algorithm"] for row in results.rows}, {"cells", "exact"})
            rows = [row for row in results.rows if row["query"] == "respond" and row["algorithm"] == "cells"]
            self.assertGreater(len(rows), 1)
            for row in rows:
                self.assertEqual((row["failed"], row["isolated"]), (0, True))
                if row["bucket_kind"] == "volume":
                    self.assertGreater(row["gamma_F_deg"], 0)
            self.assertIn("volume", {row["bucket_kind"] for row in rows})
            self.assertRegex(results.table(), r"respond.*\n[^$]*cells ")
            self.assertIn("cells", results._repr_html_())
            self.assertIn("rows of", repr(results))
            self.assertEqual(sixdof.read_rows(folder), results.rows)
            self.assertEqual(sixdof.read_context(results.files[0])["algorithm:cells"], "1")

    def test_parameters(self):
        class Asking(sixdof.Algorithm):
            parameters = (sixdof.parameter("factor", 1.0, low=0.5, high=2.0),)

            def distance(self, pose):
                return self.settings["factor"]

        rows = sixdof.bench(Asking, pairs=["torus-1k"], queries=["distance"], parameters={"asking": {"factor": 1.5}},
                            **QUICK).rows
        self.assertIn("factor=1.5", [row["settings"] for row in rows if row["algorithm"] == "asking"])

    def test_words_of_errors(self):
        class Empty(sixdof.Algorithm):
            pass

        class Exact(sixdof.Algorithm):
            def distance(self, pose):
                return 0.0

        pair = sixdof.prepare("exact", "cone-100")

        class Open(sixdof.Algorithm):
            def distance(self, pose):
                return pair.distance(pose).distance

        for words, algorithm, more in (("Empty defines none of", Empty, {}), ("name exact .*is taken", Exact, {}),
                                       ("Open uses something .*make it in prepare", Open, {}),
                                       ("no class derived", 3, {}), ("queries: touch", Faulty, {"queries": ["touch"]}),
                                       ("queries: a list", Faulty, {"queries": "distance"})):
            with self.assertRaisesRegex(sixdof.BadArgument, words):
                sixdof.bench(algorithm, ["torus-1k"], **(QUICK | more))
        for words, pairs in ((r"no pair tours; .*torus-1k", ["tours"]), (r"pairs\[0\]: neither", [3]),
                             ("pairs: a list", "torus-1k"), (r"pairs\[0\]: no model", [("tors-1k", "cone-1k")])):
            with self.assertRaisesRegex(sixdof.BadArgument, words):
                sixdof.bench(Faulty, pairs, **QUICK)
        with self.assertRaisesRegex(sixdof.BenchFailed, "no-such-option"):
            sixdof.bench(Faulty, ["torus-1k"], **(QUICK | {"options": ["--no-such-option"]}))


class Here(unittest.TestCase):
    """The same classes in this process."""

    def test_answers(self):
        poses = random_poses(20, 1.0)
        space = {}
        exec(SOURCE, space)
        pair = sixdof.prepare(space["Asking"], "cone-300", "torus-300", factor=2)
        exact = sixdof.prepare("exact", "cone-300", "torus-300")
        numpy.testing.assert_array_equal(pair.distance(poses).distance, 2 * exact.distance(poses).distance)
        numpy.testing.assert_array_equal(pair.distance(poses).points_b, exact.distance(poses).points_b)
        numpy.testing.assert_array_equal(pair.collide(poses).colliding, exact.collide(poses).colliding)
        self.assertEqual(pair.settings, "factor=2.0")

    def test_failures(self):
        poses = random_poses(20, 1.0)
        with self.assertWarnsRegex(sixdof.FailedQueries, "faulty: .* of 20 poses"):
            answers = sixdof.prepare(Faulty, "cone-300").distance(poses)
        positive = poses[:, 0, 0] > 0.1
        numpy.testing.assert_array_equal(answers.status == "failed", positive)
        numpy.testing.assert_array_equal(answers.status == "non_finite", poses[:, 0, 0] < -0.1)
        self.assertRegex(answers.words[int(numpy.flatnonzero(positive)[0])], r"ZeroDivisionError: .*bench_test.py:\d+")

    def test_responses_are_about_the_centre_of_b(self):
        poses = random_poses(4, 1.0)
        answers = sixdof.prepare(Cells, "cone-300", "torus-300").respond(poses)
        exact = sixdof.prepare("exact", "cone-300", "torus-300").respond(poses)
        numpy.testing.assert_allclose(answers.reference, exact.reference, atol=1e-14)  # roundings of lengths of 1
        self.assertTrue(answers.volume.mask.all())

    def test_bad_parameters(self):
        for words, value in (("factor: 3 is not from 0.5 to 2.0", 3), ("factor: \"x\" is no number", "x")):
            space = {}
            exec(SOURCE, space)
            with self.assertRaisesRegex(sixdof.BadArgument, words):
                sixdof.prepare(space["Asking"], "cone-300", factor=value)


if __name__ == "__main__":
    main()
