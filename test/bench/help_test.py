"""Every --help of sixdof-bench and of the scripts in bench/ ends with two examples, and they run.

usage: help_test.py SIXDOF_BENCH SIXDOF
"""

import importlib.machinery
import importlib.util
import pathlib
import shlex
import subprocess
import sys
import tempfile
import unittest

BENCH = pathlib.Path(__file__).resolve().parents[2] / "bench"
SIXDOF_BENCH, SIXDOF = sys.argv.pop(1), sys.argv.pop(1)
QUICK = ["--benchmark_min_time=0.000001"]


def run(command, **options):
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


class Help(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def succeed(self, command):
        done = run(command, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def examples(self, command):
        """The words of both example command lines."""
        done = run(command + ["--help"], timeout=30)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        *_, title, first, second = done.stdout.rstrip().splitlines()
        self.assertEqual(title.lower(), "examples:")
        return [shlex.split(first), shlex.split(second)]

    def test_sixdof_bench(self):
        measure, show_list = self.examples([SIXDOF_BENCH])
        self.assertIn("fcl-rss", self.succeed([SIXDOF_BENCH, *measure[1:], *QUICK]))
        self.assertIn("scenario/II/algorithm:exact", self.succeed([SIXDOF_BENCH, *show_list[1:]]))

    def test_run(self):
        # Its options go to sixdof-bench; setting up and building the tree is no part of this test.
        for words in self.examples([str(BENCH / "run")]):
            self.assertEqual(words[0], "bench/run")
            self.assertIn("torus-knot-10k", self.succeed([SIXDOF_BENCH, *words[1:], "--benchmark_list_tests"]))

    def test_compare(self):
        sys.path.insert(0, str(BENCH))
        loader = importlib.machinery.SourceFileLoader("compare", str(BENCH / "compare"))
        compare = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare", loader))
        loader.exec_module(compare)
        commits, programs = self.examples([str(BENCH / "compare")])
        self.assertEqual((commits[0], programs[0]), ("bench/compare", "bench/compare"))
        self.assertEqual(compare.parse_arguments(commits[1:]).base, "v0.1")
        self.assertEqual(len(compare.parse_arguments(programs[1:]).programs), 2)

    def test_collection_and_growth(self):
        for script, said in (("collection", "6 pairs of 2 objects."), ("growth", "6 pairs.")):
            measure, report = self.examples([str(BENCH / "scripts" / script)])
            programs = ["--program", SIXDOF, "--bench", SIXDOF_BENCH]
            self.assertIn(said, self.succeed([str(BENCH / "scripts" / script), *measure[1:], *programs]))
            self.assertIn(said, self.succeed([str(BENCH / "scripts" / script), *report[1:], *programs]))


if __name__ == "__main__":
    unittest.main()
