"""What sixdof-bench shows on a terminal: progress in one line that its width does not break, and colour where wanted.

usage: terminal_test.py SIXDOF_BENCH SIXDOF
"""

import fcntl
import os
import pty
import struct
import subprocess
import sys
import termios
import unittest

SIXDOF_BENCH = sys.argv.pop(1)
del sys.argv[1]
COLUMNS = 40
ERASE_LINE = "\r\033[K"
COLOR = "\033["
ROWS = ["--benchmark_filter=^collide/algorithm:null/pair:torus-knot-10k/", "--sample", "1",
        "--benchmark_min_time=0.000001"]


def resize(terminal, columns):
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))


def read_terminal(terminal, on_text=lambda text: None):
    text = b""
    while True:
        try:
            block = os.read(terminal, 4096)
        except OSError:  # the program closed the terminal
            break
        if not block:
            break
        text += block
        on_text(text.decode(errors="replace"))
    os.close(terminal)
    return text.decode()


def run_on_terminal(command, stream, columns=COLUMNS, on_text=lambda terminal, text: None, **variables):
    """Exit code, and what the program prints on `stream`, which is a terminal; the other stream is thrown away."""
    ours, theirs = pty.openpty()
    resize(theirs, columns)
    streams = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, stream: theirs}
    environment = {key: value for key, value in os.environ.items() if key not in ("NO_COLOR", "TERM")}
    with subprocess.Popen(command, env=environment | {"TERM": "xterm"} | variables, **streams) as program:
        os.close(theirs)
        text = read_terminal(ours, lambda text: on_text(ours, text))
    return program.returncode, text


class Terminal(unittest.TestCase):
    def run_rows(self, stream, *words, **options):
        code, text = run_on_terminal([SIXDOF_BENCH, *ROWS, *words], stream, **options)
        self.assertEqual(code, 0, text)
        return text

    @staticmethod
    def progress(text):
        return [line for line in text.split(ERASE_LINE) if line.startswith("rows ")]

    def test_progress_fits_on_one_line(self):
        shown = self.progress(self.run_rows("stderr"))
        self.assertGreater(len(shown), 5, shown)
        self.assertTrue(all(len(line) < COLUMNS for line in shown), shown)
        self.assertIn("rows 1/", shown[1])

    def test_progress_follows_the_width(self):
        wide, narrow = 120, 24
        resized = []

        def shrink(terminal, text):
            if not resized and len(self.progress(text)) > 2:
                resize(terminal, narrow)
                resized.append(True)

        # Slow enough that most lines come after the change.
        shown = self.progress(self.run_rows("stderr", "--benchmark_min_time=0.02", columns=wide, on_text=shrink))
        self.assertGreater(max(map(len, shown)), narrow)
        self.assertTrue(resized)
        later = shown[len(shown) // 2:]
        self.assertGreater(len(later), 2)
        self.assertTrue(all(len(line) < narrow for line in later), later)

    def test_no_progress_on_a_terminal_that_cannot_erase(self):
        text = self.run_rows("stderr", TERM="dumb")
        self.assertNotIn("\033", text)
        self.assertNotIn("rows ", text)

    def test_color(self):
        for variables, words, colored in [({}, [], True), ({"NO_COLOR": "1"}, [], False), ({"NO_COLOR": ""}, [], True),
                                          ({"TERM": "dumb"}, [], False),
                                          ({"NO_COLOR": "1"}, ["--benchmark_color=auto"], False),
                                          ({"NO_COLOR": "1"}, ["--benchmark_color=true"], True),
                                          ({"NO_COLOR": "1"}, ["--benchmark_color=yes"], True),
                                          ({"TERM": "dumb"}, ["--benchmark_color=true"], True),
                                          ({}, ["--benchmark_color=false"], False)]:
            text = self.run_rows("stdout", *words, **variables)
            self.assertIn("collide/algorithm:null", text)
            self.assertEqual(COLOR in text, colored, (variables, words))


if __name__ == "__main__":
    unittest.main()
