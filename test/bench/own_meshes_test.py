"""bench/run --a FILE --b FILE: a pair of the user's, from another folder, in a tree whose set-up and build do nothing.

usage: own_meshes_test.py SIXDOF_BENCH SIXDOF
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIXDOF_BENCH, SIXDOF = pathlib.Path(sys.argv.pop(1)), sys.argv.pop(1)
QUICK = ["--benchmark_min_time=0.000001", "--sample", "32", "-p", "ist:spheres=100", "-p", "vps:point_spacing=0.05",
         "--budget", "5"]


class Run(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.tree = self.folder / "tree"
        for name in ("bench", "cmake", "models", "fixtures", "build/release", "tools"):
            (self.tree / name).mkdir(parents=True)
        shutil.copy(ROOT / "bench" / "run", self.tree / "bench")
        for name in ("fixtures/manifest.json", "models/models.json"):
            (self.tree / name).symlink_to(ROOT / name)
        (self.tree / "build/release/bin").symlink_to(SIXDOF_BENCH.parent)
        self.script("cmake/setup", "true")
        self.script("tools/cmake", "true")
        self.script("models/fetch", f'echo "$@" > {self.folder}/fetched')
        (self.folder / "parts").mkdir()
        for model, file in (("torus-300", "my.obj"), ("cone-200", "parts/my.obj")):
            subprocess.run([SIXDOF, "models", "make", model, "-o", file], cwd=self.folder, check=True,
                           capture_output=True)

    def script(self, name, line):
        (self.tree / name).write_text(f"#!/bin/sh\n{line}\n")
        (self.tree / name).chmod(0o755)

    def run_bench(self, *words):
        environment = {**os.environ, "PATH": f"{self.tree / 'tools'}:{os.environ['PATH']}",
                       "SIXDOF_CACHE": str(self.folder / "cache"), "SIXDOF_MODELS": str(self.folder / "models")}
        return subprocess.run([str(self.tree / "bench/run"), *words, *QUICK], cwd=self.folder, env=environment,
                              capture_output=True, text=True, check=False)

    def test_measures_the_pair_and_prints_its_table(self):
        for words in (["--a", "my.obj", "--b", "parts/my.obj"], ["--b=parts/my.obj", "--a=my.obj"]):
            done = self.run_bench(*words)
            self.assertEqual(done.returncode, 0, done.stderr)
            for title in ("my-my: distance, distances in percent", "my-my: respond, overlaps in percent"):
                self.assertIn(title, done.stdout)
            self.assertRegex(done.stdout, r"\n[0-9.]+ % .* vps  ")
            self.assertNotIn("scenario/", done.stdout)
            self.assertFalse((self.folder / "fetched").exists(), "no model is needed")
        self.assertTrue(list((self.tree / "results").glob("*.json")))

    def test_fetches_a_model_of_the_pair(self):
        done = self.run_bench("--a", "elephant", "--b", "my.obj")
        self.assertEqual((self.folder / "fetched").read_text(), "elephant\n")
        self.assertNotEqual(done.returncode, 0, "the stand-in fetches nothing")

    def test_takes_the_sets_file_from_the_folder_of_the_call(self):
        subprocess.run([SIXDOF, "generate", "--a", "my.obj", "--grid", "90", "--distances", "5", "-o", "s.h5"],
                       cwd=self.folder, check=True, capture_output=True)
        done = self.run_bench("--no-manifest", "--set", "s.h5", "--benchmark_filter=^distance/algorithm:exact/.*:05$")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, "\n05 % .* exact  ")


if __name__ == "__main__":
    unittest.main()
