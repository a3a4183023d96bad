"""Every kind of file and folder that the programs write: the words that write it.

The programs are the first two arguments of the test.
"""

import pathlib
import shutil
import sys

SIXDOF, SIXDOF_BENCH = sys.argv[1:3]

A = "OFF\n4 4 6\n0 0 0\n1 0.1 0\n-0.2 1.3 0.3\n0.1 -0.3 0.9\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"
OPEN = "OFF\n4 3 6\n0 0 0\n1 0.1 0\n-0.2 1.3 0.3\n0.1 -0.3 0.9\n3 0 2 1\n3 0 1 3\n3 1 2 3\n"
GRID = ["--a", "a.off", "--b", "a.off", "--grid", "90/60", "--distances", "0,5", "--volumes", "1"]
BENCH = ["--a", "a.off", "--b", "a.off", "--benchmark_filter=^collide/algorithm:exact/", "--benchmark_min_time=0.001",
         "--sample", "8"]
STUDY = ["--a", "a.off", "--b", "a.off", "--algorithms", "exact", "--budget", "1s"]
# A query whose preparation is kept in the cache.
CACHED = [SIXDOF, "query", "--a", "a.off", "--b", "a.off", "--pose", "0.3 0.2 0.1 1 0 0 0", "--algorithm", "vps-field",
          "-p", "voxel_size=0.1", "-p", "point_spacing=0.1"]


class Kind:
    """A kind of file or folder: the words that write it, and how its content is judged."""

    def __init__(self, name, file, words, times=False, program=SIXDOF, replaces=True, resume=()):
        self.name, self.file, self.words = name, file, words
        self.times = times  # are in the file, so that two runs differ
        self.program = program
        self.replaces = replaces  # what is there already under that name
        self.resume = resume  # words that complete a folder

    def command(self, file=None):
        return [self.program, *[(file or self.file) if word == "OUT" else word for word in self.words]]


KINDS = [
    Kind("mesh, PLY", "x.ply", ["models", "make", "cone-1k", "-o", "OUT"]),
    Kind("mesh, OBJ", "x.obj", ["models", "make", "cone-1k", "-o", "OUT"]),
    Kind("mesh, OFF", "x.off", ["models", "make", "cone-1k", "-o", "OUT"]),
    Kind("mesh, STL", "x.stl", ["models", "make", "cone-1k", "-o", "OUT"]),
    Kind("repaired mesh", "x.ply", ["repair", "open.off", "-o", "OUT"]),
    Kind("drawing of a structure", "x.ply",
         ["show", "--algorithm", "vps", "--model", "cone-1k", "-p", "voxel_size=0.1", "-o", "OUT"]),
    Kind("set", "x.h5", ["generate", *GRID, "-o", "OUT"]),
    Kind("merged set", "x.h5", ["merge", "shards", "-o", "OUT"]),
    Kind("shard of a survey", "x.json", ["survey", "asked.h5", "--algorithm", "exact", "-o", "OUT"], times=True),
    Kind("series of a scenario", "x.h5",
         ["quality", "--scenario", "Ia", "--algorithm", "exact", "--steps", "60", "-o", "OUT"], times=True),
    Kind("rows of precision", "x.json", ["precision", "--question", "distance", *STUDY, "-o", "OUT"], times=True),
    Kind("rows of equivalent", "x.json",
         ["equivalent", "--scenario", "II", "--algorithm", "vps", "--tau", "10us", "--steps", "60", "--grid",
          "voxel_size=0.1,0.07,0.05", "--grid", "point_spacing=0.1,0.07,0.05", "-o", "OUT"], times=True, replaces=False),
    Kind("cells of stress", "x.json",
         ["stress", "--algorithms", "exact", "--families", "kissing", "--cases", "cases", "-o", "OUT"], times=True),
    Kind("findings of conform", "x.json",
         ["conform", "--algorithm", "brute-force", "--checks", "Declaration", "--json", "OUT"]),
    Kind("page of results", "x.html", ["report", "results.json", "-o", "OUT"]),
    Kind("page of history", "x.html", ["history", "runs", "-o", "OUT"]),
    Kind("results", "x.json",
         [*BENCH, "--out", "OUT"], times=True, program=SIXDOF_BENCH, replaces=False),
]
# Without the libraries that the build takes from npm no page is written, and no figure.
CAN_DRAW = (pathlib.Path(SIXDOF).resolve().parents[1] / "share/sixdof/report/vendor/vega.min.js").exists()
if not CAN_DRAW:
    KINDS = [kind for kind in KINDS if not kind.name.startswith("page of ")]
FOLDERS = [
    Kind("shards", "made", ["generate", *GRID, "--shards", "3", "-o", "OUT"], replaces=False, resume=["--resume"]),
    Kind("project of an algorithm", "project", ["new-algorithm", "mine", "-o", "OUT"], replaces=False),
    Kind("tables of results", "tables", ["report", "results.json", "--csv", "OUT"]),
]
if CAN_DRAW and shutil.which("node"):
    FOLDERS.append(Kind("figures of results", "figures", ["report", "results.json", "--svg", "OUT"]))
