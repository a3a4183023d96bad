#!/usr/bin/env python3
"""Which algorithm for my meshes? Asks those that answer distances, and prints time, failures and largest error of each.

usage: choose_algorithm.py [A B]    meshes: files or names of models
"""

import sys
import time

import sixdof

a, b = map(sixdof.load, sys.argv[1:3] or ("gyroid-ball-2k", "torus-knot-2k"))
poses = sixdof.pose([0.36, 0.48, 0.0, 0.8], [[0.1, 0.2, 0.5 * (a.diagonal + b.diagonal) * k / 200] for k in range(100, 200)])
truth = sixdof.prepare("exact", a, b).distance(poses).distance

print(f"{'algorithm':<16} {'us/query':>9} {'failed':>7} {'largest error':>14}")
for name, info in sixdof.algorithms().items():
    if "distance" not in info.answers or info.body != "mesh" or name in ("null", "brute-force") or info.runtime:
        continue
    pair = sixdof.prepare(name, a, b)
    start = time.perf_counter()
    answers = pair.distance(poses)
    took = (time.perf_counter() - start) / len(poses)
    print(f"{name:<16} {took * 1e6:9.1f} {(~answers.ok).sum():7d} {abs(answers.distance - truth).max():14.2e}")
