"""What bench/compare says besides times: which answers, structures and versions differ between two sides.

Every counter of a row but its times is compared: the errors, failures and angles that rows measure against the truth
in both runs, counts of work, sizes of structures.
"""

import math
import re

# Counters that no two runs share.
TIMES = re.compile(r".*_ns|ns_per_.*|real_time|cpu_time|over_1ms|iterations|timing_rounds"
                   r"|family_index|per_family_instance_index|repetition_index|repetitions|threads")
# These change with what a query looks at or how a structure is built, not with what is answered.
WORK = re.compile(r".*_tested|.*_total|bytes|nodes.*|triangles|.*voxels|.*bricks|points|spheres.*|fill_[ab]")
# Other compilers and instruction sets round differently. Errors of exact algorithms are rounding alone: 1e-16.
RELATIVE, ABSOLUTE = 1e-9, 1e-12
# Of a context: what a result depends on besides the machine.
VERSIONS = re.compile(r"(version|algorithm|settings|mesh|set):.*|.*_build|sixdof_version|commit|commit_dirty|compiler|flags"
                      r"|build_type|cpu_model|host_name")


def counters_of(documents):
    """{row: {counter: (least, largest)}} over the documents of one side; a row without a result has {"error": words}."""
    rows = {}
    for document in documents:
        for row in document["benchmarks"]:
            if row.get("run_type") != "iteration":
                continue
            counters = rows.setdefault(row["name"], {})
            if row.get("error_occurred"):
                counters["error"] = row.get("error_message", "")
                continue
            for name, value in row.items():
                if isinstance(value, (int, float)) and not isinstance(value, bool) and not TIMES.fullmatch(name):
                    least, largest = counters.get(name, (value, value))
                    counters[name] = (min(least, value), max(largest, value))
    return rows


def differs(before, after):
    """Whether two ranges (least, largest) are further apart than rounding. Texts and absent values: whether unequal."""
    if not isinstance(before, tuple) or not isinstance(after, tuple):
        return before != after
    gap = max(after[0] - before[1], before[0] - after[1])
    size = max(map(abs, before + after))
    return gap > ABSOLUTE + RELATIVE * size or not math.isfinite(size)


def changes(base, contender):
    """Sorted [(row, counter, before, after)] of all rows that both sides have."""
    before, after = counters_of(base), counters_of(contender)
    found = []
    for row in sorted(before.keys() & after.keys()):
        for counter in sorted(before[row].keys() | after[row].keys()):
            pair = before[row].get(counter), after[row].get(counter)
            if differs(*pair):
                found.append((row, counter, *pair))
    return found


def missing_rows(base, contender):
    """Rows of one side only: ([rows of base], [rows of contender])."""
    before, after = counters_of(base).keys(), counters_of(contender).keys()
    return sorted(before - after), sorted(after - before)


def version_changes(base, contender):
    """[(key, before, after)] of the contexts of two documents."""
    keys = [key for key in {**base["context"], **contender["context"]} if VERSIONS.fullmatch(key)]
    values = [(key, base["context"].get(key), contender["context"].get(key)) for key in keys]
    return [value for value in values if value[1] != value[2]]


def text_of(value):
    """A value as it stands in the report: one number where all runs agree."""
    if value is None:
        return "none"
    if isinstance(value, tuple):
        return f"{value[0]:.6g}" if value[0] == value[1] else f"{value[0]:.6g} to {value[1]:.6g}"
    return str(value)


def report(base, contender):
    """Prints versions, rows of one side only, and changes of answers and of work. @returns the number of changed answers"""
    for key, before, after in version_changes(base[0], contender[0]):
        print(f"version  {key}: {text_of(before)} -> {text_of(after)}")
    for side, rows in zip(("base", "contender"), missing_rows(base, contender)):
        for row in rows:
            print(f"only in {side}: {row}")
    answers = 0
    for row, counter, before, after in changes(base, contender):
        is_work = WORK.fullmatch(counter) is not None
        answers += not is_work
        print(f"{'work    ' if is_work else 'ANSWER  '} {row}: {counter} {text_of(before)} -> {text_of(after)}")
    print(f"answers: {answers} counters of {len(counters_of(base).keys() & counters_of(contender).keys())} rows changed")
    return answers
