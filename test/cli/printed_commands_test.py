#!/usr/bin/env python3
"""Commands that programs print or store for the user, run by a shell from where the user stands: a project with programs
turbo-bvh-sixdof and turbo-bvh-bench and no others in the PATH, mesh files of its own, an external program. Each shows
the same wrong answer, or measures the same row again. test/README.md lists them all.

usage: printed_commands_test.py SIXDOF PROGRAM BENCH (the last two with the algorithm `balls`, added_algorithm.cpp)
"""

import csv
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

SIXDOF, PROGRAM, BENCH = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
del sys.argv[1:]
ROOT = pathlib.Path(__file__).resolve().parents[2]
DEFECTS = 3  # exit code

# Says that nothing touches, also at poses that are none.
NEVER = """import json, sys
for line in sys.stdin:
    do = json.loads(line)["do"]
    print(json.dumps({"protocol": 1, "name": "never", "version": "1", "answers": ["collide"]} if do == "hello" else
                     {"prepared": True} if do == "prepare" else {"collide": False, "ns": 1}), flush=True)
"""
# Ends without an answer.
DIES = NEVER.replace('    print', '    if do == "ask":\n        sys.exit(7)\n    print')
EXTERNAL = "--external 'never=python3 never.py'"
OWN = "--a 'bolt+nut.obj' --b plate.obj"  # the name of the pair has a character of regular expressions
QUICK = "--sample 32 --benchmark_min_time=0.000001"


class Printed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name, "my work")
        tools = pathlib.Path(cls.scratch.name, "tools")
        for folder in (cls.folder, tools):
            folder.mkdir()
        (tools / "turbo-bvh-sixdof").symlink_to(PROGRAM)
        (tools / "turbo-bvh-bench").symlink_to(BENCH)
        (tools / "python3").symlink_to(sys.executable)
        (cls.folder / "never.py").write_text(NEVER)
        (cls.folder / "dies.py").write_text(DIES)
        cls.environment = {**os.environ, "PATH": f"{tools}:/usr/bin:/bin", "SIXDOF_CACHE": f"{cls.scratch.name}/cache"}
        cls.succeed("turbo-bvh-sixdof models make torus-300 -o bolt+nut.obj")
        cls.succeed("turbo-bvh-sixdof models make cone-200 -o plate.obj")
        cls.succeed(f"turbo-bvh-sixdof generate {OWN} --grid 90 --distances 5 --volumes 5 -o 'my set.h5'")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def shell(cls, line):
        return subprocess.run(line, shell=True, cwd=cls.folder, env=cls.environment, capture_output=True, text=True,
                              check=False)

    @classmethod
    def succeed(cls, line, code=0):
        done = cls.shell(line)
        assert done.returncode == code, f"{line}\nexit code {done.returncode}\n{done.stdout[-2000:]}{done.stderr}"
        return done

    def answers(self, command, code=0):
        """What a printed `turbo-bvh-sixdof query ...` answers."""
        self.assertTrue(command.startswith("turbo-bvh-sixdof query "), command)
        return json.loads(self.succeed(command + " --json", code).stdout)

    def truth(self, command):
        """The right answers to what the command asks."""
        words = shlex.split(command)
        words[words.index("--algorithm") + 1] = "exact"
        for option in ("--external", "-p"):
            while option in words:
                del words[words.index(option):words.index(option) + 2]
        return self.answers(shlex.join(words))

    def check_wrong_no(self, command):
        """It says no where yes is right, as it did when the command was printed."""
        self.assertIs(self.answers(command)["colliding"], False, command)
        self.assertIs(self.truth(command)["colliding"], True, command)

    def tables(self, results, table):
        """Lines of a table of the page; a table without lines is no file."""
        shutil.rmtree(self.folder / "tables", ignore_errors=True)
        self.succeed(f"turbo-bvh-sixdof report {results} --csv tables")
        path = self.folder / "tables" / f"{table}.csv"
        if not path.exists():
            return []
        with open(path, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def measured(self, arguments):
        """Rows of a run, and what the page of failures has of it."""
        self.succeed(f"turbo-bvh-bench {arguments} {QUICK} --out run.json")
        rows = json.loads((self.folder / "run.json").read_text())["benchmarks"]
        (self.folder / "run.json").rename(self.folder / "results.json")
        return {row["name"]: row for row in rows}, self.tables("results.json", "failures")

    def check_failures(self, arguments):
        """Every line of the page of failures has two commands that show the fault again."""
        rows, failures = self.measured(arguments)
        self.assertGreater(len(failures), 0)
        for line in failures:
            again = json.loads(self.succeed(f"{line['command']} --benchmark_min_time=0.000001 --benchmark_format=json").stdout)
            [row] = again["benchmarks"]
            before = rows[row["name"]]
            self.assertEqual((row["sixdof"]["algorithm"], row["sixdof"]["query"]), (line["algorithm"].split()[0], line["query"]))
            for counter in ("configurations", "mismatch", "failed"):
                self.assertEqual(row[counter], before[counter], line["command"])
            self.assertGreater(row["mismatch"], 0)
            answers, truth = self.answers(line["worst_pose"]), self.truth(line["worst_pose"])
            asked = "colliding" if line["query"] == "collide" else "distance"
            self.assertNotEqual(answers[asked], truth[asked], line["worst_pose"])
        return rows, failures

    def test_failures_of_own_meshes(self):
        rows, failures = self.check_failures(f"{OWN} -p balls:scale_b=0.9 --suite all '--benchmark_filter=^distance/algorithm:balls/.*:05$'")
        [row], [line] = rows.values(), failures
        self.assertIn("turbo-bvh-bench --a bolt+nut.obj --b plate.obj -p balls:scale_b=0.9 --suite all ", line["command"])
        self.assertIn(" -p scale_b=0.9", line["worst_pose"])
        # The largest error is that at its pose, in diagonals of A; the bucket is 5 % of one.
        outliers = row["outliers"]
        worst = f"{outliers['command']} --pose '{outliers['poses']['error_max']}'"
        exact = self.truth(worst)["distance"]
        self.assertAlmostEqual(abs(self.answers(worst)["distance"] - exact) / (20.0 * exact), row["error_max"], delta=1e-6)

    def test_failures_of_an_external_program(self):
        _, failures = self.check_failures(f"{OWN} {EXTERNAL} --suite all '--benchmark_filter=^collide/algorithm:never/.*volume'")
        for line in failures:
            self.assertIn(f" {EXTERNAL} ", line["command"])
            self.assertIn(f" {EXTERNAL} ", line["worst_pose"])
            self.check_wrong_no(line["worst_pose"])

    def test_failures_of_own_sets(self):
        where = "'--benchmark_filter=^collide/algorithm:never/.*volume'"
        self.check_failures(f"--no-manifest --set 'my set.h5' {EXTERNAL} {where}")
        sets = self.folder / "sets"
        sets.mkdir()
        (sets / "mine.h5").write_bytes((self.folder / "my set.h5").read_bytes())
        self.succeed(f"python3 -B {shlex.quote(str(ROOT / 'fixtures/set_manifest.py'))} --program turbo-bvh-sixdof sets")
        _, failures = self.check_failures(f"--manifest sets/manifest.json {EXTERNAL} {where}")
        self.assertIn(" --manifest sets/manifest.json ", failures[0]["command"])

    def test_rows_of_scenarios(self):
        [before] = self.measured("--no-manifest '--benchmark_filter=^scenario/II/algorithm:balls$'")[0].values()
        [command] = {line["command"] for line in self.tables("results.json", "scenario_measures")}
        [again] = json.loads(self.succeed(f"{command} --benchmark_min_time=0.000001 --benchmark_format=json").stdout)["benchmarks"]
        measures = [name for name in before if name.startswith(("sigma_", "gamma_"))]
        self.assertGreater(len(measures), 0)
        for name in ("name", "steps", *measures):
            self.assertEqual(again[name], before[name], command)

    def test_recommend_measures_what_it_takes_again(self):
        mine = "--external 'mine=turbo-bvh-sixdof --serve-algorithm exact'"
        done = self.succeed(f"turbo-bvh-sixdof recommend {OWN} {mine} --algorithms mine --question distance --deadline 1s "
                            "--budget 60s -o recommend.json")
        [command] = re.findall(r"^  again +(.*)$", done.stdout, re.MULTILINE)
        self.assertTrue(command.startswith("turbo-bvh-bench --a bolt+nut.obj "), command)
        self.assertIn(f" {mine} ", command)
        rows = json.loads(self.succeed(f"{command} {QUICK} --benchmark_format=json").stdout)["benchmarks"]
        self.assertGreater(len(rows), 1)
        for row in rows:
            self.assertEqual((row["sixdof"]["algorithm"], row["sixdof"]["query"]), ("mine", "distance"))
            self.assertEqual((row["mismatch"], row["failed"]), (0, 0))
        # The page has the command of the study.
        [again] = {line["command"] for line in self.tables("recommend.json", "frontier")}
        self.assertTrue(again.startswith("turbo-bvh-sixdof recommend "), again)
        self.assertIn("mine", self.succeed(again).stdout)

    def check_study(self, arguments, table):
        """The page's command of a study. @return rows by name: those of the study, and those that the command measures"""
        self.succeed(f"turbo-bvh-sixdof {arguments} -o study.json")
        [command] = {line["command"] for line in self.tables("study.json", table)}
        self.assertTrue(command.startswith(f"turbo-bvh-sixdof {arguments.split()[0]} "), command)
        texts = ((self.folder / "study.json").read_text(), self.succeed(command + " --json").stdout)
        return [{row["name"]: row for row in json.loads(text)["benchmarks"]} for text in texts]

    def test_precision(self):
        before, again = self.check_study(
            f"precision {OWN} --question distance --algorithms balls,exact --params balls:scale_a=1 --params balls:scale_b=0.9 "
            "--sample 16 --budget 60s", "frontier")
        self.assertEqual(before.keys(), again.keys())
        wrong = [row for row in before.values() if row["sixdof"]["algorithm"] == "balls"]
        self.assertEqual(len(wrong), 1)
        for row in before.values():
            self.assertEqual(again[row["name"]]["error_mean"], row["error_mean"])

    def test_equivalent(self):
        before, again = self.check_study(
            "equivalent --scenario II --algorithm vps --tau 10us --steps 60 --grid voxel_size=0.1,0.07,0.05 "
            "--grid point_spacing=0.1,0.07,0.05", "metrics")
        # Which resolutions the search looks at depends on times; what it is asked for does not.
        answers = [{name for name in rows if name.count("/") == 3} for rows in (before, again)]
        self.assertEqual(len(answers[0]), 1)
        self.assertEqual(answers[0], answers[1])

    def test_stress(self):
        words = f"stress --families contained,bad-pose --cases 'my cases' --algorithms never {EXTERNAL}"
        out = self.succeed(f"turbo-bvh-sixdof {words} --json").stdout
        contained, bad = json.loads(out)
        self.check_wrong_no(contained["reproduction"])
        self.assertIs(self.answers(bad["reproduction"])["colliding"], False)
        self.assertEqual(len(shlex.split(bad["reproduction"])[-1].split()), 12, "the pose is no rigid motion")
        self.answers(contained["slowest_reproduction"])
        printed = re.findall(r"^  (turbo-bvh-sixdof query .*)$", self.succeed(f"turbo-bvh-sixdof {words}").stdout, re.MULTILINE)
        self.assertEqual(printed, [contained["reproduction"], bad["reproduction"]])

    def test_stress_of_a_program_that_dies(self):
        out = self.succeed("turbo-bvh-sixdof stress --families contained --algorithms dies --external 'dies=python3 dies.py' --json").stdout
        [cell] = json.loads(out)
        self.assertEqual(cell["verdict"], "crashed")
        done = self.succeed(cell["reproduction"], code=1)
        self.assertIn("dies: crashed: ended with exit code 7", done.stderr)

    def test_stress_of_generators(self):
        [cell] = json.loads(self.succeed("turbo-bvh-sixdof stress --families kissing --algorithms generate-distances --cases 'my cases' "
                                         "--json").stdout)
        self.assertTrue(cell["reproduction"].startswith("turbo-bvh-sixdof generate "), cell)
        self.succeed(cell["reproduction"])

    def test_agree(self):
        words = f"agree --set 'my set.h5' --sample 4 --algorithms never,balls -p balls:scale_a=0.5 {EXTERNAL}"
        out = self.succeed(f"turbo-bvh-sixdof {words}", DEFECTS).stdout
        commands = re.findall(r"^    no instead of yes: (.*)$", out, re.MULTILINE)
        self.assertGreater(len(commands), 0)
        for command in commands:
            self.check_wrong_no(command)
        for answer, truth, command in re.findall(r"^    ([0-9.e-]+) instead of ([0-9.e-]+): (.*)$", out, re.MULTILINE):
            self.assertIn(" -p scale_a=0.5 ", command)
            self.assertAlmostEqual(self.answers(command)["distance"], float(answer), delta=1e-12)
            self.assertAlmostEqual(self.truth(command)["distance"], float(truth), delta=1e-8)

    def test_conform(self):
        out = self.succeed("turbo-bvh-sixdof conform --checks Collide,MotionOfRespond --json findings.json", DEFECTS).stdout
        self.assertIn("\n  failed" + " " * 9 + "Collide: yes instead of no: ", out)  # balls, which the program adds
        commands = re.findall(r"^ {17}(turbo-bvh-sixdof query .*)$", out, re.MULTILINE)
        self.assertEqual(len(commands), 3)  # one, and two where answers are compared
        self.assertIs(self.answers(commands[0])["colliding"], True)
        self.assertIs(self.truth(commands[0])["colliding"], False)
        self.assertNotEqual(self.answers(commands[1])["penalty"], self.answers(commands[2])["penalty"])
        [balls] = json.loads((self.folder / "findings.json").read_text())
        self.assertEqual(balls["checks"][0]["failures"][0]["commands"], commands[:1])
        out = self.succeed(f"turbo-bvh-sixdof conform {EXTERNAL} --algorithm never --checks Collide", DEFECTS).stdout
        [command] = re.findall(r"^ {17}(turbo-bvh-sixdof query .*)$", out, re.MULTILINE)
        self.check_wrong_no(command)

    def test_scenes(self):
        self.succeed("turbo-bvh-sixdof scene make pile -n 30 --frames 3 -o 'my scene.h5'")
        done = self.succeed("turbo-bvh-sixdof scene play 'my scene.h5' --algorithms exact --question near --frames 1 --json")
        (self.folder / "play.json").write_text(done.stdout)
        [line] = self.tables("play.json", "many_bodies")
        self.assertEqual(line["command"], "turbo-bvh-sixdof scene play 'my scene.h5' --question near --algorithms exact --frames 1")
        [before], [again] = json.loads(done.stdout), json.loads(self.succeed(line["command"] + " --json").stdout)
        self.assertEqual(again["algorithms"][0]["hash"], before["algorithms"][0]["hash"])

    def test_shards_are_merged(self):
        out = self.succeed("turbo-bvh-sixdof generate --a cone-1k --grid 90 --distances 5 --shards 2 -o 'my shards'").stdout
        [command] = re.findall(r": (\S+ merge .* -o SET)$", out, re.MULTILINE)
        self.succeed(command)
        self.assertTrue((self.folder / "SET").exists())

    def test_help(self):
        done = self.succeed("turbo-bvh-sixdof query --zzzzqqqq", 2)
        [command] = re.findall(r"\((turbo-bvh-sixdof query --help) lists them\)", done.stderr)
        text = self.succeed(command).stdout
        self.assertIn("Usage: turbo-bvh-sixdof query --a MESH ", text)
        for line in text[text.index("Examples:\n"):].splitlines()[1:]:
            self.assertTrue(line.startswith("  turbo-bvh-sixdof query "), line)
            self.succeed(line)
        first_steps = self.succeed("turbo-bvh-sixdof", 2).stderr
        [command] = re.findall(r"^  (turbo-bvh-sixdof query .*)$", first_steps, re.MULTILINE)
        self.assertIs(self.answers(command)["colliding"], True)

    def test_a_mesh_that_is_no_solid(self):
        """The warning names the command that finds the place."""
        self.succeed("turbo-bvh-sixdof models make box-12 -o box.off")
        lines = (self.folder / "box.off").read_text().split("\n")
        count = lines[1].split()
        vertices, faces = int(count[0]), int(count[1])
        body = [line for line in lines[2:] if line.strip()]
        moved = [" ".join(f"{float(x) + 0.1:.17g}" for x in line.split()) for line in body[:vertices]]
        twice = [" ".join(["3", *(str(int(i) + vertices) for i in line.split()[1:4])]) for line in body[vertices:vertices + faces]]
        text = ["OFF", f"{2 * vertices} {2 * faces} 0", *body[:vertices], *moved, *body[vertices:vertices + faces], *twice]
        (self.folder / "two boxes.off").write_text("\n".join(text) + "\n")
        done = self.succeed("turbo-bvh-sixdof generate --a 'two boxes.off' --grid 90 --distances 5 -o two.h5")
        [command] = re.findall(r"\((turbo-bvh-sixdof info --check .*)\)$", done.stderr, re.MULTILINE)
        self.assertIn("pairs of triangles meet", self.succeed(command, DEFECTS).stderr)

    def test_view_in_3d(self):
        """All that a page shows in 3D: worst poses of rows, hard cases, paths and models. `sixdof` makes the page."""
        self.measured("--a torus-300 --b cone-200 --suite all '--benchmark_filter=^distance/algorithm:balls/.*:05$'")
        self.succeed(f"turbo-bvh-sixdof stress --families contained --cases 'my cases' --algorithms never {EXTERNAL} -o stress.json")
        self.succeed("turbo-bvh-sixdof quality --scenario II --algorithm balls -p scale_a=0.5 --steps 40 -o II.h5")
        path = f"PATH={shlex.quote(str(SIXDOF.parent))}:$PATH; "
        made = self.shell(path + "sixdof report results.json stress.json --series II.h5 -o page.html")
        if "cmake/setup report" in made.stderr:
            self.skipTest(made.stderr)
        self.assertEqual(made.returncode, 0, made.stderr)
        page = (self.folder / "page.html").read_text(encoding="utf-8")
        scenes = json.loads(re.search(r'<script id="report-data" type="application/json">(.*?)</script>', page, re.DOTALL).group(1))["scenes"]
        self.assertEqual({scene["kind"] for scene in scenes}, {"pose", "case", "path", "object"})
        for scene in scenes:
            program = "sixdof" if scene["kind"] == "object" else "turbo-bvh-sixdof"
            self.assertEqual(scene["command"].split()[0], program)
            self.succeed(path + scene["command"])

    def test_commands_of_pages_without_data(self):
        """They take minutes: here the programs only say that they know every word but the last."""
        pages = json.loads((ROOT / "lib/sixdof/report/page/pages.json").read_text())
        lines = {line for page in pages for line in page["command"].split(" && ")}
        self.assertGreater(len(lines), 5)
        (self.folder / "results").mkdir()
        for line in sorted(lines):
            program, *words = shlex.split(line)
            for word in words:
                if re.search(r"\.(json|h5)$", word):  # of the user's, or of the command before
                    (self.folder / word).parent.mkdir(exist_ok=True)
                    (self.folder / word).touch()
            found = {"sixdof": PROGRAM, "sixdof-bench": BENCH}.get(program, ROOT / program)
            command = [str(found), *words, "--no-such-option"]
            done = subprocess.run(command, cwd=self.folder, env=self.environment, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2, f"{line}\n{done.stderr}")
            self.assertIn("--no-such-option", done.stderr, line)


if __name__ == "__main__":
    unittest.main()
