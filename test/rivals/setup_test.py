#!/usr/bin/env python3
"""bench/rivals/setup without a network: what it lists, and why a library is not ready.

usage: setup_test.py RIVALS
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

from conversation import load_setup

RIVALS = pathlib.Path(sys.argv[1])
del sys.argv[1:]
RECIPES = {path.parent.name: json.loads(path.read_text()) for path in RIVALS.glob("*/rival.json")}


class Setup(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.path = self.folder / "path"
        self.path.mkdir()

    def run_setup(self, *words, **variables):
        environment = {"PATH": str(self.path), "SIXDOF_RIVALS": str(self.folder / "rivals")} | variables
        return subprocess.run([sys.executable, "-B", RIVALS / "setup", *words], env=environment, capture_output=True,
                              text=True, check=False)

    def fake(self, name, script):
        program = self.path / name
        program.write_text(f"#!/bin/sh\n{script}\n")
        program.chmod(0o755)

    def test_list(self):
        done = self.run_setup("--list")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = {line.split()[0]: line for line in done.stdout.splitlines()}
        self.assertEqual(set(lines), set(RECIPES))
        for name, rival in RECIPES.items():
            self.assertIn(rival["version"], lines[name])
            self.assertIn(rival["licence"], lines[name])
            self.assertTrue(lines[name].endswith("not set up"))
        self.assertFalse((self.folder / "rivals").exists())

    def test_unknown_name(self):
        done = self.run_setup("no-such-library")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no-such-library", done.stderr)

    def test_older_releases(self):
        setup = load_setup(RIVALS)
        older = setup.recipe("coal==3.0.1")
        self.assertEqual((older["version"], older["licence"]), ("3.0.1", RECIPES["coal"]["licence"]))
        pinned = (RIVALS / "coal" / older["requirements"]).read_text()
        self.assertIn("\ncoal==3.0.1 ", pinned)
        self.assertNotEqual(setup.fingerprint("coal==3.0.1"), setup.fingerprint("coal"))
        done = self.run_setup("coal==9")
        self.assertEqual(done.returncode, 2)
        self.assertIn("coal==9; there are", done.stderr)
        self.assertIn("coal==3.0.1", done.stderr)

    def test_missing_programs(self):
        for name, program in (("parry", "cargo"), ("jolt", "node")):
            done = self.run_setup(name)
            self.assertEqual(done.returncode, 1)
            self.assertIn(f"not ready: {program} is not installed", done.stdout)

    def test_no_network(self):
        self.fake("cargo", "echo 'error: failed to download'; exit 1")
        done = self.run_setup("parry")
        self.assertEqual(done.returncode, 1)
        self.assertIn("not ready: cargo: error: failed to download", done.stdout)
        self.assertFalse((self.folder / "rivals/ready/parry.json").exists())

    def test_what_takes_too_long_ends_with_all_it_has_started(self):
        pid = self.folder / "pid"
        self.fake("cargo", f"sleep 1000 & echo $! > {pid}; wait")
        setup = load_setup(RIVALS)
        setup.INSTALL_SECONDS = 2
        with self.assertRaisesRegex(setup.NotReady, "cargo took longer than 2 s"):
            setup.run(self.path / "cargo")
        stat = pathlib.Path("/proc", pid.read_text().strip(), "stat")
        for _ in range(1000):
            try:
                if "(sleep) Z" in stat.read_text():
                    return
            except OSError:
                return  # gone
            time.sleep(0.01)
        self.fail(f"{stat.parent} survives")

    def test_another_package_than_the_recipe_has(self):
        self.fake("node", "exit 0")
        self.fake("npm", """echo '{"packages": {"": {}, "node_modules/jolt-physics": {"integrity": "sha512-x"}}}' \
> package-lock.json""")
        done = self.run_setup("jolt")
        self.assertEqual(done.returncode, 1)
        self.assertIn("packages differ from those of the recipe", done.stdout)

    def test_ready_until_the_recipe_changes(self):
        integrity = json.dumps({"packages": {f"node_modules/{name}": {"integrity": each}
                                             for name, each in RECIPES["jolt"]["integrity"].items()}})
        self.fake("npm", f"echo '{integrity}' > package-lock.json")
        hello = {"protocol": 1, "name": "jolt", "version": RECIPES["jolt"]["version"], "answers": ["collide"]}
        self.fake("node", f"echo '{json.dumps(hello)}'")
        path = f"{self.path}:{os.environ['PATH']}"  # cp, env
        done = self.run_setup("jolt", PATH=path)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertTrue(done.stdout.strip().endswith(" ready"))
        ready = json.loads((self.folder / "rivals/ready/jolt.json").read_text())
        self.assertEqual((ready["name"], ready["runtime"], ready["hello"]), ("jolt", "wasm", hello))
        self.assertIn("adapter.js", ready["command"])
        self.assertTrue(self.run_setup("jolt", "--list").stdout.strip().endswith(" ready"))
        self.fake("npm", "exit 1")  # what is ready is not installed again
        ready["adapter"] = "another script, with a greeting of its own"
        ready["hello"] = None
        (self.folder / "rivals/ready/jolt.json").write_text(json.dumps(ready))
        self.assertFalse(self.run_setup("jolt", "--list").stdout.strip().endswith(" ready"))
        self.assertEqual(self.run_setup("jolt", PATH=path).returncode, 0)
        self.assertEqual(json.loads((self.folder / "rivals/ready/jolt.json").read_text())["hello"], hello)
        self.assertEqual(self.run_setup("jolt", PATH=path).returncode, 0)

    def test_recipes_are_complete(self):
        self.assertTrue(RECIPES)
        for name, rival in RECIPES.items():
            for key in ("library", "version", "licence", "runtime", "install"):
                self.assertTrue(rival[key], f"{name}: {key}")
            self.assertIn(rival["runtime"], ("native", "python", "node", "wasm"))
            if rival["install"] == "pip":
                text = (RIVALS / name / "requirements.txt").read_text()
                pinned = re.split(r"\n(?=\S)", text.strip())
                self.assertTrue(all("==" in each and "--hash=sha256:" in each for each in pinned), name)

    def test_the_page_has_an_adapter_of_thirty_lines(self):
        adapter = (RIVALS / "vtk/adapter.py").read_text()
        self.assertIn(f"```python\n{adapter}```", (RIVALS / "ADAPTERS.md").read_text())
        self.assertLessEqual(len(adapter.splitlines()), 30)


if __name__ == "__main__":
    unittest.main()
