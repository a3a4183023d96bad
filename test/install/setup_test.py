"""cmake/setup on systems that lack packages. apt and dpkg are stand-ins whose lists are files in a folder.

usage: setup_test.py
"""

import os
import pathlib
import re
import stat
import subprocess
import tempfile
import unittest

SETUP = pathlib.Path(__file__).resolve().parents[2] / "cmake" / "setup"
GROUPS = ["build", "test", "bench", "fuzz"]  # not cluster, for which the script writes to /usr/sbin
REQUIRED, OPTIONAL, OTHER_OPTIONAL = "libfcl-dev", "clang-format-14", "libode-dev"

STUBS = {
    "dpkg-query": """for name; do :; done
if grep -qx -- "$name" installed; then printf installed; fi""",
    "apt-cache": """for name; do
  if grep -qx -- "$name" lists; then echo "Package: $name"; fi
done""",
    "apt-get": """echo "$*" >> trace
simulate=false names=
for word; do
  case $word in
    update) cp archive lists; exit ;;
    --simulate) simulate=true ;;
    install | -*) ;;
    *) names="$names $word" ;;
  esac
done
for name in $names; do grep -qx -- "$name" lists || exit 100; done
if $simulate; then exit; fi
for name in $names; do if grep -qx -- "$name" broken; then exit 100; fi; done
for name in $names; do echo "$name" >> installed; done""",
    "sudo": 'exec "$@"',
}


def packages():
    """Names of all packages, and of the optional ones, by cmake/setup --list."""
    out = subprocess.run([SETUP, "--list"], capture_output=True, text=True, check=True).stdout
    rows = [re.fullmatch(r"(\w+) +(\S+) +(.*)", line).groups() for line in out.splitlines()]
    return {name for _, name, _ in rows}, {name for _, name, reason in rows if reason.endswith("(optional)")}


class Setup(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        stubs = self.folder / "stubs"
        stubs.mkdir()
        for name, text in STUBS.items():
            stub = stubs / name
            stub.write_text(f"#!/bin/sh\ncd '{self.folder}'\n{text}\n")
            stub.chmod(stub.stat().st_mode | stat.S_IXUSR)
        self.environment = os.environ | {"PATH": f"{stubs}:/usr/bin:/bin"}
        self.names, self.optional = packages()

    def system(self, archive, lists=(), broken=()):
        """A system with nothing installed: what its archive has, what its lists know, what fails to install."""
        for name, content in (("archive", archive), ("lists", lists), ("broken", broken), ("installed", ()),
                              ("trace", ())):
            (self.folder / name).write_text("".join(line + "\n" for line in content))

    def run_it(self, *words):
        done = subprocess.run([SETUP, *words], capture_output=True, text=True, check=False, env=self.environment)
        return done.returncode, done.stdout + done.stderr

    def lines(self, name):
        return (self.folder / name).read_text().splitlines()

    def updates(self):
        return sum(line.startswith("update") for line in self.lines("trace"))

    def test_list_says_what_is_optional(self):
        self.assertLessEqual({REQUIRED, OPTIONAL, OTHER_OPTIONAL}, self.names)
        self.assertLessEqual({OPTIONAL, OTHER_OPTIONAL, "chromium", "slurmd"}, self.optional)
        for name in (REQUIRED, "g++", "libhdf5-dev", "libgtest-dev", "libbenchmark-dev"):
            self.assertNotIn(name, self.optional)
        self.assertFalse([name for name in self.names if name.endswith("?")])

    def test_fresh_system_without_an_optional_package(self):
        self.system(self.names - {OPTIONAL})
        code, text = self.run_it(*GROUPS)
        self.assertEqual(code, 0, text)
        self.assertIn(f"not to be had here: {OPTIONAL}.", text)
        self.assertIn(OTHER_OPTIONAL, self.lines("installed"))
        self.assertIn(REQUIRED, self.lines("installed"))
        self.assertEqual(self.updates(), 1)
        # A second run has nothing to do, and knows it without new lists.
        self.assertEqual(self.run_it(*GROUPS)[0], 0)
        self.assertEqual(self.updates(), 1)

    def test_complete_system(self):
        self.system(self.names, self.names)
        code, text = self.run_it(*GROUPS)
        self.assertEqual(code, 0, text)
        self.assertRegex(text, r"all \d+ are there")
        self.assertEqual(self.updates(), 0)
        self.assertRegex(self.run_it(*GROUPS)[1], r"all \d+ packages are installed")

    def test_optional_package_that_cannot_be_installed_costs_itself_only(self):
        self.system(self.names, self.names, [OTHER_OPTIONAL])
        code, text = self.run_it(*GROUPS)
        self.assertEqual(code, 0, text)
        self.assertIn(f"not to be had here: {OTHER_OPTIONAL}.", text)
        self.assertIn(OPTIONAL, self.lines("installed"))

    def test_required_package_stops_it(self):
        self.system(self.names - {REQUIRED})
        code, text = self.run_it(*GROUPS)
        self.assertEqual(code, 2, text)
        self.assertEqual(self.lines("installed"), [])

    def test_check_counts_required_packages_only(self):
        self.system(self.names, self.names)
        self.assertEqual(self.run_it("--check", *GROUPS)[0], 1)
        (self.folder / "installed").write_text("\n".join(self.names - self.optional) + "\n")
        code, text = self.run_it("--check", *GROUPS)
        self.assertEqual(code, 0, text)
        self.assertIn(f"missing  {OPTIONAL}", text)
        self.assertFalse([line for line in self.lines("trace") if "install" in line])


if __name__ == "__main__":
    unittest.main(verbosity=2)
