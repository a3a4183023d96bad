"""test/fuzz/run: which fuzzers it runs with what, its table, and where inputs go. The fuzzers are stand-ins.

usage: run_test.py RUN
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

RUN = pathlib.Path(sys.argv.pop(1))
TARGETS = ["mesh_file", "configuration_set", "cached_structure", "protocol", "pose_table", "command_line"]

# Says what libFuzzer says, and keeps an input in its first folder.
STAND_IN = """#!/bin/sh
for word; do case $word in -*) ;; *) folder=$word; break ;; esac; done
echo new > "$folder/new-input"
echo "#7	INITED cov: 5 ft: 6 corp: 3/9b" >&2
echo "#9	DONE cov: 1234 ft: 5678 corp: 4/9b" >&2
case $0 in *ENDED)
  echo "artifact_prefix='x'; Test unit written to /found/crash-1" >&2
  code=77 ;;
esac
echo "stat::number_of_executed_units: 2000" >&2
echo "stat::new_units_added:          1" >&2
exit ${code:-0}
"""


class Run(unittest.TestCase):
    def setUp(self):
        self.top = pathlib.Path(tempfile.mkdtemp(prefix="sixdof-fuzz-run-"))
        self.addCleanup(shutil.rmtree, self.top)
        self.build = self.top / "build" / "fuzz"
        (self.build / "test" / "fuzz").mkdir(parents=True)
        (self.build / "build.ninja").touch()
        (self.top / "test" / "fuzz").mkdir(parents=True)
        (self.top / "bin").mkdir()
        shutil.copy(RUN, self.top / "test" / "fuzz" / "run")
        self.program(self.top / "bin" / "ninja", '#!/bin/sh\necho "$@" > ' + str(self.top / "built"))
        for target in TARGETS:
            (self.top / "test" / "fuzz" / "corpus" / target).mkdir(parents=True)
            self.program(self.build / "test" / "fuzz" / ("fuzz_" + target), STAND_IN)

    @staticmethod
    def program(path, text):
        path.write_text(text)
        path.chmod(0o755)

    def run_script(self, *words):
        return subprocess.run([sys.executable, self.top / "test" / "fuzz" / "run", *words], text=True,
                              capture_output=True, check=False, timeout=60,
                              env={"PATH": f"{self.top / 'bin'}:/usr/bin:/bin"})

    @staticmethod
    def rows(done):
        return [[cell.strip() for cell in line.strip("|").split("|")] for line in done.stdout.splitlines()[2:]]

    def test_all_targets_in_order_with_a_table_that_is_kept(self):
        for words in ([], ["--parallel", "2"]):
            done = self.run_script("--minutes", "1e-5", *words)
            self.assertEqual(done.returncode, 0, done.stderr)
            rows = self.rows(done)
            self.assertEqual([row[0] for row in rows], [f"`{target}`" for target in TARGETS])
            for row in rows:
                self.assertEqual([row[2], *row[4:]], ["2,000", "1,234", "5,678", "1", "0"])
            self.assertEqual((self.build / "figures.md").read_text(), done.stdout)
        for target in TARGETS:
            self.assertIn("fuzz_" + target, (self.top / "built").read_text())

    def test_new_inputs_stay_out_of_the_repository(self):
        self.assertEqual(self.run_script("protocol", "--minutes", "1e-5").returncode, 0)
        self.assertTrue((self.build / "corpus" / "protocol" / "new-input").exists())
        self.assertEqual([path for path in (self.top / "test").rglob("*") if path.is_file()],
                         [self.top / "test" / "fuzz" / "run"])

    def test_runs_until_the_processor_time_is_used(self):
        done = self.run_script("protocol", "--minutes", "0.001")  # 60 ms: each run takes a few
        self.assertEqual(done.returncode, 0, done.stderr)
        executions = int(self.rows(done)[0][2].replace(",", ""))
        self.assertGreater(executions, 2000)
        self.assertEqual(executions % 2000, 0)

    def test_an_input_that_ends_a_fuzzer_is_named(self):
        place = self.build / "test" / "fuzz"
        self.program(place / "fuzz_protocol", STAND_IN.replace("*ENDED", "*"))
        done = self.run_script("protocol", "mesh_file", "--minutes", "1e-5")
        self.assertEqual(done.returncode, 1)
        self.assertIn("protocol was ended by /found/crash-1\n", done.stdout)
        self.assertEqual([row[-1] for row in self.rows(done)[:2]], ["1", "0"])
        self.program(place / "fuzz_protocol", "#!/bin/sh\nexit 3\n")
        done = self.run_script("protocol", "--minutes", "1e-5")
        self.assertEqual(done.returncode, 1)
        self.assertIn("protocol ended with exit code 3", done.stdout)
        self.assertEqual(self.rows(done)[0][-1], "1")

    def test_wrong_words_are_refused(self):
        for words in (["nothing"], ["--minutes", "0"], ["--parallel", "0"]):
            done = self.run_script(*words)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn("run: error: ", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
