"""Figures in documents are those of bench/published: `bench/publish --check`, on this repository and on planted faults.

usage: publish_test.py SIXDOF
"""

import importlib.machinery
import importlib.util
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIXDOF = sys.argv.pop(1)
sys.path.insert(0, str(ROOT / "bench/scripts"))
sys.dont_write_bytecode = True
import published_documents as documents  # noqa: E402
import published_parts as parts  # noqa: E402

LOADER = importlib.machinery.SourceFileLoader("publish", str(ROOT / "bench/publish"))
publish = importlib.util.module_from_spec(importlib.util.spec_from_loader("publish", LOADER))
LOADER.exec_module(publish)

ROW = {"name": "distance/algorithm:exact/pair:p/distance:05", "run_type": "iteration", "real_time": 1.25, "cpu_time": 1.25,
       "time_unit": "us", "configurations": 8, "mismatch": 0, "error_rms": 1e-17,
       "sixdof": {"query": "distance", "algorithm": "exact", "settings": {}, "pair": "p", "order": "random",
                  "cache": "warm", "bucket": {"kind": "distance", "percent": 5}, "configurations": 8}}


class Marks(unittest.TestCase):
    """In a repository of one document, made for each test."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        root = pathlib.Path(folder.name)
        for name, path in (("ROOT", root), ("PUBLISHED", root / "published"), ("FACTS", root / "published/parts.json"),
                           ("DRAWINGS", root / "drawings.json")):
            self.addCleanup(setattr, documents, name, getattr(documents, name))
            setattr(documents, name, path)
        (root / "published").mkdir()
        documents.DRAWINGS.write_text("{}")
        self.publish(ROW)
        documents.FACTS.write_text(json.dumps({"one": {"commit": "abc"}, "two": {"commit": "abc"}}))
        self.file = root / "README.md"
        subprocess.run(["git", "init", "-q", root], check=True)

    def publish(self, row):
        (documents.PUBLISHED / "rows.json").write_text(parts.as_text({"context": {"commit": "abc"}, "benchmarks": [row]}))

    def fill(self, text):
        self.file.write_text(text)
        subprocess.run(["git", "add", "README.md"], cwd=documents.ROOT, check=True)
        documents.write(SIXDOF)
        return self.file.read_text()

    def test_a_value(self):
        mark = "<!--= rows.json benchmarks[name=distance/algorithm:exact/pair:p/distance:05].cpu_time .1f -->"
        self.assertEqual(self.fill(f"takes {mark}?<!--=--> us"), f"takes {mark}1.2<!--=--> us")
        self.assertEqual(documents.check(SIXDOF), 0)
        self.publish(ROW | {"cpu_time": 3.0})
        self.assertEqual(documents.check(SIXDOF), 1)

    def test_a_named_figure(self):
        self.addCleanup(setattr, documents, "FIGURES", documents.FIGURES)
        documents.FIGURES = documents.ROOT / "figures.json"
        documents.FIGURES.write_text(json.dumps({"row.time": ["rows.json", "benchmarks[time_unit=us].cpu_time", ".2f"]}))
        self.assertEqual(self.fill("<!--= row.time --><!--=-->"), "<!--= row.time -->1.25<!--=-->")
        with self.assertRaisesRegex(documents.Stale, "names no 'gone'"):
            self.fill("<!--= gone --><!--=-->")

    def test_columns_and_pivot_of_a_table(self):
        lines = ["| a\\_1 | b | c |", "|---|---|---:|", "| x | p | 1 |", "| x | q | 2 |", "| y | q | 3 |"]
        self.assertEqual(documents.with_columns(lines[:3], ["c", "a_1"]), ["| c | a\\_1 |", "| ---: | --- |", "| 1 | x |"])
        self.assertEqual(documents.pivoted(lines, "b", "c"),
                         ["| a\\_1 | p | q |", "|---|---:|---:|", "| x | 1 | 2 |", "| y |  | 3 |"])
        with self.assertRaisesRegex(documents.Stale, "no column is called d"):
            documents.with_columns(lines, ["d"])
        for filtered in (lambda: documents.with_columns([], ["a"]), lambda: documents.pivoted([], "b", "c")):
            with self.assertRaisesRegex(documents.Stale, "there is no table"):
                filtered()

    def test_a_planted_digit_is_found(self):
        mark = "<!--= rows.json benchmarks[time_unit=us].cpu_time .2f -->"
        text = self.fill(f"{mark}<!--=-->")
        self.file.write_text(text.replace("1.25", "1.26"))
        self.assertEqual(documents.check(SIXDOF), 1)

    def test_a_table(self):
        text = self.fill("<!--= sixdof table rows.json --markdown | grep exact -->\n<!--=-->")
        self.assertIn("| 05 % |", text)
        self.assertIn("1.25 |", text)
        self.assertEqual(documents.check(SIXDOF), 0)
        self.publish(ROW | {"cpu_time": 2.5})
        self.assertEqual(documents.check(SIXDOF), 1)

    @unittest.skipUnless(documents.can_draw(SIXDOF), "no Node.js, or without libraries of npm")
    def test_a_drawing(self):
        documents.DRAWINGS.write_text(json.dumps({"time.svg": ["time_distance", "rows.json"], "other.svg": ["time_distance", "gone/rows.json"]}))
        self.fill("")
        self.assertIn("<svg", (documents.PUBLISHED / "time.svg").read_text())
        self.assertFalse((documents.PUBLISHED / "other.svg").exists(), "its part is not published")
        self.assertEqual(documents.check(SIXDOF), 0)
        self.publish(ROW | {"cpu_time": 2.5})
        self.assertEqual(documents.check(SIXDOF), 1)

    def test_what_cannot_be_filled_names_document_and_mark(self):
        for mark in ("one/gone.json a", "two/gone.txt", "sixdof table one/*.json", "rows.json context.gone", "rows.json benchmarks[name=other].cpu_time",
                     "sixdof table gone.json"):
            with self.assertRaisesRegex(documents.Stale, f"README.md: <!--= {mark[:9]}"):
                self.fill(f"<!--= {mark.replace('[', '[')} --><!--=-->")

    def test_what_is_not_published_says_so(self):
        for mark in ("gone.json a", "gone.txt | head 3", "sixdof table part/*.json", "parts gone.date"):
            self.assertEqual(self.fill(f"<!--= {mark} --><!--=-->"), f"<!--= {mark} -->(not measured)<!--=-->")

    def test_parts_of_two_commits_are_refused(self):
        documents.FACTS.write_text(json.dumps({"one": {"commit": "abc"}, "two": {"commit": "def"}}))
        with self.assertRaisesRegex(documents.Stale, "2 commits: abc, def"):
            documents.check(SIXDOF)

    def test_a_part_that_is_compared_with_itself_only_may_have_its_own_commit(self):
        documents.FACTS.write_text(json.dumps({"one": {"commit": "abc"}, "rivals": {"commit": "def"}}))
        documents.one_commit()
        documents.FACTS.write_text(json.dumps({"one": {"commit": "abc"}, "two": {"commit": "ghi"}, "rivals": {"commit": "def"}}))
        with self.assertRaisesRegex(documents.Stale, "2 commits: abc, ghi"):
            documents.one_commit()

    def test_a_section_with_a_commit_of_its_own_names_it(self):
        text = (ROOT / "bench/RESULTS.md").read_text(encoding="utf-8")
        for part in documents.OWN_COMMIT:
            self.assertIn(f"<!--= parts {part}.commit -->", text)


class Run(unittest.TestCase):
    def test_only_some_rows_of_other_libraries_may_have_no_answer(self):
        row = {"name": "row", "sixdof": {}}
        failed = row | {"error_occurred": True, "sixdof": {"isolated": True}}
        own = row | {"error_occurred": True}
        missed = own | {"error_message": "3 missed, 0 wrong; the first: frame 1"}
        deforms = [missed | {"sixdof": {"query": "deform", "algorithm": name}} for name in ("fcl-refit", "exact-refit")]
        for rows, code, passes in (([row], 0, True), ([row, failed], 1, True), ([row, failed, own], 1, False),
                                   ([row, failed, deforms[0]], 1, True), ([row, deforms[1]], 1, False),
                                   ([row, deforms[0] | {"error_message": "crashed"}], 1, False), ([row, missed], 1, False),
                                   ([row], 1, False), ([row, failed], 2, False)):
            with tempfile.TemporaryDirectory() as name, self.subTest(rows=rows, code=code):
                folder = pathlib.Path(name)
                program = folder / "program"
                program.write_text(f"#!/bin/sh\necho '{json.dumps({'benchmarks': rows})}' > {folder}/rows.json\nexit {code}\n")
                program.chmod(0o755)
                step = parts.Step("rows.json", [str(program)], 0.1)
                if passes:
                    publish.run(step, folder, folder)
                else:
                    with self.assertRaisesRegex(publish.Failure, f"rows.json: exit code {code}"):
                        publish.run(step, folder, folder)


class Repository(unittest.TestCase):
    def test_figures_in_documents_are_the_published_ones(self):
        self.assertEqual(documents.check(SIXDOF), 0)

    def test_a_stale_figure_of_the_readme_is_found(self):
        """In a copy of the documents."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            text = (ROOT / "README.md").read_text(encoding="utf-8")
            mark = documents.MARK.search(text)
            (folder / "README.md").write_text(text.replace(mark.group(), f"<!--= {mark['what']} -->{mark['text']}9<!--=-->"))
            subprocess.run(["git", "init", "-q", folder], check=True)
            subprocess.run(["git", "add", "README.md"], cwd=folder, check=True)
            self.addCleanup(setattr, documents, "ROOT", documents.ROOT)
            documents.ROOT = folder
            self.assertEqual(documents.check(SIXDOF), 1)


class Short(unittest.TestCase):
    def test_rows_keep_what_tables_show_in_few_digits(self):
        row = ROW | {"cpu_time": 1.23456789, "configurations": 1991808.0, "outliers": {"a": "p"}, "checksum": "0", "nodes": 17}
        short = parts.compact({"context": {"commit": "abc", "executable": "/a/path", "checksum": "0"}, "benchmarks": [row]})
        self.assertEqual(short["context"], {"commit": "abc"})
        self.assertEqual(short["benchmarks"], [ROW | {"cpu_time": 1.235, "configurations": 1991808}])
        self.assertEqual(json.loads(parts.as_text(short)), short)

    def test_paths_are_those_of_the_repository(self):
        part = parts.Part("one", "", [parts.Step("one.txt", [], 1.0, prints=True), parts.Step("one.json", [], 1.0)])
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "one.txt").write_text(f"sixdof query --a {parts.ROOT}/results/case.off\n")
            (folder / "one.json").write_text(json.dumps({"context": {"arguments": f"--set {parts.ROOT}/fixtures/a.h5"}, "benchmarks": []}))
            written = {}
            parts.write_short(part, folder, folder, lambda file, text: written.update({file.name: text}))
        self.assertEqual(written["one.txt"], "sixdof query --a results/case.off\n")
        self.assertIn('"--set fixtures/a.h5"', written["one.json"])

    def test_commands_are_those_that_a_user_types(self):
        for part in parts.parts():
            for command in parts.commands_of(part):
                self.assertNotIn("{", command)
                self.assertRegex(command, "^(sixdof|sixdof-bench|bench/(scripts/)?[a-z]+) ")


class Steps(unittest.TestCase):
    def test_every_value_of_a_parameter_has_rows(self):
        found = 0
        for step in (step for part in parts.parts() for step in part.steps):
            words = [word for word in step.command[1:] if word not in ("-o", "{out}")]
            lists = [words[i + 1] for i, word in enumerate(words) if word == "-p" and "," in words[i + 1]]
            if not lists:
                continue
            done = subprocess.run([pathlib.Path(SIXDOF).with_name("sixdof-bench"), *words, "--benchmark_list_tests"], cwd=ROOT,
                                  check=True, capture_output=True, text=True)
            for name, values in (entry.split("=") for entry in lists):
                algorithm, parameter = name.split(":")
                for value in values.split(","):
                    found += 1
                    self.assertIn(f"/algorithm:{algorithm}@{parameter}={value}/", done.stdout)
        self.assertEqual(found, 8)

    def test_what_broke_off_is_continued(self):
        steps = [step for part in parts.parts() for step in part.steps if step.resumes]
        self.assertIn("equivalent.json", [step.file for step in steps])
        for step in steps:
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                for begun in (False, True):
                    words = " ".join(publish.command_of(step, folder, folder))
                    self.assertEqual("--resume" in words, begun, words)
                    self.assertIn(str(folder / step.file), words)
                    (folder / (step.file + ".journal")).touch()

    def test_short_results_keep_the_counters_of_their_tables(self):
        fields = {"pair", "percent", "bodies", "algorithm", "time_us", "p50_us", "faults"}
        found = 0
        for mark in documents.MARK.finditer((ROOT / "bench/RESULTS.md").read_text(encoding="utf-8")):
            table, _, columns = mark["what"].partition(" | columns ")
            if re.match("report (contacts|depths) ", table):
                found += 1
                self.assertLessEqual(set(columns.split()) - fields, set(parts.KEPT))
        self.assertEqual(found, 3)

    def test_measurements_are_not_published(self):
        short = parts.compact({"context": {}, "benchmarks": [], "measurements": [1], "paper": [{"printed": 2.4}]})
        self.assertEqual(short, {"context": {}, "benchmarks": [], "paper": [{"printed": 2.4}]})


class Plan(unittest.TestCase):
    def test_lists_every_part(self):
        printed = subprocess.run([ROOT / "bench/publish", "--help"], check=True, capture_output=True, text=True).stdout
        for part in parts.parts():
            self.assertIn(part.name, printed)
        wrong = subprocess.run([ROOT / "bench/publish", "gone"], check=False, capture_output=True, text=True)
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("no part is called gone", wrong.stderr)


if __name__ == "__main__":
    unittest.main()
