"""Ctrl-C acts within a second in rows and commands that take far longer, and leaves no half-written file.

usage: ctrl_c_test.py SIXDOF_BENCH SIXDOF
"""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SIXDOF_BENCH, SIXDOF = sys.argv.pop(1), sys.argv.pop(1)
# A second, and what a busy machine adds. The work under test takes five times as long or more.
LIMIT_S = 2.5
FIRST = "collide/algorithm:null/pair:torus-knot-10k/distance:05"


def handles(pid, program, how):
    """Whether the process runs the program by now, and that has installed a handler of the signal (proc(5), SigCgt)."""
    try:
        if os.path.realpath(f"/proc/{pid}/exe") != os.path.realpath(program):
            return False  # still this one, which has a handler, too
        lines = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="ascii").splitlines()
    except OSError:
        return False
    masks = [int(line.split()[1], 16) for line in lines if line.startswith("SigCgt:")]
    return bool(masks) and bool(masks[0] >> (how - 1) & 1)


class CtrlC(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def files(self):
        return sorted(str(path.relative_to(self.folder)) for path in self.folder.rglob("*") if path.is_file())

    def interrupt(self, words, begun, how=signal.SIGINT):
        """Sends the signal half a second after begun() is true and the program handles it; returns what was printed."""
        with subprocess.Popen([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              env=os.environ | {"SIXDOF_CACHE": str(self.folder / "cache")}) as program:
            deadline = time.monotonic() + 60
            while not (begun() and handles(program.pid, words[0], how)) and time.monotonic() < deadline:
                time.sleep(0.01)
            time.sleep(0.5)
            self.assertIsNone(program.poll(), "ended before the signal")
            start = time.monotonic()
            program.send_signal(how)
            out, err = program.communicate(timeout=120)
            took = time.monotonic() - start
        self.assertEqual(program.returncode, 130, err)
        self.assertLess(took, LIMIT_S, words)
        self.assertTrue(err.endswith("interrupted\n"), err)
        self.assertEqual([name for name in self.files() if name.endswith(".partial")], [])
        return out

    def interrupt_row(self, row, *words):
        """In a long row behind a short one."""
        out = self.folder / "result.json"
        journal = self.folder / "result.json.journal"
        self.interrupt([SIXDOF_BENCH, f"--benchmark_filter=^({FIRST}|{row})$", "--out", out, "--sample", "16", *words],
                       lambda: journal.exists() and f'"row":"{FIRST}"' in journal.read_text())
        document = json.loads(out.read_text())
        self.assertEqual([each["name"] for each in document["benchmarks"]], [FIRST])
        self.assertEqual(document["context"]["interrupted"], "true")
        self.assertFalse(journal.exists())

    def test_scenario(self):
        self.interrupt_row("scenario/IV/algorithm:exact")

    def test_generator(self):
        self.interrupt_row("generate/distance/algorithm:fcl/pair:gyroid-ball-100k")

    def test_preparation(self):
        # Prepare rows come first in the list; nothing is finished before.
        out = self.folder / "result.json"
        self.interrupt([SIXDOF_BENCH, "--benchmark_filter=^prepare/algorithm:ist/pair:torus-knot-10k$", "--out", out,
                        "-p", "ist:spheres=200000"], (self.folder / "result.json.journal").exists)
        self.assertEqual(json.loads(out.read_text())["benchmarks"], [])
        self.assertEqual(self.files(), ["result.json"])

    def test_terminate(self):
        out = self.folder / "result.json"
        self.interrupt([SIXDOF_BENCH, "--benchmark_filter=^scenario/IV/algorithm:exact$", "--out", out],
                       (self.folder / "result.json.journal").exists, signal.SIGTERM)

    def test_json_on_standard_output_is_whole(self):
        text = self.interrupt([SIXDOF_BENCH, "--benchmark_filter=^scenario/IV/algorithm:exact$",
                               "--benchmark_format=json"], lambda: True)
        self.assertEqual(json.loads(text)["benchmarks"], [])

    def test_commands(self):
        output = self.folder / "set.h5"
        for words in (["generate", "--a", "gyroid-ball-100k", "--grid", "10", "--distances", "0:30", "-o", output],
                      ["generate", "--a", "gyroid-ball-10k", "--grid", "10", "--volumes", "0:10", "-o", output],
                      ["quality", "--scenario", "IV", "--algorithm", "exact", "--steps", "20000"],
                      ["models", "make", "gyroid-ball", "--triangles", "20000000", "-o", self.folder / "x.off"]):
            self.interrupt([SIXDOF, *words], lambda: True)
            self.assertEqual([name for name in self.files() if not name.startswith("cache/")], [], words)


if __name__ == "__main__":
    unittest.main()
