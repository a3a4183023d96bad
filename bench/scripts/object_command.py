"""What the commands bench/scripts/collection and bench/scripts/growth have in common: options, measuring, the report."""

import argparse
import contextlib
import json
import os
import pathlib
import signal
import sys

import object_runs as runs


def seconds_of(text):
    """30s, 25min, 2h as seconds. @raises argparse.ArgumentTypeError"""
    for unit, factor in (("min", 60), ("h", 3600), ("s", 1)):
        with contextlib.suppress(ValueError):
            if text.endswith(unit) and float(text.removesuffix(unit)) > 0:
                return float(text.removesuffix(unit)) * factor
    raise argparse.ArgumentTypeError(f"'{text}' is no time such as 90s, 25min, 2h")


def positive(text):
    if not text.isdigit() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number above 0")
    return int(text)


def parser_of(script, about, examples):
    """A parser with the options that both scripts have."""
    parser = argparse.ArgumentParser(prog=f"bench/scripts/{script}", description=about, epilog=examples,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder of the run")
    parser.add_argument("--algorithms", type=lambda text: text.split(","), help="default: those of sixdof-bench")
    parser.add_argument("--grid", default="so3:8:4", help="grid of the sets (sixdof generate), default %(default)s")
    parser.add_argument("--sample", type=positive, default=16, help="configurations per bucket, default %(default)s")
    parser.add_argument("--min-time", type=float, default=0.001, help="seconds of measuring per row, default %(default)s")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--budget", type=seconds_of, help="wall time, such as 25min or 2h; default: no limit")
    parser.add_argument("--retry", action="store_true", help="measure pairs again in which a step exceeded its time limit")
    parser.add_argument("--jobs", type=positive, default=os.cpu_count(), help="pairs in parallel, default: processors")
    parser.add_argument("--report", action="store_true", help="only write the report of what is measured")
    for option, name in (("--program", "sixdof"), ("--bench", "sixdof-bench")):
        parser.add_argument(option, type=pathlib.Path, default=runs.ROOT / "build/release/bin" / name)
    return parser


def choice_of(options, distances, volumes, queries=tuple(runs.QUERIES)):
    """@raises Failure for an algorithm that does not exist"""
    return runs.Choice(runs.chosen_algorithms(options.program, options.algorithms), distances, volumes, options.grid,
                       options.sample, options.min_time, options.seed, queries)


def measure(options, choice, units):
    """Measures what is not measured yet."""
    runs.bind_to(options.out, choice)
    if options.retry:
        runs.forget_cut(options.out)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with runs.Runner(options.out, choice, options.program, options.bench,
                     runs.Budget(options.budget, options.jobs)) as runner:
        runs.run(runner, units)


def rows_of(unit):
    """The rows of a unit with its labels, of its set, and of the algorithms that did not end
    (lib/sixdof/results/measured_pairs.h)."""
    rows = unit["benchmarks"] + [own_row(unit, "set", "sixdof generate", unit["set"])]
    rows += [own_row(unit, "pair", algorithm, record)
             for algorithm, record in unit["algorithms"].items() if record["status"] != "ok"]
    return [row | {"sixdof": row["sixdof"] | unit["labels"]} for row in rows]


def own_row(unit, query, algorithm, record):
    row = {"name": f"{query}/algorithm:{algorithm}/pair:{unit['unit']}", "run_type": "iteration",
           "sixdof": {"query": query, "algorithm": algorithm, "settings": {}, "pair": unit["unit"]}}
    if record["status"] != "ok":
        return row | {"error_occurred": True, "error_message": record["status"]}
    return row | {"cpu_time": record["cpu_s"], "real_time": record.get("seconds", record["cpu_s"]), "time_unit": "s"}


def write_report(options, name, summary):
    """Writes a file with the rows of all units and the summary that `sixdof table` makes of them, and prints its tables.
    @param summary option of `sixdof table` @raises Failure if no unit is measured"""
    units = runs.results(options.out)
    if not units:
        raise runs.Failure(f"{options.out}: no pair is measured yet")
    document = {"context": next((unit["context"] for unit in units if "context" in unit), {}),
                "benchmarks": [row for unit in units for row in rows_of(unit)]}
    table = [options.program, "table", summary]
    document |= json.loads(runs.printed([*table, "--json", "/dev/stdin"], json.dumps(document)))
    runs.write(options.out / name, document)
    print(runs.printed([*table, options.out / name]), end="", flush=True)


def run_script(main, parser):
    """Calls main(options). Errors end in one line."""
    options = parser.parse_args()
    try:
        for program in (options.program, options.bench):
            if not program.is_file():
                raise runs.Failure(f"{program} is not there: cmake --preset release && cmake --build --preset release "
                                   "--target sixdof_program sixdof-bench")
        main(options)
    except (runs.Failure, OSError) as failure:
        sys.exit(f"{parser.prog}: {failure}")
    except KeyboardInterrupt:
        sys.exit(130)
