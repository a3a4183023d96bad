#!/usr/bin/env python3
"""Results as rows and as DataFrames, and signals of scenarios.

usage: results_test.py RESULTS
RESULTS: the published results, a file of sixdof-bench
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

from common import arguments, environment, main, numpy, sixdof

RESULTS = pathlib.Path(arguments(1))

try:
    import pandas
except ImportError:
    pandas = None


class Results(unittest.TestCase):
    def setUp(self):
        self.rows = sixdof.read_rows(RESULTS)
        self.written = json.loads(RESULTS.read_text())

    def test_rows_are_those_of_the_file(self):
        wanted = {entry["name"]: entry for entry in self.written["benchmarks"]}
        self.assertEqual([row["name"] for row in self.rows], list(wanted))
        for row in self.rows:
            entry = wanted[row["name"]]
            fields = entry["sixdof"]
            self.assertEqual((row["query"], row["algorithm"]), (fields["query"], fields["algorithm"]))
            if "bucket" in fields:
                self.assertEqual((row["bucket_kind"], row["percent"]),
                                 (fields["bucket"]["kind"], fields["bucket"]["percent"]))
            for counter in ("failed", "mismatch", "p50_ns", "gamma_F_deg"):
                if counter in entry:
                    self.assertEqual(row[counter], entry[counter])

    def test_context(self):
        self.assertEqual(sixdof.read_context(RESULTS)["date"], self.written["context"]["date"])

    @unittest.skipUnless(pandas, "no pandas")
    def test_frame(self):
        frame = sixdof.read_results(RESULTS)
        self.assertEqual(len(frame), len(self.rows))
        for column in ("query", "algorithm", "settings", "pair", "bucket", "percent", "processor_mean_ns"):
            self.assertIn(column, frame.columns)
        distances = frame[(frame["query"] == "distance") & (frame["error"] == "")]
        self.assertGreater(len(distances), 10)
        self.assertTrue((distances["processor_mean_ns"] > 0).all())
        self.assertEqual(len(sixdof.read_results(RESULTS, RESULTS)), 2 * len(frame))

    def test_without_pandas(self):
        code = ("import sys; sys.modules['pandas'] = None; import sixdof\n"
                f"assert len(sixdof.read_rows({str(RESULTS)!r})) == {len(self.rows)}\n"
                f"sixdof.read_results({str(RESULTS)!r})")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False,
                              env=environment())
        self.assertIn("Error: a DataFrame needs pandas", done.stderr)

    def test_words_of_errors(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "half.json"
            file.write_text(RESULTS.read_text()[:1000])
            for wrong, words in ((file, "half.json: "), (pathlib.Path(folder) / "none.json", "none.json: "),
                                 (pathlib.Path(folder), folder)):
                with self.assertRaisesRegex(sixdof.BadFile, words):
                    sixdof.read_rows(wrong)


class Signals(unittest.TestCase):
    def test_recorded_and_read(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "II.h5"
            recorded = sixdof.record("II", "exact", steps=60, out=file)
            read = sixdof.read_signals(file)
        self.assertTrue(recorded.ok.all() and (recorded.status == "ok").all())
        self.assertEqual(recorded.force.shape, (60, 3))
        self.assertLess(recorded.measures["gamma_F_deg"], 5)  # the reference force against its ideal on fine meshes
        for name in ("force", "torque", "ideal_force", "ideal_torque", "ok"):
            numpy.testing.assert_array_equal(getattr(read, name), getattr(recorded, name))
        numpy.testing.assert_allclose(read.poses, recorded.poses, atol=1e-14)  # through quaternions
        self.assertEqual((read.algorithm, read.scenario, read.settings), ("exact", "II", recorded.settings))
        self.assertEqual(recorded.time[-1], 59 / 1000)

    @unittest.skipUnless(pandas, "no pandas")
    def test_frame(self):
        signals = sixdof.record("III", "vps", steps=40, law="gradient", voxel_size=0.05)
        frame = signals.frame()
        self.assertEqual(len(frame), 40)
        numpy.testing.assert_array_equal(frame["ideal_torque_z"], signals.ideal_torque[:, 2])
        self.assertIn("voxel_size=0.05", signals.settings)
        self.assertEqual(signals.law, "gradient")

    def test_words_of_errors(self):
        for words, call in (("V", lambda: sixdof.record("V", "exact")),
                            ("algorithm: fcl-rss gives no response", lambda: sixdof.record("II", "fcl-rss")),
                            ("vps: voxels: no such parameter", lambda: sixdof.record("II", "vps", voxels=3))):
            with self.assertRaisesRegex(sixdof.BadArgument, words):
                call()
        with self.assertRaisesRegex(sixdof.BadFile, "none.h5"):
            sixdof.read_signals("none.h5")
        self.assertEqual(sixdof.scenarios()[0], "Ia")


if __name__ == "__main__":
    main()
