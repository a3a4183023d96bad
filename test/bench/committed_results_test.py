"""Errors in bench/published are those of this build: rows of the elephants, asked again at the same configurations.
Times are not compared.

usage: committed_results_test.py SIXDOF_BENCH SIXDOF
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PUBLISHED = ROOT / "bench/published/pairs/pairs.json"
SIXDOF_BENCH = sys.argv[1]
del sys.argv[1:3]

FAST = ("exact", "ist", "ist-descent", "vps", "vps-field")
ERRORS = ("failed", "mismatch", "misses", "error_max", "gamma_F_deg", "gamma_T_deg", "magnitude_error_F", "volume_error_mean")
ROUNDING = 1e-12  # Errors below are rounding: their digits depend on the order of sums.
DIGITS = 1e-3     # Published numbers have four significant digits.
LEAST_ROWS = 30


def rows_of(file):
    """Errors of the fast algorithms' rows on the elephants, by the row's name, and how many configurations were asked."""
    found = {}
    for row in json.loads(file.read_text(encoding="utf-8"))["benchmarks"]:
        fields = row["sixdof"]
        if fields["algorithm"] in FAST and fields.get("pair") == "elephant" and fields["query"] in ("distance", "respond"):
            found[row["name"]] = fields["configurations"], {name: row[name] for name in ERRORS if name in row}
    return found


def asked_again(count):
    """The rows of this build, at so many configurations."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "rows.json"
        subprocess.run([SIXDOF_BENCH, f"--out={out}", "--benchmark_min_time=0.0001", "--sample", str(count), "--budget", "0",
                        f"--benchmark_filter=^(distance|respond)/algorithm:({'|'.join(FAST)})/pair:elephant/[^/]+$"],
                       check=True, capture_output=True)
        return rows_of(out)


class CommittedResults(unittest.TestCase):
    def test_errors_of_the_elephants(self):
        published = rows_of(PUBLISHED)
        self.assertGreaterEqual(len(published), LEAST_ROWS)
        now = {}
        for count in {configurations for configurations, _ in published.values()}:
            now |= {(name, count): errors for name, (_, errors) in asked_again(count).items()}
        for name, (count, errors) in published.items():
            for counter, before in errors.items():
                after = now[name, count][counter]
                self.assertLessEqual(abs(after - before), max(ROUNDING, DIGITS * abs(before)),
                                     f"{name}: {counter} is published as {before}, now {after}")


if __name__ == "__main__":
    unittest.main()
