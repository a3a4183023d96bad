#!/usr/bin/env python3
"""Algorithms in other languages: bench/external/example.py and broken programs, in sixdof-bench and in sixdof.

usage: external_test.py SIXDOF_BENCH SIXDOF EXAMPLE MANIFEST
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

SIXDOF_BENCH, SIXDOF, EXAMPLE, MANIFEST = sys.argv[1:5]
del sys.argv[1:]
SAMPLE = 32
ROW = "distance/algorithm:spheres/pair:torus-1k/distance:05"

# What a faulty adapter does instead of an answer, every 8th time that one process or another is asked.
FAULT = """
    asked = int(open(counter).read() or 0) + 1 if os.path.exists(counter) else 1
    open(counter, "w").write(str(asked))
    if asked % 8 == 0:
        {fault}
"""


class External(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)

    def adapter(self, fault=None):
        """The command line of the example, or of one with a fault."""
        if fault is None:
            return f"{sys.executable} {EXAMPLE}"
        text = pathlib.Path(EXAMPLE).read_text()
        inserted = FAULT.format(fault=fault).replace("counter", repr(str(self.folder / "asked")))
        head = "def answer(query, pose):\n"
        self.assertIn(head, text)
        script = self.folder / "faulty.py"
        script.write_text("import os\n" + text.replace(head, head + inserted))
        return f"{sys.executable} {script}"

    def bench(self, command, *words):
        out = self.folder / "out.json"
        run = subprocess.run([SIXDOF_BENCH, "--manifest", MANIFEST, f"--benchmark_filter=^{ROW}$|^distance/algorithm:exact"
                              "/pair:torus-1k/distance:05$", "--sample", str(SAMPLE), "--benchmark_min_time=0.000001",
                              "--out", out, "--external", f"spheres={command}", *words],
                             capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        document = json.loads(out.read_text())
        rows = {row["name"]: row for row in document["benchmarks"]}
        self.assertEqual(rows[ROW.replace("spheres", "exact")]["failed"], 0, "the run went on")
        return document, rows[ROW]

    def test_example_is_a_row(self):
        document, row = self.bench(self.adapter())
        self.assertEqual(row["failed"], 0)
        self.assertEqual(row["judged"], SAMPLE)
        self.assertEqual(row["mismatch"], SAMPLE, "the spheres are nearer than the bodies")
        self.assertTrue(row["sixdof"]["isolated"])
        self.assertGreater(row["p50_ns"], 0)
        self.assertNotIn("times include", row.get("label", ""))
        self.assertEqual(document["context"]["algorithm:spheres"], "1.0")
        self.assertEqual(document["context"]["isolated"], "spheres")

    def test_killed(self):
        _, row = self.bench(self.adapter("os.kill(os.getpid(), 9)"))
        # Every pose is asked once in the check: each 8th ends the process. Later passes meet other poses.
        self.assertGreaterEqual(row["crashed"], SAMPLE // 8)
        self.assertEqual(row["failed"], row["crashed"])
        self.assertIn("ended by signal 9 (Killed)", row["label"])

    def test_endless_loop(self):
        _, row = self.bench(self.adapter("while True: pass"), "--query-timeout", "1s")
        self.assertGreaterEqual(row["timed_out"], SAMPLE // 8)
        self.assertEqual(row["failed"], row["timed_out"])
        self.assertIn("gave no answer in time", row["label"])

    def test_nonsense(self):
        _, row = self.bench(self.adapter("print('So far, so good', flush=True)"))
        self.assertGreaterEqual(row["failed"], SAMPLE // 8)
        self.assertNotIn("crashed", row)
        self.assertIn('wrote a malformed reply: "So far, so good"', row["label"])

    def test_exception(self):
        _, row = self.bench(self.adapter("1 / 0"))
        self.assertGreaterEqual(row["crashed"], SAMPLE // 8)
        self.assertIn("ended with exit code 1", row["label"])

    def sixdof(self, *words, code=0):
        run = subprocess.run([SIXDOF, *words], capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, code, run.stderr)
        return run

    def test_query(self):
        words = ["query", "--a", "cone-1k", "--b", "torus-1k", "--pose", "5 0 0 1 0 0 0", "--algorithm", "spheres",
                 "--json", "--external"]
        answers = json.loads(self.sixdof(*words, f"spheres={self.adapter()}").stdout)
        exact = json.loads(self.sixdof("query", "--a", "cone-1k", "--b", "torus-1k", "--pose", "5 0 0 1 0 0 0",
                                       "--json").stdout)
        self.assertFalse(answers["colliding"])
        self.assertGreater(answers["distance"], 0)
        self.assertLess(answers["distance"], exact["distance"])
        self.adapter("os.abort()")
        script = self.folder / "faulty.py"
        script.write_text(script.read_text().replace("% 8", "% 1"))
        crashed = self.sixdof(*words, f"spheres={sys.executable} {script}", code=1)
        self.assertEqual(json.loads(crashed.stdout)["status"], "crashed")
        self.assertIn("sixdof: spheres: crashed: ended by signal 6 (Aborted)\n", crashed.stderr)

    def test_isolated_query_has_the_same_answers(self):
        words = ["query", "--a", "cone-1k", "--b", "torus-1k", "--pose", "0.9 0 0.1 1 0 0 0", "--algorithm", "exact",
                 "--json"]
        here, there = (json.loads(self.sixdof(*words, *more).stdout) for more in ([], ["--isolate"]))
        for answers in (here, there):
            self.assertGreater(answers.pop("time_ns"), 0)
            answers.pop("times_ns")
        self.assertEqual(here, there)

    def test_quality(self):
        words = ["quality", "--scenario", "II", "--algorithm", "vps", "--steps", "40", "--json"]
        here, there = (json.loads(self.sixdof(*words, *more).stdout) for more in ([], ["--isolate"]))
        for measures in (here["measures"], there["measures"]):
            for time_of_it in ("mean_ns", "processor_ns", "p50_ns", "p99_ns", "p999_ns", "max_ns"):
                if time_of_it in measures:
                    self.assertGreater(measures.pop(time_of_it), 0)
            measures.pop("over_1ms")
        self.assertEqual(here, there)

    def test_studies(self):
        out = self.folder / "study.json"
        self.sixdof("precision", "--a", "cone-1k", "--b", "torus-1k", "--question", "distance", "--algorithms",
                    "spheres,exact,fcl-rss", "--sample", "32", "--budget", "20s", "-o", out, "--external",
                    f"spheres={self.adapter()}")
        rows = {row["sixdof"]["algorithm"]: row for row in json.loads(out.read_text())["benchmarks"]}
        self.assertTrue(rows["spheres"]["sixdof"]["isolated"])
        self.assertTrue(rows["fcl-rss"]["sixdof"]["isolated"], "third-party by default")
        self.assertNotIn("isolated", rows["exact"]["sixdof"])
        self.assertGreater(rows["spheres"]["too_small"], 0)
        self.assertEqual(rows["spheres"]["too_large"], 0)
        for row in rows.values():
            self.assertGreater(row["cpu_time"], 0)
        self.sixdof("recommend", "--a", "cone-1k", "--b", "torus-1k", "--metric", "error_rms", "--deadline", "10s",
                    "--algorithms", "spheres,exact", "--budget", "20s", "--external", f"spheres={self.adapter()}")
        listed = json.loads(self.sixdof("algorithms", "--json", "--external", f"spheres={self.adapter()}").stdout)
        self.assertEqual(listed[-1]["name"], "spheres")
        self.assertEqual(listed[-1]["answers"], ["collide", "distance"])

    def test_hostile_words_end_no_run(self):
        words = "red \x1b[31m \x9b2J\n\x00\x7f \u202e\u2028 | a |`<script>\\\" \ud800 " + "w" * 100000
        script = self.folder / "hostile.py"
        script.write_text(f"""import json, sys
words = {words!r}
asked = 0
for line in sys.stdin:
    do = json.loads(line)["do"]
    if do == "hello":
        reply = dict(protocol=1, name=words, version="1" + words, summary=words, answers=["distance"], parameters=[
            dict(name="p", meaning=words, unit=words, default="1", low=1, high=9)])
    elif do == "prepare":
        reply = dict(prepared=True, counts={{words: 3}})
    else:
        asked += 1
        reply = dict(status="failed", words=words) if asked % 2 else dict(distance=0.25)
    print(json.dumps(reply), flush=True)
""")
        command = f"{sys.executable} {script}"
        document, row = self.bench(command)
        self.assertGreaterEqual(row["failed"], SAMPLE // 2)
        self.assertIn("red \\x1B[31m \\xC2\\x9B2J\\x0A\\x00\\x7F", row["label"])
        self.assertTrue(document["context"]["algorithm:spheres"].startswith("1red \\x1B[31m"))
        out = self.folder / "out.json"
        document["benchmarks"] = document["benchmarks"][:1]
        out.write_text(json.dumps(document))
        more = ["--manifest", MANIFEST, "--sample", str(SAMPLE), "--benchmark_min_time=0.000001", "--external",
                f"spheres={command}", f"--benchmark_filter=^({ROW}|distance/algorithm:exact/pair:torus-1k/distance:05|"
                "prepare/algorithm:spheres/pair:torus-1k)$"]
        done = subprocess.run([SIXDOF_BENCH, *more, "--resume", out], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(json.loads(out.read_text())["benchmarks"]), 3)
        shown = [done.stdout, done.stderr]
        ask = ["--external", f"spheres={command}"]
        pose = ["query", "--a", "cone-1k", "--b", "torus-1k", "--pose", "5 0 0 1 0 0 0", "--algorithm", "spheres", *ask]
        for command, code in ((["algorithms", *ask], 0), (["algorithms", "--json", *ask], 0), (pose, 1),
                              ([*pose, "--json"], 1), (["table", out], 0), (["table", "--markdown", out], 0),
                              (["table", "--wide", out], 0), (["table", "--json", out], 0),
                              (["report", out, "--csv", self.folder / "t", "--markdown", self.folder / "t"], 0)):
            done = self.sixdof(*command, code=code)
            shown += [done.stdout, done.stderr]
        shown += [file.read_text() for file in (self.folder / "t").iterdir()]
        for text in shown:
            self.assertNotRegex(text, "[\x00-\x09\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028-\u202f]")
        self.assertIn("red \\x1B[31m", "".join(shown))

    def children_of(self, process):
        text = subprocess.run(["ps", "-o", "pid=", "--ppid", str(process.pid)], capture_output=True, text=True, check=False)
        return [int(word) for word in text.stdout.split()]

    def wait_for(self, condition, what):
        for _ in range(3000):
            if condition():
                return
            time.sleep(0.02)
        self.fail(what)

    def test_no_orphan_survives(self):
        """Ctrl-C, and a kill that leaves no time to clean up."""
        for how, code in ((signal.SIGINT, 130), (signal.SIGKILL, -9)):
            (self.folder / "asked").unlink(missing_ok=True)
            command = self.adapter("while True: pass")
            with subprocess.Popen([SIXDOF_BENCH, "--manifest", MANIFEST, f"--benchmark_filter=^{ROW}$", "--external",
                                   f"spheres={command}", "--query-timeout", "100s"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as program:
                asked = self.folder / "asked"
                self.wait_for(lambda: asked.exists() and asked.read_text() == "8", "the adapter was not asked")
                children = self.children_of(program)
                self.assertTrue(children)
                program.send_signal(how)
                self.assertEqual(program.wait(60), code)
            for child in children:
                self.wait_for(lambda: not pathlib.Path(f"/proc/{child}").exists(), f"{child} survives")


if __name__ == "__main__":
    unittest.main()
