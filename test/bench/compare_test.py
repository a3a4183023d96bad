"""bench/compare: the verdict on synthetic times (a slowdown is found, noise is not taken for one), the rows, and answers.
"""

import importlib.machinery
import importlib.util
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "bench" / "compare"
sys.path.insert(0, str(SCRIPT.parent))
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
            done = subprocess.run(compare.compare_py("benchmarks", *map(str, files)), capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("+0.5000", done.stdout)


# A program that writes one row; what it answers and how long it takes are settings.
PROGRAM = """#!/usr/bin/python3
import json, random, sys
settings = json.loads('''SETTINGS''')
flags = dict(word[2:].split("=", 1) for word in sys.argv[1:] if word.startswith("--") and "=" in word)
row = {"name": "distance/algorithm:x/pair:p/distance:05", "run_name": "distance/algorithm:x/pair:p/distance:05",
       "run_type": "iteration", "repetitions": 1, "repetition_index": 0, "threads": 1, "iterations": 9,
       "time_unit": "ns", "cpu_time": settings["time"] * (1 + 0.01 * random.random()), "failed": 0.0, "p50_ns": 5.0,
       "mismatch": 0.0, "error_max": 1e-16 * random.random(), "nodes_tested": 10.0,
       "sixdof": {"query": "distance", "algorithm": "x", "settings": {}}} | settings.get("row", {})
row["real_time"] = row["cpu_time"]
rows = [row] + [row | {"name": name, "run_name": name} for name in settings.get("more", [])]
if settings.get("error"):
    rows[0] = {key: row[key] for key in ("name", "run_name", "run_type", "repetitions", "repetition_index", "threads", "sixdof")}
    rows[0] |= {"error_occurred": True, "error_message": settings["error"]}
json.dump({"context": {"date": "today", "algorithm:x": settings["version"]}, "benchmarks": rows},
          open(flags["benchmark_out"], "w"))
sys.exit(1 if settings.get("error") else 0)
"""


def compared(programs, folder, *arguments):
    return subprocess.run([sys.executable, "-B", SCRIPT, "--programs", *programs,
                           "--sixdof", SIXDOF, "--folder", pathlib.Path(folder) / "results", *arguments], capture_output=True, text=True)


class Programs(unittest.TestCase):
    """Two programs whose answers and times are known."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def program(self, name, time=100.0, version="1.0", **settings):
        path = pathlib.Path(self.folder.name) / name
        settings |= {"time": time, "version": version}
        path.write_text(PROGRAM.replace("SETTINGS", json.dumps(settings)), encoding="utf-8")
        path.chmod(0o755)
        return path

    def compare(self, *arguments, base=None, contender=None):
        programs = [self.program("base", **(base or {})), self.program("contender", **(contender or {}))]
        return compared(programs, self.folder.name, "--filter", ".", *arguments)

    def test_that_agree_have_no_changed_answers(self):
        done = self.compare("--fail-on-answers", "--fail-above", "10")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("answers: 0 counters of 1 rows changed", done.stdout)
        self.assertNotIn("version", done.stdout)

    def test_that_differ_show_versions_and_answers_before_times(self):
        done = self.compare("--fail-on-answers", "--fail-above", "10", contender={
            "version": "1.1", "row": {"mismatch": 3.0, "error_max": 0.02, "nodes_tested": 20.0}})
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        lines = done.stdout.splitlines()
        self.assertEqual(lines[0], "version  algorithm:x: 1.0 -> 1.1")
        row = "distance/algorithm:x/pair:p/distance:05"
        self.assertRegex(lines[1], f"^ANSWER   {row}: error_max .* -> 0.02$")
        self.assertEqual(lines[2], f"ANSWER   {row}: mismatch 0 -> 3")
        self.assertEqual(lines[3], f"work     {row}: nodes_tested 10 -> 20")
        self.assertEqual(lines[4], "answers: 2 counters of 1 rows changed")
        self.assertIn("Time", "".join(lines[5:]))

    def test_answers_alone_need_one_run_of_each(self):
        done = self.compare("--fail-on-answers")
        self.assertEqual((done.returncode, done.stdout), (0, "answers: 0 counters of 1 rows changed\n"), done.stderr)
        self.assertIn("repetition 1 of 1: contender", done.stderr)

    def test_changed_answers_alone_fail_nothing_that_was_not_asked(self):
        done = self.compare(contender={"row": {"mismatch": 3.0}})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_that_are_slower_fail_by_time(self):
        done = self.compare("--fail-above", "10", contender={"time": 130.0})
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("answers: 0 counters", done.stdout)
        self.assertRegex(done.stdout, "SLOWER distance/algorithm:x/pair:p/distance:05: x1.[23]")

    def test_a_row_without_a_result_is_a_change(self):
        done = self.compare("--fail-on-answers", base={"more": ["distance/y"]},
                            contender={"error": "it broke", "more": ["distance/z"]})
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("only in base: distance/y", done.stdout)
        self.assertIn("only in contender: distance/z", done.stdout)
        self.assertIn("ANSWER   distance/algorithm:x/pair:p/distance:05: error none -> it broke", done.stdout)

    def test_that_do_not_exist_are_named(self):
        done = subprocess.run([SCRIPT, "--programs", "/nowhere/a", "/nowhere/b"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr, "bench/compare: /nowhere/a: no such program\n")

    def test_are_not_mixed_with_commits(self):
        for arguments in (["HEAD", "--programs", "a", "b"], []):
            done = subprocess.run([SCRIPT, *arguments], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertIn("name a commit, or two programs", done.stderr)


class SixdofBench(unittest.TestCase):
    """sixdof-bench against itself: its rows are read, and the same program gives the same answers."""

    def test_agrees_with_itself(self):
        with tempfile.TemporaryDirectory() as folder:
            done = compared([BENCH, BENCH], folder, "--filter", "^(distance|respond)/algorithm:(exact|vps)/",
                            "--sample", "8", "--min-time", "0.001", "--fail-on-answers", "--", "--manifest", MANIFEST)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout.splitlines()[0], "^answers: 0 counters of [1-9][0-9]* rows changed$")


if __name__ == "__main__":
    SIXDOF, BENCH, MANIFEST = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
