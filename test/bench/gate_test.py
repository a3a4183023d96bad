"""`sixdof gate`: programs and files whose answers, work, instructions and times are known get the verdict that they deserve.

usage: gate_test.py SIXDOF SIXDOF_BENCH MANIFEST PLANTED_BENCH
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

ROW = "distance/algorithm:x/pair:p/distance:05"
# A program with one row and more of other names. What it answers, how long it takes, and what a counter of instructions
# sees are settings.
PROGRAM = """#!/usr/bin/python3
import json, os, random, re, sys
settings = json.loads('''SETTINGS''')
flags = dict(word[2:].split("=", 1) for word in sys.argv[1:] if word.startswith("--") and "=" in word)
if "--benchmark_list_tests" in sys.argv: sys.exit(2)
if settings.get("dies"): sys.exit(settings["dies"])
row = {"name": "ROW", "run_name": "ROW",
       "run_type": "iteration", "repetitions": 1, "repetition_index": 0, "threads": 1, "iterations": 9,
       "time_unit": "ns", "cpu_time": settings.get("time", 100.0) * (1 + 0.01 * random.random()), "failed": 0.0, "p50_ns": 5.0,
       "mismatch": 0.0, "error_max": 1e-16 * random.random(), "error_rms": 0.25, "nodes_tested": 100.0, "nodes_total": 500.0,
       "sixdof": {"query": "distance", "algorithm": "x", "settings": {}}} | settings.get("row", {})
row["real_time"] = row["cpu_time"]
rows = [row] + [row | {"name": name, "run_name": name} for name in settings.get("more", [])]
if settings.get("error"):
    rows[0] = {key: row[key] for key in ("name", "run_name", "run_type", "repetitions", "repetition_index", "threads", "sixdof")}
    rows[0] |= {"error_occurred": True, "error_message": settings["error"]}
rows = [row for row in rows if re.search(flags["benchmark_filter"], row["name"])]
if "COUNT_FILE" in os.environ:
    loops = int(flags["iterations"])
    noise = 1 if settings.get("instructions") == 0 else random.uniform(0.9999, 1.0001)
    with open(os.environ["COUNT_FILE"], "w") as log:
        log.write(f"==7== I   refs:      {round(noise * loops * settings.get('instructions', 10_000)):,}\\n")
calls = settings.get("slow_calls")  # of a machine that is busy in the first runs, or in every second one
if calls:
    counted = sys.argv[0] + ".calls"
    done = int(open(counted).read()) if os.path.exists(counted) else 0
    open(counted, "w").write(str(done + 1))
    if done % 2 if calls == "every second" else done < calls:
        for each in rows: each["cpu_time"] *= 2
json.dump({"context": {"date": "today", "algorithm:x": settings.get("version", "1"), "arguments": sys.argv[1:]}, "benchmarks": rows},
          open(flags["benchmark_out"], "w"))
sys.exit(1 if settings.get("error") else 0)
"""
# Counts what the program itself notes.
VALGRIND = """#!/usr/bin/python3
import os, sys
if "--version" in sys.argv: print("valgrind-0"); sys.exit()
words = sys.argv[1:]
log = [word for word in words if word.startswith("--log-file=")][0].split("=", 1)[1].replace("%p", "7")
while words[0].startswith("-"): words.pop(0)
os.environ["COUNT_FILE"] = log
os.execv(words[0], words)
"""


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write("valgrind", VALGRIND)

    def write(self, name, text, mode=0o755):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        path.chmod(mode)
        return path

    def program(self, name, **settings):
        return self.write(name, PROGRAM.replace("SETTINGS", json.dumps(settings)).replace("ROW", ROW))

    def gate(self, *words, expected=0):
        environment = os.environ | {"PATH": f"{self.folder}:{os.environ['PATH']}"}
        done = subprocess.run([SIXDOF, "gate", *map(str, words)], cwd=self.folder, env=environment, capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.returncode, expected, done.stdout + done.stderr)
        return done.stdout if expected in (0, 3) else done.stderr

    def judged(self, base, candidate, *words, expected=0):
        base, candidate = self.program("base", **base), self.program("candidate", **candidate)
        return self.gate(base, candidate, "--filter", ".", *words, expected=expected)


class Answers(Folder):
    """Answers, and rows that are lost."""

    def answers(self, base, candidate, expected, *words):
        return self.judged(base, candidate, "--stages", "answers", *words, expected=expected)

    def test_as_before_are_green(self):
        out = self.answers({}, {"time": 300.0}, 0)
        self.assertRegex(out, r"green +answers: 1 row judged\ngate: green\n$")

    def test_wrong_lost_and_changed_are_red(self):
        for counter, value, kind in (("mismatch", 1.0, "wrong"), ("failed", 1.0, "lost"), ("error_rms", 0.2500001, "changed"),
                                     ("error_max", 1e-9, "changed"), ("crashed", 1.0, "lost"), ("judged", 3.0, "changed")):
            out = self.answers({}, {"row": {counter: value}}, 3)
            self.assertRegex(out, f"RED      answers: {ROW}: {kind}: {counter} ", counter)
            self.assertIn("gate: red", out)

    def test_of_a_row_that_fails_or_is_gone_are_lost(self):
        self.assertIn("lost: error none -> it broke", self.answers({}, {"error": "it broke"}, 3, ))
        out = self.answers({"more": ["distance/y"]}, {"more": ["distance/z"]}, 3)
        self.assertIn("RED      answers: distance/y: lost: the candidate has no such row", out)
        self.assertIn("note     answers: new row: distance/z", out)

    def test_of_a_program_that_dies_are_lost(self):
        self.assertIn("lost: the program ended with exit code 1 without a result", self.answers({}, {"dies": 1}, 3))
        self.assertIn("the baseline ended with exit code 1", self.answers({"dies": 1}, {}, 1))

    def test_within_the_tolerance_are_green(self):
        changed = {"row": {"error_rms": 0.2501}}
        self.answers({}, changed, 3)
        self.answers({}, changed, 0, "--tolerance", "0.001")
        self.answers({}, {"row": {"mismatch": 1.0}}, 3, "--tolerance", "0.001")

    def test_that_are_better_are_red_unless_allowed(self):
        self.assertIn("better: mismatch 1 -> 0", self.answers({"row": {"mismatch": 1.0}}, {}, 3))
        self.assertIn("note     answers: better", self.answers({"row": {"mismatch": 1.0}}, {}, 0, "--allow-better"))
        self.answers({}, {"row": {"mismatch": 1.0}}, 3, "--allow-better")

    def test_without_any_row_are_no_verdict(self):
        self.assertIn("no row has a result on both sides", self.answers({"error": "a"}, {"error": "a"}, 1))

    def test_that_are_red_leave_out_what_is_slower_to_judge(self):
        out = self.judged({}, {"row": {"mismatch": 1.0}}, "--stages", "answers,time", expected=3)
        self.assertRegex(out, "not judged time: answers are red")


class Work(Folder):
    """Counts, and instructions."""

    def work(self, base, candidate, expected, *words):
        return self.judged(base, candidate, "--stages", "answers,work", *words, expected=expected)

    def test_that_grows_by_more_than_allowed_is_red(self):
        self.assertIn("counts differ by less", self.work({}, {"row": {"nodes_tested": 102.9}}, 0))
        self.assertIn("nodes_tested 100 -> 104 (+4 %)", self.work({}, {"row": {"nodes_tested": 104.0}}, 3))
        self.work({}, {"row": {"nodes_tested": 104.0}}, 0, "--work-above", "5")

    def test_that_shrinks_is_green(self):
        self.work({}, {"row": {"nodes_tested": 50.0}}, 0)
        self.work({}, {"row": {"nodes_total": 5000.0}}, 0)
        self.work({"row": {"fill_a": 0.9}}, {"row": {"fill_a": 0.8}}, 3)

    def instructions(self, base, candidate, expected, *words):
        return self.judged({"instructions": base}, {"instructions": candidate}, "--stages", "instructions", *words,
                           expected=expected)

    def test_of_instructions_is_counted(self):
        self.assertRegex(self.instructions(10_000, 10_000, 0), r"green +instructions: 1 row judged")
        self.assertRegex(self.instructions(10_000, 10_300, 3), r"instructions: .*: \d+ -> 10[23]\d\d instructions a query \(\+[23]\.")
        self.assertIn("not counted: " + ROW + ": the program was built without valgrind/callgrind.h", self.instructions(0, 0, 0))
        self.instructions(10_000, 10_280, 0)
        self.instructions(10_000, 9_000, 0)

    def test_of_instructions_without_a_counter_is_not_judged(self):
        self.write("valgrind", "#!/bin/sh\nexit 1\n")
        self.assertRegex(self.instructions(10_000, 10_000, 0), "not counted: .* exit code 1")


class Time(Folder):
    """Two programs that run alternately."""

    def time(self, base, candidate, expected, *words):
        return self.judged(base, candidate, "--stages", "time", *words, expected=expected)

    def test_that_is_longer_is_red_after_two_measurements(self):
        out = self.time({}, {"time": 130.0}, 3)
        self.assertRegex(out, rf"RED      time: {ROW}: x1.[23]\d, again x1.[23]\d \(median of pairs\)")

    def test_that_is_hardly_longer_is_green(self):
        self.time({}, {"time": 105.0}, 0)
        self.time({}, {"time": 130.0}, 0, "--fail-above", "50")

    def test_of_a_busy_machine_is_not_confirmed(self):
        # The candidate takes twice as long in the run for its answers and in all nine of the first measurement.
        out = self.judged({}, {"slow_calls": 10}, "--stages", "answers,time", expected=0)
        self.assertIn("slower in the first of two measurements only", out)

    def test_that_is_longer_is_red_where_every_second_run_is_slow(self):
        uneven = {"slow_calls": "every second"}
        out = self.time(uneven, uneven | {"time": 130.0}, 3)
        self.assertIn("1 rows may be slower, and were measured 3 times as often", out)
        self.time(uneven, uneven, 0)

    def test_of_files_is_not_judged(self):
        self.gate(self.program("base"), "--record", "base.json", "--filter", ".", "--stages", "answers")
        out = self.gate("base.json", self.program("candidate"), "--stages", "answers,time")
        self.assertRegex(out, "not judged time: times of files are not compared")
        self.assertIn("gate: green", out)


class Stored(Folder):
    """A baseline that --record wrote."""

    def record(self, *words, **settings):
        self.gate(self.program("base", **settings), "--record", "base.json", "--filter", ".", "--sample", "8", *words)
        return json.loads((self.folder / "base.json").read_text())

    def test_has_answers_and_counts_and_no_times(self):
        made = self.record()
        (row,) = made["benchmarks"]
        self.assertEqual((row["error_rms"], row["nodes_tested"], row["cpu_time"]), (0.25, 100.0, 0.0))
        self.assertNotIn("p50_ns", row)
        self.assertAlmostEqual(made["context"]["gate"]["instructions"][ROW], 10_000, delta=20)

    def test_is_compared_with_the_sample_and_the_flags_that_it_was_recorded_with(self):
        self.record("--", "--a", "cone-1k")
        candidate = self.program("candidate")
        self.gate("base.json", candidate)
        asked = json.loads((self.folder / "sixdof-gate" / "candidate.json").read_text())["context"]["arguments"]
        self.assertEqual(asked[asked.index("--sample") + 1], "8")
        self.assertEqual(asked[asked.index("--a") + 1], "cone-1k")
        self.assertIn(f"--benchmark_filter=^({ROW})$", asked)
        for settings, expected in (({"row": {"mismatch": 1.0}}, 3), ({"instructions": 10_400}, 3), ({"more": ["other"]}, 0)):
            self.gate("base.json", self.program("candidate", **settings), expected=expected)

    def test_of_another_machine_has_no_instructions_to_compare(self):
        made = self.record()
        made["context"]["gate"]["instructions_on"] = "valgrind-3 | gcc"
        self.write("base.json", json.dumps(made), 0o644)
        out = self.gate("base.json", self.program("candidate", instructions=20_000))
        self.assertIn("not judged instructions: the baseline's were counted on valgrind-3 | gcc", out)

    def test_is_not_made_of_rows_without_a_result(self):
        error = self.gate(self.program("base", error="it broke"), "--record", "base.json", "--filter", ".", expected=1)
        self.assertIn("1 rows have no result", error)
        self.assertFalse((self.folder / "base.json").exists())


class Outputs(Folder):
    """Files for people and for other programs, and words for what cannot be done."""

    def outputs(self, candidate, expected):
        self.judged({}, candidate, "--stages", "answers,work,time", "--markdown", "gate.md", "--junit", "gate.xml",
                    expected=expected)
        suites = {suite.get("name"): suite for suite in xml.parse(self.folder / "gate.xml").getroot()}
        return (self.folder / "gate.md").read_text(), suites

    def test_say_what_is_green(self):
        text, suites = self.outputs({}, 0)
        self.assertTrue(text.startswith("### sixdof gate: green\n"))
        self.assertIn("| answers | green | 1 row judged |", text)
        self.assertEqual([(suite.get("tests"), suite.get("failures")) for suite in suites.values()], [("1", "0")] * 3)
        self.assertEqual(json.loads((self.folder / "sixdof-gate" / "gate.json").read_text())["verdict"], "green")

    def test_say_what_is_red(self):
        more = [f"distance/<&>|{i}" for i in range(60)]
        base = self.program("base", more=more)
        candidate = self.program("candidate", more=more, row={"mismatch": 1.0})
        self.gate(base, candidate, "--filter", ".", "--markdown", "gate.md", "--junit", "gate.xml", expected=3)
        text = (self.folder / "gate.md").read_text()
        self.assertLessEqual(len(text.splitlines()), 40)
        self.assertIn("- and 41 more", text)
        self.assertIn(r"distance/\<&\>\|0", text)
        suites = {suite.get("name"): suite for suite in xml.parse(self.folder / "gate.xml").getroot()}
        self.assertEqual((suites["answers"].get("tests"), suites["answers"].get("failures")), ("61", "61"))
        self.assertEqual((suites["time"].get("tests"), suites["time"].get("skipped")), ("1", "1"))
        self.assertIn("mismatch 0 -> 1", suites["answers"].find("testcase/failure").get("message"))

    def test_name_what_is_not_there(self):
        self.assertIn("nowhere: no such program or result file", self.gate("nowhere", "nowhere", expected=1))
        self.assertIn("no result of sixdof-bench", self.gate(self.write("a.json", "{}", 0o644), "b", expected=1))
        self.assertIn("is none of answers", self.gate("a", "b", "--stages", "answer", expected=2))
        self.assertIn("one program with --record", self.gate("a", expected=2))
        self.assertIn("--filtre", self.gate("a", "b", "--filtre", ".", expected=2))

    def test_take_command_lines(self):
        base = self.program("base")
        self.gate(f"{base} --first --x=1", f"{base} --second", "--filter", ".", "--stages", "answers", "--", "--third")
        asked = json.loads((self.folder / "sixdof-gate" / "baseline.json").read_text())["context"]["arguments"]
        self.assertEqual(asked[:3], ["--first", "--x=1", "--third"])


class Options(unittest.TestCase):
    """The command and the script know the same options."""

    def test_are_the_same(self):
        script = pathlib.Path(__file__).resolve().parents[2] / "bench" / "gate"
        texts = [subprocess.run(command, capture_output=True, text=True, check=True).stdout
                 for command in ([SIXDOF, "gate", "--help"], [script, "--help"])]
        of_command, of_script = (set(re.findall(r"^ +(?:-h, *)?(--[a-z-]+)", text, re.MULTILINE)) for text in texts)
        self.assertEqual(of_command, of_script - {"--sixdof"})


class SixdofBench(Folder):
    """sixdof-bench against itself, with a real counter where there is one."""

    def test_is_green(self):
        out = self.gate(BENCH, BENCH, "--filter", "^(collide|distance)/algorithm:exact/", "--sample", "8",
                        "--stages", "answers,work", "--", "--manifest", MANIFEST)
        self.assertRegex(out, r"green +answers: [1-9]\d* rows judged\ngreen +work: ")

    def test_of_planted_faults_is_red(self):
        rows = ["--filter", "^distance/algorithm:planted/", "--sample", "8", "--stages", "answers,work", "--", "--a", "cone-1k", "--b", "torus-1k"]
        self.gate(PLANTED, PLANTED, *rows)
        for plant, kind in (("wrong:1", "wrong: mismatch 0 -> 1"), ("wrong:20", "wrong: mismatch 0 -> 1"), ("lost:3", "lost: failed 0 -> ")):
            self.assertIn(kind, self.gate(PLANTED, f"env SIXDOF_PLANT={plant} {PLANTED}", *rows, expected=3))

    def test_figures_are_of_planted_faults(self):
        script = pathlib.Path(__file__).resolve().parents[2] / "bench" / "scripts" / "gate-figures"
        done = subprocess.run([script, "--program", PLANTED, "--sixdof", SIXDOF, "--unchanged", "0", "--wrong", "2", "--lost", "1",
                               "--instructions", "0", "--time", "0", "--out", self.folder / "figures.json"], cwd=self.folder,
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        found = json.loads((self.folder / "figures.json").read_text())["figures"]
        self.assertEqual([(one["kind"], one["red"]) for one in found], [("wrong", 2), ("lost", 1)])


if __name__ == "__main__":
    SIXDOF, BENCH, MANIFEST, PLANTED = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
