#!/usr/bin/env python3
"""fixtures/scene_file.py: a scene that it reads and writes is the same, and one that it makes is played.

usage: scene_file_test.py SIXDOF SCENE_FILE
"""
import json
import os
import subprocess
import sys
import tempfile


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def info(sixdof, path):
    return json.loads(run(sixdof, "scene", "info", path, "--json"))


def main():
    sixdof, script = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        first, copy, made = (os.path.join(folder, name) for name in ("a.h5", "b.h5", "c.h5"))
        for family in ("robot", "still"):
            run(sixdof, "scene", "make", family, "-n", "40", "--frames", "4", "-o", first)
            out = run(sys.executable, "-B", script, first, copy)
            assert "40 bodies" in out and "4 frames" in out, out
            before, after = info(sixdof, first), info(sixdof, copy)
            assert before == after and len(before["hash"]) == 32, (before, after)
        run(sixdof, "scene", "make", "wave", "--triangles", "300", "--frames", "4", "-o", first)
        run(sys.executable, "-B", script, first, copy)
        before, after = info(sixdof, first), info(sixdof, copy)
        assert before == after and before["shapes"] == 3, (before, after)
        run(sys.executable, "-B", script, "--example", made)
        played = json.loads(run(sixdof, "scene", "play", made, "--algorithms", "exact", "--question", "touching,near",
                                "--json"))
        # Its lowest corner is in the plane x + y + z = 1 of the fixed one at z = 0.8, and within 0.05 of it from
        # z = 0.8 + 0.05 * sqrt(3) on. It is at 0.85, 0.75 and 0.65 in the last frames.
        assert [part["true_pairs"] for part in played] == [2, 3], played
        assert all(part["algorithms"][0]["same_bits"] for part in played), played
        wrong = subprocess.run([sys.executable, "-B", script], capture_output=True, text=True)
        assert wrong.returncode == 1 and "usage" in wrong.stderr, wrong


if __name__ == "__main__":
    main()
