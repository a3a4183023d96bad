"""The table of bench/generate-ratios on synthetic rows."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "bench" / "generate-ratios"


def row(method, pair, ns, **more):
    name = f"generate/distance/algorithm:{method}/pair:{pair}"
    result = {"name": name, "run_name": name, "run_type": "iteration", "ns_per_configuration": ns, "triangles": 2e4}
    return result | more


def ratios(rows):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "rows.json"
        path.write_text(json.dumps({"benchmarks": rows}), encoding="utf-8")
        return subprocess.run([sys.executable, SCRIPT, path], capture_output=True, text=True, check=False)


class Ratios(unittest.TestCase):
    def test_divides_the_smallest_of_each(self):
        done = ratios([
            row("raycast", "knot", 25e3), row("raycast", "knot", 20e3),
            row("raycast", "knot", 1.0, run_type="aggregate"),
            row("fcl", "knot", 4e6), row("fcl", "knot", 3e6), row("fcl-sweep", "knot", 1e6),
            row("raycast", "small", 10e3, triangles=200), row("fcl", "small", 1e6, triangles=200),
            row("raycast", "alone", 10e3),
        ])
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.splitlines()[2:], [
            "| `small` | 200 | 10.0 | 1,000 | 100 | - | - |",
            "| `knot` | 20,000 | 20.0 | 3,000 | 150 | 1,000 | 50 |",
        ])

    def test_refuses_a_run_without_both(self):
        failed = row("fcl", "knot", 4e6, error_occurred=True)
        for rows in ([row("raycast", "knot", 25e3)], [row("raycast", "knot", 25e3), failed], []):
            done = ratios(rows)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertIn("no pair", done.stderr)


if __name__ == "__main__":
    unittest.main()
