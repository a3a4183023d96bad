#!/usr/bin/env python3
"""Programs that are set up as rivals (bench/rivals/setup), by their names in all commands: bench/external/example.py as one.

usage: rivals_test.py SIXDOF_BENCH SIXDOF EXAMPLE MANIFEST
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SIXDOF_BENCH, SIXDOF, EXAMPLE, MANIFEST = sys.argv[1:5]
del sys.argv[1:]
HELLO = {"protocol": 1, "name": "spheres", "version": "1.0", "summary": "bounding spheres", "answers": ["collide", "distance"]}
BUCKET = "pair:torus-1k/distance:05"
POSE = ["--a", "cone-1k", "--b", "torus-1k", "--pose", "5 0 0 1 0 0 0"]


class Rivals(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.started = self.folder / "started"
        (self.folder / "ready").mkdir()
        script = self.folder / "spheres.sh"
        script.write_text(f"#!/bin/sh\ntouch {self.started}\nexec {sys.executable} {EXAMPLE}\n")
        script.chmod(0o755)
        self.set_up("spheres", command=str(script))

    def set_up(self, name, **changes):
        ready = {"name": name, "command": "false", "runtime": "python", "licence": "MIT", "hello": HELLO | {"name": name}}
        self.write(name, json.dumps(ready | changes))

    def write(self, name, text):
        (self.folder / "ready" / f"{name}.json").write_text(text)

    def run_program(self, *words, code=0):
        environment = os.environ | {"SIXDOF_RIVALS": str(self.folder)}
        done = subprocess.run([str(word) for word in words], env=environment, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def sixdof(self, *words, code=0):
        return self.run_program(SIXDOF, *words, code=code)

    def rows(self, *words):
        """Names of the rows that sixdof-bench would run."""
        listed = self.run_program(SIXDOF_BENCH, "--manifest", MANIFEST, "--benchmark_list_tests", *words)
        return listed.stdout.split()

    def test_listed_without_being_started(self):
        listed = {each["name"]: each for each in json.loads(self.sixdof("algorithms", "--json").stdout)}
        self.assertEqual({key: listed["spheres"][key] for key in ("version", "answers", "runtime", "by_default", "body")},
                         {"version": "1.0", "answers": ["collide", "distance"], "runtime": "python", "by_default": False,
                          "body": "mesh"})
        self.assertEqual(listed["spheres"]["summary"], "bounding spheres (MIT)")
        self.assertIsNone(listed["exact"]["runtime"])
        self.assertIn("(rival, python: only where it is named)", self.sixdof("algorithms").stdout)
        self.assertFalse(self.started.exists())

    def test_broken_files_cost_their_rivals_only(self):
        self.write("broken", '{\n"name": broken}')
        self.set_up("exact")
        self.set_up("unknown-runtime", runtime="abacus")
        self.set_up("silent", hello=HELLO | {"answers": []})
        self.write("old", '{"name": "old", "runtime": "native", "licence": "MIT", "command": "false"}')
        done = self.sixdof("algorithms", "--json")
        names = [each["name"] for each in json.loads(done.stdout)]
        self.assertIn("spheres", names)
        self.assertEqual(names.count("exact"), 1)
        self.assertFalse({"broken", "unknown-runtime", "silent", "old"} & set(names))
        warnings = {line.split("/ready/")[1].split(".json")[0]: line for line in done.stderr.splitlines()}
        self.assertTrue(all(line.startswith("sixdof: warning: rival left out: ") for line in warnings.values()))
        for name, words in (("broken", "line 2,"), ("exact", "already registered"), ("old", "'hello' not found"),
                            ("unknown-runtime", '"abacus" is none of native, python, node, wasm'),
                            ("silent", "answers no kind of query")):
            self.assertIn(words, warnings[name])

    def test_rows(self):
        row = f"distance/algorithm:spheres/{BUCKET}"
        out = self.folder / "out.json"
        self.run_program(SIXDOF_BENCH, "--manifest", MANIFEST, f"--benchmark_filter=^{row}$", "--sample", "16",
                         "--benchmark_min_time=0.000001", "--out", out)
        document = json.loads(out.read_text())
        (measured,) = document["benchmarks"]
        self.assertEqual((measured["name"], measured["failed"], measured["mismatch"]), (row, 0, 16))
        self.assertEqual(measured["sixdof"]["runtime"], "python")
        self.assertEqual(document["context"]["algorithm:spheres"], "1.0")
        for option in ("--external", "--isolate"):
            self.assertNotIn(option, measured["outliers"]["command"], "found by name")
        self.assertTrue(self.started.exists())

    def test_parameters_of_all_rivals(self):
        mode = {"name": "mode", "meaning": "m", "unit": "", "default": "a", "choices": ["a", "b"]}
        self.set_up("spheres", command=f"{sys.executable} {EXAMPLE}", hello=HELLO | {"parameters": [mode]})
        self.set_up("plain")
        out = self.folder / "out.json"
        words = ["--manifest", MANIFEST, f"--benchmark_filter=^distance/algorithm:spheres/{BUCKET}$", "--sample", "8",
                 "--benchmark_min_time=0.000001", "--out", out]
        self.run_program(SIXDOF_BENCH, *words, "-p", "rivals:mode=b")
        self.assertEqual(json.loads(out.read_text())["benchmarks"][0]["sixdof"]["settings"], {"mode": "b"})
        refused = self.run_program(SIXDOF_BENCH, *words, "-p", "rivals:size=3", code=1)
        self.assertIn("rivals: none that suits is set up", refused.stderr)

    def test_rows_only_where_they_are_named(self):
        row = f"distance/algorithm:spheres/{BUCKET}"
        self.assertNotIn(row, self.rows(f"--benchmark_filter=^distance/.*/{BUCKET}$"))
        self.assertIn(row, self.rows(f"--benchmark_filter=spheres.*/{BUCKET}$"))
        listed = self.rows(f"--benchmark_filter=^distance/algorithm:(exact|rivals)/{BUCKET}$")
        self.assertEqual(listed, [f"distance/algorithm:exact/{BUCKET}", row])
        suite = self.folder / "suite.json"
        entry = {"query": ["distance"], "pair": "all", "distance": ["05"]}
        for algorithms, expected in (("all", False), (["exact"], False), (["rivals"], True)):
            suite.write_text(json.dumps({"rows": [entry | {"algorithm": algorithms}]}))
            self.assertEqual(row in self.rows("--suite", suite, f"--benchmark_filter={BUCKET}$"), expected, algorithms)
        self.assertFalse(self.started.exists())

    def test_another_rival_does_not_keep_a_run_from_going_on(self):
        out = self.folder / "out.json"
        words = [SIXDOF_BENCH, "--manifest", MANIFEST, f"--benchmark_filter=algorithm:exact/{BUCKET}$", "--sample", "8",
                 "--benchmark_min_time=0.000001"]
        self.run_program(*words, "--out", out)
        self.assertNotIn("algorithm:spheres", json.loads(out.read_text())["context"])
        self.set_up("more")
        self.run_program(*words, "--resume", out)

    def test_studies_and_queries(self):
        answer = json.loads(self.sixdof("query", *POSE, "--algorithm", "spheres", "--json").stdout)
        self.assertFalse(answer["colliding"])
        set_file = pathlib.Path(MANIFEST).parent / "torus-1k.h5"
        agree = json.loads(self.sixdof("agree", "--set", set_file, "--algorithms", "exact,rivals", "--sample", "8", "--json",
                                       code=3).stdout)
        self.assertEqual([each["name"] for each in agree["algorithms"]], ["exact", "spheres"])
        self.assertTrue(all(each["algorithm"] == "spheres" for each in agree["pairs"][0]["differences"]))
        precision = json.loads(self.sixdof("precision", "--a", "cone-1k", "--b", "torus-1k", "--question", "distance",
                                           "--algorithms", "rivals,exact", "--sample", "16", "--budget", "20s",
                                           "--json").stdout)
        self.assertIn("spheres", json.dumps(precision))
        told = self.sixdof("precision", "--a", "cone-1k", "--b", "torus-1k", "--question", "distance", "--algorithms",
                           "spheres,exact", "--sample", "16", "--budget", "20s").stdout
        self.assertIn("spheres (python)", told)
        self.assertIn("algorithms of Python and Node have frontiers of their own", told)
        stress = json.loads(self.sixdof("stress", "--algorithms", "rivals", "--families", "kissing", "--json", "--cases",
                                        self.folder / "cases").stdout)
        self.assertEqual([each["algorithm"] for each in stress], ["spheres"])
        self.assertEqual(stress[0]["verdict"], "wrong")

    def test_what_is_removed_loses_its_own_answers_only(self):
        self.set_up("spheres", command=str(self.folder / "nothing"))
        set_file = pathlib.Path(MANIFEST).parent / "torus-1k.h5"
        agree = json.loads(self.sixdof("agree", "--set", set_file, "--algorithms", "exact,spheres", "--sample", "8",
                                       "--json").stdout)
        self.assertEqual(len(agree["pairs"][0]["refusals"]), 1)
        self.assertIn("spheres", agree["pairs"][0]["refusals"][0])
        out = self.folder / "out.json"
        self.run_program(SIXDOF_BENCH, "--manifest", MANIFEST, "--sample", "8", "--benchmark_min_time=0.000001", "--out", out,
                         f"--benchmark_filter=^distance/algorithm:(exact|spheres)/{BUCKET}$", code=1)
        rows = {row["sixdof"]["algorithm"]: row for row in json.loads(out.read_text())["benchmarks"]}
        self.assertIn("error_message", rows["spheres"])
        self.assertEqual(rows["exact"]["failed"], 0)

    def test_none_is_set_up(self):
        (self.folder / "ready/spheres.json").unlink()
        for words in (["stress", "--algorithms", "rivals"], ["conform", "--algorithms", "rivals"],
                      ["precision", *POSE[:4], "--algorithms", "rivals"]):
            self.assertIn("bench/rivals/setup", self.sixdof(*words, code=1).stderr)

    def test_an_external_one_comes_instead(self):
        self.set_up("spheres", command="false", hello=HELLO | {"version": "0.9"})
        listed = json.loads(self.sixdof("algorithms", "--json", "--external",
                                        f"spheres={sys.executable} {EXAMPLE}").stdout)
        found = [each for each in listed if each["name"] == "spheres"]
        self.assertEqual([(each["version"], each["runtime"]) for each in found], [("1.0", None)])


if __name__ == "__main__":
    unittest.main()
