"""On a terminal sixdof-bench shows its progress in one line that the terminal's width does not break.

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


def stderr_on_terminal(command):
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, COLUMNS, 0, 0))
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=theirs) as program:
        os.close(theirs)
        text = b""
        while True:
            try:
                block = os.read(ours, 4096)
            except OSError:  # the program closed the terminal
                break
            if not block:
                break
            text += block
    os.close(ours)
    return program.returncode, text.decode()


class Terminal(unittest.TestCase):
    def test_progress_fits_on_one_line(self):
        code, text = stderr_on_terminal(
            [SIXDOF_BENCH, "--benchmark_filter=^collide/algorithm:null/pair:torus-knot-10k/", "--sample", "1",
             "--benchmark_min_time=0.000001"])
        self.assertEqual(code, 0, text)
        shown = [line for line in text.split(ERASE_LINE) if line.startswith("rows ")]
        self.assertGreater(len(shown), 5, text)
        self.assertTrue(all(len(line) < COLUMNS for line in shown), shown)
        self.assertIn("rows 1/", shown[1])


if __name__ == "__main__":
    unittest.main()
