"""bench/scripts/growth: a real run on small recipes.

usage: growth_test.py SIXDOF SIXDOF_BENCH
"""

import importlib.machinery
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

GROWTH = str(pathlib.Path(__file__).resolve().parents[2] / "bench/scripts/growth")
SIXDOF, SIXDOF_BENCH = sys.argv[1:3]
del sys.argv[1:3]
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("growth", GROWTH)
growth = importlib.util.module_from_spec(importlib.util.spec_from_loader("growth", loader))
loader.exec_module(growth)


class Words(unittest.TestCase):
    def test_counts(self):
        self.assertEqual([growth.count_of(text) for text in ("500", "3k", "1m")], [500, 3_000, 1_000_000])


class Run(unittest.TestCase):
    def growth(self, *words):
        return subprocess.run([sys.executable, "-B", GROWTH, "--program", SIXDOF, "--bench",
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
            self.assertIn("no pair is measured yet", done.stderr)
            self.assertEqual(self.growth("--out", folder, "--counts", "3q").returncode, 2)
            self.assertIn("no algorithm is called exakt",
                          self.growth("--out", folder, "--algorithms", "exakt").stderr)


if __name__ == "__main__":
    unittest.main()
