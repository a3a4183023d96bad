"""bench/paper: real runs on a tiny grid.

usage: paper_test.py SIXDOF SIXDOF_BENCH
"""

import argparse
import importlib.machinery
import importlib.util
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

BENCH = pathlib.Path(__file__).resolve().parents[2] / "bench"
SIXDOF, _ = sys.argv[1:3]
del sys.argv[1:3]
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("paper", str(BENCH / "paper"))
paper = importlib.util.module_from_spec(importlib.util.spec_from_loader("paper", loader))
loader.exec_module(paper)

# 26 directions x 320 rotations, as the sets that come with the programs.
CONFIGURATIONS = 26 * 320


class Words(unittest.TestCase):
    def test_algorithms_and_shards_of_the_command_line(self):
        self.assertEqual(paper.algorithm("ist:spheres=300,seed=2"), ("ist", ["spheres=300", "seed=2"]))
        self.assertEqual(paper.algorithm("exact"), ("exact", []))
        self.assertEqual(paper.folder_of("ist", ["spheres=300", "seed=2"]), "ist@spheres=300,seed=2")
        self.assertEqual(paper.shard_number("3/64"), (3, 64))
        for text in ("ist:spheres", "../x", "ist:spheres=a/b"):
            self.assertRaises(argparse.ArgumentTypeError, paper.algorithm, text)
        for text in ("0/4", "5/4", "4", "a/b"):
            self.assertRaises(argparse.ArgumentTypeError, paper.shard_number, text)

    def test_the_grid_is_the_papers_by_default(self):
        options = paper.parser().parse_args(["--out", "x", "--a", "elephant"])
        self.assertEqual((options.grid, options.distances, options.volumes), ("paper", "0:30", "0:10"))


class Run(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="sixdof-paper-")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.out = self.root / "run"
        self.environment = os.environ | {"SIXDOF_CACHE": str(self.root / "cache"), "SIXDOF_MODELS": str(self.root)}

    def command(self, *words):
        return [sys.executable, "-B", str(BENCH / "paper"), "--program", SIXDOF, "--out", str(self.out), "--a", "box-12",
                "--grid", "45", "--distances", "0,5", "--volumes", "1,5", "--set-shards", "2", "--algorithms", "exact",
                "ist:spheres=50", *words]

    def paper(self, *words):
        return subprocess.run(self.command(*words), capture_output=True, text=True, check=False, env=self.environment)

    def rows(self):
        return {row["name"]: row for row in json.loads((self.out / "survey.json").read_text())["benchmarks"]}

    def shards(self):
        return {file.relative_to(self.out): file.stat().st_mtime_ns for file in self.out.glob("shards/*/*.json")}

    def test_asks_all_configurations_and_reports_mean_and_longest(self):
        done = self.paper("--shards", "3")
        self.assertEqual(done.returncode, 0, done.stderr)
        document = json.loads((self.out / "survey.json").read_text())
        counts = {each["algorithm"]: each for each in document["survey"]["algorithms"]}
        self.assertEqual(list(counts), ["exact", "ist@spheres=50"])
        # exact: distance and response at two distances, response at two volumes; ist likewise.
        for each in counts.values():
            self.assertEqual((each["tests"], each["failed"]), (6 * CONFIGURATIONS, 0), each)
        self.assertEqual(counts["exact"]["wrong"], 0)
        rows = self.rows()
        for algorithm in counts:
            for query, bucket in (("distance", "distance:05"), ("respond", "distance:05"), ("respond", "volume:05")):
                row = rows[f"{query}/algorithm:{algorithm}/pair:box-12/{bucket}"]
                self.assertGreaterEqual(row["max_ns"], row["cpu_time"])
                self.assertGreater(row["cpu_time"], 0)
                self.assertIn("max_ns", row["outliers"]["poses"])
                self.assertGreater(row["configurations"], CONFIGURATIONS // 2)
        self.assertEqual(rows["respond/algorithm:exact/pair:box-12/distance:05"]["phantoms"], 0)
        self.assertIn("respond", done.stdout)
        before = self.shards()
        self.assertEqual(len(before), 6)
        again = self.paper("--shards", "3")
        self.assertEqual((again.returncode, self.shards()), (0, before), "nothing is asked twice")
        other = self.paper("--shards", "2")
        self.assertEqual((other.returncode, other.stderr.count("\n")), (1, 1), other.stderr)
        self.assertIn("--shards", other.stderr)

    def test_tasks_of_slurm_make_the_same_shards(self):
        self.assertEqual(self.paper("--shards", "2", "--only-set").returncode, 0)
        missing = self.paper("--shards", "2", "--report")
        self.assertEqual((missing.returncode, missing.stderr.count("\n")), (1, 1), missing.stderr)
        for task in ("1", "2"):
            command = ["bash", str(BENCH / "slurm/paper.sbatch"), *self.command()[2:3], "2", *self.command()[3:]]
            done = subprocess.run(command, capture_output=True, text=True, check=False,
                                  env=self.environment | {"SLURM_ARRAY_TASK_ID": task})
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(len(self.shards()), 2 * int(task))
        self.assertFalse((self.out / "survey.json").exists())
        whole = self.paper("--shards", "2", "--report")
        self.assertEqual(whole.returncode, 0, whole.stderr)
        self.assertTrue(self.rows())

    def test_a_kill_loses_one_shard_at_most(self):
        self.assertEqual(self.paper("--shards", "40", "--only-set").returncode, 0)
        with subprocess.Popen(self.command("--shards", "40"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              env=self.environment, start_new_session=True) as process:
            deadline = time.monotonic() + 60
            while len(self.shards()) < 3 and process.poll() is None and time.monotonic() < deadline:
                time.sleep(0.01)
            os.killpg(process.pid, signal.SIGKILL)
        kept = self.shards()
        self.assertGreaterEqual(len(kept), 3)
        for name in kept:
            self.assertEqual(json.loads((self.out / name).read_text())["number"], int(name.stem))
        done = self.paper("--shards", "40")
        self.assertEqual(done.returncode, 0, done.stderr)
        after = self.shards()
        self.assertEqual(len(after), 80)
        self.assertEqual({name: after[name] for name in kept}, kept, "what was there is not asked again")

    def test_a_plan_measures_a_sample_and_writes_nothing(self):
        self.assertEqual(self.paper("--only-set").returncode, 0)
        plan = self.paper("--plan", "--plan-sample", "8")
        self.assertEqual(plan.returncode, 0, plan.stderr)
        self.assertIn("exact: distance distance: ", plan.stdout)
        self.assertIn("ist@spheres=50: respond volume: ", plan.stdout)
        self.assertRegex(plan.stdout, r"(?m)^all: about [\d.]+ s of processor time")
        self.assertFalse((self.out / "shards").exists())

    def test_wrong_words_end_in_one_line(self):
        for words in (("--set", "none.h5"), ("--algorithms", "nobody")):
            with self.subTest(words=words):
                done = self.paper(*words)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertIn("bench/paper: ", done.stderr.splitlines()[-1])


if __name__ == "__main__":
    unittest.main()
