#!/usr/bin/env python3
"""Links that another user planted are not written through; a set on a disk of any size is whole or an error; a command
whose output cannot be written says so.

usage: links_and_full_disks_test.py SIXDOF SIXDOF_BENCH
"""
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

SIXDOF, SIXDOF_BENCH = (str(pathlib.Path(word).resolve()) for word in sys.argv[1:3])
del sys.argv[1:3]
STRANGER = 65534
PAGE = os.sysconf("SC_PAGE_SIZE")
# So many values that nothing hides what is missing: buckets of 18,252 configurations, 0.1 MB each when compressed.
GENERATE = [SIXDOF, "generate", "--a", "cone-1k", "--b", "cone-1k", "--grid", "30/90", "--distances", "0:5"]
QUERY = [SIXDOF, "query", "--a", "torus-1k", "--b", "cone-1k", "--pose", "0.9 0 0.1 1 0 0 0", "--algorithm", "vps-field",
         "-p", "voxel_size=0.1", "-p", "point_spacing=0.1"]


def run(words, **options):
    return subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False, **options)


class Scratch(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="sixdof-faults-"))
        self.addCleanup(shutil.rmtree, self.folder)
        os.chmod(self.folder, 0o755)

    def environment(self, **more):
        return {**os.environ, "SIXDOF_CACHE": str(self.folder / "cache"), **more}

    def succeed(self, words, **options):
        done = run(words, **{"env": self.environment(), **options})
        self.assertEqual(done.returncode, 0, done.stderr)
        return done


class FullDisks(Scratch):
    def check_end(self, done, target, old, whole):
        """Either the whole file and exit code 0, or a message and the old one."""
        left = [path.name for path in target.parent.iterdir() if path.name.endswith(".partial")]
        self.assertEqual(left, [])
        content = target.read_bytes()
        if done.returncode == 0:
            self.assertEqual(content, whole)
        else:
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertRegex(done.stderr, r"cannot be written: (No space left on device|File too large)")
            self.assertEqual(content, old)
        return done.returncode == 0

    def whole_set(self):
        target = self.folder / "whole.h5"
        self.succeed([*GENERATE, "-o", target])
        return target.read_bytes()

    def test_a_set_at_every_limit_of_a_file(self):
        whole = self.whole_set()
        target = self.folder / "set.h5"
        ends = []
        for size in range(0, len(whole) + PAGE, max(PAGE, len(whole) // 40)):
            target.write_bytes(b"old")

            def limit(size=size):
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
            done = run([*GENERATE, "-o", target], env=self.environment(SIXDOF_CACHE="off"), preexec_fn=limit)
            ends.append(self.check_end(done, target, b"old", whole))
        self.assertIn(False, ends)

    def test_a_set_on_a_disk_of_every_size(self):
        whole = self.whole_set()
        disk = self.folder / "disk"
        disk.mkdir()
        if os.geteuid() != 0:
            self.skipTest("mounting a small file system needs root")
        mounted = run(["mount", "-t", "tmpfs", "-o", f"size={PAGE}", "none", disk])
        if mounted.returncode != 0:
            self.skipTest("no small file system can be mounted: " + mounted.stderr)
        try:
            target = disk / "set.h5"
            ends = []
            pages = len(whole) // PAGE + 3
            # In ctest every eighth size; all of them with SIXDOF_EVERY_SIZE=1.
            step = 1 if os.environ.get("SIXDOF_EVERY_SIZE") else max(1, pages // 30)
            for size in [*range(2, pages, step), pages]:
                run(["mount", "-o", f"remount,size={size * PAGE}", disk])
                target.write_bytes(b"old")
                done = run([*GENERATE, "-o", target], env=self.environment(SIXDOF_CACHE="off"))
                ends.append(self.check_end(done, target, b"old", whole))
            self.assertEqual((ends[0], ends[-1]), (False, True))
            self.assertEqual(ends, sorted(ends), "from one size on, the set has room")
        finally:
            run(["umount", disk])

    def test_info_is_not_content_with_a_damaged_set(self):
        target = self.folder / "set.h5"
        target.write_bytes(self.whole_set())
        self.succeed([SIXDOF, "info", target])
        data = bytearray(target.read_bytes())
        data[len(data) // 2] ^= 1  # among the values
        target.write_bytes(data)
        for words in ([], ["--json"]):
            done = run([SIXDOF, "info", target, *words])
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertIn(str(target), done.stderr)

    def test_output_that_cannot_be_written(self):
        for words in ([SIXDOF, "models", "list"], [SIXDOF, "--help"], [SIXDOF, "--version"], [SIXDOF, "query", "--help"],
                      [*QUERY, "--json"], [SIXDOF, "info", "cone-1k"], [SIXDOF, "algorithms", "--json"],
                      [SIXDOF_BENCH, "--help"], [SIXDOF_BENCH, "--version"],
                      [SIXDOF_BENCH, "--no-manifest", "--benchmark_list_tests"]):
            with self.subTest(" ".join(words)), open("/dev/full", "w", encoding="utf-8") as full:
                done = subprocess.run(words, stdout=full, stderr=subprocess.PIPE, text=True, check=False,
                                      env=self.environment())
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertIn("standard output", done.stderr)
            with self.subTest("closed: " + " ".join(words)):
                end, closed = os.pipe()
                os.close(end)
                done = subprocess.run(words, stdout=closed, stderr=subprocess.PIPE, text=True, check=False,
                                      env=self.environment())
                os.close(closed)
                self.assertNotEqual(done.returncode, 0)


@unittest.skipIf(os.geteuid() != 0, "links and folders of another user need root")
class Links(Scratch):
    def setUp(self):
        super().setUp()
        self.precious = self.folder / "precious.txt"
        self.precious.write_text("precious")
        self.shared = self.folder / "shared"
        self.shared.mkdir()
        os.chmod(self.shared, 0o1777)

    def plant(self, name):
        link = self.shared / name
        link.symlink_to(self.precious)
        os.lchown(link, STRANGER, STRANGER)
        return link

    def tearDown(self):
        self.assertEqual(self.precious.read_text(), "precious")

    def test_names_that_an_older_version_had(self):
        # The shell becomes the victim, with the number that the links were planted for.
        script = f"""
for n in x.h5 x.ply; do for c in 0 1 2 3; do
  ln -s '{self.precious}' "{self.shared}/.$n.$$.$c.partial"; chown -h {STRANGER} "{self.shared}/.$n.$$.$c.partial"
done; done
exec "$@"
"""
        for words in ([*GENERATE, "-o", self.shared / "x.h5"],
                      [SIXDOF, "models", "make", "cone-1k", "-o", self.shared / "x.ply"]):
            done = run(["sh", "-c", script, "sh", *words], env=self.environment())
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertTrue((self.shared / words[-1]).is_file() and not (self.shared / words[-1]).is_symlink())

    def test_a_target_that_is_a_link_of_a_stranger(self):
        for name, words in (("x.h5", GENERATE), ("x.ply", [SIXDOF, "models", "make", "cone-1k"])):
            link = self.plant(name)
            done = run([*words, "-o", link], env=self.environment())
            self.assertEqual(done.returncode, 1)
            self.assertRegex(done.stderr, re.escape(str(link)) + ": cannot be written: .* is a link of another user")
            self.assertTrue(link.is_symlink())

    def test_a_journal_that_is_a_link(self):
        self.plant("x.json.journal")
        done = run([SIXDOF_BENCH, "--a", "cone-1k", "--b", "cone-1k", "--sample", "4", "--benchmark_min_time=0.001",
                    "--benchmark_filter=^collide/algorithm:exact/", "--out", self.shared / "x.json"], env=self.environment())
        self.assertEqual(done.returncode, 1)
        self.assertIn("x.json.journal: is a link, which is not followed", done.stderr)

    def test_a_cache_that_others_can_write(self):
        own = self.folder / "own"
        expected = [line for line in self.succeed(QUERY, env=self.environment(SIXDOF_CACHE=str(own))).stdout.splitlines()
                    if "_ns" not in line]
        names = [path.name for path in own.iterdir()]
        self.assertGreater(len(names), 0)
        other = self.folder / "other"
        shutil.copytree(own, other)
        os.chown(other, STRANGER, STRANGER)
        for name in names:
            self.plant(name)
        for cache, why in ((self.shared, "others can write it (mode 1777)"), (other, "it belongs to another user")):
            before = sorted(path.name for path in cache.iterdir())
            done = self.succeed(QUERY, env=self.environment(SIXDOF_CACHE=str(cache)))
            self.assertEqual([line for line in done.stdout.splitlines() if "_ns" not in line], expected)
            self.assertEqual(done.stderr.count("is not used as cache"), 1, done.stderr)
            self.assertIn(f"{cache}: is not used as cache: {why}", done.stderr)
            self.assertEqual(sorted(path.name for path in cache.iterdir()), before, "nothing is kept there")


if __name__ == "__main__":
    unittest.main(verbosity=2)
