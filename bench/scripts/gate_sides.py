"""The two sides of bench/gate: programs or result files, what they answer, and the baseline that --record writes."""

import importlib.machinery
import importlib.util
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys

loader = importlib.machinery.SourceFileLoader("compare", str(pathlib.Path(__file__).resolve().parents[1] / "compare"))
compare = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare", loader))
loader.exec_module(compare)
Failure, write_whole = compare.Failure, compare.write_whole

# In a stored baseline: of a row the answers and counts stay, of the context what they depend on.
NOT_STORED = ("outliers", "checksum", "real_time", "cpu_time")
NOT_STORED_OF_RUN = ("checksum", "load_avg", "caches", "host_name", "mhz_per_cpu", "executable")


class Side:
    """A program as words of a command line, or a result file."""

    def __init__(self, name, word):
        self.name, self.words, self.document = name, None, None
        path = pathlib.Path(word)
        if path.is_file() and not os.access(path, os.X_OK):
            self.document = read_json(path)
            if not isinstance(self.document, dict) or not isinstance(self.document.get("benchmarks"), list):
                raise Failure(f"{word}: no result of sixdof-bench, and no program")
            return
        words = [word] if path.is_file() else shlex.split(word)
        program = shutil.which(words[0]) if words else None
        if program is None:
            raise Failure(f"{word}: no such program or result file")
        self.words = [str(pathlib.Path(program).resolve()), *words[1:]]

    def recorded(self):
        """What --record wrote besides rows."""
        found = (self.document or {}).get("context", {}).get("gate", {})
        return found if isinstance(found, dict) else {}


class Ended(Exception):
    """A program that gave no result."""


def read_json(path):
    try:
        return json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise Failure(f"{path}: {error}") from error


def environment():
    found = dict(os.environ)
    if compare.IS_CLONE:
        found.setdefault("SIXDOF_MODELS", str(compare.ROOT / "models" / "cache"))
    return found


def ask(side, options):
    """Runs a program once. @raises Ended"""
    out = options.folder / f"{side.name}-run.json"
    for file in (out, out.with_name(out.name + ".journal")):
        file.unlink(missing_ok=True)
    command = [*side.words, *options.flags, f"--benchmark_filter={options.filter}", "--sample", options.sample, "--seed", 1,
               "--budget", 0, "--benchmark_min_time=0.000001", f"--benchmark_out={out}"]
    print(f"answers of the {side.name}", file=sys.stderr, flush=True)
    done = subprocess.run([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                          env=environment(), check=False)
    said = (done.stderr.strip().splitlines() or [""])[-1]
    if done.returncode in (130, -2):
        raise KeyboardInterrupt
    if not out.exists():
        raise Ended(f"exit code {done.returncode} without a result: {said}")
    document = read_json(out)
    out.unlink()
    return document


def documents_of(sides, options):
    """The answers of both sides, in files. @raises Failure for a baseline without any, Ended for a candidate"""
    baseline, candidate = sides
    if baseline.document is None:
        try:
            baseline.document = ask(baseline, options)
        except Ended as ended:
            raise Failure(f"the baseline ended with {ended}") from ended
    if candidate.document is None:
        candidate.document = ask(candidate, options)
    files = [options.folder / f"{side.name}.json" for side in sides]
    for side, file in zip(sides, files):
        write_whole(file, json.dumps(side.document))
    return files


def filter_of(rows):
    return f"^({'|'.join(rows)})$"


def default_filter(sides, flags):
    """The rows of a stored baseline, those that options of the programs choose, or their default suite."""
    for side in sides:
        if side.document is not None:
            return filter_of(row["name"] for row in side.document["benchmarks"])
    if flags:  # which may choose a pair
        return "."
    programs = dict(zip(("contender", "base"), (side.words for side in reversed(sides))))
    return compare.filter_of_default_suite(programs | {"base": programs.get("base", programs["contender"])})


def without_result(document):
    return [row["name"] for row in document["benchmarks"] if row.get("error_occurred")]


def stored(document):
    """A result without what differs between two runs: times, worst poses, checksums."""
    def is_stored(key):
        return key not in NOT_STORED and not key.endswith("_ns") and not key.startswith("ns_per_") and key != "over_1ms"

    rows = [{key: value for key, value in row.items() if is_stored(key)} | {"real_time": 0.0, "cpu_time": 0.0}
            for row in document["benchmarks"]]
    context = {key: value for key, value in document["context"].items() if key not in NOT_STORED_OF_RUN}
    return {"context": context, "benchmarks": rows}
