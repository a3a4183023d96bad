#!/usr/bin/env python3
"""An algorithm outside of C++: the boxes' bounding spheres. lib/sixdof/process/README.md describes the protocol.

usage: sixdof query --a cone-1k --b torus-1k --pose '0.9 0 0.1 1 0 0 0' --external 'spheres=python3 example.py' --algorithm spheres
"""

import array
import json
import math
import sys
import time


def sphere(mesh):
    """Centre and radius of the sphere around a mesh's bounding box."""
    with open(mesh["vertices"], "rb") as file:
        numbers = array.array("d", file.read())
    low, high = [[pick(numbers[i::3]) for i in range(3)] for pick in (min, max)]
    return [(l + h) / 2 for l, h in zip(low, high)], math.dist(low, high) / 2


def answer(query, pose):
    if any(isinstance(number, str) for number in pose):  # "nan" or "inf"
        return {"status": "non_finite", "words": "the pose is not finite"}
    (center_a, radius_a), (center_b, radius_b) = spheres
    moved = [math.fsum(pose[3 * i + k] * center_b[k] for k in range(3)) + pose[9 + i] for i in range(3)]
    gap = max(0.0, math.dist(moved, center_a) - radius_a - radius_b)
    return {"distance": gap} if query == "distance" else {"collide": gap == 0.0}


spheres = None
for line in sys.stdin:
    request = json.loads(line)
    start = time.perf_counter_ns()
    if request["do"] == "hello":
        reply = {"protocol": 1, "name": "spheres", "version": "1.0", "answers": ["collide", "distance"]}
    elif request["do"] == "prepare":
        spheres = [sphere(request["a"]), sphere(request["b"])]
        reply = {"prepared": True}
    else:
        reply = answer(request["query"], request["pose"])
        reply["ns"] = time.perf_counter_ns() - start
    print(json.dumps(reply), flush=True)
