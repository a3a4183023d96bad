#!/usr/bin/env python3
"""fixtures/set_manifest.py: its commands make the sets again, byte for byte, and --check finds what differs.

usage: set_manifest_test.py SIXDOF SET_MANIFEST
"""
import json
import pathlib
import shlex
import subprocess
import sys
import tempfile

JOBS = {
    "both": "--a bumpy-sphere-200 --b torus-knot-600 --grid 90 --volume-grid 90/60 --distances 5,0:2 --volumes 2",
    "distances": "--a torus-knot-600 --grid so3:5:4 --distances 7 --method advance --oracle exact",
    "portable": "--a mesh.ply --grid 90 --distances 3 --no-absolute-paths",
    "volumes": "--a bumpy-sphere-200 --grid 90 --volumes 0.5,1:3,2.5",
}


def main():
    sixdof, script = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as name:
        folder, again = pathlib.Path(name, "sets"), pathlib.Path(name, "again")
        folder.mkdir()
        again.mkdir()

        def manifest(*options):
            return subprocess.run([sys.executable, "-B", script, "--program", sixdof, *options, str(folder)],
                                  capture_output=True, text=True)

        for place in (folder, again):
            subprocess.run([sixdof, "models", "make", "torus-200", "-o", str(place / "mesh.ply")], check=True, capture_output=True)
        for stem, job in JOBS.items():
            subprocess.run([sixdof, "generate", *job.split(), "-o", str(folder / f"{stem}.h5")], check=True, cwd=folder,
                           capture_output=True)
        assert manifest().returncode == 0
        sets = json.loads((folder / "manifest.json").read_text())["sets"]
        assert [entry["pair"] for entry in sets] == sorted(JOBS), sets
        for entry in sets:
            program, *arguments = shlex.split(entry["command"])
            assert program == "sixdof"
            subprocess.run([sixdof, *arguments], check=True, cwd=again, capture_output=True)
            assert (again / entry["file"]).read_bytes() == (folder / entry["file"]).read_bytes(), entry["command"]

        assert manifest("--check").returncode == 0
        file = folder / "both.h5"
        data = bytearray(file.read_bytes())
        data[len(data) // 2] ^= 1
        file.write_bytes(data)
        (folder / "volumes.h5").rename(folder / "renamed.h5")
        checked = manifest("--check")
        assert checked.returncode == 1, checked
        for words in ("both.h5: is not the file", "volumes.h5: missing", "renamed.h5: not in the manifest"):
            assert words in checked.stderr, checked.stderr

        # Files that are none of ours end in one line that names them.
        file.write_text("no set")
        foreign = manifest()
        (folder / "manifest.json").write_text('{"sets": [{}]}')
        damaged = manifest("--check")
        for done, words in ((foreign, "both.h5"), (damaged, "manifest.json")):
            assert done.returncode == 1 and words in done.stderr and done.stderr.count("\n") == 1, done


if __name__ == "__main__":
    main()
