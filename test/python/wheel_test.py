#!/usr/bin/env python3
"""The wheel: built from the sources, installed in a fresh virtual environment, moved to another folder, and used there.

usage: wheel_test.py SOURCES
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCES = pathlib.Path(sys.argv.pop(1))
REQUIREMENTS = pathlib.Path(__file__).resolve().parent / "requirements.txt"

# From the wheel to a table with an algorithm of one's own.
PROGRAM = """
import numpy
import sixdof

class BoundingSpheres(sixdof.Algorithm):
    def distance(self, pose):
        centres = pose[:3, :3] @ self.b.center + pose[:3, 3] - self.a.center
        return max(0.0, float(numpy.linalg.norm(centres)) - (self.a.diagonal + self.b.diagonal) / 2)

print(sixdof.__file__)
print(sixdof.bench(BoundingSpheres, pairs=["torus-knot-10k"], queries=["distance"], sample=32, budget=5).table())
"""


class Wheel(unittest.TestCase):
    def run_it(self, *words, **more):
        environment = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "SIXDOF_DATA")}
        done = subprocess.run(words, capture_output=True, text=True, check=False, env=environment, **more)
        self.assertEqual(done.returncode, 0, f"{words}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def test_a_fresh_environment(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        folder = pathlib.Path(scratch.name)
        self.run_it(sys.executable, "-m", "venv", folder / "build")
        pip = folder / "build" / "bin" / "pip"
        self.run_it(pip, "wheel", "--no-deps", "--wheel-dir", folder / "wheels", SOURCES)
        wheel, = (folder / "wheels").glob("sixdof-*.whl")
        self.assertNotIn("none-any", wheel.name)

        self.run_it(sys.executable, "-m", "venv", folder / "fresh")
        pip = folder / "fresh" / "bin" / "pip"
        self.run_it(pip, "install", "--require-hashes", "--only-binary", ":all:", "-r", REQUIREMENTS)
        self.run_it(pip, "install", "--no-deps", wheel)
        self.run_it(pip, "check")
        # Installed packages know no folder: they are used from another one, without the environment.
        site = next((folder / "fresh" / "lib").glob("python3*/site-packages"))
        moved = folder / "moved here"
        site.rename(moved)
        out = self.run_it(sys.executable, "-S", "-c", f"import sys; sys.path.insert(0, {str(moved)!r})\n" + PROGRAM,
                          cwd=folder)
        self.assertTrue(out.startswith(str(moved)))
        self.assertRegex(out, r"! +bounding-spheres +32 ")
        self.assertRegex(out, r"\* +exact +32 ")
        version = self.run_it(moved / "sixdof" / "bin" / "sixdof", "--version")
        self.assertIn("sixdof", version)


if __name__ == "__main__":
    unittest.main()
