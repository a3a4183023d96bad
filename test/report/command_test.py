"""`sixdof report` and `sixdof history` as typed: tables and figures as files, refusals, nothing half-written.

usage: command_test.py SIXDOF
"""

import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from sample_results import HOSTILE, STRESS, cast_rows, collection, contact_rows, row, rows, scene_rows  # noqa: E402

SIXDOF = sys.argv.pop(1)


class Report(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "run.json").write_text(json.dumps({"context": {"seed": "1"}, "benchmarks": rows()}))
        (self.folder / "stress.json").write_text(json.dumps(STRESS))

    def run_it(self, *words, **environment):
        return subprocess.run([SIXDOF, *words], capture_output=True, text=True, check=False, cwd=self.folder, env=os.environ | environment)

    def need_libraries(self, done):
        if done.returncode != 0 and "cmake/setup report" in done.stderr:
            self.skipTest(done.stderr)

    def refused(self, *words, **environment):
        done = self.run_it(*words, **environment)
        self.assertEqual(done.returncode, 1, words)
        self.assertEqual(done.stdout, "")
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        return done.stderr

    def test_csv_has_the_values_of_the_rows(self):
        done = self.run_it("report", "run.json", "stress.json", "--csv", "tables")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))
        with open(self.folder / "tables" / "times.csv", newline="", encoding="utf-8") as file:
            lines = list(csv.DictReader(file))
        [line] = [line for line in lines if (line["algorithm"], line["pair"], line["query"], line["percent"], line["statistic"]) ==
                  ("ist", "elephant", "distance", "5", "mean")]
        self.assertEqual(float(line["time_us"]), 0.5)
        self.assertIn("sixdof-bench '--benchmark_filter=^distance/algorithm:ist/pair:elephant/distance:5$' --sample 64 --seed 1", line["command"])
        with open(self.folder / "tables" / "stability.csv", newline="", encoding="utf-8") as file:
            self.assertEqual([line["verdict"] for line in csv.DictReader(file)][:2], ["exact", "within declared resolution"])
        self.assertNotIn("signals.csv", os.listdir(self.folder / "tables"), "a table without lines is no file")

    def test_markdown_has_no_markup_of_the_results(self):
        self.assertEqual(self.run_it("report", "run.json", "--markdown", "tables").returncode, 0)
        text = (self.folder / "tables" / "winners.md").read_text()
        self.assertRegex(text, r"### The fastest right algorithm of each place\n\n\| run \|")
        self.assertRegex(text, r"\| distance \| random \| elephant \| distance 5 % \| exact \| 0\.166667 \| vps \| 2 \| clear \|")
        self.assertNotIn("<img", (self.folder / "tables" / "failures.md").read_text())
        self.assertIn("&lt;img", (self.folder / "tables" / "failures.md").read_text())

    def test_svg_figures_have_axes_marks_and_legends(self):
        if not shutil.which("node"):
            self.skipTest("no node here")
        done = self.run_it("report", "run.json", "stress.json", "--svg", "figures")
        self.need_libraries(done)
        self.assertEqual(done.returncode, 0, done.stderr)
        names = sorted(os.listdir(self.folder / "figures"))
        for name in ("time_distance.svg", "time_volume.svg", "frontier.svg", "stability.svg", "response_errors.svg", "winners.svg"):
            self.assertIn(name, names)
        self.assertEqual([name for name in names if not name.endswith(".svg")], [])
        for name in names:
            xml.etree.ElementTree.parse(self.folder / "figures" / name)
        text = (self.folder / "figures" / "time_distance.svg").read_text()
        for words in ("Time against distance", "time of a query, µs", "distance of the bodies", "exact", "vps", "ist"):
            self.assertIn(words, text)
        self.assertEqual(len(re.findall(r"mark-line role-mark", text)), 4, "a line for each algorithm")
        self.assertNotIn("[1]", text, "one file needs no name")
        self.assertNotIn("<img", text)
        self.assertIn("role-legend", (self.folder / "figures" / "frontier.svg").read_text())

    def test_choices_of_a_figure_are_set(self):
        if not shutil.which("node"):
            self.skipTest("no node here")
        done = self.run_it("report", "run.json", "--svg", "figures", "--choose", "pair=elephant", "--choose", "statistic=longest")
        self.need_libraries(done)
        self.assertEqual(done.returncode, 0, done.stderr)
        text = (self.folder / "figures" / "time_distance.svg").read_text()
        self.assertIn("elephant, longest", text)
        done = self.run_it("report", "run.json", "--svg", "others", "--choose", "axis_x=p99_ns", "--choose", "axis_y=max_ns")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("99 % of the queries take no longer", (self.folder / "others" / "metrics.svg").read_text())
        refused = self.refused("report", "run.json", "--svg", "no", "--choose", "pair=horse")
        self.assertIn("--choose pair=horse: no figure offers it, but", refused)
        self.assertIn("elephant; all objects (mean)", refused)
        refused = self.refused("report", "run.json", "--svg", "no", "--choose", "pair=horse" + 1000 * "e")
        self.assertIn("--choose pair=horseeee", refused, "the beginning of a long message")
        self.assertTrue(refused.endswith("...\n"), refused)
        self.assertIn("no figure has this choice, but", self.refused("report", "run.json", "--svg", "no", "--choose", "colour=red"))
        self.assertIn("not COLUMN=VALUE", self.refused("report", "run.json", "--svg", "no", "--choose", "red"))
        self.assertEqual(os.listdir(self.folder / "no") if (self.folder / "no").exists() else [], [])

    def figures(self, option, *words):
        """Texts of the figures that a command writes, by name."""
        if not shutil.which("node"):
            self.skipTest("no node here")
        folder = self.folder / "of-command"
        shutil.rmtree(folder, ignore_errors=True)
        done = self.run_it("report", "run.json", "stress.json", option, str(folder), *words)
        self.need_libraries(done)
        self.assertEqual(done.returncode, 0, done.stderr)
        return {path.name: path.read_text() for path in folder.iterdir()}

    def test_figures_have_the_width_and_font_of_a_paper(self):
        for width, pixels in (("84mm", 84 / 25.4 * 96), ("3.3in", 3.3 * 96), ("320px", 320)):
            for name, text in self.figures("--svg", "--width", width, "--font", "DejaVu Serif", "--no-title").items():
                root = xml.etree.ElementTree.fromstring(text)
                self.assertEqual(root.get("width"), width, name)
                self.assertAlmostEqual(float(root.get("viewBox").split()[2]), pixels, delta=1, msg=name)
                self.assertAlmostEqual(float(root.get("height")[:-2]) / float(width[:-2]), float(root.get("viewBox").split()[3]) / pixels, delta=0.01)
                texts = [each for each in root.iter("{http://www.w3.org/2000/svg}text") if each.text]
                self.assertEqual({each.get("font-family") for each in texts}, {"DejaVu Serif"}, name)
                self.assertGreaterEqual(min(float(each.get("font-size")[:-2]) for each in texts), 10, f"{name}: 7.5 points")
                self.assertNotIn("role-title-text", text, name)
        self.assertIn("Time against distance", self.figures("--svg", "--width", "84mm")["time_distance.svg"])

    def test_tikz_has_the_numbers_of_the_curves(self):
        files = self.figures("--tikz", "--width", "84mm", "--choose", "pair=elephant")
        self.assertNotIn("stability.tex", files, "neither lines nor points")
        text = files["time_distance.tex"]
        self.assertIn("width=8.40cm", text)
        self.assertEqual(re.findall(r"\\addlegendentry\{(\w+)\}", text), ["ist", "vps", "exact"], "and one with a name that LaTeX would run")
        self.assertIn("\\textless{}/script", text)
        of_exact = re.findall(r"\{(time_distance-\d\.dat)\}", text)[-1]
        lines = [line.split() for line in files[of_exact].splitlines()[2:]]
        self.assertEqual([(float(x), float(y)) for x, y, *_ in lines], [(0, 1), (1, 0.5), (5, 0.166667), (10, 0.0909091)])
        for name, document in files.items():
            if name.endswith(".tex"):
                self.assertEqual(set(re.findall(r"\{([\w-]+\.dat)\}", document)), {each for each in files if each.startswith(name[:-4] + "-") and each.endswith(".dat")})
        if not shutil.which("pdflatex") or not shutil.which("kpsewhich") or not subprocess.run(["kpsewhich", "pgfplots.sty"], capture_output=True, check=False).stdout:
            return
        for name in ("time_distance", "winners", "frontier"):
            done = subprocess.run(["pdflatex", "-interaction=batchmode", "-halt-on-error", name], cwd=self.folder / "of-command", capture_output=True, check=False)
            self.assertEqual(done.returncode, 0, name)

    def test_looks_that_are_none_are_refused(self):
        self.assertIn("are about --svg, --pdf and --tikz", self.refused("report", "run.json", "-o", "x.html", "--width", "84mm"))
        self.assertIn("are about --svg, --pdf and --tikz", self.refused("report", "run.json", "--csv", "x", "--no-title"))
        if not shutil.which("node"):
            self.skipTest("no node here")
        for width in ("84", "mm", "-5mm", "1mm", "9e9px", "nanmm", "84 mm", "84mmx"):
            refused = self.refused("report", "run.json", "--svg", "no", f"--width={width}")
            if "cmake/setup report" not in refused:
                self.assertIn(f"--width {width}: not a width", refused)

    def test_csv_has_outliers_scenes_and_the_collection(self):
        (self.folder / "more.json").write_text(json.dumps({"context": {}, "benchmarks": [*scene_rows(), *cast_rows(), *contact_rows()], **collection()}))
        self.assertEqual(self.run_it("report", "run.json", "more.json", "--csv", "tables").returncode, 0)

        def lines(name):
            with open(self.folder / "tables" / f"{name}.csv", newline="", encoding="utf-8") as file:
                return list(csv.DictReader(file))
        [line] = [line for line in lines("times") if (line["algorithm"], line["pair"], line["query"], line["percent"], line["statistic"]) ==
                  ("ist", "elephant", "distance", "5", "longest")]
        self.assertEqual(line["worst_pose"], "sixdof query --a torus-1k --b torus-1k --algorithm 'ist' --pose \"5.123456789012345 0 0 1 0 0 0\"")
        self.assertEqual({line["scene"] for line in lines("many_bodies")}, {"pile", HOSTILE})
        [line] = [line for line in lines("casts") if (line["algorithm"], line["pair"], line["motion"], line["step"]) ==
                  ("fcl-cast", "elephant", "tumble", "0.01 %")]
        self.assertEqual((line["missed_hits"], line["missed_percent"], line["faults"]), ("6", "12.5", "6 of 64 wrong"))
        self.assertIn("^cast/algorithm:fcl-cast/pair:elephant/motion:tumble/step:0.01$", line["command"])
        [line] = [line for line in lines("contacts") if (line["algorithm"], line["pair"], line["percent"]) == ("fcl-contacts", "elephant", "5")]
        self.assertEqual((line["reversed_normals"], line["contact_depth_ratio"]), ("3", "0.8"))
        [line] = [line for line in lines("depths") if (line["algorithm"], line["pair"], line["percent"]) == ("fcl-contacts", "elephant", "5")]
        self.assertEqual((line["too_shallow"], line["open_depths"]), ("10", "2"))
        self.assertNotIn("cast", {line["query"] for line in lines("times")})
        self.assertEqual({line["part"] for line in lines("deforming")}, {"update and query", "update", "query"})
        self.assertEqual({line["rebuild_wins_from"] for line in lines("refit_payoff")}, {"never"})
        self.assertEqual(float(lines("collection")[0]["p90_us"]), 90.0)
        self.assertIn("bed", {line["point"] for line in lines("collection_ratios")})
        self.assertEqual(float(lines("growth_exponents")[0]["low"]), 0.35)
        self.assertIn("gamma_F_deg", lines("metrics")[0])

    def test_pdf_figures_are_pdf(self):
        if not shutil.which("node") or not shutil.which("rsvg-convert"):
            self.skipTest("no node or rsvg-convert here")
        done = self.run_it("report", "stress.json", "--pdf", "figures")
        self.need_libraries(done)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(os.listdir(self.folder / "figures"), ["stability.pdf"])
        data = (self.folder / "figures" / "stability.pdf").read_bytes()
        self.assertTrue(data.startswith(b"%PDF-"))
        self.assertGreater(len(data), 5000)
        pieces = [zlib.decompress(piece) for piece in re.findall(rb"/FlateDecode.*?stream\r?\n(.*?)\r?\nendstream", data, re.DOTALL)[:-1]]
        self.assertTrue(any(b"/FontFile" in piece for piece in [data, *pieces]), "fonts are in the file")

    def test_what_cannot_be_done_is_refused_in_a_line(self):
        self.assertIn("-o, --csv, --markdown, --svg, --pdf or --tikz is needed", self.refused("report", "run.json"))
        self.assertIn("a result file or --series is needed", self.refused("report", "-o", "x.html"))
        self.assertIn("absent.json: cannot be opened", self.refused("report", "absent.json", "-o", "x.html"))
        (self.folder / "other.json").write_text('{"a": 1}')
        self.assertIn("other.json: neither a result of sixdof-bench", self.refused("report", "run.json", "other.json", "-o", "x.html"))
        self.assertIn("run.json: ", self.refused("report", "--series", "run.json", "-o", "x.html"))
        self.assertIn("is missing", self.refused("report", "run.json", "-o", "x.html", SIXDOF_DATA=str(self.folder)))
        # Whichever is found missing first, node or a library.
        self.assertIn("cmake/setup report", self.refused("report", "run.json", "--svg", "figures", PATH="/nowhere"))
        self.assertEqual(sorted(os.listdir(self.folder)), ["other.json", "run.json", "stress.json"])

    def test_history_has_a_line_for_each_row_and_file(self):
        runs = self.folder / "runs"
        runs.mkdir()
        for k in range(8):
            result = {"context": {"date": f"2026-01-{k + 1:02}", "commit": f"{k}"},
                      "benchmarks": [row("distance", "exact", "elephant", "distance", 5, 1000.0 if k < 4 else 2000.0),
                                     row("distance", HOSTILE, "elephant", "distance", 5, 1000.0)]}
            (runs / f"{k}.json").write_text(json.dumps(result))
        done = self.run_it("history", "runs", "-o", "history.html")
        self.need_libraries(done)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = (self.folder / "history.html").read_text()
        data = json.loads(re.search(r'<script id="report-data" type="application/json">(.*?)</script>', page, re.DOTALL).group(1))
        self.assertEqual(len(data["tables"]["history"]["rows"]), 16)
        self.assertIn("Changes of level over all rows: 1", data["summary"][1])

    def test_history_of_nothing_is_refused(self):
        (self.folder / "empty").mkdir()
        self.assertIn("empty: has no result of sixdof-bench", self.refused("history", "empty", "-o", "x.html"))
        self.assertIn("absent: cannot be read", self.refused("history", "absent", "-o", "x.html"))


if __name__ == "__main__":
    unittest.main()
