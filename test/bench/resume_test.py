"""A run that is killed or interrupted, or meets a full disk, loses no finished row, and --resume measures none twice.

usage: resume_test.py SIXDOF_BENCH SIXDOF MANIFEST
"""

import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SIXDOF_BENCH, SIXDOF, MANIFEST = sys.argv[1:4]
del sys.argv[1:4]
ROWS = "^(collide|distance)/algorithm:(exact|fcl-rss)/pair:torus-1k/"
# The runtime of the thread sanitizer writes a file into this folder, if it exists, as a program starts; where that file
# has no room, the program ends before its first line.
WITHOUT_SANITIZER_FILE = {**os.environ, "TEST_TMPDIR": "/no-such-folder"}
LONG = 60  # seconds, for what ends long before unless something hangs


def command(*words, manifest=MANIFEST, rows=ROWS, min_time=0.05, sample=32):
    return [SIXDOF_BENCH, "--manifest", str(manifest), f"--benchmark_filter={rows}", f"--benchmark_min_time={min_time}",
            "--sample", str(sample), *map(str, words)]


def run(words, **options):
    return subprocess.run(words, capture_output=True, text=True, check=False, **options)


class Resume(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.out = self.folder / "result.json"
        self.journal = self.folder / "result.json.journal"

    def succeed(self, words):
        done = run(words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def names(self, rows=ROWS):
        return self.succeed(command("--benchmark_list_tests", rows=rows)).stdout.split()

    def journal_rows(self):
        """Names of the rows in the journal, of whole lines only."""
        if not self.journal.exists():
            return []
        lines = self.journal.read_text().split("\n")[:-1]
        return [line["row"] for line in map(json.loads, lines) if "row" in line]

    def result_rows(self):
        return [row["name"] for row in json.loads(self.out.read_text())["benchmarks"]]

    def end_after(self, rows, words, how):
        """Starts a run and sends a signal when the journal has so many rows."""
        with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as program:
            while len(self.journal_rows()) < rows and program.poll() is None:
                time.sleep(0.005)
            self.assertIsNone(program.poll(), "ended before the signal")
            program.send_signal(how)
            program.communicate(timeout=LONG)
        return program.returncode

    def test_killed_runs_lose_no_row_and_measure_none_twice(self):
        names = self.names()
        self.assertGreater(len(names), 12)
        measured = []
        for number in range(3):
            there = len(self.journal_rows())
            words = command("--resume" if number else "--out", self.out)
            self.assertEqual(self.end_after(there + 3, words, signal.SIGKILL), -signal.SIGKILL)
            self.assertFalse(self.out.exists())
            rows = self.journal_rows()
            self.assertEqual(rows[:there], measured, "what was measured stays")
            self.assertGreaterEqual(len(rows), there + 3)
            measured = rows
        self.assertEqual(len(set(measured)), len(measured), "no row twice")
        times = {name: json.loads(line)["runs"] for line in self.journal.read_text().split("\n")[:-1]
                 for name in [json.loads(line).get("row")] if name}
        done = self.succeed(command("--resume", self.out, "--stats"))
        self.assertIn(f"rows_measured={len(names) - len(measured)}\n", done.stderr)
        self.assertIn(f"{len(measured)} rows are finished, {len(names) - len(measured)} will be measured", done.stderr)
        self.assertEqual(self.result_rows(), names)
        document = json.loads(self.out.read_text())
        for row in document["benchmarks"]:
            if row["name"] in times:
                self.assertEqual(row["real_time"], times[row["name"]][0]["real_time"], "as it was measured")
        self.assertEqual(document["context"]["interrupted"], "false")
        self.assertEqual([path.name for path in self.folder.iterdir()], ["result.json"])

        done = self.succeed(command("--resume", self.out, "--stats"))
        self.assertIn("rows_measured=0\n", done.stderr)
        self.assertEqual(self.result_rows(), names)

    def test_torn_line_is_measured_again(self):
        self.end_after(4, command("--out", self.out), signal.SIGKILL)
        text = self.journal.read_text()
        rows = self.journal_rows()
        last = text.rstrip("\n").rfind("\n")
        self.journal.write_text(text[:last + 40])
        self.assertEqual(self.journal_rows(), rows[:-1])
        self.succeed(command("--resume", self.out))
        self.assertEqual(self.result_rows(), self.names())

    def test_interrupted_run_is_continued(self):
        self.assertEqual(self.end_after(3, command("--out", self.out), signal.SIGINT), 130)
        self.assertFalse(self.journal.exists())
        some = self.result_rows()
        self.assertGreaterEqual(len(some), 3)
        self.succeed(command("--resume", self.out))
        self.assertEqual(self.result_rows(), self.names())

    def test_repetitions_survive(self):
        words = ["--benchmark_repetitions=3", "--benchmark_enable_random_interleaving=true"]
        self.end_after(2, command("--out", self.out, "--benchmark_repetitions=3"), signal.SIGKILL)
        self.succeed(command("--resume", self.out, "--benchmark_repetitions=3"))
        rows = json.loads(self.out.read_text())["benchmarks"]
        count = {name: sum(row["run_name"] == name for row in rows) for name in self.names()}
        self.assertEqual(set(count.values()), {3 + 4}, "runs; mean, median, stddev, cv")
        changed = run(command("--resume", self.out, *words))
        self.assertEqual(changed.returncode, 1)
        self.assertIn("benchmark_flags was", changed.stderr)

    def test_other_conditions_are_refused(self):
        self.end_after(1, command("--out", self.out), signal.SIGKILL)
        before = self.journal.read_text()
        for options, words, difference in [({"sample": 16}, [], "sample was 32, now it is 16"),
                                           ({"min_time": 0.2}, [], "benchmark_flags was --benchmark_min_time=0.05"),
                                           ({}, ["--seed", "9"], "seed was 1, now it is 9"),
                                           ({}, ["-p", "exact:warm_start=on"], "settings:exact was warm_start=off")]:
            done = run(command("--resume", self.out, *words, **options))
            self.assertEqual(done.returncode, 1)
            self.assertIn(difference, done.stderr)
        self.assertEqual(self.journal.read_text(), before)

    def test_other_meshes_are_refused(self):
        mesh = self.folder / "torus-1k.off"
        self.succeed([SIXDOF, "models", "make", "cone-1k", "-o", mesh])
        self.succeed(command("--out", self.out, rows="^prepare/algorithm:null/pair:torus-1k$"))
        before = self.out.read_text()
        done = run(command("--resume", self.out, "--mesh", mesh, rows="^prepare/algorithm:(null|exact)/pair:torus-1k$"))
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "mesh:torus-1k was [0-9a-f]+, now it is [0-9a-f]+")
        self.assertEqual(self.out.read_text(), before)
        self.assertFalse(self.journal.exists())

    def test_budget_and_choice_of_rows_may_differ(self):
        self.end_after(2, command("--out", self.out, "--budget", "50"), signal.SIGKILL)
        rows = ROWS + "distance:05"
        self.succeed(command("--resume", self.out, "--budget", "1", rows=rows))
        found = self.result_rows()
        self.assertLessEqual(set(self.names(rows)), set(found))
        self.assertEqual(len(set(found)), len(found))
        document = json.loads(self.out.read_text())
        self.assertEqual(document["context"]["budget_s"], "1")
        self.assertTrue(all(row["configurations"] > 0 for row in document["benchmarks"]), "how many had time")

    def test_unfinished_journal_is_not_overwritten(self):
        self.end_after(1, command("--out", self.out), signal.SIGKILL)
        before = self.journal.read_text()
        done = run(command("--out", self.out))
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"--resume {self.out} continues it", done.stderr)
        self.assertEqual(self.journal.read_text(), before)

    def test_full_disk_keeps_what_was_measured(self):
        def small_files(size):
            def limit():
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
            return limit

        # Without line breaks and indentation the journal takes three quarters of the result.
        words = ["--benchmark_repetitions=4"]
        whole = self.folder / "whole.json"
        self.succeed(command("--out", whole, *words, min_time=0.001))
        size = whole.stat().st_size
        done = run(command("--out", self.out, *words, min_time=0.001), preexec_fn=small_files(size // 2),
                   env=WITHOUT_SANITIZER_FILE)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "result.json.journal: cannot be written: File too large")
        self.assertGreater(len(self.journal_rows()), 1)
        done = run(command("--resume", self.out, *words, min_time=0.001), preexec_fn=small_files(size * 92 // 100),
                   env=WITHOUT_SANITIZER_FILE)
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"the rows are in {self.journal}, and --resume {self.out}", done.stderr)
        self.assertFalse(self.out.exists())
        self.assertEqual(len(self.journal_rows()), len(self.names()))
        done = self.succeed(command("--resume", self.out, "--stats", *words, min_time=0.001))
        self.assertIn("rows_measured=0\n", done.stderr)
        self.assertEqual(len(self.result_rows()), len(json.loads(whole.read_text())["benchmarks"]))
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["result.json", "whole.json"])

    def test_file_that_cannot_be_written_is_refused_before_anything_is_measured(self):
        (self.folder / "locked").mkdir()
        for out in ["/no-such-folder/x.json", self.folder / "locked", "/dev/null"]:
            done = run(command("--out", out, "--stats"))
            self.assertEqual(done.returncode, 1, out)
            self.assertIn(f"{out}: cannot be written", done.stderr)
            self.assertNotIn("stats", done.stderr)
            self.assertEqual(done.stdout, "")
        if os.geteuid() != 0:
            (self.folder / "locked").chmod(0o555)
            self.assertEqual(run(command("--out", self.folder / "locked" / "x.json")).returncode, 1)
        self.assertTrue(pathlib.Path("/dev/null").is_char_device())

    def test_csv(self):
        table = self.succeed(command("--benchmark_format=csv")).stdout.splitlines()
        self.assertEqual(len(table), 1 + len(self.names()))
        self.assertRegex(table[0], "^name,.*real_time,cpu_time")
        self.assertIn("error_rms", table[0])
        columns = table[0].count(",")
        self.assertTrue(all(re.sub('"[^"]*"', "", line).count(",") == columns for line in table), table)
        self.end_after(2, command("--out", self.out, "--benchmark_out_format=csv"), signal.SIGINT)
        self.assertTrue(self.journal.exists(), "a CSV file cannot be continued, its journal can")
        self.succeed(command("--resume", self.out, "--benchmark_out_format=csv"))
        lines = self.out.read_text().splitlines()
        self.assertEqual([line.split(",")[0] for line in lines[1:]], self.names())
        self.assertFalse(self.journal.exists())


if __name__ == "__main__":
    unittest.main()
