"""Foreign projects with an algorithm of their own, against the installed package and by FetchContent.

CMakeLists.txt calls this with a test class and the folders.
"""

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import unittest

PROJECT = pathlib.Path(__file__).resolve().parent / "project"
MOST_LINES = 50  # of an adapter around a library
PAIR = ["--a", "cone-1k", "--b", "torus-1k"]
APART, TOGETHER = "2.9 0 0.1 1 0 0 0", "0.9 0 0.1 1 0 0 0"
VERSION = r"^[0-9]+\.[0-9]+ ([0-9a-f]{12}( \(modified\))?|unknown)$"  # of Bullet, and the commit
ARGUMENTS = None


def run(*words, cwd="/", expected=0):
    """Standard output of a command that ends with the expected code. Its caches are the test's own."""
    environment = {**os.environ, "SIXDOF_CACHE": str(ARGUMENTS.work / "cache")}
    for name in ("SIXDOF_DATA", "SIXDOF_MODELS"):  # the package's own are looked for
        environment.pop(name, None)
    done = subprocess.run([str(word) for word in words], cwd=cwd, env=environment, capture_output=True, text=True)
    if done.returncode != expected:
        raise AssertionError(f"{words} ended with {done.returncode}\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done.stdout if expected == 0 else done.stderr


def configure_and_build(source, build, *options):
    run("cmake", "-G", "Ninja", "-S", source, "-B", build, *ARGUMENTS.cmake, *options)
    run("cmake", "--build", build)


class Project(unittest.TestCase):
    """What every program with an added algorithm must show."""

    def check_lists(self, program, name, version):
        listed = {entry["name"]: entry for entry in json.loads(run(program, "algorithms", "--json"))}
        self.assertIn("exact", listed)
        self.assertRegex(listed[name]["version"], version)

    def check_queries(self, program, name):
        for pose, meet in ((APART, False), (TOGETHER, True)):
            answer = json.loads(run(program, "query", *PAIR, "--pose", pose, "--algorithm", name, "--json"))
            self.assertEqual((answer["status"], answer["colliding"]), ("ok", meet))

    def check_conformance(self, program, known):
        """All checks pass or are known failures, which run."""
        out = run(program)
        self.assertEqual(out.count("\nknown failure: "), len(known))
        for check in known:
            self.assertIn(f"_{check}\nknown failure: ", re.sub(r", where .*", "", out))
        self.assertGreaterEqual(int(re.search(r"PASSED  \] (\d+) tests", out).group(1)), 12)

    def check_study(self, program, name, folder):
        file = folder / "precision.json"
        run(program, "precision", *PAIR, "--question", "collide", "--algorithms", f"exact,{name}", "--sample", 16,
            "--budget", "60s", "-o", file)
        result = json.loads(file.read_text())
        self.assertIn(f"algorithm:{name}", result["context"])
        self.assertEqual({row["sixdof"]["algorithm"] for row in result["benchmarks"]}, {"exact", name})

    def check_rows(self, program, name, version, folder):
        """Rows of the default suites: of a pair of one's own, and of a set that comes with the programs."""
        file = folder / "result.json"
        of_it = f"--benchmark_filter=/algorithm:{name}/"
        for words in ([*PAIR, of_it], ["--suite", "default", of_it + "pair:torus-knot-10k/distance:0[15]$"]):
            run(program, *words, "--sample", 16, "--budget", 20, "--out", file)
            result = json.loads(file.read_text())
            self.assertRegex(result["context"][f"algorithm:{name}"], version)
            rows = [row for row in result["benchmarks"] if row["sixdof"]["algorithm"] == name]
            self.assertGreaterEqual({row["sixdof"]["query"] for row in rows}, {"collide"})
            for row in rows:
                self.assertNotIn("error_occurred", row)
                self.assertGreater(row["real_time"], 0.0)


class Installed(Project):
    """The package was installed and moved."""

    def test_of_bullet(self):
        lines = (PROJECT / "gimpact.cpp").read_text().splitlines()
        self.assertLessEqual(len(lines), MOST_LINES)
        build = ARGUMENTS.work / "installed"
        shutil.rmtree(build, ignore_errors=True)
        configure_and_build(PROJECT, build, f"-DSIXDOF={ARGUMENTS.installed}")
        self.check_lists(build / "gimpact-sixdof", "gimpact", VERSION)
        self.check_queries(build / "gimpact-sixdof", "gimpact")
        self.check_study(build / "gimpact-sixdof", "gimpact", build)
        self.check_rows(build / "gimpact-bench", "gimpact", VERSION, build)
        self.check_conformance(build / "gimpact-conformance", ["Collide", "MotionOfCollide"])
        self.assertIn("gimpact", run(build / "gimpact-sixdof", "query", *PAIR, "--pose", APART, "--algorithm", "none",
                                     expected=1))

    def test_programs_find_their_data(self):
        programs = ARGUMENTS.installed / "bin"
        rows = run(programs / "sixdof-bench", "--suite", "default", "--benchmark_list_tests").splitlines()
        self.assertIn("collide/algorithm:exact/pair:elephant/distance:05", rows)
        self.assertIn(str(ARGUMENTS.installed / "share/sixdof/models/cache"),
                      run(programs / "sixdof", "info", "elephant", expected=1))

    def check_printed_commands(self, build):
        """Failures of the two programs of a project name its own program, which asks the same."""
        for words, code in (("fast-boxes-sixdof conform --checks Collide", 3), ("fast-boxes-conformance --gtest_filter='*_Collide'", 0)):
            done = subprocess.run(f"{build}/{words}", shell=True, cwd=ARGUMENTS.work, capture_output=True, text=True,
                                  env={**os.environ, "SIXDOF_CACHE": str(ARGUMENTS.work / "cache")}, check=False)
            self.assertEqual(done.returncode, code, done.stderr)
            command = re.search(r"fast-boxes-sixdof query .*", done.stdout).group(0)
            self.assertIn(" --algorithm fast-boxes", command)
            asked, exact = (json.loads(run("sh", "-c", f"PATH={build}:$PATH; {line} --json", cwd=ARGUMENTS.work))
                            for line in (command, command.replace("--algorithm fast-boxes", "--algorithm exact")))
            self.assertNotEqual(asked["colliding"], exact["colliding"], command)

    def test_compares_two_programs(self):
        programs = ARGUMENTS.installed / "bin"
        out = run(programs / "sixdof-compare", "--programs", programs / "sixdof-bench", programs / "sixdof-bench",
                  "--fail-on-answers", "--filter", "^collide/algorithm:exact/pair:torus-knot-10k/distance:05$",
                  "--sample", 16, "--folder", ARGUMENTS.work / "compare")
        self.assertIn("answers: 0 counters of 1 rows changed", out)
        self.assertIn("commits are compared in a clone", run(programs / "sixdof-compare", "HEAD", expected=2))

    def test_new_algorithm(self):
        program = ARGUMENTS.installed / "bin" / "sixdof"
        folder = ARGUMENTS.work / "mine"
        shutil.rmtree(folder, ignore_errors=True)
        printed = run(program, "new-algorithm", "fast-boxes", "-o", folder)
        self.assertIn("It uses the installation of sixdof in ", printed)
        self.assertEqual(sorted(path.name for path in folder.iterdir()), ["CMakeLists.txt", "README.md", "fast_boxes.cpp", "fast_boxes_conformance.cpp"])
        configure_and_build(folder, folder / "build")
        self.assertIn("fast-boxes: uses the installation of sixdof in ", run("cmake", folder / "build"))
        self.assertIn("--prefix FOLDER", run("cmake", "-S", folder, "-B", folder / "without", "-DSIXDOF=/nowhere",
                                             "-DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF", expected=1))
        # What its README says.
        commands = re.search(r"```sh\n(.*?)```", (folder / "README.md").read_text(), re.DOTALL).group(1)
        for line in commands.splitlines()[2:]:
            run("sh", "-c", line, cwd=folder)
        # What new-algorithm printed; the build's options are kept, and the rows are few.
        build, bench = printed.splitlines()[-2:]
        run("sh", "-c", f"{build} && {bench} --benchmark_filter=/algorithm:fast-boxes/ --sample 16 --budget 20", cwd=ARGUMENTS.work)
        self.check_printed_commands(folder / "build")
        self.check_lists(folder / "build" / "fast-boxes-sixdof", "fast-boxes", r"^0\.1\.0 ")

    def test_program_of_the_readme(self):
        """What README.md says of the library: its C++ program with its two lines of CMake."""
        readme = (ARGUMENTS.source / "README.md").read_text()
        program = re.search(r"```cpp\n(.*?)```", readme, re.DOTALL).group(1)
        find, link = (re.search(f"`({name}\\([^`]*\\))`", readme).group(1) for name in ("find_package", "target_link_libraries"))
        folder = ARGUMENTS.work / "readme"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        (folder / "main.cpp").write_text(program)
        (folder / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(my_program)\n"
                                               f"{find}\nadd_executable(my_program main.cpp)\n{link}\n")
        configure_and_build(folder, folder / "build", f"-DCMAKE_PREFIX_PATH={ARGUMENTS.installed}")
        cube = folder / "cube.obj"  # of edge 1; its copy is 3 higher
        cube.write_text("".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 1)) +
                        "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n")
        self.assertEqual(run(folder / "build" / "my_program", cube, cube), "2\n")


class Gate(Project):
    """The gate that `sixdof new-algorithm --ci` writes. It compares times: no other test runs beside it."""

    def heavier(self, source, turns, by="asm volatile(\"\" : : \"r\"(i))"):
        """The template's algorithm with so many turns of an empty loop in every query."""
        return source.replace("    return gap(X_AB) <= 0.0;", f"    for (long i = 0; i < {turns}; ++i) {by};\n    return gap(X_AB) <= 0.0;").replace(
            "    return sixdof::Separation{", f"    for (long i = 0; i < {turns}; ++i) {by};\n    return sixdof::Separation{{")

    def judge_commit(self, clone, source, *options):
        """Exit code and words of ci/gate, in a clone, of a change against the first commit."""
        (clone / "fast_boxes.cpp").write_text(source)
        environment = {**os.environ, "SIXDOF": str(ARGUMENTS.installed), "SIXDOF_WORK": str(ARGUMENTS.work / "gate-work")}
        given = dict(word.removeprefix("-D").split("=", 1) for word in ARGUMENTS.cmake)
        for variable, option in (("CXX", "CMAKE_CXX_COMPILER"), ("CXXFLAGS", "CMAKE_CXX_FLAGS"),
                                 ("CMAKE_CXX_COMPILER_LAUNCHER", "CMAKE_CXX_COMPILER_LAUNCHER")):
            if given.get(option):
                environment[variable] = given[option]
        for name in ("SIXDOF_DATA", "SIXDOF_MODELS"):
            environment.pop(name, None)
        done = subprocess.run(["ci/gate", "--base", "first", *options], cwd=clone, env=environment, capture_output=True, text=True,
                              check=False)
        return done.returncode, done.stdout + done.stderr[-3000:]

    def test_gate_of_a_new_algorithm(self):
        """The script that continuous integration runs, in a fresh clone: what it calls red and what not."""
        if any("-fsanitize" in word for word in ARGUMENTS.cmake):
            self.skipTest("times and instructions of sanitized programs mean nothing")
        origin, clone = ARGUMENTS.work / "gate-origin", ARGUMENTS.work / "gate-clone"
        for folder in (origin, clone, ARGUMENTS.work / "gate-work"):
            shutil.rmtree(folder, ignore_errors=True)
        run(ARGUMENTS.installed / "bin" / "sixdof", "new-algorithm", "fast-boxes", "--ci", "github", "-o", origin)
        base = self.heavier((origin / "fast_boxes.cpp").read_text(), 4000)
        (origin / "fast_boxes.cpp").write_text(base)
        git = ["git", "-c", "user.name=test", "-c", "user.email=test@example.org"]
        for words in (["init", "--quiet"], ["add", "."], ["commit", "--quiet", "-m", "first"], ["tag", "first"]):
            run(*git, *words, cwd=origin)
        run("git", "clone", "--quiet", origin, clone)
        template = base.replace("i < 4000;", "i < TURNS;")
        exact_ones = ["--stages", "answers,work"]
        wrong = base.replace("return gap(X_AB) <= 0.0;", "return gap(X_AB) <= 0.0 && X_AB.t.x() < 0.9;")
        lost = base.replace("    return sixdof::Separation{", "    if (X_AB.t.x() > 0.9) return fail(sixdof::Status::failed, \"lost\");\n"
                            "    return sixdof::Separation{")
        cases = [("unchanged", base, ["--fail-above", "25"], 0, "gate: green"), ("wrong", wrong, exact_ones, 3, "RED      answers: collide/"),
                 ("lost", lost, exact_ones, 3, "lost: failed 0 -> "),
                 ("time", template.replace("TURNS", "5400"), ["--stages", "answers,time"], 3, "RED      time: ")]
        if shutil.which("valgrind"):
            cases.append(("instructions", template.replace("TURNS", "4130"), ["--stages", "instructions"], 3, "RED      instructions: "))
        for name, source, options, expected, words in cases:
            with self.subTest(name):
                self.assertNotEqual(source == base, name != "unchanged", "the fault is planted")
                code, said = self.judge_commit(clone, source, *options)
                self.assertEqual(code, expected, said)
                self.assertIn(words, said)
        for file in ("gate.md", "gate.xml", "gate.json"):
            self.assertTrue((ARGUMENTS.work / "gate-work" / "out" / file).is_file())


class Fetched(Project):
    """The project has sixdof's source as a part of its own."""

    def test_of_bullet(self):
        build = ARGUMENTS.fetched
        configure_and_build(PROJECT, build, f"-DSIXDOF={ARGUMENTS.source}")
        self.check_lists(build / "gimpact-sixdof", "gimpact", VERSION)
        self.check_rows(build / "gimpact-bench", "gimpact", VERSION, ARGUMENTS.work)
        self.check_conformance(build / "gimpact-conformance", ["Collide", "MotionOfCollide"])


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("test", choices=["Installed", "Gate", "Fetched"])
    for folder in ("installed", "source", "work", "fetched"):
        parser.add_argument("--" + folder, type=pathlib.Path, required=True)
    parser.add_argument("--cmake", nargs=argparse.REMAINDER, default=[])
    ARGUMENTS = parser.parse_args()
    unittest.main(argv=["downstream_test.py", ARGUMENTS.test], verbosity=2)
