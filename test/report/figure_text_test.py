"""The sentences under every figure against the places of its marks, by node without a browser (figure_text_test.js).

usage: figure_text_test.py SIXDOF

Exits with 77 (a skipped test) where node or the page's libraries are missing.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE))
from sample_results import STRESS, cast_rows, collection, contact_rows, row, rows, scene_rows  # noqa: E402

SIXDOF = sys.argv.pop(1)
SKIPPED = 77
REPORT = HERE.parent.parent / "lib" / "sixdof" / "report"


def data_of(page):
    text = page.read_text()
    return re.search(r'<script id="report-data" type="application/json">(.*?)</script>', text, re.DOTALL).group(1)


def repeated(one):
    """Three repetitions whose times differ much."""
    return [{**one, "cpu_time": factor * one["cpu_time"]} for factor in (0.6, 1.0, 1.7)]


class FigureTexts(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_it(self, *words):
        done = subprocess.run([SIXDOF, *words], capture_output=True, text=True, check=False, cwd=self.folder)
        if done.returncode != 0 and "cmake/setup report" in done.stderr:
            print("skipped:", done.stderr)
            os._exit(SKIPPED)
        self.assertEqual(done.returncode, 0, done.stderr)

    def write(self, name, benchmarks, context=None, **more):
        (self.folder / name).write_text(json.dumps({"context": context or {}, "benchmarks": benchmarks, **more}))

    def report_data(self):
        failed = row("distance", "fcl-kios", "elephant", "distance", 0, 1.0)
        failed = {key: failed[key] for key in ("name", "run_type", "sixdof")} | {"error_occurred": True, "error_message": "no memory"}
        noisy = repeated(row("distance", "fcl-rss", "elephant", "distance", 5, 4000.0)) + repeated(row("distance", "fcl-rss", "elephant", "distance", 10, 3000.0))
        # The fastest where it is right, but wrong elsewhere.
        hasty = [row("distance", "ode", "elephant", "distance", percent, 10.0, mismatch=wrong, error_rms=0.0) for percent, wrong in ((5, 0), (10, 2))]
        bounded = row("respond", "fcl-contacts", "elephant", "volume", 0, 8000.0, gamma_F_deg=4.0, gamma_F_deg_low=3.0, gamma_F_deg_high=6.0)
        self.write("run.json", [*rows(), failed, *noisy, *hasty, bounded], {"load_avg": [6.5, 5.0, 4.0], "num_cpus": 2})
        self.write("later.json", rows(1.3), {"load_avg": [0.1, 5.0, 4.0], "num_cpus": 2})
        self.write("scenes.json", [*scene_rows(), *cast_rows(), *contact_rows()])
        self.write("objects.json", [], **collection())
        (self.folder / "stress.json").write_text(json.dumps(STRESS))
        self.run_it("quality", "--scenario", "II", "--algorithm", "vps", "-p", "voxel_size=0.05", "-p", "point_spacing=0.05", "--steps", "128", "-o", "II.h5")
        self.run_it("report", "run.json", "later.json", "scenes.json", "objects.json", "stress.json", "--series", "II.h5", "-o", "page.html")
        (self.folder / "data.json").write_text(data_of(self.folder / "page.html"))
        return self.folder / "data.json"

    def history_data(self):
        (self.folder / "runs").mkdir()
        for k in range(8):
            time = 1000.0 if k < 4 else 2000.0
            self.write(f"runs/{k}.json", [row("prepare", "exact", "elephant", "distance", 5, time), row("distance", "exact", "elephant", "distance", 5, time),
                                          row("distance", "vps", "elephant", "distance", 5, 3.0 * time)], {"date": f"2026-01-{k + 1:02}", "commit": str(k)})
        self.run_it("history", "runs", "-o", "history.html")
        (self.folder / "history_data.json").write_text(data_of(self.folder / "history.html"))
        return self.folder / "history_data.json"

    def test_sentences_are_those_of_the_marks(self):
        files = [self.report_data(), self.history_data()]
        # The page's files of the source, with the libraries of the build.
        vendor = next(folder / "share" / "sixdof" / "report" / "vendor" for folder in pathlib.Path(SIXDOF).resolve().parents
                      if (folder / "share" / "sixdof" / "report" / "vendor").exists())
        (self.folder / "report").mkdir()
        (self.folder / "report" / "page").symlink_to(REPORT / "page")
        (self.folder / "report" / "vendor").symlink_to(vendor)
        done = subprocess.run(["node", str(HERE / "figure_text_test.js"), str(self.folder / "report"), *map(str, files)], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        compared = json.loads(done.stdout.splitlines()[-1])["compared"]
        figures = [path.stem for path in (REPORT / "figures").glob("*.json")]
        self.assertEqual([figure for figure in figures if figure not in compared], [], "every figure is compared")
        for what in ("failed", "once", "busy", "wide", "bars", "fewer", "faults of winners", "faults of metrics", "verdict with others"):
            self.assertGreater(compared.get(what, 0), 0, what)


if __name__ == "__main__":
    if not shutil.which("node"):
        print("skipped: no node here")
        sys.exit(SKIPPED)
    unittest.main()
