"""bench/scripts/collection: real runs on small recipes.

usage: collection_test.py SIXDOF SIXDOF_BENCH
"""

import argparse
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

BENCH = pathlib.Path(__file__).resolve().parents[2] / "bench"
SCRIPTS = BENCH / "scripts"
SIXDOF, SIXDOF_BENCH = sys.argv[1:3]
del sys.argv[1:3]
sys.path.insert(0, str(SCRIPTS))
import object_command  # noqa: E402
import object_runs  # noqa: E402

OBJECTS = ["box-1k", "sphere-1k", "torus-2k"]


class Words(unittest.TestCase):
    def test_percentages_and_times_of_the_command_line(self):
        self.assertEqual(object_runs.percents_of("0,0.5,5:7"), [0, 0.5, 5, 6, 7])
        self.assertEqual([object_command.seconds_of(text) for text in ("90s", "25min", "2h")], [90, 1500, 7200])
        for text in ("5", "-5s", "fives"):
            self.assertRaises(argparse.ArgumentTypeError, object_command.seconds_of, text)


class Run(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="sixdof-collection-")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.out = self.root / "run"
        self.environment = os.environ | {"SIXDOF_MODELS": str(self.root), "SIXDOF_CACHE": str(self.root / "cache")}

    def command(self, *words):
        return [sys.executable, "-B", str(SCRIPTS / "collection"), "--program", SIXDOF, "--bench", SIXDOF_BENCH, "--out",
                str(self.out), "--algorithms", "exact", "--distances", "0,5", "--volumes", "5", "--grid", "so3:4:2",
                "--sample", "4", "--objects", ",".join(OBJECTS), "--most-triangles", "3000", "--recipes", *words]

    def collection(self, *words):
        return subprocess.run(self.command(*words), capture_output=True, text=True, check=False, env=self.environment)

    @staticmethod
    def ended(text):
        """The pairs of the lines about those that have ended."""
        return re.findall(r"(?m)^\d+ of \d+: (\S+): \d+ % done, [\d.e+]+ (?:s|min|h) left$", text)

    def units(self):
        return sorted(file.stem for file in (self.out / "units").glob("*.json"))

    def test_measures_all_pairs_and_reports(self):
        done = self.collection()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.units(), sorted(f"{name}.{partner}" for name in OBJECTS
                                              for partner in ("self", "seeded", "tenth")))
        self.assertRegex(done.stderr, r"^pairs to measure: 9, \d+ at a time\nabout \S+ (s|min) in all, by the first one\n1 of 9: ")
        self.assertEqual(sorted(self.ended(done.stderr)), self.units())
        document = json.loads((self.out / "results.json").read_text())
        summary = document["collection"]
        self.assertEqual((summary["units"], summary["objects"]), (9, sorted(OBJECTS)))
        self.assertEqual([summary[key] for key in ("faults", "sets_not_made", "not_measured")], [[], [], []])
        names = [one["name"] for one in document["benchmarks"]]
        self.assertEqual(len(names), len(set(names)))
        self.assertEqual({one["sixdof"]["partner"] for one in document["benchmarks"]}, {"self", "seeded", "tenth"})
        found = {(cell["partner"], cell["query"], cell["bucket"]["kind"], cell["bucket"]["percent"], cell["objects"])
                 for cell in summary["cells"]}
        self.assertLessEqual({("self", "distance", "distance", 0, 3), ("self", "distance", "distance", 5, 3),
                              ("tenth", "respond", "volume", 5, 3),
                              *(("self", f"cast {kind}/10", "distance", 0, 3)
                                for kind in ("translation", "rotation", "tumble"))}, found)
        self.assertEqual({(percent, objects) for _, _, kind, percent, objects in found if kind == "volume"}, {(5, 3)})
        self.assertIn("**distance, self**", done.stdout)
        self.assertIn("9 pairs of 3 objects.", done.stdout)

        before = {name: (self.out / "units" / f"{name}.json").stat().st_mtime_ns for name in self.units()}
        (self.out / "units" / "box-1k.self.json").unlink()
        again = self.collection()
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertRegex(again.stderr, r"^pairs to measure: 1, \d+ at a time; about \S+ \S+ in all, by those that are measured\n"
                         r"1 of 1: box-1k.self: 100 % done, 0 s left\n$")
        del before["box-1k.self"]
        for name, changed in before.items():
            self.assertEqual((self.out / "units" / f"{name}.json").stat().st_mtime_ns, changed)
        other = self.collection("--sample", "8")
        self.assertEqual(other.returncode, 1)
        self.assertIn("holds units with sample 4, not 8", other.stderr)

        plan = self.collection("--plan")
        self.assertEqual(plan.returncode, 0, plan.stderr)
        self.assertEqual(plan.stdout.count(" measured\n"), 9)
        self.assertIn("0 pairs to measure", plan.stdout)

    def test_a_folder_gains_algorithms_and_keeps_what_it_has(self):
        words = ("--partners", "self", "--objects", "box-1k")
        self.assertEqual(self.collection(*words).returncode, 0)
        [before] = object_runs.results(self.out)
        gained = self.collection(*words, "--algorithms", "ode,exact")
        self.assertEqual((gained.returncode, self.ended(gained.stderr)), (0, ["box-1k.self"]))
        [after] = object_runs.results(self.out)
        self.assertEqual(list(after["algorithms"]), ["exact", "ode"])
        self.assertEqual(after["algorithms"]["exact"], before["algorithms"]["exact"])
        self.assertEqual(after["benchmarks"][:len(before["benchmarks"])], before["benchmarks"])
        self.assertEqual({row["sixdof"]["algorithm"] for row in after["benchmarks"][len(before["benchmarks"]):]},
                         {"ode"})
        self.assertGreater(after["seconds"], before["seconds"])
        self.assertEqual(json.loads((self.out / "choice.json").read_text())["algorithms"], ["exact", "ode"])
        self.assertEqual(self.collection(*words, "--algorithms", "ode").stderr, "")

    def test_shards_are_disjoint_and_complete(self):
        words = ("--partners", "self")
        seen = []
        batch = BENCH / "slurm" / "collection.sbatch"
        for shard in (1, 2, 3):
            if shard == 2:  # as a task of Slurm runs it
                command = ["bash", str(batch), str(SCRIPTS / "collection"), "3", *self.command(*words)[3:]]
                done = subprocess.run(command, capture_output=True, text=True, check=False,
                                      env=self.environment | {"SLURM_ARRAY_TASK_ID": "2"})
            else:
                done = self.collection(*words, "--shard", f"{shard}/3")
            self.assertEqual((done.returncode, done.stdout), (0, ""), done.stderr)
            seen += self.ended(done.stderr)
        self.assertEqual(sorted(seen), sorted(f"{name}.self" for name in OBJECTS))
        self.assertFalse((self.out / "results.json").exists())
        self.assertEqual(self.collection("--report").returncode, 0)
        self.assertTrue((self.out / "results.json").exists())

    def test_a_plan_estimates_every_pair_and_measures_none(self):
        plan = self.collection("--plan", "--budget", "1s", "--jobs", "1")
        self.assertEqual(plan.returncode, 0, plan.stderr)
        estimates = [line.split() for line in plan.stdout.splitlines() if ".self" in line or ".seeded" in line]
        self.assertEqual(len(estimates), 6)
        for _, _, seconds in estimates:
            self.assertGreater(float(seconds), 0)
        self.assertIn("The budget of", plan.stdout)
        self.assertFalse((self.out / "units").exists())

    def test_a_budget_ends_the_run_and_the_same_command_continues(self):
        cut = self.collection("--budget", "0.01s")
        self.assertEqual(cut.returncode, 1)
        self.assertRegex(cut.stderr, r"the budget left out 9 of 9 pairs: \S+, .*, \.\.\.; the same command continues\n")
        self.assertIn("no pair is measured yet", cut.stderr)
        self.assertEqual(self.units(), [])
        self.assertEqual(self.collection("--partners", "self").returncode, 0)
        self.assertEqual(len(self.units()), 3)

    def test_a_signal_leaves_whole_files_only(self):
        with subprocess.Popen(self.command(), stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                              env=self.environment) as process:
            while line := process.stderr.readline():
                if self.ended(line):  # the first pair is measured
                    break
            process.send_signal(signal.SIGTERM)
            process.communicate()
        self.assertEqual(process.returncode, 130)
        self.assertGreaterEqual(len(self.units()), 1)
        for file in (self.out / "units").iterdir():
            json.loads(file.read_text())
        leftovers = [file for file in self.out.rglob("*") if file.name.endswith(".partial") or ".run-" in file.name]
        self.assertEqual(leftovers, [])
        self.assertEqual(self.collection("--partners", "self").returncode, 0)

    def wait_for(self, condition, what):
        for _ in range(3000):
            if condition():
                return
            time.sleep(0.02)
        self.fail(what)

    def test_a_kill_leaves_no_process_and_nothing_that_the_next_run_keeps(self):
        # The program tells its number, and is asked about a set when the run is killed.
        slow = self.root / "slow"
        slow.write_text(f"#!/bin/sh\necho $$ >> {self.root}/numbers\nexec sleep 600\n")
        slow.chmod(0o755)
        with subprocess.Popen([*self.command("--partners", "self", "--jobs", "2"), "--bench", str(slow)],
                              stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL, env=self.environment) as process:
            numbers = self.root / "numbers"
            self.wait_for(lambda: numbers.exists() and len(numbers.read_text().split()) == 2, "nothing is asked")
            held = list(self.out.glob(".run-*"))
            self.assertEqual(len(held), 1)
            other = object_runs.Scratch(self.out)  # of a run that begins beside it
            self.assertTrue(held[0].exists())
            process.kill()
            process.wait()
        for number in numbers.read_text().split():
            self.wait_for(lambda number=number: not pathlib.Path(f"/proc/{number}").exists(), f"{number} survives")
        self.assertTrue(held[0].exists(), "nobody was left to remove it")
        (self.out / ".run-of-an-earlier-version").mkdir()
        self.assertEqual(self.collection("--partners", "self").returncode, 0)
        self.assertEqual(list(self.out.glob(".run-*")), [other.path], "a run that goes on keeps its own")
        other.close()
        self.assertEqual(list(self.out.glob(".run-*")), [])
        self.assertEqual([file for file in self.out.rglob("*") if file.name.endswith(".partial")], [])

    def test_an_algorithm_that_takes_too_long_costs_its_own_rows_only(self):
        planted_s = 600
        slow = self.root / "slow"
        slow.write_text(f"#!/bin/sh\ncase \"$*\" in *algorithm:ist/*) exec sleep {planted_s};; esac\nexec {SIXDOF_BENCH} \"$@\"\n")
        slow.chmod(0o755)
        begun = time.monotonic()
        choice = object_runs.Choice(["exact", "ist"], "5", "", "so3:4:2", 4, 0.001, 1)
        runner = object_runs.Runner(self.out, choice, SIXDOF, slow, object_runs.Budget(600, 1))
        body = object_runs.Body("box-1k", "box-1k")
        object_runs.LEAST_LIMIT_S, limit = 2.0, object_runs.LEAST_LIMIT_S
        object_runs.UNIT_OF_SHARE, share = 1e-3, object_runs.UNIT_OF_SHARE
        try:
            runner.measure(object_runs.Unit("box", body, body, 2000, True, ()))
        finally:
            object_runs.LEAST_LIMIT_S, object_runs.UNIT_OF_SHARE = limit, share
        [result] = object_runs.results(self.out)
        self.assertRegex(result["algorithms"]["ist"]["status"], r"^not done in \d s$")
        self.assertEqual({one["sixdof"]["algorithm"] for one in result["benchmarks"]}, {"exact"})
        self.assertLess(time.monotonic() - begun, planted_s)

    def test_pairs_that_were_cut_are_measured_again_with_retry_only(self):
        self.assertEqual(self.collection("--partners", "self").returncode, 0)
        for name, change in (("box-1k", {"algorithms": {"exact": {"status": "not done in 10 s"},
                                                        "ode": {"status": "ok"}}, "benchmarks": []}),
                             ("torus-2k", {"set": {"status": "no volumes: not made in time"}})):
            file = self.out / "units" / f"{name}.self.json"
            file.write_text(json.dumps(json.loads(file.read_text()) | change))
        cut = self.collection("--partners", "self")
        self.assertEqual(cut.stderr, "")
        self.assertIn("Sets that were not made as chosen: 1\n  torus-2k.self: no volumes: not made in time\n", cut.stdout)
        self.assertIn("Algorithms that did not end: 1\n  box-1k.self: exact: not done in 10 s\n", cut.stdout)
        again = self.collection("--partners", "self", "--retry")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(sorted(self.ended(again.stderr)), ["box-1k.self", "torus-2k.self"])
        for result in object_runs.results(self.out):
            self.assertEqual((result["set"]["status"], result["algorithms"]["exact"]["status"]), ("ok", "ok"))
        self.assertIn("ode", object_runs.result_of(self.out, "box-1k.self")["algorithms"])

    def test_wrong_words_end_in_one_line(self):
        for words, said in ((["--objects", "no-such"], "no object of paper-like is called no-such"),
                            (["--collection", "papers"], "no collection is called papers"),
                            (["--algorithms", "exakt"], "no algorithm is called exakt"),
                            (["--program", "/no/such"], "/no/such is not there")):
            done = self.collection(*words)
            self.assertEqual(done.returncode, 1)
            self.assertIn(said, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1)
        for words in (["--shard", "0/3"], ["--budget", "5"], ["--partners", "none"], ["--distances", "a:b"]):
            done = self.collection(*words)
            self.assertEqual(done.returncode, 2, done.stderr)
        files = subprocess.run([word for word in self.command() if word != "--recipes"], capture_output=True,
                               text=True, check=False, env=self.environment)
        self.assertEqual(files.returncode, 1)
        self.assertRegex(files.stderr, r"\d+ objects are not fetched, such as \S+: run models/fetch --collection\n$")


if __name__ == "__main__":
    unittest.main()
