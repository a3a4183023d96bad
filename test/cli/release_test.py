#!/usr/bin/env python3
"""fixtures/release: the same bytes in every folder, with shards, after an interruption and one by one; what --verify finds.

usage: release_test.py SIXDOF FIXTURES
"""
import importlib.util
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

OBJECTS = "box-1k,bumpy-sphere-3k,shaft-2k"
SMALL = ["--recipes", "--objects", OBJECTS, "--grid", "so3:3:3", "--distances", "0,5", "--volumes", "1"]
SETS = sorted(f"{name}-{partner}.h5" for name in OBJECTS.split(",") for partner in ("self", "seeded"))


class Release(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def release(self, *words, expected=0):
        done = subprocess.run([FIXTURES / "release", "--program", SIXDOF, *map(str, words)], capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, expected, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def bytes_of(self, name):
        return {path.name: path.read_bytes() for path in sorted((self.folder / name).iterdir()) if path.is_file()}

    def test_has_the_same_bytes_in_every_folder(self):
        said = self.release("--out", self.folder / "one", *SMALL)
        self.assertIn("6 sets, ", said)
        one = self.bytes_of("one")
        self.assertEqual(sorted(one), sorted([*SETS, "SHA256SUMS", "datacite.json", "manifest.json"]))
        # Two tasks of a cluster, a file that is lost, and the last command.
        for shard in ("1/2", "2/2"):
            self.release("--out", self.folder / "two", *SMALL, "--shard", shard, "--jobs", 1)
        self.assertEqual(sorted(self.bytes_of("two")), SETS, "no metadata before all sets are there")
        (self.folder / "two" / "box-1k-self.h5").unlink()
        self.assertIn("sets to make: 1 of 6", self.release("--out", self.folder / "two", *SMALL))
        self.assertEqual(self.bytes_of("two"), one)
        # One set alone.
        self.release("--out", self.folder / "three", *SMALL, "--only", "shaft-2k-seeded")
        self.assertEqual(self.bytes_of("three"), {"shaft-2k-seeded.h5": one["shaft-2k-seeded.h5"]})
        self.describes(self.folder / "one")
        self.is_verified(self.folder / "one")
        self.is_read_without_sixdof(self.folder / "one")

    def test_that_is_killed_leaves_no_program_behind(self):
        words = ["--recipes", "--objects", OBJECTS, "--grid", "so3:100:100", "--jobs", "2"]
        release = subprocess.Popen([FIXTURES / "release", "--program", SIXDOF, "--out", self.folder / "killed", *words],
                                   stderr=subprocess.PIPE)

        def running():
            found = []
            for file in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
                try:
                    program, *arguments = file.read_bytes().decode().split("\0")
                except OSError:
                    continue  # it has ended
                if program == SIXDOF and "so3:100:100" in arguments:
                    found.append(file)
            return found

        try:
            self.wait_until(lambda: len(running()) >= 2)
        finally:
            release.kill()
            release.communicate()
        self.wait_until(lambda: not running())
        self.assertEqual(list((self.folder / "killed").glob("*.h5")), [])

    def wait_until(self, true):
        deadline = time.monotonic() + 60
        while not true():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.1)

    def describes(self, folder):
        sets = json.loads((folder / "manifest.json").read_text())["sets"]
        self.assertEqual([one["file"] for one in sets], SETS)
        for one in sets:
            self.assertEqual(one["buckets"], ["distance/00", "distance/05", "volume/01"])
            self.assertEqual(one["a"]["licence"], "BSD-3-Clause (made by a recipe of sixdof)")
            self.assertNotIn(str(self.folder), json.dumps(one))
            self.assertEqual("made_by" in one["b"], one["file"].endswith("-seeded.h5"))
            self.assertIn(f"--only {one['pair']}", one["command"])
        described = json.loads((folder / "datacite.json").read_text())
        for key in ("titles", "creators", "publisher", "publicationYear", "types", "version", "rightsList"):
            self.assertTrue(described[key], key)
        self.assertEqual(described["creators"][0]["name"], "sixdof contributors")
        self.assertEqual(len(described["alternateIdentifiers"]), len(SETS))
        self.assertEqual(subprocess.run(["sha256sum", "--check", "--quiet", "SHA256SUMS"], cwd=folder, check=False).returncode, 0)

    def is_verified(self, folder):
        self.assertEqual(self.release("--verify", folder), "")
        (folder / "meshes" / "box-1k-unit.ply").unlink()
        self.assertEqual(self.release("--verify", folder), "", "it makes what is not part of a release")
        file = folder / SETS[0]
        whole = file.read_bytes()
        damaged = bytearray(whole)
        damaged[len(damaged) // 2] ^= 1
        file.write_bytes(damaged)
        said = self.release("--verify", folder, "--hashes-only", expected=3)
        self.assertIn(f"{SETS[0]}: is not the file", said)
        file.unlink()
        self.assertIn(f"{SETS[0]}: missing", self.release("--verify", folder, expected=3))
        file.write_bytes(whole)

    def is_read_without_sixdof(self, folder):
        if importlib.util.find_spec("h5py") is None:
            self.skipTest("h5py is not here")
        program = re.search(r"```python\n(.*?)```", (FIXTURES / "RELEASE.md").read_text(), re.DOTALL).group(1)
        done = subprocess.run([sys.executable, "-c", program, folder / "bumpy-sphere-3k-self.h5"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        numbers = [float(word) for word in re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", done.stdout)]
        self.assertEqual(len(numbers), 13, done.stdout)  # R, t, distance
        # The printed distance is that of the printed pose, which has eight digits.
        R, t, target = numbers[:9], numbers[9:12], numbers[12]
        trace = R[0] + R[4] + R[8]
        w = 0.5 * max(0.0, 1 + trace) ** 0.5
        self.assertGreater(w, 0.1, "a rotation for which this formula is exact enough")
        quaternion = [w, (R[7] - R[5]) / (4 * w), (R[2] - R[6]) / (4 * w), (R[3] - R[1]) / (4 * w)]
        pose = " ".join(repr(number) for number in [*t, *quaternion])
        asked = subprocess.run([SIXDOF, "query", "--a", "bumpy-sphere-3k", "--b", "bumpy-sphere-3k", "--pose", pose, "--json"],
                               capture_output=True, text=True, check=True).stdout
        self.assertAlmostEqual(json.loads(asked)["distance"], target, delta=1e-6)

    def test_names_what_cannot_be_made(self):
        self.assertIn("no set of the release is called nothing", self.release("--out", self.folder, *SMALL, "--only", "nothing", expected=1))
        said = self.release("--out", self.folder / "bad", *SMALL[:-1], "x", expected=1)
        self.assertIn("6 sets could not be made: ", said)
        self.assertIn("manifest.json", self.release("--verify", self.folder / "bad", expected=1))
        # A folder with sets of another grid.
        self.release("--out", self.folder / "one", *SMALL)
        other = [word if word != "so3:3:3" else "so3:2:2" for word in SMALL]
        self.assertIn("choose another folder", self.release("--out", self.folder / "one", *other, expected=1))


if __name__ == "__main__":
    SIXDOF, FIXTURES = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1])
