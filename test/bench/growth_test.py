"""bench/growth: its fit on synthetic points, and a real run on small recipes.

usage: growth_test.py SIXDOF SIXDOF_BENCH
"""

import importlib.machinery
import importlib.util
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

BENCH = pathlib.Path(__file__).resolve().parents[2] / "bench"
SIXDOF, SIXDOF_BENCH = sys.argv[1:3]
del sys.argv[1:3]
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("growth", str(BENCH / "growth"))
growth = importlib.util.module_from_spec(importlib.util.spec_from_loader("growth", loader))
loader.exec_module(growth)


class Fit(unittest.TestCase):
    def test_finds_one_exponent_of_shapes_with_factors_of_their_own(self):
        points = {shape: [(n, factor * n ** 0.7) for n in (1e3, 1e4, 1e5)] for shape, factor in (("a", 3), ("b", 50))}
        exponent, half_width, count = growth.fit(points)
        self.assertAlmostEqual(exponent, 0.7)
        self.assertAlmostEqual(half_width, 0.0)
        self.assertEqual(count, 6)

    def test_agrees_with_a_line_worked_out_by_hand(self):
        # Logarithms (0, 0), (1, 2), (2, 1), (3, 3): slope 0.8, residual squares 1.8, so that the slope's standard
        # error is sqrt(1.8 / 2 / 5), and t = 4.303 with two degrees of freedom.
        points = {"a": [(math.exp(x), math.exp(y)) for x, y in ((0, 0), (1, 2), (2, 1), (3, 3))]}
        exponent, half_width, _ = growth.fit(points)
        self.assertAlmostEqual(exponent, 0.8)
        self.assertAlmostEqual(half_width, 4.303 * math.sqrt(1.8 / 2 / 5))

    def test_the_interval_holds_the_exponent_in_95_of_100_cases(self):
        generator = random.Random(4)
        runs, held = 2000, 0
        for _ in range(runs):
            points = {shape: [(n, n ** 0.4 * math.exp(generator.gauss(0, 0.3))) for n in (1e3, 3e3, 1e4, 3e4)]
                      for shape in "ab"}
            exponent, half_width, _ = growth.fit(points)
            held += abs(exponent - 0.4) <= half_width
        self.assertAlmostEqual(held / runs, 0.95, delta=0.02)  # four standard deviations of the count

    def test_too_few_points_have_no_fit(self):
        self.assertIsNone(growth.fit({}))
        self.assertIsNone(growth.fit({"a": [(1e3, 1.0)], "b": [(1e3, 2.0)]}))
        self.assertIsNone(growth.fit({"a": [(1e3, 1.0), (1e4, 2.0)]}))

    def test_counts(self):
        self.assertEqual([growth.count_of(text) for text in ("500", "3k", "1m")], [500, 3_000, 1_000_000])


class Run(unittest.TestCase):
    def growth(self, *words):
        return subprocess.run([sys.executable, "-B", str(BENCH / "growth"), "--program", SIXDOF, "--bench",
                               SIXDOF_BENCH, "--algorithms", "exact", "--grid", "so3:4:2", "--sample", "4", *words],
                              capture_output=True, text=True, check=False)

    def test_fits_every_quantity_and_names_what_was_not_made(self):
        with tempfile.TemporaryDirectory(prefix="sixdof-growth-") as folder:
            out = pathlib.Path(folder) / "run"
            words = ["--out", str(out), "--shapes", "box,circular-box", "--counts", "500,1k,2k,4k"]
            done = self.growth(*words)
            self.assertEqual(done.returncode, 0, done.stderr)
            # A circular box has 960 triangles at least.
            self.assertIn("circular-box-500: no mesh: ", done.stdout)
            rows = json.loads((out / "growth.json").read_text())["growth"]
            self.assertEqual({(row["algorithm"], row["quantity"]) for row in rows},
                             {("sixdof generate", "set, s")} | {("exact", quantity) for quantity in (
                                 "prepare, ms", "memory, bytes", "distance, us", "collide, us", "respond, us")})
            for row in rows:
                self.assertEqual(row["fitted"], 7)
            # The bytes of a tree are proportional to the triangles.
            [memory] = [row for row in rows if row["quantity"] == "memory, bytes"]
            self.assertAlmostEqual(memory["exponent"], 1.0, delta=0.15)
            self.assertIn("| `exact` |", done.stdout)
            self.assertEqual(self.growth(*words).stderr, "")
            self.assertEqual(self.growth("--out", str(out), "--report").returncode, 0)

    def test_wrong_words_end_in_one_line(self):
        with tempfile.TemporaryDirectory(prefix="sixdof-growth-") as folder:
            done = self.growth("--out", folder, "--report")
            self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1))
            self.assertIn("nothing is measured yet", done.stderr)
            self.assertEqual(self.growth("--out", folder, "--counts", "3q").returncode, 2)
            self.assertIn("no algorithm is called exakt",
                          self.growth("--out", folder, "--algorithms", "exakt").stderr)


if __name__ == "__main__":
    unittest.main()
