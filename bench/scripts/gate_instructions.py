"""Instructions of a query, for bench/gate, counted by callgrind (Debian: valgrind).

The program tells callgrind where the timed loop of a row begins and ends (bench/harness/counted_loop.h), so that start,
loading, preparation, checks of answers and truth are not counted. The row times one round over its configurations.
"""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile

SAMPLE = 16        # configurations of a row
REPEATABLE = 0.05  # percent: how far two counts of one program differ at most
LONGEST_S = 240.0  # of one run; a row that takes longer is not counted
QUERIES = ("collide", "distance", "respond")


class NotCounted(Exception):
    """Why a row, or all, cannot be counted."""


def find_counter():
    """(name and version, function of a log file's stem that gives the words before a command). @raises NotCounted"""
    valgrind = shutil.which("valgrind")
    if not valgrind:
        raise NotCounted("valgrind, which counts instructions, is not there")
    version = subprocess.run([valgrind, "--version"], capture_output=True, text=True, check=False).stdout.strip()
    return version, lambda log: [valgrind, "--tool=callgrind", "--instr-atstart=no", "--callgrind-out-file=/dev/null",
                                 "--trace-children=yes", f"--log-file={log}.%p"]


def counted(folder):
    """The sum over the log files of all processes. @raises NotCounted if it is zero"""
    texts = [log.read_text(encoding="utf-8", errors="replace") for log in folder.iterdir()]
    total = sum(int(found.replace(",", "")) for text in texts for found in re.findall(r"\bI\s+refs:\s+([0-9,]+)", text))
    if total == 0:
        raise NotCounted("the program was built without valgrind/callgrind.h, which tells the counter where its loop is")
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
    command = [*program, *flags, f"--benchmark_filter=^{row}$", "--sample", SAMPLE, "--seed", 1, "--budget", 0,
               f"--iterations={SAMPLE}"]
    return count(command, counter, environment) / SAMPLE


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
