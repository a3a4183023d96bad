#!/usr/bin/env python3
"""Tests models/fetch without a network, on a package made here. Usage: fetch_test.py PATH-OF-FETCH"""

import gzip
import hashlib
import io
import json
import pathlib
import subprocess
import sys
import tarfile
import tempfile
import unittest

FETCH = pathlib.Path(sys.argv.pop()).resolve()
PLAIN = b"OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"
PACKED = PLAIN.replace(b"1", b"2")
MEMBER = PLAIN.replace(b"1", b"3")
INNER = PLAIN.replace(b"1", b"5")


def sha256(content):
    return hashlib.sha256(content).hexdigest()


class Fetch(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory(prefix="sixdof-fetch-")
        self.root = pathlib.Path(self.temporary.name)
        self.cache = self.root / "cache"
        self.packages = self.root / "packages"
        self.packages.mkdir()
        self.make_package()
        self.manifest = self.root / "models.json"
        self.write_manifest(sha256(PLAIN))

    def tearDown(self):
        self.temporary.cleanup()

    def make_package(self):
        tree = self.root / "tree"
        (tree / "DEBIAN").mkdir(parents=True)
        (tree / "DEBIAN" / "control").write_text(
            "Package: test-shapes\nVersion: 1\nArchitecture: all\n"
            "Maintainer: nobody <nobody@invalid>\nDescription: shapes\n")
        data = tree / "usr" / "share"
        data.mkdir(parents=True)
        (data / "plain.off").write_bytes(PLAIN)
        (data / "packed.off.gz").write_bytes(gzip.compress(PACKED))
        with tarfile.open(data / "many.tar.gz", "w:gz") as archive:
            for name, content in (("meshes/member.off", MEMBER), ("meshes/inner.off", INNER)):
                entry = tarfile.TarInfo(name)
                entry.size = len(content)
                archive.addfile(entry, io.BytesIO(content))
        package = self.packages / "test-shapes_1_all.deb"
        subprocess.run(["dpkg-deb", "--root-owner-group", "-b", str(tree), str(package)],
                       check=True, capture_output=True)

    def write_manifest(self, plain_digest):
        entry = {"package": "test-shapes"}
        self.manifest.write_text(json.dumps({"models": [
            {**entry, "name": "plain", "path": "usr/share/plain.off", "file": "plain.off", "sha256": plain_digest},
            {**entry, "name": "packed", "path": "usr/share/packed.off.gz", "file": "packed.off",
             "sha256": sha256(PACKED)},
            {**entry, "name": "member", "path": "usr/share/many.tar.gz", "member": "meshes/member.off",
             "file": "member.off", "sha256": sha256(MEMBER)}]}))

    def fetch(self, *arguments, packages=True):
        command = [str(FETCH), "--manifest", str(self.manifest), "--cache", str(self.cache), *arguments]
        if packages:
            command += ["--packages", str(self.packages)]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def files(self):
        return sorted(path.name for path in self.cache.iterdir() if path.name != ".lock")

    def test_fetches_plain_compressed_and_archived_files(self):
        result = self.fetch()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.files(), ["member.off", "packed.off", "plain.off"])
        self.assertEqual((self.cache / "plain.off").read_bytes(), PLAIN)
        self.assertEqual((self.cache / "packed.off").read_bytes(), PACKED)
        self.assertEqual((self.cache / "member.off").read_bytes(), MEMBER)

    def test_fetches_only_what_is_named(self):
        self.assertEqual(self.fetch("packed").returncode, 0)
        self.assertEqual(self.files(), ["packed.off"])

    def write_collection(self):
        entry = {"package": "test-shapes", "path": "usr/share/many.tar.gz"}
        (self.root / "collection.json").write_text(json.dumps({"objects": [
            {"name": "torus-2k", "triangles": 2000},
            {**entry, "name": "inner", "member": "meshes/inner.off", "file": "inner.off", "sha256": sha256(INNER)}]}))

    def test_fetches_the_collection_and_needs_no_file_for_recipes(self):
        self.write_collection()
        self.assertEqual(self.fetch("--collection", "--list").stdout.count("missing"), 4)
        result = self.fetch("--collection")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.files(), ["inner.off", "member.off", "packed.off", "plain.off"])
        self.assertEqual((self.cache / "inner.off").read_bytes(), INNER)

    def test_an_object_of_the_collection_is_fetched_by_its_name_only(self):
        self.write_collection()
        self.assertEqual(self.fetch().returncode, 0)
        self.assertEqual(self.files(), ["member.off", "packed.off", "plain.off"])
        self.assertEqual(self.fetch("inner").returncode, 0)
        self.assertIn("inner.off", self.files())

    def test_a_collection_that_is_not_there_is_named(self):
        result = self.fetch("--collection")
        self.assertEqual(result.returncode, 1)
        self.assertIn("collection.json: no such collection", result.stderr)

    def test_keeps_valid_files_and_needs_no_package_for_them(self):
        self.assertEqual(self.fetch().returncode, 0)
        before = (self.cache / "plain.off").stat()
        (self.packages / "test-shapes_1_all.deb").unlink()
        result = self.fetch()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.count("here already"), 3)
        after = (self.cache / "plain.off").stat()
        self.assertEqual((before.st_mtime_ns, before.st_ino), (after.st_mtime_ns, after.st_ino))

    def test_replaces_a_damaged_file_and_says_so(self):
        self.assertEqual(self.fetch().returncode, 0)
        (self.cache / "plain.off").write_bytes(PLAIN[:-7])
        self.assertIn("damaged", self.fetch("--list").stdout)
        result = self.fetch()
        self.assertEqual(result.returncode, 0)
        self.assertIn(f"{self.cache / 'plain.off'} is damaged", result.stdout)
        self.assertEqual((self.cache / "plain.off").read_bytes(), PLAIN)

    def test_does_not_store_a_file_of_another_version(self):
        self.write_manifest("0" * 64)
        result = self.fetch()
        self.assertEqual(result.returncode, 1)
        self.assertIn("plain: test-shapes_1_all.deb holds another version", result.stderr)
        self.assertIn("1 of 3 models could not be fetched", result.stderr)
        self.assertEqual(self.files(), ["member.off", "packed.off"])

    def test_a_damaged_package_is_an_error_and_leaves_nothing(self):
        deb = self.packages / "test-shapes_1_all.deb"
        deb.write_bytes(deb.read_bytes()[:-200])
        result = self.fetch()
        self.assertEqual(result.returncode, 1)
        self.assertNotIn("Traceback", result.stderr)
        self.assertEqual(self.files(), [])

    def test_a_package_that_cannot_be_downloaded_is_named(self):
        result = self.fetch("plain", packages=False)
        self.assertEqual(result.returncode, 1)
        self.assertIn("test-shapes: apt-get could not download it", result.stderr)
        self.assertEqual(self.files(), [])

    def test_an_unknown_name_fetches_nothing(self):
        result = self.fetch("plain", "plane")
        self.assertEqual(result.returncode, 1)
        self.assertIn("no model is called plane; known: plain, packed, member", result.stderr)
        self.assertFalse(self.cache.exists())

    def test_runs_at_the_same_time_wait_for_each_other(self):
        command = [str(FETCH), "--manifest", str(self.manifest), "--cache", str(self.cache),
                   "--packages", str(self.packages)]
        running = [subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                   for _ in range(4)]
        outputs = [process.communicate() for process in running]
        self.assertEqual([process.returncode for process in running], [0] * 4, outputs)
        self.assertEqual(sum(out.count(": fetched ") for out, _ in outputs), 3)
        self.assertEqual(self.files(), ["member.off", "packed.off", "plain.off"])

    def test_a_closed_pipe_ends_the_list_without_a_message(self):
        command = [str(FETCH), "--manifest", str(self.manifest), "--cache", str(self.cache), "--list"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            process.stdout.close()
            self.assertEqual(process.stderr.read(), b"")
            self.assertEqual(process.wait(), 141)

    def test_a_cache_that_cannot_be_made_is_named(self):
        self.cache.write_text("not a folder")
        result = self.fetch()
        self.assertEqual(result.returncode, 1)
        self.assertIn(str(self.cache), result.stderr)
        self.assertNotIn("Traceback", result.stderr)


if __name__ == "__main__":
    unittest.main()
