#!/usr/bin/env python3
"""fixtures/read_set.py: the poses that it computes have the distance and the volume of their bucket.

usage: read_set_test.py SIXDOF READ_SET
"""
import json
import os
import re
import subprocess
import sys
import tempfile

A, B = "bumpy-sphere-200", "torus-knot-600"
TOLERANCE = 1e-8  # of the meshes' size, about 3; sets promise 1e-9 of A's diagonal and volume


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def main():
    sixdof, example = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "set.h5")
        run(sixdof, "generate", "--a", A, "--b", B, "--grid", "60", "--volume-grid", "60/90", "--distances", "5",
            "--volumes", "2", "-o", path)
        info = json.loads(run(sixdof, "info", path, "--json"))
        targets = {bucket["bucket"]: bucket["target"] for bucket in info["buckets"]}
        for bucket, measure in (("distance/05", "distance"), ("volume/02", "volume")):
            for where in ([], ["--rotation", "31", "--direction", "5"]):
                out = run(sys.executable, "-B", example, path, bucket, *where)
                command = re.search(r"^sixdof query .*$", out, re.MULTILINE).group(0)
                programs = f"{os.path.dirname(sixdof)}:{os.environ['PATH']}"
                answer = json.loads(subprocess.run(command + " --json", shell=True, check=True, capture_output=True, text=True,
                                                   env={**os.environ, "PATH": programs}).stdout)
                error = abs(answer[measure] - targets[bucket])
                assert error <= TOLERANCE, f"{bucket} {where}: {answer[measure]} instead of {targets[bucket]}\n{out}"
                assert f"{A} with {B}" in out and (not where or "rotation 31, direction 5" in out), out


if __name__ == "__main__":
    main()
