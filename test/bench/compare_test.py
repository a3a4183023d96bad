"""bench/compare: the verdict on synthetic times (a slowdown is found, noise is not taken for one), and the rows."""

import importlib.machinery
import importlib.util
import json
import pathlib
import random
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "bench" / "compare"
loader = importlib.machinery.SourceFileLoader("compare", str(SCRIPT))
compare = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare", loader))
loader.exec_module(compare)


def document(times):
    return {"benchmarks": [{"name": name, "cpu_time": t} for name, series in times.items() for t in series]}


def dump(p_values):
    return [{"name": name, "utest": {"cpu_pvalue": p}} for name, p in p_values.items()] + [{"name": "x", "utest": {}}]


def verdict(base, contender, p_values, percent=10):
    rows, tested = compare.slower_rows(document(base), document(contender), dump(p_values), percent)
    return [row[0] for row in rows], tested


class Verdict(unittest.TestCase):
    def setUp(self):
        noise = random.Random(5)
        self.base = [100 * (1 + 0.3 * noise.random()) for _ in range(9)]
        self.twice = [2 * t for t in self.base]

    def test_sees_a_slowdown(self):
        self.assertEqual(verdict({"a": self.base}, {"a": self.twice}, {"a": 4e-4}), (["a"], 1))

    def test_needs_significance_after_correction(self):
        self.assertEqual(verdict({"a": self.base}, {"a": self.twice}, {"a": 0.06}), ([], 1))
        # 0.01 is significant for one row but not for the best of ten.
        names = [f"r{i}" for i in range(10)]
        p_values = {name: 0.01 for name in names}
        self.assertEqual(verdict(dict.fromkeys(names, self.base), dict.fromkeys(names, self.twice), p_values)[0], [])

    def test_needs_size(self):
        slightly = [1.05 * t for t in self.base]
        self.assertEqual(verdict({"a": self.base}, {"a": slightly}, {"a": 1e-4})[0], [])

    def test_ignores_a_busy_machine(self):
        # Slower in most runs, but as fast as before in one.
        busy = self.twice[:8] + [min(self.base)]
        self.assertEqual(verdict({"a": self.base}, {"a": busy}, {"a": 1e-4})[0], [])

    def test_does_not_call_faster_slower(self):
        self.assertEqual(verdict({"a": self.twice}, {"a": self.base}, {"a": 1e-4})[0], [])


class Rows(unittest.TestCase):
    def program(self, text):
        path = pathlib.Path(self.folder.name) / f"program-{len(list(pathlib.Path(self.folder.name).iterdir()))}"
        path.write_text("#!/bin/sh\n" + text, encoding="utf-8")
        path.chmod(0o755)
        return path

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.old = self.program("exit 2\n")
        self.new = self.program('[ "$*" = "--suite default --benchmark_list_tests" ] && printf "a/b:1\\nc/d:2\\n"\n')

    def test_are_the_default_suite_of_a_commit_that_has_one(self):
        for base, contender in ((self.old, self.new), (self.new, self.old)):
            filter_ = compare.filter_of_default_suite({"base": base, "contender": contender})
            self.assertEqual(filter_, "^(a/b:1|c/d:2)$")

    def test_have_to_be_chosen_where_there_is_none(self):
        with self.assertRaises(compare.Failure):
            compare.filter_of_default_suite({"base": self.old, "contender": self.old})


class ComparePy(unittest.TestCase):
    """Google Benchmark's script takes rows with the fields of sixdof-bench."""

    def test_reads_result_files(self):
        fields = {"query": "distance", "algorithm": "exact", "settings": {}, "pair": "p", "order": "random",
                  "bucket": {"kind": "distance", "percent": 5}, "configurations": 64}
        with tempfile.TemporaryDirectory() as folder:
            files = []
            for side, time in (("base", 100.0), ("contender", 150.0)):
                row = {"name": "distance/algorithm:exact", "run_name": "distance/algorithm:exact",
                       "run_type": "iteration", "repetitions": 1, "repetition_index": 0, "threads": 1, "iterations": 9,
                       "real_time": time, "cpu_time": time, "time_unit": "ns", "sixdof": fields}
                files.append(pathlib.Path(folder) / side)
                files[-1].write_text(json.dumps({"context": {"date": "today"}, "benchmarks": [row]}), encoding="utf-8")
            done = subprocess.run(compare.COMPARE + ["benchmarks", *map(str, files)], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("+0.5000", done.stdout)


if __name__ == "__main__":
    unittest.main()
