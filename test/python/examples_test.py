#!/usr/bin/env python3
"""The examples run, the class of each is short, and what they print is right. Types: the stubs name what there is.

usage: examples_test.py EXAMPLES RESULTS
"""

import ast
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from common import arguments, environment, main, sixdof

EXAMPLES, RESULTS = map(pathlib.Path, arguments(2))
MOST_LINES = 25  # of an algorithm


class Examples(unittest.TestCase):
    def run_it(self, name, *words, folder=None):
        done = subprocess.run([sys.executable, EXAMPLES / name, *words], capture_output=True, text=True, check=False,
                              env=environment(), cwd=folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_wrong_distance(self):
        out = self.run_it("wrong_distance.py")
        error = float(re.search(r"largest error ([\d.]+) at pose", out).group(1))
        self.assertGreater(error, 0.1)
        self.assertRegex(out, r"! +bounding-spheres +32 ")
        self.assertRegex(out, r"\* +exact +32 ")

    def test_choose_algorithm(self):
        out = self.run_it("choose_algorithm.py", "cone-300", "torus-300")
        errors = {line.split()[0]: float(line.split()[3]) for line in out.splitlines()[1:]}
        self.assertEqual(errors["exact"], 0.0)
        self.assertGreater(errors["ist"], 0.0)
        if "fcl-rss" in errors:
            self.assertLess(errors["fcl-rss"], 1e-9)

    def test_plot_result(self):
        with tempfile.TemporaryDirectory() as folder:
            out = self.run_it("plot_result.py", RESULTS, folder=folder)
            self.assertTrue("exact" in out or (pathlib.Path(folder) / "result.svg").exists())

    def test_algorithms_are_short(self):
        for example in EXAMPLES.glob("*.py"):
            for node in ast.walk(ast.parse(example.read_text())):
                if isinstance(node, ast.ClassDef):
                    self.assertLessEqual(node.end_lineno - node.lineno + 1, MOST_LINES)


class Types(unittest.TestCase):
    def test_stubs_name_what_there_is(self):
        package = pathlib.Path(sixdof.__file__).parent
        self.assertTrue((package / "py.typed").exists())
        stub = ast.parse((package / "_core.pyi").read_text())
        self.compare(stub.body, sixdof._core)
        for node in stub.body:
            if isinstance(node, ast.ClassDef):
                self.compare(node.body, getattr(sixdof._core, node.name))

    def compare(self, nodes, thing):
        named = {node.name for node in nodes if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
        named |= {node.target.id for node in nodes if isinstance(node, ast.AnnAssign)}
        self.assertEqual(named, {name for name in dir(thing) if not name.startswith("_")})

    def test_everything_public_has_documentation(self):
        for name in sixdof.__all__:
            thing = getattr(sixdof, name)
            self.assertTrue(thing.__doc__, name)
            for member, value in vars(thing).items() if isinstance(thing, type) else ():
                if callable(value) and not member.startswith("_"):
                    self.assertTrue(value.__doc__, f"{name}.{member}")


if __name__ == "__main__":
    main()
