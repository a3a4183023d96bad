"""Every kind of file that the programs write is there whole or not at all: with a full disk, a write that kills the
writer, a folder without permission, two writers, another locale and hard names.

usage: output_files_test.py SIXDOF SIXDOF_BENCH
"""

import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

from output_kinds import SIXDOF, SIXDOF_BENCH, A, OPEN, GRID, BENCH, CACHED, KINDS, FOLDERS

del sys.argv[1:3]
NOBODY = 65534
# The runtime of the thread sanitizer writes a file into this folder, if it exists, as a program starts; where that file
# has no room, the program ends before its first line.
WITHOUT_SANITIZER_FILE = {**os.environ, "TEST_TMPDIR": "/no-such-folder"}
KNOWN_TEMPORARY = ".partial"


class OutputFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.top = pathlib.Path(tempfile.mkdtemp(prefix="sixdof-output-"))
        cls.addClassCleanup(shutil.rmtree, cls.top)
        os.chmod(cls.top, 0o755)
        cls.cache = cls.top / "cache"
        cls.whole = {}  # what an undisturbed run writes
        for kind in KINDS + FOLDERS:
            folder = cls.new_folder()
            done = cls.run_in(folder, kind.command())
            assert done.returncode == 0, (kind.name, done.stderr)
            cls.whole[kind.name] = cls.content(folder / kind.file)
            assert not cls.left_overs(folder), kind.name

    @classmethod
    def new_folder(cls):
        """Of the same name each time, since a set knows where its meshes are."""
        folder = cls.top / "work"
        if folder.exists():
            shutil.rmtree(folder)
        folder.mkdir()
        (folder / "a.off").write_text(A)
        (folder / "open.off").write_text(OPEN)
        inputs = cls.top / "inputs"  # that take time to make
        if not inputs.exists():
            (inputs / "runs").mkdir(parents=True)
            for command in ([SIXDOF, "generate", *GRID, "--shards", "3", "-o", inputs / "shards"],
                            [SIXDOF, "generate", *GRID, "-o", inputs / "asked.h5"],
                            [SIXDOF_BENCH, *BENCH, "--out", inputs / "results.json"]):
                subprocess.run(command, cwd=folder, check=True, capture_output=True, env=cls.environment())
            shutil.copy(inputs / "results.json", inputs / "runs" / "first.json")
        shutil.copytree(inputs, folder, dirs_exist_ok=True)
        return folder

    @classmethod
    def environment(cls, **more):
        return {**WITHOUT_SANITIZER_FILE, "SIXDOF_CACHE": str(cls.cache), **more}

    @classmethod
    def run_in(cls, folder, command, environment=None, **options):
        return subprocess.run(command, cwd=folder, capture_output=True, check=False, timeout=250,
                              env=environment or cls.environment(), **options)

    @staticmethod
    def content(path):
        """Bytes of a file, or of all files of a folder; None if there is nothing."""
        if path.is_dir():
            return {str(file.relative_to(path)): file.read_bytes() for file in path.rglob("*") if file.is_file()}
        return path.read_bytes() if path.exists() else None

    @staticmethod
    def without_left_overs(content):
        """Files of a folder, without those of a writer that was killed."""
        return {name: data for name, data in (content or {}).items() if KNOWN_TEMPORARY not in name}

    @staticmethod
    def left_overs(folder):
        return [str(path) for path in folder.rglob("*") if path.name.endswith(KNOWN_TEMPORARY)]

    def is_whole(self, kind, content):
        whole = self.whole[kind.name]
        if not kind.times or isinstance(content, dict):
            return content == whole
        if kind.file.endswith(".h5"):  # HDF5's superblock: no writer has it open, and where the file ends
            is_open, end = content[11], int.from_bytes(content[28:36], "little")
            return not is_open and end == len(content) == len(whole)
        content, whole = json.loads(content), json.loads(whole)
        return isinstance(content, type(whole)) and len(content) == len(whole)

    def check_error(self, done, *names):
        """A message of the program, and an exit code."""
        words = done.stderr.decode(errors="replace")
        self.assertIn(done.returncode, (1, 2), words)
        self.assertRegex(words, r"(?m)^sixdof[^:]*: ")
        for name in names:
            self.assertIn(name, words)

    def check_full(self, done, kind):
        words = done.stderr.decode(errors="replace")
        self.check_error(done)
        # What stress needs besides may be the first that has no room. The limit of files is one of files in memory, too.
        self.assertRegex(words.strip().split("\n")[-1],
                         rf"^sixdof[^:]*: \S*({kind.file}|cases/|sixdof-stress: a file in memory)[^:]*: "
                         r".*(File too large|No space left on device)")

    @staticmethod
    def answers(done):
        """What was printed, without times."""
        lines = done.stdout.decode().splitlines()
        return done.returncode, [line for line in lines if "_ns" not in line]

    # Full disks.

    def limits(self, kind):
        size = len(self.whole[kind.name])
        return sorted({0, 1, size // 3, size - 1}) if not kind.times else [0, 64]

    def limited(self, size, handler):
        def prepare():
            signal.signal(signal.SIGXFSZ, handler)
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
        return prepare

    def test_a_disk_that_is_full_leaves_the_old_file(self):
        for kind in KINDS:
            with self.subTest(kind.name):
                for size in self.limits(kind):
                    folder = self.new_folder()
                    if kind.replaces:
                        (folder / kind.file).write_bytes(b"old")
                    done = self.run_in(folder, kind.command(), preexec_fn=self.limited(size, signal.SIG_IGN))
                    self.check_full(done, kind)
                    self.assertEqual(self.content(folder / kind.file), b"old" if kind.replaces else None)
                    self.assertEqual(self.left_overs(folder), [])

    def test_a_writer_that_is_killed_in_the_middle_leaves_the_old_file(self):
        # SIGXFSZ ends the process at the byte, with no chance to clean up: the same as kill -9 there.
        for kind in KINDS:
            with self.subTest(kind.name):
                for size in self.limits(kind):
                    folder = self.new_folder()
                    if kind.replaces:
                        (folder / kind.file).write_bytes(b"old")
                    done = self.run_in(folder, kind.command(), preexec_fn=self.limited(size, signal.SIG_DFL))
                    self.assertEqual(done.returncode, -signal.SIGXFSZ, done.stderr)
                    self.assertEqual(self.content(folder / kind.file), b"old" if kind.replaces else None)
                    if kind.program is SIXDOF_BENCH:
                        (folder / (kind.file + ".journal")).unlink(missing_ok=True)
                    done = self.run_in(folder, kind.command())
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assertTrue(self.is_whole(kind, self.content(folder / kind.file)))

    def test_a_folder_is_whole_or_has_whole_files_only(self):
        for kind in FOLDERS:
            whole = self.whole[kind.name]
            for handler in (signal.SIG_IGN, signal.SIG_DFL):
                for size in sorted({0, 100, min(map(len, whole.values())) - 1}):
                    with self.subTest(f"{kind.name}, {handler.name}, {size}"):
                        folder = self.new_folder()
                        done = self.run_in(folder, kind.command(), preexec_fn=self.limited(size, handler))
                        if handler is signal.SIG_IGN:
                            self.check_error(done, "File too large")
                            self.assertEqual(self.left_overs(folder), [])
                        else:
                            self.assertEqual(done.returncode, -signal.SIGXFSZ, done.stderr)
                        made = self.without_left_overs(self.content(folder / kind.file))
                        self.assertEqual(made, {name: whole[name] for name in made})
                        if not kind.replaces and not kind.resume:
                            self.assertFalse((folder / kind.file).exists())
                        done = self.run_in(folder, [*kind.command(), *kind.resume])
                        self.assertEqual(done.returncode, 0, done.stderr)
                        self.assertEqual(self.without_left_overs(self.content(folder / kind.file)), whole)

    def test_a_small_disk(self):
        if os.geteuid() != 0:
            self.skipTest("mounting a small file system needs root")
        folder = self.top / "disk"
        folder.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8k", "none", folder], capture_output=True,
                                 check=False)
        if mounted.returncode != 0:
            self.skipTest("no small file system can be mounted: " + mounted.stderr.decode())
        try:
            (folder / "rest").write_bytes(bytes(4096))
            for kind in KINDS:
                with self.subTest(kind.name):
                    if len(self.whole[kind.name]) <= 4096:
                        continue
                    done = self.run_in(self.new_folder(), kind.command(str(folder / kind.file)))
                    self.check_full(done, kind)
                    # A journal has finished rows.
                    left = {path.name for path in folder.iterdir()} - {kind.file + ".journal"}
                    self.assertEqual(left, {"rest"})
                    (folder / (kind.file + ".journal")).unlink(missing_ok=True)
            for kind in FOLDERS[2:]:
                for size in ("8k", "72k", "88k") if kind.file == "figures" else ("8k",):
                    with self.subTest(f"{kind.name}, {size}"):
                        subprocess.run(["mount", "-o", f"remount,size={size}", folder], check=True)
                        done = self.run_in(self.new_folder(), kind.command(str(folder / kind.file)))
                        self.check_error(done, str(folder / kind.file))
                        self.assertRegex(done.stderr, b"[Nn]o space left on device")
                        made = self.content(folder / kind.file)
                        self.assertEqual(made, {name: self.whole[kind.name][name] for name in made})
                        self.assertEqual(self.left_overs(folder), [])
                        shutil.rmtree(folder / kind.file)
        finally:
            subprocess.run(["umount", folder], check=True)

    def test_the_cache_does_without_what_cannot_be_written(self):
        folder = self.new_folder()
        cache = folder / "cache"
        environment = self.environment(SIXDOF_CACHE=str(cache))
        expected = self.answers(self.run_in(folder, CACHED, environment))
        self.assertEqual(expected[0], 0)
        whole = self.content(cache)
        self.assertGreaterEqual(len(whole), 3)
        for size in (0, 1000, min(map(len, whole.values())) - 1):
            for handler in (signal.SIG_IGN, signal.SIG_DFL):
                shutil.rmtree(cache)
                done = self.run_in(folder, CACHED, environment, preexec_fn=self.limited(size, handler))
                if handler is signal.SIG_IGN:
                    self.assertEqual(self.answers(done), expected, done.stderr)
                for name, content in self.content(cache).items():
                    self.assertTrue(name.endswith(KNOWN_TEMPORARY) or content == whole[name], name)
                done = self.run_in(folder, CACHED, environment)
                self.assertEqual(self.answers(done), expected, done.stderr)
                self.assertEqual(self.content(cache), whole)

    # Permissions.

    def as_user(self):
        """Options of a process without root's rights, or None where there is none."""
        if os.geteuid() != 0:
            return {}
        options = {"user": NOBODY, "group": NOBODY, "extra_groups": []}
        folder = self.new_folder()
        try:
            if self.run_in(folder, [SIXDOF, "info", "a.off"], **options).returncode == 0:
                return options
        except PermissionError:
            pass
        return self.skipTest("a user without rights cannot run the program where it lies")

    def test_a_folder_without_permission(self):
        options = self.as_user()
        for kind in KINDS + FOLDERS:
            with self.subTest(kind.name):
                folder = self.new_folder()
                taken = folder / "taken"
                taken.mkdir()
                os.chmod(taken, 0o555)
                os.chmod(folder, 0o777)
                environment = self.environment(SIXDOF_CACHE="off")
                done = self.run_in(folder, kind.command("taken/" + kind.file), environment, **options)
                self.check_error(done, "taken/" + kind.file)
                self.assertIn(b"Permission denied", done.stderr)
                self.assertEqual(self.content(taken), {})

    def test_an_input_without_permission(self):
        options = self.as_user()
        folder = self.new_folder()
        done = self.run_in(folder, KINDS[6].command("set.h5"))
        self.assertEqual(done.returncode, 0, done.stderr)
        for file, words in self.inputs():
            os.chmod(folder / file, 0)
            with self.subTest(" ".join(words)):
                done = self.run_in(folder, [SIXDOF, *words], self.environment(SIXDOF_CACHE="off"), **options)
                self.check_error(done, file)
            os.chmod(folder / file, 0o755)

    # Inputs that are something else.

    @staticmethod
    def inputs():
        pose = ["--pose", "0.3 0.2 0.1 1 0 0 0"]
        return [("a.off", ["info", "a.off"]), ("a.off", ["query", "--a", "a.off", "--b", "open.off", *pose]),
                ("open.off", ["repair", "open.off", "-o", "x.off"]),
                ("a.off", ["generate", "--a", "a.off", "--grid", "90", "--distances", "5", "-o", "y.h5"]),
                ("set.h5", ["info", "set.h5"]), ("set.h5", ["verify", "set.h5", "--oracle", "exact"]),
                ("set.h5", ["table", "set.h5"]), ("shards", ["merge", "shards", "-o", "y.h5"]),
                ("results.json", ["report", "results.json", "-o", "y.html"]),
                ("runs", ["history", "runs", "-o", "y.html"])]

    def test_inputs_that_are_missing_empty_or_folders(self):
        for file, words in self.inputs():
            for what in ("missing", "empty", "folder", "a loop of links"):
                with self.subTest(f"{what}: {' '.join(words)}"):
                    folder = self.new_folder()
                    path = folder / file
                    if path.is_dir():
                        shutil.rmtree(path)
                    path.unlink(missing_ok=True)
                    if what == "empty":
                        path.write_bytes(b"")
                    elif what == "folder":
                        path.mkdir()
                    elif what == "a loop of links":
                        path.symlink_to(path)
                    done = self.run_in(folder, [SIXDOF, *words])
                    self.check_error(done, file)
                    self.assertEqual(list(folder.glob("y.*")), [])

    # Two writers.

    def run_twice(self, folder, command, environment=None):
        """Two processes that run at the same time, when both have ended."""
        writers = [subprocess.Popen(command, cwd=folder, env=environment or self.environment(), stdout=subprocess.PIPE,
                                    stderr=subprocess.PIPE) for _ in range(2)]
        ended = []
        for writer in writers:
            printed, words = writer.communicate(timeout=250)
            ended.append(subprocess.CompletedProcess(command, writer.returncode, printed, words))
        return ended

    def test_two_writers_of_one_file_leave_a_whole_one(self):
        for kind in KINDS:
            with self.subTest(kind.name):
                if not kind.replaces:
                    continue
                folder = self.new_folder()
                for done in self.run_twice(folder, kind.command()):
                    self.assertEqual(done.returncode, 0, done.stderr)
                self.assertTrue(self.is_whole(kind, self.content(folder / kind.file)))
                self.assertEqual(self.left_overs(folder), [])

    def check_at_least_one_wrote(self, ends, kind):
        self.assertIn(0, [done.returncode for done in ends], [done.stderr for done in ends])
        for done in ends:
            if done.returncode != 0:
                self.check_error(done, kind.file)

    def test_two_writers_of_results_are_told_apart(self):
        kind = KINDS[-1]
        folder = self.new_folder()
        self.check_at_least_one_wrote(self.run_twice(folder, kind.command()), kind)
        self.assertTrue(self.is_whole(kind, self.content(folder / kind.file)))

    def test_two_writers_of_one_folder_leave_a_whole_one(self):
        for kind in FOLDERS:
            with self.subTest(kind.name):
                folder = self.new_folder()
                self.check_at_least_one_wrote(self.run_twice(folder, kind.command()), kind)
                self.assertEqual(self.content(folder / kind.file), self.whole[kind.name])
                self.assertEqual(self.left_overs(folder), [])

    def test_two_that_resume_the_same_shards_both_succeed(self):
        kind = FOLDERS[0]
        folder = self.new_folder()
        self.assertEqual(self.run_in(folder, kind.command()).returncode, 0)
        for shard in sorted((folder / kind.file).iterdir())[1:]:
            shard.unlink()
        for done in self.run_twice(folder, [*kind.command(), *kind.resume]):
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.content(folder / kind.file), self.whole[kind.name])
        self.assertEqual(self.left_overs(folder), [])

    def test_two_writers_of_the_cache_both_answer(self):
        folder = self.new_folder()
        cache = folder / "cache"
        environment = self.environment(SIXDOF_CACHE=str(cache))
        expected = self.answers(self.run_in(folder, CACHED, environment))
        self.assertEqual(expected[0], 0)
        whole = self.content(cache)
        for _ in range(4):
            shutil.rmtree(cache)
            for done in self.run_twice(folder, CACHED, environment):
                self.assertEqual(self.answers(done), expected, done.stderr)
            self.assertEqual(self.content(cache), whole)

    # Locales and names.

    def test_a_decimal_comma_changes_nothing(self):
        locales = self.top / "locales"
        locales.mkdir()
        made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", locales / "de_DE.UTF-8"], capture_output=True,
                              check=False) if shutil.which("localedef") else None
        if made is None or not (locales / "de_DE.UTF-8" / "LC_NUMERIC").exists():
            self.skipTest("no locale with a decimal comma can be made")
        environment = self.environment(LOCPATH=str(locales), LC_ALL="de_DE.UTF-8")
        for kind in KINDS + FOLDERS:
            with self.subTest(kind.name):
                folder = self.new_folder()
                done = self.run_in(folder, kind.command(), environment)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertTrue(self.is_whole(kind, self.content(folder / kind.file)))
        query = [SIXDOF, "query", "--a", "a.off", "--b", "a.off", "--pose", "0.35 0.2 0.1 1 0 0 0"]
        folder = self.new_folder()
        expected = self.answers(self.run_in(folder, query))
        self.assertEqual(expected[0], 0)
        for variable in ("LC_ALL", "LC_NUMERIC"):
            environment = self.environment(LOCPATH=str(locales), **{variable: "de_DE.UTF-8"})
            self.assertEqual(self.answers(self.run_in(folder, query, environment)), expected)

    def test_names_with_spaces_breaks_and_other_letters(self):
        for name in ("a b", "line\nbreak", "é-ß-日本", "'quoted' \"twice\"", "-dash", "\udcff"):
            folder = self.new_folder()
            shutil.copy(folder / "a.off", folder / f"{name}.off")
            for kind in KINDS + FOLDERS:
                with self.subTest(kind.name):
                    file = f"./{name}.{kind.file}"
                    done = self.run_in(folder, kind.command(file))
                    self.assertEqual(done.returncode, 0, done.stderr)
                    content = self.content(folder / file)
                    self.assertTrue(self.is_whole(kind, content))
            done = self.run_in(folder, [SIXDOF, "info", f"./{name}.off"])
            self.assertEqual(done.returncode, 0, done.stderr)
            done = self.run_in(folder, [SIXDOF, "info", f"./{name} absent.off"])
            self.check_error(done)


if __name__ == "__main__":
    unittest.main(verbosity=2)
