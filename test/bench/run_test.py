"""bench/run, in a tree where set-up and build are stubs that leave a trace: help, refusals, and --resume.

usage: run_test.py SIXDOF_BENCH SIXDOF
"""

import json
import os
import pathlib
import re
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIXDOF_BENCH, SIXDOF = sys.argv.pop(1), sys.argv.pop(1)
ROWS = ["--benchmark_filter=^collide/algorithm:(null|exact)/pair:torus-knot-10k/distance:0[0-5]$", "--sample", "16"]
COUNT = 10


class Run(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.trace = self.folder / "trace"
        for name in ("bench/run", "CMakeLists.txt", "models/models.json", "fixtures/manifest.json"):
            (self.folder / name).parent.mkdir(exist_ok=True)
            shutil.copy(ROOT / name, self.folder / name)
        for name in ("cmake/setup", "stubs/cmake", "models/fetch"):
            stub = self.folder / name
            stub.parent.mkdir(exist_ok=True)
            stub.write_text(f"#!/bin/sh\necho {name} >> '{self.trace}'\n")
            stub.chmod(stub.stat().st_mode | stat.S_IXUSR)
        programs = self.folder / "build" / "release" / "bin"
        programs.mkdir(parents=True)
        (programs / "sixdof-bench").symlink_to(SIXDOF_BENCH)
        (programs / "sixdof").symlink_to(SIXDOF)
        self.environment = os.environ | {"PATH": f"{self.folder / 'stubs'}:{os.environ['PATH']}"}

    def command(self, *words):
        return [str(self.folder / "bench" / "run"), *words]

    def run_it(self, *words):
        return subprocess.run(self.command(*words), capture_output=True, text=True, check=False, env=self.environment)

    def result(self):
        """The only file in results/; its report stands in a folder beside it."""
        [path] = [path for path in (self.folder / "results").iterdir() if path.is_file()]
        return path

    def rows(self):
        return [row["name"] for row in json.loads(self.result().read_text())["benchmarks"]]

    def end(self, how):
        """Sends a signal to a run and its children, as a terminal does, when three rows have ended."""
        words = self.command(*ROWS, "--benchmark_min_time=0.2", "-p", "exact:warm_start=off")
        with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
                              env=self.environment) as program:
            while program.poll() is None:
                journals = list(self.folder.glob("results/*.journal"))
                if journals and journals[0].read_text().count('"row":') >= 3:
                    break
                time.sleep(0.01)
            self.assertIsNone(program.poll())
            os.killpg(program.pid, how)
            _, err = program.communicate(timeout=60)
        return program.returncode, err

    def test_help_and_version_build_nothing(self):
        usage = self.run_it("--help")
        self.assertEqual((usage.returncode, usage.stderr), (0, ""))
        self.assertTrue(usage.stdout.startswith("usage: bench/run"))
        for words in (["-h"], ["--sample", "3", "--help"], ["--help", "--no-such-option"], ["--resume", "-h"]):
            self.assertEqual(self.run_it(*words).stdout, usage.stdout, words)
        version = subprocess.run([SIXDOF_BENCH, "--version"], capture_output=True, text=True, check=True).stdout
        for words in (["--version"], ["--sample", "3", "--version"]):
            self.assertEqual(self.run_it(*words).stdout, version, words)
        self.assertFalse(self.trace.exists())
        self.assertFalse((self.folder / "results").exists())

    def test_wrong_options_are_refused_before_the_build(self):
        for words, message in [(["--no-such-option"], "--no-such-option: no such option"),
                               (["--sampel=3"], "--sampel=3: no such option"), (["--out", "x.json"], "results/"),
                               (["--benchmark_out_format=csv"], "results/"), (["-x"], "-x: no such option"),
                               (["--resume"], "no result in results/ is unfinished"),
                               (["--a", "absent.stl", "--b", "cone-1k"], "absent.stl: no such file"),
                               (["--a=cone-1k", "--b=/absent/part.ply"], "/absent/part.ply: no such file"),
                               (["--resume", "absent.json"], "absent.json: no such result")]:
            done = self.run_it(*words)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn("bench/run: ", done.stderr)
            self.assertIn(message, done.stderr)
        self.assertFalse(self.trace.exists())

    def test_knows_the_options_of_sixdof_bench(self):
        text = subprocess.run([SIXDOF_BENCH, "--help"], capture_output=True, text=True, check=True).stdout
        options, own = text.split("Google Benchmark's own flags:")
        names = set(re.findall(r"^  (-.*?)[ =\[\n]", options, re.MULTILINE))
        names = {name for group in names for name in group.split(",")} | set(re.findall(r"\[(--[a-z_]+)", own))
        names -= {"-h", "--help", "--out", "--benchmark_out", "--benchmark_out_format", "--resume",
                  "--benchmark_dry_run", "--benchmark_perf_counters"}  # the last two in some versions only
        script = (ROOT / "bench" / "run").read_text()
        known = re.search(r'known="(.*?)"', script, re.DOTALL).group(1).replace("\\\n", "").split()
        self.assertEqual(set(known), names)

    def test_killed_run_is_continued_with_its_arguments(self):
        self.end(signal.SIGKILL)
        journal = self.result()
        there = journal.read_text().count('"row":')
        done = self.run_it("--resume")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"{there} rows are finished, {COUNT - there} will be measured", done.stderr)
        self.assertEqual(self.result().name, journal.stem)
        self.assertEqual(len(set(self.rows())), COUNT)
        context = json.loads(self.result().read_text())["context"]
        self.assertEqual(context["benchmark_flags"], "--benchmark_min_time=0.2")
        self.assertEqual(context["budget_s"], "480")
        self.assertIn("collide", done.stdout, "the table")
        if "cmake/setup report" not in done.stderr:  # the page's libraries are here
            page = f"results/{journal.stem.removesuffix('.json')}/report.html"
            self.assertEqual(done.stdout.splitlines()[-1], page)
            self.assertIn("sixdof report", (self.folder / page).read_text())
        self.assertIn("cmake/setup", self.trace.read_text())
        self.assertEqual(self.run_it("--resume").returncode, 2, "nothing is unfinished any more")

    def test_interrupted_run_is_continued(self):
        code, err = self.end(signal.SIGINT)
        self.assertEqual(code, 130, err)
        self.assertIn("--resume continues it", err)
        some = self.rows()
        self.assertLess(len(some), COUNT)
        name = f"results/{self.result().name}"
        other = self.run_it("--resume", name, "--sample", "17")
        self.assertEqual(other.returncode, 1)
        self.assertIn("sample was 16, now it is 17", other.stderr)
        done = self.run_it(f"--resume={name}")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(self.rows()), COUNT)
        self.assertEqual(json.loads(self.result().read_text())["context"]["interrupted"], "false")

    def test_all_algorithms_stand_in_one_wide_table(self):
        words = ["--all-algorithms", "--sample", "8", "--budget", "0", "--benchmark_min_time=0.001",
                 "--benchmark_filter=^collide/algorithm:(exact|ode)/pair:torus-knot-1m/(distance:0[15]|distance:10)$"]
        done = self.run_it(*words)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, "collide: cpu mean / wall clock p99, us")
        [line] = [line for line in done.stdout.splitlines() if re.match("torus-knot-1m +exact ", line)]
        self.assertEqual(len(re.findall(" / ", line)), 3, line)
        context = json.loads(self.result().read_text())["context"]
        self.assertIn("--suite all-algorithms", context["arguments"])
        self.assertEqual(context["sample"], "8")

    def test_all_algorithms_have_sizes_of_their_own(self):
        rows = "--benchmark_filter=^collide/algorithm:exact/pair:torus-knot-1m/distance:05$"
        done = self.run_it("--all-algorithms", "--benchmark_min_time=0.001", rows)
        self.assertEqual(done.returncode, 0, done.stderr)
        context = json.loads(self.result().read_text())["context"]
        self.assertEqual((context["sample"], context["budget_s"]), ("200", "3000"))
        self.assertEqual(self.run_it("--all-algorithms", "--benchmark_list_tests=true", rows).stdout.splitlines()[-1],
                         "collide/algorithm:exact/pair:torus-knot-1m/distance:05")


if __name__ == "__main__":
    unittest.main()
