#!/usr/bin/env python3
"""Compares the answers of two builds of `sixdof` on 50 commands, byte for byte.

usage: test/same_answers.py BEFORE AFTER [--rename="OLD=NEW ..."] [--before-options="NEW=OLD ..."]

BEFORE and AFTER are programs. Printed answers are compared line by line, sets as the bytes of all datasets and attributes,
other files by their bytes. What the second program prints in addition is no difference; times and sentences are no answers.
--rename replaces words (keys) of the first program's answers before they are compared; --before-options replaces
words of a command before the first program runs it, for options that have another name there.
"""

import argparse
import collections
import hashlib
import pathlib
import re
import subprocess
import sys
import tempfile

POSES = ["0.9 0 0.1 1 0 0 0", "0.3 -0.2 0.5 0.48 0.6 -0.48 0.4233202097703346", "0.7 0.4 -0.6 0.28 0.6 0.64 0.3898717737923585"]
PAIRS = [("torus-knot-10k", "torus-knot-10k"), ("gyroid-ball-10k", "circular-box-10k"), ("cone-1k", "torus-1k")]
ALGORITHMS = ["exact", "ist", "vps", "vps-field", "fcl-obbrss", "fcl-contacts"]


def commands():
    """50 command lines; files are written into the working directory."""
    list_ = []
    for a, b in PAIRS:
        for i, algorithm in enumerate(ALGORITHMS):
            list_.append(["query", "--a", a, "--b", b, "--pose", POSES[i % len(POSES)], "--algorithm", algorithm, "--json"])
    ist = ["query", "--a", "cone-1k", "--b", "torus-1k", "--pose", POSES[1], "--algorithm", "ist", "--json"]
    list_ += [ist + ["--parameter", "force=gradient"], ist + ["--parameter", "force=volume"],
              ist + ["--parameter", "correct_fill=cells"], ist + ["--about", "0.1 0.2 0.3"]]
    for scenario, algorithm in [("Ia", "exact"), ("Ia", "vps"), ("Ib", "exact"), ("Ib", "ist"), ("II", "vps"),
                                ("II", "fcl-contacts"), ("III", "exact"), ("III", "ist"), ("IV", "vps-field"),
                                ("IV", "ist")]:
        list_.append(["quality", "--scenario", scenario, "--algorithm", algorithm, "--steps", "60", "--json"])
    sets = [["--a", "cone-1k", "--b", "torus-1k", "--grid", "90", "--distances", "0,1,5:10", "--volumes", "0,1,5"],
            ["--a", "torus-knot-10k", "--grid", "so3:24:12", "--distances", "0:30"],
            ["--a", "torus-knot-10k", "--grid", "so3:12:12", "--volumes", "0:10"],
            ["--a", "gyroid-ball-10k", "--b", "circular-box-10k", "--grid", "90/60", "--distances", "0,2,20"],
            ["--a", "gyroid-ball-10k", "--b", "circular-box-10k", "--grid", "so3:8:8", "--volumes", "0,2,10"],
            ["--a", "box-300", "--grid", "90", "--distances", "0,3,10", "--volumes", "0,2"],
            ["--a", "cone-1k", "--b", "torus-1k", "--grid", "90", "--distances", "1,5", "--method", "advance"],
            ["--a", "cone-1k", "--b", "cylinder-100", "--grid", "so3:2:4", "--distances", "0,7", "--method", "advance",
             "--oracle", "brute-force"]]
    for i, words in enumerate(sets):
        list_.append(["generate"] + words + ["-o", f"set-{i}.h5"])
    list_.append(["verify", "set-0.h5", "--sample", "10"])
    list_.append(["verify", "set-7.h5", "--sample", "3", "--oracle", "brute-force"])
    list_.append(["generate"] + sets[0] + ["--shards", "3", "-o", "shards"])
    list_.append(["merge", "shards", "-o", "merged.h5"])
    for algorithm in ["ist", "vps", "vps-field"]:
        list_.append(["show", "--algorithm", algorithm, "--model", "cone-1k", "-o", f"{algorithm}.ply"])
    list_.append(["info", "circular-box-10k", "--json"])
    list_.append(["info", "cone-1k"])
    list_.append(["models", "make", "circular-box-5k", "-o", "circular-box.off"])
    assert len(list_) == 50, len(list_)
    return list_


def dump_set(path):
    """All names, shapes, bytes and attributes of an HDF5 file as text; what names the version of the format is left out."""
    import h5py  # pylint: disable=import-outside-toplevel

    lines = []

    def visit(name, item):
        for key in sorted(item.attrs):
            if key not in ("format_version", "job", "program") and not (key == "content_hash" and name in ("", "/")):
                lines.append(f"{name} @{key} = {item.attrs[key]!r}")
        if isinstance(item, h5py.Dataset):
            data = item[()]
            lines.append(f"{name} {data.shape} {hashlib.sha256(data.tobytes()).hexdigest()}")

    with h5py.File(path) as file:
        visit("", file)
        file.visititems(visit)
    return "\n".join(lines)


def answer(program, words, folder):
    """What a command prints and writes. Times are no answers."""
    done = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True, check=False)
    text = done.stdout
    if words[0] in ("generate", "merge", "verify"):  # sentences, and of verify a table
        text = "".join(line for line in text.splitlines(True) if re.match(r"(distance|volume)/", line))
    text = re.sub(r'"times_ns": \{[^}]*\}', "", text)
    text = re.sub(r'"(\w+_ns|over_1ms)": [-+.e0-9]+', "", text)
    text = re.sub(r",$", "", text, flags=re.MULTILINE)  # a new key may follow
    text += f"exit code {done.returncode}\n{done.stderr}"
    if "-o" in words:
        output = pathlib.Path(folder, words[words.index("-o") + 1])
        for file in sorted(output.iterdir()) if output.is_dir() else [output]:
            if file.suffix == ".h5":
                text += f"{file.name}\n{dump_set(file)}\n"
            elif file.exists():
                text += f"{file.name} {hashlib.sha256(file.read_bytes()).hexdigest()}\n"
    return text


def replace_words(text, pairs):
    for pair in pairs:
        old, new = pair.split("=", 1)
        text = re.sub(rf"(?<![\w-]){re.escape(old)}(?![\w-])", new, text)
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("--rename", type=str.split, default=[])
    parser.add_argument("--before-options", type=str.split, default=[])
    arguments = parser.parse_args()
    different = 0
    with tempfile.TemporaryDirectory() as before, tempfile.TemporaryDirectory() as after:
        for words in commands():
            old_words = [replace_words(word, arguments.before_options) for word in words]
            old = replace_words(answer(str(pathlib.Path(arguments.before).resolve()), old_words, before), arguments.rename)
            new = answer(str(pathlib.Path(arguments.after).resolve()), words, after)
            same = not collections.Counter(old.split("\n")) - collections.Counter(new.split("\n"))
            different += not same
            print("same     " if same else "DIFFERENT", " ".join(words), flush=True)
            if not same:
                new_lines, old_lines = set(new.split("\n")), set(old.split("\n"))
                for line in [line for line in old.split("\n") if line not in new_lines][:5]:
                    print("    before:", line[:200])
                for line in [line for line in new.split("\n") if line not in old_lines][:5]:
                    print("    after: ", line[:200])
    print(f"{different} of {len(commands())} commands differ")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
