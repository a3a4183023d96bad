#!/usr/bin/env python3
"""Every call that writes fails once, for every kind of file that the programs write; nothing is lost.

usage: write_faults.py SIXDOF SIXDOF_BENCH FAIL_WRITES [--most N] [--kinds REGEX] [--jobs N]

FAIL_WRITES is the library of fail_writes.cpp. A run without a fault counts a command's calls; then every one fails, in
every way: once or from there on, with ENOSPC, EIO, EDQUOT, EFBIG, after half of a write, or silently. After a fault

- the exit code is not 0, unless the new file is whole and what failed was not needed for it (a write that was taken up
  again, the cache, closing the journal of rows that are in the file),
- there is a message, and no signal ended the program,
- the old file stands, bit for bit, or the new one is whole,
- no temporary file is left.

--most N takes N faults, spread evenly over all. Without it all are taken, more than 10,000. The last line has the counts.
"""
import argparse
import collections
import concurrent.futures
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
sys.path.insert(0, str(HERE.parent / "cli"))
sys.dont_write_bytecode = True

PROGRAMS = [str(pathlib.Path(word).resolve()) for word in sys.argv[1:4]]
if len(PROGRAMS) < 3 or PROGRAMS[0].startswith("-"):
    sys.exit(__doc__)
SIXDOF, SIXDOF_BENCH, FAIL_WRITES = PROGRAMS
OPTIONS = sys.argv[4:]
sys.argv[1:] = PROGRAMS[:2]  # for the kinds of files, which this test shares with that one
import output_files_test as output  # noqa: E402
from output_kinds import Kind  # noqa: E402

PYTHON = sys.executable
MANY = ["--a", "a.off", "--b", "a.off", "--grid", "90/60", "--distances", "0:20", "--volumes", "1:5"]
KINDS = [
    *output.KINDS,
    Kind("set of many buckets", "x.h5", ["generate", *MANY, "-o", "OUT"]),
    Kind("scene", "x.h5", ["scene", "make", "robot", "-n", "6", "--frames", "2", "-o", "OUT"]),
    Kind("scene of a mesh that deforms", "x.h5", ["scene", "make", "bump", "--triangles", "200", "--frames", "2", "-o", "OUT"]),
    Kind("results, CSV", "x.csv", [*output.BENCH, "--benchmark_out_format=csv", "--out", "OUT"], times=True,
                program=SIXDOF_BENCH, replaces=False),
    Kind("results that are continued", "kept.json", [*output.BENCH, "--resume", "OUT"], times=True,
                program=SIXDOF_BENCH),
    Kind("scene by Python", "x.h5", ["-B", str(SOURCE / "fixtures/scene_file.py"), "--example", "OUT"],
                times=True, program=PYTHON),
    Kind("manifest of sets", "sets/manifest.json",
                ["-B", str(SOURCE / "fixtures/set_manifest.py"), "--program", SIXDOF, "sets"], program=PYTHON),
]
FOLDERS = [kind for kind in output.FOLDERS if kind.name != "figures of results"]  # node runs for a second each
FOLDERS.append(Kind("shards of many buckets", "made", ["generate", *MANY, "--shards", "6", "-o", "OUT"], replaces=False))
# Commands of sixdof that make a coarse set, and do without keeping it where the cache cannot be written.
WITH_COARSE_SETS = ("rows of precision",)
# Commands of sixdof that close a journal when all of it is in the file.
WITH_JOURNALS = ("rows of equivalent",)
CACHE = Kind("entries of the cache", "cache", output.CACHED[1:])
# (what fails, only once)
WAYS = [(kind, once) for kind in ("ENOSPC", "EIO", "EDQUOT", "EFBIG", "short") for once in (True, False)] + [("lost", True)]
work = output.OutputFiles  # its folders and what it knows of whole files


class Fault:
    def __init__(self, at, what="ENOSPC", once=True):
        self.at, self.what, self.once = at, what, once

    def environment(self, counts):
        return {"LD_PRELOAD": FAIL_WRITES, "SIXDOF_FAULT": str(counts), "SIXDOF_FAULT_AT": str(self.at),
                "SIXDOF_FAULT_KIND": self.what, "SIXDOF_FAULT_ONCE": str(int(self.once))}


def prepare(asked, folder):
    """Makes the inputs, in each process that runs commands."""
    tempfile.tempdir = folder
    work.setUpClass()
    for kind in [*KINDS, CACHE]:
        if kind.name in work.whole or kind.name not in asked:
            continue
        folder = fresh(kind)
        environment = work.environment(SIXDOF_CACHE=str(folder / "cache")) if kind is CACHE else None
        done = work.run_in(folder, kind.command(), environment)
        assert done.returncode == 0, (kind.name, done.stderr)
        work.whole[kind.name] = work.content(folder / kind.file)
        if kind is CACHE:
            global answers
            answers = work.answers(done)


def fresh(kind):
    """A folder with the inputs and what is there before."""
    folder = work.new_folder()
    target = folder / kind.file
    if kind.file.startswith("sets/"):
        (folder / "sets").mkdir()
        (folder / "results.json").rename(folder / "sets" / "no_set.txt")
        target.parent.joinpath("a.h5").write_bytes(work.whole["set"])
    if kind.name == "results that are continued":
        (folder / "results.json").rename(target)
    elif kind in KINDS and kind.replaces:
        target.write_bytes(b"old")
    return folder


def run(kind, fault):
    """@return calls, faults, the process's end, the folder, what was there before"""
    folder = fresh(kind)
    old = work.content(folder / kind.file)
    counts = work.top / "counts"
    counts.write_bytes(bytes(16))
    environment = work.environment(**fault.environment(counts),
                                   SIXDOF_CACHE=str(folder / "cache" if kind is CACHE else work.cache))
    done = work.run_in(folder, kind.command(), environment)
    calls, faults = struct.unpack("QQ", counts.read_bytes())
    return calls, faults, done, folder, old


def is_whole(kind, content):
    """Whether it is what an undisturbed run writes."""
    if content is None:
        return False
    if kind.file.endswith(".csv"):
        return content.count(b"\n") == work.whole[kind.name].count(b"\n")
    try:
        return work.is_whole(work, kind, content)
    except ValueError:  # no JSON
        return False


def complaints(kind, fault, done, folder, old):
    """What is wrong after a fault."""
    found = []
    words = done.stderr.decode(errors="replace")
    content = work.content(folder / kind.file)
    if kind is CACHE:
        if work.answers(done) != answers:
            found.append(f"answers {done.returncode}, {words}")
        for name, data in (content or {}).items():
            if data != work.whole[kind.name].get(name):
                found.append(f"{name} is not whole")
    else:
        # sixdof-bench does without a cache that it cannot write, and closes its journal when all rows are in the file.
        spared = kind.program is SIXDOF_BENCH or kind.name in WITH_COARSE_SETS + WITH_JOURNALS
        silent = fault.what == "lost" or (fault.what == "short" and fault.once) or spared
        if done.returncode == 0 and not (silent and is_folder_or_whole(kind, content, True)):
            found.append("exit code 0" + ("" if is_folder_or_whole(kind, content, True) else ", and the file is not whole"))
        if done.returncode not in (0, 1):
            found.append(f"exit code {done.returncode}")
        if done.returncode != 0 and not words.strip():
            found.append("no message")
        if content != old and not is_folder_or_whole(kind, content, False):
            found.append("neither the old file nor a whole one is there")
    left = [path for path in work.left_overs(folder)]
    if left:
        found.append(f"left: {left}")
    return [f"{kind.name}, call {fault.at}, {fault.what}{', once' if fault.once else ''}: {one}; {words.strip()[-300:]}"
            for one in found]


def is_folder_or_whole(kind, content, all_of_it):
    if kind in KINDS:
        return is_whole(kind, content)
    whole = work.whole[kind.name]
    if all_of_it or kind.name == "project of an algorithm":
        return content == whole
    return all(data == whole.get(name) for name, data in (content or {}).items())


def all_kinds(pattern):
    return [kind for kind in [*KINDS, *FOLDERS, CACHE] if re.search(pattern, kind.name)]


def count(name):
    kind = next(kind for kind in all_kinds("") if kind.name == name)
    calls, _, done, _, _ = run(kind, Fault(0))
    assert done.returncode == 0, done.stderr
    return calls


def attempt(name, at, what, once):
    """@return whether the call was reached, and complaints"""
    kind = next(kind for kind in all_kinds("") if kind.name == name)
    fault = Fault(at, what, once)
    _, faults, done, folder, old = run(kind, fault)
    if faults == 0:
        return False, []
    return True, complaints(kind, fault, done, folder, old)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--most", type=int, default=0)
    parser.add_argument("--kinds", default="")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args(OPTIONS)
    names = [kind.name for kind in all_kinds(options.kinds)]
    # What prepare() makes; the manifest is one of a set.
    output.KINDS = [kind for kind in output.KINDS if kind.name in [*names, "set"]]
    output.FOLDERS = [kind for kind in FOLDERS if kind.name in names]
    with tempfile.TemporaryDirectory(prefix="sixdof-faults-") as folder, \
            concurrent.futures.ProcessPoolExecutor(options.jobs, initializer=prepare, initargs=(names, folder)) as pool:
        calls = dict(zip(names, pool.map(count, names)))
        faults = [(name, at, what, once) for name in names for at in range(1, calls[name] + 1) for what, once in WAYS]
        if options.most and len(faults) > options.most:
            # A step that shares no factor with the number of ways would do; a fraction needs no thought.
            faults = [faults[int(i * len(faults) / options.most)] for i in range(options.most)]
        hit, missed, found = collections.Counter(), 0, []
        results = iter(pool.map(attempt, *zip(*faults), chunksize=4))
        for name in names:
            for _ in (fault for fault in faults if fault[0] == name):
                reached, problems = next(results)
                hit[name] += reached
                missed += not reached
                found += problems
                for problem in problems:
                    print(problem, flush=True)
            print(f"{name:<32} {calls[name]:>4} calls, {hit[name]:>5} faults", flush=True)
    print(f"{sum(hit.values())} faults over {len(names)} kinds of files ({missed} did nothing, e.g. a lost fsync); "
          f"{len(found)} complaints")
    sys.exit(1 if found or sum(hit.values()) == 0 else 0)


if __name__ == "__main__":
    main()
