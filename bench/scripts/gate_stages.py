"""The stages of bench/gate: each compares two sides and returns a gate_report.Stage."""

import json
import math
import pathlib
import subprocess
import sys
import types

import gate_instructions as instructions
from gate_report import Finding, Stage
from gate_sides import Failure, compare, environment, filter_of, read_json, without_result, write_whole

LOST = {"failed", "crashed", "timed_out", "out_of_memory", "misses", "missed_pairs"}
LONGER = 3  # times as many runs, where those that were asked do not decide
WRONG = {"mismatch", "wrong_pairs", "wrong_apart", "wrong_near", "wrong_overlapping", "false_positives", "false_negatives"}


def differences(files, options):
    """What `sixdof compare` says of both. @raises Failure"""
    done = subprocess.run([str(options.sixdof), "compare", *map(str, files), "--json", f"--tolerance={options.tolerance!r}"],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Failure(done.stderr.strip() or f"{options.sixdof}: exit code {done.returncode}")
    return json.loads(done.stdout)


def side_text(value):
    if value is None:
        return "none"
    if isinstance(value, str):
        return value
    return f"{value[0]:.9g}" if value[0] == value[1] else f"{value[0]:.9g} to {value[1]:.9g}"


def kind_of(change):
    """wrong, lost or changed."""
    if not change["worse"]:
        return "better" if change["worse"] is False else "changed"
    return "lost" if change["counter"] in LOST | {"error"} else "wrong" if change["counter"] in WRONG else "changed"


def change_text(change):
    return f"{change['counter']} {side_text(change['before'])} -> {side_text(change['after'])}"


def judge_answers(found, documents, options):
    failing = set(without_result(documents[0])) & set(without_result(documents[1]))
    names = {row["name"] for row in documents[1]["benchmarks"]} - set(found["only_after"])
    stage = Stage("answers", sorted(names - failing))
    stage.findings += [Finding(row, "lost: the candidate has no such row") for row in found["only_before"]]
    for change in found["answers"]:
        kind = kind_of(change)
        if kind == "better" and options.allow_better:
            stage.notes.append(f"better: {change['row']}: {change_text(change)}")
        else:
            stage.findings.append(Finding(change["row"], f"{kind}: {change_text(change)}"))
    stage.notes += [f"new row: {row}" for row in found["only_after"]]
    stage.notes += [f"no result on both sides: {row}" for row in sorted(failing)]
    stage.notes += [f"{one['key']}: {one['before'] or 'none'} -> {one['after'] or 'none'}" for one in found["versions"]]
    if not stage.rows and not stage.findings:
        raise Failure("no row has a result on both sides")
    return stage


def growth(change):
    """In percent, of the largest values; infinite from 0 on."""
    before, after = (max(value) if isinstance(value, list) else 0.0 for value in (change["before"], change["after"]))
    return 100 * (after / before - 1) if before > 0 else float("inf")


def judge_work(found, rows, options):
    stage = Stage("work", rows)
    for change in found["work"]:
        more = growth(change)
        known = change["before"] is not None and change["after"] is not None
        # What more is better for grows worse when it falls.
        size = more if more > 0 else 100 / (1 + more / 100) - 100 if more > -100 else float("inf")
        if change["worse"] and known and size > options.work_above:
            stage.findings.append(Finding(change["row"], f"{change_text(change)} ({more:+.3g} %)"))
    others = sum(1 for change in found["work"]) - len(stage.findings)
    if others:
        stage.notes.append(f"{others} counts differ by less, for the better, or are on one side only")
    return stage


def instructions_on(name, document):
    """On what counts depend besides the program's own source."""
    context = document.get("context", {})
    return " | ".join([name, *(str(context.get(key, "")) for key in ("compiler", "flags", "build_type", "cpu_model"))])


def count_rows(side, rows, options, counter):
    """Instructions of a query by row, and rows that cannot be counted with the reason."""
    counts, reasons = {}, {}
    for index, row in enumerate(rows):
        print(f"instructions of the {side.name}: row {index + 1} of {len(rows)}   ", end="\r", file=sys.stderr, flush=True)
        try:
            counts[row] = instructions.per_query(side.words, row, options.flags, counter, environment())
        except instructions.NotCounted as reason:
            reasons[row] = str(reason)
    print(file=sys.stderr)
    return counts, reasons


def judge_instructions(sides, options):
    baseline, candidate = sides
    stage = Stage("instructions")
    try:
        name, counter = instructions.find_counter()
    except instructions.NotCounted as reason:
        stage.why = str(reason)
        return stage
    if candidate.words is None:
        stage.why = "the candidate is no program"
        return stage
    rows, left_out = instructions.rows_to_count(candidate.document)
    if left_out:
        stage.notes.append(f"not counted, in processes of their own: {', '.join(left_out)}")
    if baseline.words is None:
        before, here = baseline.recorded().get("instructions"), instructions_on(name, candidate.document)
        if not before:
            stage.why = "the baseline has none"
            return stage
        if baseline.recorded().get("instructions_on") != here:
            stage.why = f"the baseline's were counted on {baseline.recorded().get('instructions_on')}; here: {here}"
            return stage
        rows = [row for row in before if row in {one["name"] for one in candidate.document["benchmarks"]}]
        reasons = {}
    else:
        before, reasons = count_rows(baseline, rows, options, counter)
    after, more_reasons = count_rows(candidate, rows, options, counter)
    limit = options.work_above - instructions.REPEATABLE

    def grown(counts_before, counts_after):
        both = [row for row in counts_before if row in counts_after]
        return {row: 100 * (counts_after[row] / counts_before[row] - 1) for row in both}

    first = grown(before, after)
    suspects = [row for row, percent in first.items() if percent >= limit]
    if suspects:
        again = count_rows(candidate, suspects, options, counter)[0]
        base = before if baseline.words is None else count_rows(baseline, suspects, options, counter)[0]
        second = grown({row: base[row] for row in suspects if row in base}, again)
        for row in suspects:
            least = min(first[row], second.get(row, float("inf")))
            if least >= limit:
                stage.findings.append(Finding(row, f"{before[row]:.0f} -> {after[row]:.0f} instructions a query ({least:+.2f} %)"))
    stage.rows = list(first)
    stage.notes += [f"not counted: {row}: {reason}" for row, reason in (reasons | more_reasons).items()]
    stage.notes.append(f"counted by {name}, {instructions.SAMPLE} configurations a row")
    if not stage.rows:
        stage.why = "no row could be counted"
    return stage


def slower(programs, options, folder, filter_, times=1):
    """{row: (median of ratios, ratio of fastest)} of rows that are certainly slower; that of rows that are slower as far as
    these runs tell; which rows were tested. @param times as many runs as were asked"""
    folder.mkdir(parents=True, exist_ok=True)
    asked = types.SimpleNamespace(filter=filter_, repetitions=times * options.repetitions, sample=options.sample,
                                  min_time=options.min_time, flags=[*options.flags, "--budget", 0])
    merged = {side: compare.merge(list_) for side, list_ in compare.measure(programs, asked, folder).items()}
    files = {side: folder / f"{side}-times.json" for side in merged}
    for side, document in merged.items():
        write_whole(files[side], json.dumps(compare.with_times(document)))
    dump = folder / "difference.json"
    compare.run(compare.compare_py("-d", dump, "benchmarks", files["base"], files["contender"]), quiet=True)
    base, contender = (read_json(file) for file in files.values())
    certain, likely = (compare.slower_rows(base, contender, read_json(dump), options.fail_above, significant)[0]
                       for significant in (compare.SIGNIFICANT, math.inf))
    ratios = [{name: (ratio, fastest) for name, ratio, fastest, _ in rows} for rows in (certain, likely)]
    return *ratios, sorted(set(compare.times_of(base)))


def judge_time(sides, options):
    stage = Stage("time")
    if any(side.words is None for side in sides):
        stage.why = "times of files are not compared: two programs have to run alternately"
        return stage
    if not pathlib.Path(compare.COMPARE_PY).is_file():
        stage.why = "compare.py of Google Benchmark is not there (Debian: libbenchmark-tools)"
        return stage
    programs = dict(zip(("base", "contender"), (side.words for side in sides)))
    first, likely, stage.rows = slower(programs, options, options.folder / "time", options.filter)
    if not first and likely:
        # On a machine whose speed changes during the runs their test has too little power.
        stage.notes.append(f"{len(likely)} rows may be slower, and were measured {LONGER} times as often")
        first, _, _ = slower(programs, options, options.folder / "time-longer", filter_of(likely), LONGER)
    if not first:
        return stage
    print(f"{len(first)} rows look slower and are measured again", file=sys.stderr, flush=True)
    second, _, _ = slower(programs, options, options.folder / "time-again", filter_of(first), LONGER)
    for name, (ratio, fastest) in first.items():
        if name in second:
            stage.findings.append(Finding(name, f"x{ratio:.2f}, again x{second[name][0]:.2f} (median of pairs); fastest runs "
                                                f"x{fastest:.2f}, x{second[name][1]:.2f}"))
        else:
            stage.notes.append(f"slower in the first of two measurements only: {name}: x{ratio:.2f}")
    return stage
