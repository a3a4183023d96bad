"""Instructions of a query, for bench/gate: counted by perf where the machine lets it, or else by valgrind.

A row is run twice that differ only in how many queries it times (--iterations): the difference of both counts is that
of the loop. Start, loading, preparation, checks of answers and truth cancel.
"""

import math
import os
import pathlib
import re
import shutil
import subprocess
import tempfile

SAMPLE = 16        # configurations of a row
LOOPS = 16         # more rounds of the timed loop, at least; more where they take fewer than ENOUGH instructions
MOST_LOOPS = 65536
# Two starts of a program differ by up to 2,000,000: when it is loaded, libhwy measures the resolution of its timer.
ENOUGH = 1_000_000_000
REPEATABLE = 0.2   # percent: how far two counts of one program differ at most
LONGEST_S = 240.0  # of one run; a row that takes longer is not counted
QUERIES = ("collide", "distance", "respond")


class NotCounted(Exception):
    """Why a row, or all, cannot be counted."""


def perf_counts(perf):
    """Whether perf counts instructions here: in many virtual machines and containers it does not."""
    done = subprocess.run([perf, "stat", "-x,", "-e", "instructions:u", "true"], capture_output=True, text=True, check=False)
    return done.returncode == 0 and done.stderr.split(",")[0].strip().isdigit()


def find_counter():
    """(name and version, function of a log file's stem that gives the words before a command). @raises NotCounted"""
    perf, valgrind = shutil.which("perf"), shutil.which("valgrind")
    if perf and perf_counts(perf):
        return "perf", lambda log: [perf, "stat", "-x,", "-o", f"{log}.1", "-e", "instructions:u", "--"]
    if valgrind:
        version = subprocess.run([valgrind, "--version"], capture_output=True, text=True, check=False).stdout.strip()
        return version, lambda log: [valgrind, "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null",
                                     "--trace-children=yes", f"--log-file={log}.%p"]
    raise NotCounted("neither perf nor valgrind counts instructions here")


def counted(folder):
    """The sum over the log files of all processes."""
    total, found = 0, False
    for log in folder.iterdir():
        text = log.read_text(encoding="utf-8", errors="replace")
        for match in (re.search(r"\bI\s+refs:\s+([0-9,]+)", text), re.search(r"^([0-9]+),[^,]*,instructions", text, re.MULTILINE)):
            if match:
                total, found = total + int(match.group(1).replace(",", "")), True
    if not found:
        raise NotCounted("the counter printed no count")
    return total


def pin():
    """One processor: the number of threads, and with it the number of instructions, is then the same everywhere."""
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})


def count(command, counter, environment):
    """Instructions of a command. @raises NotCounted"""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "logs").mkdir()
        words = [*counter(folder / "logs" / "log"), *command, f"--benchmark_out={folder / 'rows.json'}"]
        try:
            done = subprocess.run([str(word) for word in words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                  env=environment, preexec_fn=pin, timeout=LONGEST_S, check=False)
        except subprocess.TimeoutExpired:
            raise NotCounted(f"not done in {LONGEST_S:.0f} s") from None
        if done.returncode != 0:
            raise NotCounted(f"exit code {done.returncode}: {(done.stderr.strip().splitlines() or [''])[-1]}")
        return counted(folder / "logs")


def per_query(program, row, flags, counter, environment):
    """Instructions of one query of a row. @param program words of a command line @raises NotCounted"""
    def total(loops):
        return count([*program, *flags, f"--benchmark_filter=^{row}$", "--sample", SAMPLE, "--seed", 1, "--budget", 0,
                      f"--iterations={loops * SAMPLE}"], counter, environment)

    start, loops = total(1), LOOPS
    difference = total(1 + loops) - start
    if difference < ENOUGH:
        loops = min(MOST_LOOPS, math.ceil(loops * ENOUGH / max(difference, 1)))
        difference = total(1 + loops) - start
    if difference <= 0:
        raise NotCounted("the loop takes fewer instructions than two starts differ")
    return difference / (loops * SAMPLE)


def rows_to_count(document):
    """One row of every query and algorithm, from the middle of its buckets; names of isolated algorithms that are left out."""
    groups, left_out = {}, set()
    for row in document["benchmarks"]:
        fields = row.get("sixdof", {})
        if row.get("error_occurred") or fields.get("query") not in QUERIES:
            continue
        if fields.get("isolated") or fields.get("runtime"):
            left_out.add(fields.get("algorithm"))
            continue
        groups.setdefault((fields["query"], fields.get("algorithm")), []).append(row["name"])
    return [names[len(names) // 2] for names in groups.values()], sorted(filter(None, left_out))
