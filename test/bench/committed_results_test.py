"""Answers that README.md prints are those of this build: the errors in its table, asked again at the same configurations.
Times are not compared.

usage: committed_results_test.py SIXDOF_BENCH SIXDOF
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIXDOF_BENCH, SIXDOF = sys.argv[1:3]
del sys.argv[1:3]

# Errors below are rounding: their digits depend on the order of sums.
ROUNDING = 1e-12
FAST = ("exact", "ist", "ist-descent", "vps", "vps-field")


def table(folder, sample, buckets):
    """What `sixdof table` prints of the fast algorithms' rows on the elephants."""
    result = pathlib.Path(folder) / f"{sample}.json"
    subprocess.run([SIXDOF_BENCH, f"--benchmark_out={result}", "--benchmark_min_time=0.0001", "--sample", str(sample),
                    f"--benchmark_filter=^(distance|respond)/algorithm:({'|'.join(FAST)})/pair:elephant/{buckets}$"],
                   check=True, capture_output=True)
    return subprocess.run([SIXDOF, "table", str(result)], check=True, capture_output=True, text=True).stdout


def sections(text):
    """Lines of the first part, which is about distances, and of the second, about responses."""
    before, after = text.split("elephant: respond", maxsplit=1)
    return {"distance": before, "respond": after}


def narrow(text):
    """Errors by query, bucket and algorithm, of the README's table or of `sixdof table`."""
    columns = {"distance": 2, "respond": 6}
    found = {}
    for query, part in sections(text).items():
        for line in part.splitlines():
            row = re.match(r"(\d+) %\s+(?:[*!]+\s+)?([a-z-]+)\s+\d+\s", line)
            if row:
                found[query, row[1], row[2]] = line.split()[-columns[query]:]
    return found


class CommittedResults(unittest.TestCase):
    def compare(self, committed, now, least):
        rows = [row for row in committed if row[-1] in FAST]
        self.assertGreaterEqual(len(rows), least)
        for row in rows:
            self.assertIn(row, now)
            for before, after in zip(committed[row], now[row], strict=True):
                if before != after:
                    self.assertLess(max(float(before), float(after)), ROUNDING, f"{row}: {committed[row]}, now {now[row]}")

    def test_readme(self):
        with tempfile.TemporaryDirectory() as folder:
            now = narrow(table(folder, 256, "(distance|volume):05"))
        self.compare(narrow((ROOT / "README.md").read_text(encoding="utf-8")), now, 5)


if __name__ == "__main__":
    unittest.main()
