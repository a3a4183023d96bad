"""bench/speedups: its arithmetic on synthetic rows, what it refuses, and a real run on the small sets of the tests.

usage: speedups_test.py SIXDOF_BENCH MANIFEST
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "bench" / "speedups"
SIXDOF_BENCH, MANIFEST = sys.argv[1:3]
del sys.argv[1:3]
CONTEXT = {"cpu_model": "Fast CPU", "num_cpus": 2, "commit": "0123456789abcdef",
           "commit_dirty": "true", "fcl_build": "FCL 9"}

# Instead of sixdof-bench: writes the rows of its seed, and its arguments beside them.
PROGRAM = """\
    #!/usr/bin/python3
    import json, pathlib, sys
    here = pathlib.Path(__file__).parent
    words = sys.argv[1:]
    seed = words[words.index("--seed") + 1]
    out = next(word.split("=")[1] for word in words if word.startswith("--benchmark_out="))
    (here / "arguments").write_text(json.dumps(words))
    document = json.loads((here / "rows.json").read_text())[int(seed) - 1]
    pathlib.Path(out).write_text(json.dumps(document))
    if any(row.get("error_occurred") for row in document["benchmarks"]):
        sys.exit("some rows have errors")
"""


def row(algorithm, us, pair="knot", query="distance", kind="distance", percent=5, **more):
    name = f"{query}/algorithm:{algorithm}/pair:{pair}/{kind}:{percent:02}"
    fields = {"query": query, "algorithm": algorithm, "pair": pair, "bucket": {"kind": kind, "percent": percent}}
    return {"name": name, "cpu_time": us, "time_unit": "us", "failed": 0, "mismatch": 0, "sixdof": fields} | more


class Speedups(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def speedups(self, *words):
        return subprocess.run([sys.executable, "-B", str(SCRIPT), *map(str, words)], capture_output=True, text=True,
                              check=False, cwd=self.folder)

    def on_rows(self, seeds, *words):
        """With the given rows of each seed instead of measured ones."""
        program = self.folder / "program"
        program.write_text(textwrap.dedent(PROGRAM))
        program.chmod(0o755)
        documents = [{"context": CONTEXT, "benchmarks": rows} for rows in seeds]
        (self.folder / "rows.json").write_text(json.dumps(documents))
        return self.speedups("--program", program, "--pairs", "knot", "--query", "distance", "--seeds", len(seeds),
                             *words)

    def refuses(self, done, code, *words):
        self.assertEqual((done.returncode, done.stdout), (code, ""), done.stderr)
        last = done.stderr.splitlines()[-1]
        for word in words:
            self.assertIn(word, last)

    def test_takes_the_fastest_other_of_each_seed(self):
        # Ratios 20, 30 and 12: the median of the ratios is not that of the times.
        done = self.on_rows([
            [row("exact", 10), row("fcl-a", 200), row("fcl-b", 300)],
            [row("exact", 10), row("fcl-a", 400), row("fcl-b", 0.3, time_unit="ms")],
            [row("exact", 20), row("fcl-a", 240e3, time_unit="ns"), row("fcl-b", 300),
             row("exact", 1, run_type="aggregate")],
        ], "--sample", 7, "--out", "kept/results", "--", "--set", "my.h5")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.splitlines()[2:], [
            "| `knot` | distance | distance 5 % | 10 | 240 | fcl-a, fcl-b | 20.0 | 12.0..30.0 |",
            "",
            "3 seeds; up to 7 configurations per bucket and seed; Fast CPU, 2 processors; "
            "sixdof 0123456789ab (modified); FCL: FCL 9.",
        ])
        self.assertEqual(sorted(file.name for file in (self.folder / "kept/results").iterdir()),
                         ["seed-1.json", "seed-2.json", "seed-3.json"])
        arguments = json.loads((self.folder / "arguments").read_text())
        self.assertEqual(arguments[-2:], ["--set", "my.h5"])
        self.assertEqual(arguments[arguments.index("--sample") + 1], "7")
        rows = re.compile(arguments[0].removeprefix("--benchmark_filter="))
        self.assertTrue(rows.search("distance/algorithm:fcl-any/pair:knot/volume:0.5"))
        for other in ("distance/algorithm:null/pair:knot/volume:05", "collide/algorithm:exact/pair:knot/volume:05",
                      "distance/algorithm:exact/pair:knots/volume:05",
                      "distance/algorithm:exact/pair:knot/volume:05/order:path"):
            self.assertFalse(rows.search(other), other)

    def test_has_no_table_with_a_fault(self):
        good = [row("exact", 10), row("fcl-a", 200)]
        for fault, words in (({"failed": 3}, "3 configurations without an answer"),
                             ({"mismatch": 1}, "1 configurations wrong"),
                             ({"misses": 2}, "2 configurations without a force"),
                             ({"error_occurred": True, "error_message": "no memory"}, "no memory")):
            done = self.on_rows([good, [row("exact", 10), row("fcl-a", 200, **fault)]])
            self.refuses(done, 1, "seed 2: distance/algorithm:fcl-a/pair:knot/distance:05: " + words)

    def test_names_what_has_no_rows(self):
        rows = [row("exact", 10), row("fcl-a", 200), row("exact", 10, pair="alone")]
        for words, missing in ((["--pairs", "knot,alone"], "alone"), (["--query", "distance,collide"], "collide"),
                               (["--buckets", "distance:05,distance:10"], "distance:10")):
            self.refuses(self.on_rows([rows], *words), 1, f"no rows of {missing} ")

    def test_refuses_words_that_are_none(self):
        for words in (["--seeds", 0], ["--sample", "-4"], ["--query", "touch"], ["--buckets", "05"], ["--pairs", "a|b"],
                      ["--algorithm", "(exact"], ["--against", ""]):
            self.refuses(self.on_rows([[]], *words), 2, words[0])
        self.refuses(self.speedups("--pairs", "knot", "--program", "not-there"), 1, "not-there")

    def test_measures(self):
        def real(*words):
            return self.speedups("--program", SIXDOF_BENCH, "--pairs", "torus-1k", "--sample", 32, *words,
                                 "--", "--manifest", MANIFEST, "--benchmark_min_time=0.000001")

        done = real("--seeds", 2, "--out", "results", "--buckets", "distance:05,volume:03")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = [[cell.strip() for cell in line.strip("|").split("|")]
                 for line in done.stdout.splitlines() if "torus" in line]
        self.assertEqual([line[1:3] for line in lines], [["distance", "distance 5 %"], ["collide", "distance 5 %"],
                                                         ["collide", "volume 3 %"]])
        for line in lines:
            least, greatest = map(float, line[7].split(".."))
            self.assertTrue(0 < least <= float(line[6]) <= greatest, line)
        documents = [json.loads((self.folder / "results" / f"seed-{seed}.json").read_text()) for seed in (1, 2)]
        self.assertEqual([document["context"]["seed"] for document in documents], ["1", "2"])
        names = {entry["name"] for entry in documents[0]["benchmarks"]}
        self.assertIn("distance/algorithm:fcl-rss/pair:torus-1k/distance:05", names)
        ratios = []
        for document in documents:
            times = {entry["name"].split("/")[1]: entry["cpu_time"] for entry in document["benchmarks"]
                     if entry["name"].startswith("distance/")}
            exact = times.pop("algorithm:exact")
            ratios.append(min(times.values()) / exact)
        self.assertAlmostEqual(float(lines[0][6]), sum(ratios) / 2, delta=0.06 * max(1, ratios[0]))
        self.assertIn("FCL: ", done.stdout)

        self.refuses(real("--seeds", 1, "--against", "fcl-nothing"), 1, "fcl-nothing")
        self.refuses(real("--seeds", 1, "--buckets", "distance:42"), 1, "sixdof-bench")


if __name__ == "__main__":
    unittest.main()
