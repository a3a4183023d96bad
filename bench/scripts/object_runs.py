"""Measures algorithms on pairs of meshes, one pair after the other, such that a run may be killed and continued.

Of bench/scripts/collection and bench/scripts/growth. A unit is one pair. Everything of a run lies in one folder:

  meshes/NAME.ply   the meshes, with all bits
  sets/UNIT.h5      configuration sets
  units/UNIT.json   a unit's result, which appears whole when the unit is measured
  .run-XXXX/        what a run has not finished; the next run removes those of runs that have ended, however they did

Every algorithm is asked by a process of its own (sixdof-bench), so that one that hangs or takes all memory costs its own
rows only. All of them are asked the same configurations.
"""

import concurrent.futures
import contextlib
import dataclasses
import fcntl
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "fixtures"))
from object_progress import Progress  # noqa: E402
from whole_file import write_whole  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
QUERIES = ["distance", "collide", "respond"]
CAST_STEP = 10  # Percent of A's diagonal by which B moves in casts (sixdof-bench, cast rows).
# The least time that a step of a unit gets: a process needs some seconds to load two large meshes on a busy machine.
LEAST_LIMIT_S = 10.0
# A unit may take this many times its equal part of the budget: most units take far less than the largest ones.
UNIT_OF_SHARE = 12.0
# One step of a unit, such as an algorithm, gets this part of the unit's time.
STEP_OF_UNIT = 0.5
# What a process gets to end in order.
GRACE_S = 3.0


class Failure(Exception):
    """Ends the run with one line on stderr."""


class OutOfTime(Exception):
    """The budget is spent."""


@dataclasses.dataclass(frozen=True)
class Body:
    """A model or file, scaled to a diagonal of its box if one is given."""
    model: str
    file: str  # Stem of the mesh file, and the name in rows.
    diagonal: float | None = None


@dataclasses.dataclass(frozen=True)
class Unit:
    name: str
    a: Body
    b: Body
    triangles: int  # Of both together, as the models' names say; for estimates.
    volumes: bool   # Both are solids.
    labels: tuple   # (key, value) pairs that say what the unit is.
    volume_unit: float = 1.0  # That of the volumes' percentages, in volumes of A.


@dataclasses.dataclass
class Choice:
    """What is asked of every unit."""
    algorithms: list
    distances: str
    volumes: str
    grid: str
    sample: int
    min_time: float
    seed: int
    queries: tuple = tuple(QUERIES)

    def key(self):
        """What units of one run have in common; a folder holds units of one choice."""
        return {field.name: getattr(self, field.name) for field in dataclasses.fields(self)} | {
            "queries": list(self.queries)}


@dataclasses.dataclass
class Step:
    """How a process ended."""
    code: int | None  # None: stopped when its time was over.
    seconds: float    # Wall time.
    cpu_s: float
    peak_bytes: int   # Of its memory.
    said: str         # Last line on stderr.


class Budget:
    """Wall time for all units, shared by `jobs` that run at a time. None: no limit."""

    def __init__(self, seconds, jobs):
        self.jobs = jobs
        self.end = time.monotonic() + seconds if seconds else math.inf
        self.left = 0  # Units that are not begun.

    def remaining(self):
        return self.end - time.monotonic()

    def unit_limit(self):
        if self.end == math.inf:
            return math.inf
        share = self.remaining() * self.jobs / max(self.left, 1)
        return max(4 * LEAST_LIMIT_S, UNIT_OF_SHARE * share)


class Scratch:
    """A folder for what is not finished. It is locked while this process lives, so that others know, also those on other
    machines that share the run's folder; those that nobody holds any more are removed."""

    PREFIX = ".run-"
    LOCK = "held"

    def __init__(self, folder):
        with open(folder / ".runs", "a", encoding="utf-8") as one_at_a_time:
            fcntl.flock(one_at_a_time, fcntl.LOCK_EX)
            for left in folder.glob(f"{self.PREFIX}*"):
                self.remove_unless_held(left)
            self.path = pathlib.Path(tempfile.mkdtemp(dir=folder, prefix=self.PREFIX))
            self.lock = open(self.path / self.LOCK, "w", encoding="utf-8")
            fcntl.flock(self.lock, fcntl.LOCK_EX)

    def remove_unless_held(self, folder):
        with contextlib.suppress(OSError):  # BlockingIOError: its run goes on
            with open(folder / self.LOCK, "a", encoding="utf-8") as lock:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            shutil.rmtree(folder, ignore_errors=True)

    def close(self):
        shutil.rmtree(self.path, ignore_errors=True)
        self.lock.close()


def ends_with_this_process(command):
    """The command, such that it gets SIGTERM when this process ends, however it does: at that it removes what is
    half-written."""
    setpriv = shutil.which("setpriv")  # of util-linux
    return [setpriv, "--pdeathsig", "TERM", "--", *command] if setpriv else command


class Runner:
    """Of one run. A context: what it has not finished goes with it."""

    def __init__(self, folder, choice, program, bench, budget):
        self.folder, self.choice, self.program, self.bench, self.budget = folder, choice, program, bench, budget
        self.running = set()
        self.stopped = False
        self.mesh_locks = {}
        self.lock = threading.Lock()
        for name in ("meshes", "sets", "units"):
            (folder / name).mkdir(parents=True, exist_ok=True)
        self.scratch = Scratch(folder)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.scratch.close()

    def stop(self):
        """Ends the processes that this object started; nothing more begins."""
        with self.lock:
            self.stopped = True
            running = list(self.running)
        for process in running:
            self.end(process)

    def end(self, process):
        """Ends a process and its children: by SIGTERM, at which they remove what is half-written, then by SIGKILL."""
        for number in (signal.SIGTERM, signal.SIGKILL):
            with self.lock, contextlib.suppress(ProcessLookupError):
                if process in self.running:
                    os.killpg(process.pid, number)
            deadline = time.monotonic() + GRACE_S
            while process in self.running and time.monotonic() < deadline:
                time.sleep(0.05)

    def call(self, command, limit_s):
        """Runs a command for so many seconds at most. @raises OutOfTime if the budget ends it, or stop()"""
        limit_s = min(limit_s, self.budget.remaining())
        begun = time.monotonic()
        timed_out = threading.Event()
        with tempfile.TemporaryFile("w+") as said:
            with self.lock:
                if self.stopped or limit_s <= 0:
                    raise OutOfTime
                process = subprocess.Popen(ends_with_this_process([str(word) for word in command]), stdin=subprocess.DEVNULL,
                                           stdout=subprocess.DEVNULL, stderr=said, start_new_session=True)
                self.running.add(process)
            timer = threading.Timer(min(limit_s, threading.TIMEOUT_MAX), lambda: (timed_out.set(), self.end(process)))
            timer.start()
            os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)  # its number stays taken until it is removed
            with self.lock:
                self.running.discard(process)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            timer.cancel()
            said.seek(0)
            last = (said.read().strip().splitlines() or [""])[-1]
        if self.stopped or self.budget.remaining() <= 0:
            raise OutOfTime
        code = None if timed_out.is_set() else process.returncode
        return Step(code, time.monotonic() - begun, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024, last)

    def mesh(self, body):
        """The body's file, made if it is not there. @raises Failure"""
        with self.lock:
            lock = self.mesh_locks.setdefault(body.file, threading.Lock())
        with lock:
            file = self.folder / "meshes" / f"{body.file}.ply"
            if not file.exists():
                scale = ["--diagonal", repr(body.diagonal)] if body.diagonal else []
                step = self.call([self.program, "models", "make", body.model, *scale, "-o", file], math.inf)
                if step.code != 0:
                    raise Failure(step.said or f"{body.model}: could not be made")
            return file

    def make_set(self, unit, a, b, limit_s):
        """(file, record) of the unit's set. Volumes that take too long are left out. A set that is there is kept,
        with the record of how it was made."""
        file = self.folder / "sets" / f"{unit.name}.h5"
        record_file = file.with_suffix(".json")
        if file.exists() and record_file.exists():
            return file, json.loads(record_file.read_text(encoding="utf-8"))
        record = {"status": "ok", "volumes": unit.volumes}
        for volumes in ([True, False] if unit.volumes else [False]):
            percents = ",".join(f"{percent * unit.volume_unit:.6g}" for percent in percents_of(self.choice.volumes))
            chosen = ["--volumes", percents] if volumes and percents else []
            step = self.call([self.program, "generate", "--a", a, "--b", b, "--grid", self.choice.grid, "--distances",
                              self.choice.distances, *chosen, "--threads", 1, "-o", file], limit_s)
            record |= {"volumes": bool(chosen), "seconds": step.seconds, "cpu_s": step.cpu_s,
                       "peak_bytes": step.peak_bytes}
            if step.code == 0:
                write(record_file, record, self.scratch.path)
                return file, record
            said = "not made in time" if step.code is None else step.said
            record["status"] = f"no volumes: {said}" if volumes else f"no set: {said}"
        return None, record

    def measure(self, unit):
        """Measures the algorithms that a unit lacks and writes its result, also that it has no mesh or set.
        @raises OutOfTime"""
        limit = self.budget.unit_limit()
        step_limit = max(LEAST_LIMIT_S, STEP_OF_UNIT * limit)
        begun = time.monotonic()
        result = result_of(self.folder, unit.name) or {
            "unit": unit.name, "labels": {**dict(unit.labels), "total_triangles": unit.triangles,
                                          "volume_unit": unit.volume_unit},
            "a": dataclasses.asdict(unit.a), "b": dataclasses.asdict(unit.b), "algorithms": {}, "benchmarks": [],
            "seconds": 0.0}
        made = None
        try:
            a, b = self.mesh(unit.a), self.mesh(unit.b)
            made, result["set"] = self.make_set(unit, a, b, step_limit)
        except Failure as failure:
            result["set"] = {"status": f"no mesh: {failure}"}
        if made:
            for algorithm in missing(result, self.choice.algorithms):
                record, document = self.ask(algorithm, made, a, b, step_limit)
                result["algorithms"][algorithm] = record
                if document:
                    result.setdefault("context", document["context"])
                    result["benchmarks"] += document["benchmarks"]
        result["seconds"] += time.monotonic() - begun
        write(self.folder / "units" / f"{unit.name}.json", result, self.scratch.path)

    def ask(self, algorithm, made, a, b, limit_s):
        """Record and result document of one algorithm on a set; None for the document if it did not end in time."""
        queries = "|".join(("prepare", *self.choice.queries))
        with tempfile.TemporaryDirectory(dir=self.scratch.path) as name:
            out = pathlib.Path(name) / "rows.json"
            step = self.call([self.bench, "--no-manifest", "--set", made, "--mesh", a, *(["--mesh", b] if a != b else []),
                              f"--benchmark_filter=^({queries})/algorithm:{algorithm}/pair:[^/]+"
                              f"(/(distance|volume):[0-9.]+|/motion:[a-z]+/step:{CAST_STEP})?$",
                              "--sample", self.choice.sample, "--seed", self.choice.seed, "--isolate=third-party",
                              f"--benchmark_min_time={self.choice.min_time}", f"--out={out}"], limit_s)
            record = {"status": "ok", "seconds": step.seconds, "cpu_s": step.cpu_s, "peak_bytes": step.peak_bytes}
            if step.code is None:
                record |= {"status": f"not done in {limit_s:.0f} s"}
                return record, None
            if not out.exists():
                record |= {"status": f"exit code {step.code}: {step.said}"}
                return record, None
            return record, json.loads(out.read_text(encoding="utf-8"))


def write(file, document, scratch=None):
    """Writes JSON whole or not at all. @param scratch where it stands until it is whole, on the same file system"""
    write_whole(file, json.dumps(document), scratch)


def bind_to(folder, choice):
    """Notes the choice in the folder, which may gain algorithms. @raises Failure if it holds units of another choice"""
    file = folder / "choice.json"
    if not file.exists():
        folder.mkdir(parents=True, exist_ok=True)
        write(file, choice.key())
        return
    known = json.loads(file.read_text(encoding="utf-8"))
    for field, value in choice.key().items():
        if field != "algorithms" and known.get(field) != value:
            raise Failure(f"{folder}: holds units with {field} {known.get(field)}, not {value}: choose another folder")
    gained = [name for name in choice.algorithms if name not in known["algorithms"]]
    if gained:
        write(file, known | {"algorithms": known["algorithms"] + gained})


def forget_cut(folder):
    """Removes from the results what the time cut, so that the next run measures it again: algorithms that did not end,
    and units whose set lacks its volumes, with that set. @returns the units' names"""
    names = []
    for result in results(folder):
        file = folder / "units" / f"{result['unit']}.json"
        kept = {name: record for name, record in result["algorithms"].items()
                if not record["status"].startswith("not done")}
        if "in time" in result["set"]["status"]:
            file.unlink()
            (folder / "sets" / f"{result['unit']}.json").unlink(missing_ok=True)
        elif len(kept) < len(result["algorithms"]):
            write(file, result | {"algorithms": kept})
        else:
            continue
        names.append(result["unit"])
    return names


def result_of(folder, name):
    """A unit's result so far; None if it has none."""
    try:
        return json.loads((folder / "units" / f"{name}.json").read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None


def missing(result, algorithms):
    """Those of the algorithms that the result has no record of."""
    return [name for name in algorithms if name not in result["algorithms"]]


def done(folder, unit, algorithms):
    """Whether nothing is left to measure: no algorithm, or there is no set to ask them about."""
    result = result_of(folder, unit.name)
    return result is not None and (not set_was_made(result) or not missing(result, algorithms))


def set_was_made(result):
    return not result["set"]["status"].startswith(("no set", "no mesh"))


def measured_points(folder):
    """(triangles, seconds) of the units of a folder."""
    return [(unit["labels"]["total_triangles"], unit["seconds"]) for unit in results(folder)]


def run(runner, units):
    """Measures what is not measured yet, and says so on stderr."""
    waiting = [unit for unit in units if not done(runner.folder, unit, runner.choice.algorithms)]
    runner.budget.left = len(waiting)
    progress = Progress(runner.budget, measured_points(runner.folder))
    progress.begin(waiting)
    left_out = []

    def one(unit):
        try:
            if runner.stopped or runner.budget.remaining() <= 0:
                raise OutOfTime
            runner.measure(unit)
            with runner.lock:
                progress.finished(unit)
        except OutOfTime:
            left_out.append(unit)
        finally:
            with runner.lock:
                runner.budget.left -= 1

    with concurrent.futures.ThreadPoolExecutor(runner.budget.jobs) as executor:
        futures = [executor.submit(one, unit) for unit in waiting]
        try:
            for future in concurrent.futures.as_completed(futures):
                future.result()
        except BaseException:
            runner.stop()
            raise
    progress.end(left_out)


def results(folder):
    """All unit results of a folder, by name."""
    return [json.loads(file.read_text(encoding="utf-8")) for file in sorted((folder / "units").glob("*.json"))]


def printed(command, text=None):
    """What a program prints. @raises Failure"""
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
    if done.returncode:
        raise Failure(done.stderr.strip().removeprefix("sixdof: "))
    return done.stdout


def chosen_algorithms(program, names):
    """The named algorithms, with those of all rivals about meshes for "rivals"; without names those that benchmarks ask by
    default, but for the one that answers with constants. @raises Failure for a name that does not exist"""
    listed = json.loads(printed([program, "algorithms", "--json"]))
    if names and "rivals" in names:
        rivals = [one["name"] for one in listed if one["runtime"] and one["body"] == "mesh"]
        if not rivals:
            raise Failure("rivals: none is set up; bench/rivals/setup does it")
        names = [name for name in names if name not in ("rivals", *rivals)] + rivals
    unknown = set(names or []) - {one["name"] for one in listed}
    if unknown:
        raise Failure(f"no algorithm is called {', '.join(sorted(unknown))}")
    return names or [one["name"] for one in listed
                     if one["timed"] and one["by_default"] and one["body"] == "mesh" and one["name"] != "null"]


def percents_of(text):
    """0,1,5:7 as [0, 1, 5, 6, 7]. @raises ValueError"""
    percents = []
    for word in text.split(",") if text else []:
        low, colon, high = word.partition(":")
        percents += range(int(low), int(high) + 1) if colon else [float(low)]
    return percents
