#!/usr/bin/env python3
"""Plots a result: mean time of a distance query by distance, one line of the figure per algorithm.

usage: plot_result.py [RESULT.json [FIGURE.svg]]    without a result: measures one first; without matplotlib: prints it
"""

import sys

import sixdof

if len(sys.argv) > 1:
    rows = sixdof.read_rows(sys.argv[1])
else:
    measured = sixdof.bench(["exact", "fcl-rss"], pairs=["torus-knot-10k"], queries=["distance"], sample=64, budget=10)
    rows = measured.rows
lines = {}
for row in rows:
    if row["query"] == "distance" and row["bucket_kind"] == "distance" and not row["error"]:
        lines.setdefault(row["algorithm"], []).append((row["percent"], row["processor_mean_ns"] / 1000))

try:
    from matplotlib import pyplot
except ImportError:
    for algorithm, points in lines.items():
        print(algorithm, " ".join(f"{percent:g} %: {us:.1f} us" for percent, us in sorted(points)))
else:
    for algorithm, points in lines.items():
        pyplot.plot(*zip(*sorted(points)), marker="o", label=algorithm)
    pyplot.xlabel("distance, % of A's diagonal")
    pyplot.ylabel("mean time of a query, us")
    pyplot.yscale("log")
    pyplot.legend()
    pyplot.savefig(sys.argv[2] if len(sys.argv) > 2 else "result.svg")
