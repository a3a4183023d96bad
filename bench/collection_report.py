"""What bench/collection makes of its units: one result file, the figure's data, and a table."""

import collections
import csv
import io
import math
import pathlib
import statistics
import sys

import object_runs as runs

# Columns of the table, in percent; the figure has all buckets.
SHOWN = {"distance": [("distance", p) for p in (0, 1, 5, 10, 20, 30)] + [("volume", 5)],
         "collide": [("distance", p) for p in (0, 1, 5, 10, 20, 30)] + [("volume", p) for p in (1, 5, 10)],
         "respond": [("volume", p) for p in (1, 2, 5, 10)]}
REFERENCE = "exact"
WORST = 3  # Objects that the table names per algorithm.
# Where objects of one kind are compared with all others, and the fewest objects for that.
COMPARED = [("distance", ("distance", 5.0)), ("collide", ("distance", 1.0)), ("respond", ("volume", 5.0))]
FEWEST_COMPARED = 8


def quantile(values, share):
    """By linear interpolation between order statistics."""
    ordered = sorted(values)
    place = share * (len(ordered) - 1)
    low = math.floor(place)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (place - low) * (ordered[high] - ordered[low])


def geometric_mean(values):
    return math.exp(statistics.fmean(math.log(value) for value in values))


def times_and_faults(units):
    """{(partner, query, bucket, algorithm): {object: ns}}, and the rows at fault as (unit, row's name, why)."""
    times, faults = collections.defaultdict(dict), []
    for unit in units:
        labels = unit["labels"]
        for row in unit["benchmarks"]:
            why = runs.fault_of(row)
            if why:
                faults.append((unit["unit"], row["name"], why))
                continue
            fields = row["sixdof"]
            bucket = runs.bucket_of(unit, row)
            if bucket:
                key = (labels["partner"], fields["query"], bucket, fields["algorithm"])
                times[key][labels["object"]] = runs.cpu_ns(row)
    return times, faults


def cell(by_object):
    """Mean and spread over objects of one algorithm in one bucket, in microseconds."""
    us = {name: ns / 1e3 for name, ns in by_object.items()}
    values = list(us.values())
    worst = max(us, key=us.get)
    return {"objects": len(values), "mean_us": statistics.fmean(values), "median_us": statistics.median(values),
            "p10_us": quantile(values, 0.1), "p90_us": quantile(values, 0.9), "least_us": min(values),
            "greatest_us": max(values), "greatest_object": worst}


def ratios_to_reference(times, partner, query):
    """{algorithm: {object: geometric mean over buckets of time / time of `exact`}}"""
    ratios = collections.defaultdict(lambda: collections.defaultdict(list))
    for (of_partner, of_query, bucket, algorithm), by_object in times.items():
        if (of_partner, of_query) != (partner, query):
            continue
        reference = times.get((partner, query, bucket, REFERENCE), {})
        for name, ns in by_object.items():
            if reference.get(name, 0) > 0 and ns > 0:
                ratios[algorithm][name].append(ns / reference[name])
    return {algorithm: {name: geometric_mean(values) for name, values in by_object.items()}
            for algorithm, by_object in ratios.items()}


def power_law(points):
    """(c, e) of y = c x^e through (x, y), by least squares of the logarithms; e is 0 if all x are equal."""
    xs, ys = [math.log(x) for x, _ in points], [math.log(y) for _, y in points]
    mx, my = statistics.fmean(xs), statistics.fmean(ys)
    spread = sum((x - mx) ** 2 for x in xs)
    exponent = sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / spread if spread > 0 else 0.0
    return math.exp(my - exponent * mx), exponent


def hardness(units, times):
    """How much more time objects of a kind take than the law of the number of triangles says, which is fitted to all
    objects: geometric means, with themselves as partners."""
    objects = {unit["labels"]["object"]: unit["labels"] for unit in units}
    found = []
    for query, bucket in COMPARED:
        for algorithm in sorted({key[3] for key in times if key[:3] == ("self", query, bucket)}):
            by_object = times["self", query, bucket, algorithm]
            if len(by_object) < FEWEST_COMPARED:
                continue
            factor, exponent = power_law([(objects[name]["triangles"], ns) for name, ns in by_object.items()])
            kinds = collections.defaultdict(list)
            for name, ns in by_object.items():
                kinds[objects[name]["kind"]].append(ns / (factor * objects[name]["triangles"] ** exponent))
            found.append({"query": query, "bucket": {"kind": bucket[0], "percent": bucket[1]}, "algorithm": algorithm,
                          "exponent": exponent, "kinds": {kind: {"objects": len(values), "factor": geometric_mean(values)}
                                                          for kind, values in sorted(kinds.items())}})
    return found


def summary_of(units):
    times, faults = times_and_faults(units)
    cells = [{"partner": partner, "query": query, "bucket": {"kind": kind, "percent": percent}, "algorithm": algorithm,
              **cell(by_object)}
             for (partner, query, (kind, percent), algorithm), by_object in sorted(times.items())]
    against = []
    for partner, query in sorted({(key[0], key[1]) for key in times}):
        for algorithm, by_object in sorted(ratios_to_reference(times, partner, query).items()):
            worst = sorted(by_object, key=by_object.get, reverse=True)[:WORST]
            least = min(by_object, key=by_object.get)
            against.append({"partner": partner, "query": query, "algorithm": algorithm, "objects": len(by_object),
                            "ratio": geometric_mean(by_object.values()), "p10": quantile(by_object.values(), 0.1),
                            "p90": quantile(by_object.values(), 0.9),
                            "worst": [{"object": name, "ratio": by_object[name]} for name in worst],
                            "faster": sum(ratio < 1.0 for ratio in by_object.values()),
                            "least": {"object": least, "ratio": by_object[least]}})
    not_measured = [{"unit": unit["unit"], "algorithm": algorithm, "why": record["status"]}
                    for unit in units for algorithm, record in unit["algorithms"].items() if record["status"] != "ok"]
    sets = [{"unit": unit["unit"], "why": unit["set"]["status"]} for unit in units if unit["set"]["status"] != "ok"]
    return {"units": len(units), "objects": sorted({unit["labels"]["object"] for unit in units}), "cells": cells,
            "against_" + REFERENCE: against, "hardness": hardness(units, times), "sets_not_made": sets, "not_measured": not_measured,
            "faults": [{"unit": unit, "row": row, "why": why} for unit, row, why in faults]}


def rows_of(units):
    """The rows of all units in the project's format, with the unit's labels among their fields."""
    rows = []
    for unit in units:
        for row in unit["benchmarks"]:
            rows.append({**row, "sixdof": {**row["sixdof"], "object": unit["labels"]["object"],
                                           "partner": unit["labels"]["partner"]}})
    return rows


def us(value):
    return f"{value:.3g}" if value < 1e4 else f"{value:,.0f}"


def text_of(found, most):
    fewer = f" [{found['objects']}]" if found["objects"] < most else ""
    return f"{us(found['mean_us'])} ({us(found['p10_us'])}..{us(found['p90_us'])}){fewer}"


def table(summary):
    """Lines of Markdown: mean over objects, 10 % to 90 %, by algorithm and bucket; then ratios and worst objects."""
    by_key = {(one["partner"], one["query"], one["algorithm"], one["bucket"]["kind"], one["bucket"]["percent"]): one
              for one in summary["cells"]}
    lines = []
    for one in sorted({(key[0], key[1]) for key in by_key}):
        partner, query = one
        shown = [bucket for bucket in SHOWN[query] if any(key[:2] == one and key[3:] == bucket for key in by_key)]
        if not shown:
            continue
        most = max(value["objects"] for key, value in by_key.items() if key[:2] == one)
        lines += ["", f"**{query}, {partner}**: mean over {most} objects, us (10 %..90 % of the objects); in square brackets "
                  "the number of objects where it is less", "",
                  "| algorithm | " + " | ".join(f"{kind} {percent:g} %" for kind, percent in shown) + " |",
                  "|---|" + "---|" * len(shown)]
        for algorithm in sorted({key[2] for key in by_key if key[:2] == one}):
            cells = []
            for bucket in shown:
                found = by_key.get((partner, query, algorithm, *bucket))
                cells.append(text_of(found, most) if found else "-")
            lines.append(f"| `{algorithm}` | " + " | ".join(cells) + " |")
    lines += ["", f"Time / time of `{REFERENCE}` on the same object (geometric mean over buckets and objects):", "",
              "| partner | query | algorithm | objects | ratio | 10 %..90 % | faster on | worst objects |",
             "|---|---|---|---|---|---|---|---|"]
    for one in summary["against_" + REFERENCE]:
        if one["algorithm"] == REFERENCE:
            continue
        worst = ", ".join(f"{each['object']} {each['ratio']:.3g}" for each in one["worst"])
        lines.append(f"| {one['partner']} | {one['query']} | `{one['algorithm']}` | {one['objects']} | "
                     f"{one['ratio']:.3g} | {one['p10']:.3g}..{one['p90']:.3g} | {one['faster']} | {worst} |")
    return lines + hardness_table(summary["hardness"])


def hardness_table(found):
    """Lines of Markdown, none without entries."""
    kinds = sorted({kind for one in found for kind in one["kinds"]})
    if not kinds:
        return []
    lines = ["", "What makes an object hard: time / what the number of triangles n alone says, c n^e (geometric mean over "
             "the objects of a kind; in brackets their number):", "",
             "| query | algorithm | e | " + " | ".join(kinds) + " |", "|---|---|---|" + "---|" * len(kinds)]
    for one in found:
        cells = [f"{one['kinds'][kind]['factor']:.2f} ({one['kinds'][kind]['objects']})" if kind in one["kinds"] else "-"
                 for kind in kinds]
        where = f"{one['query']}, {one['bucket']['kind']} {one['bucket']['percent']:g} %"
        lines.append(f"| {where} | `{one['algorithm']}` | {one['exponent']:.2f} | " + " | ".join(cells) + " |")
    return lines


def write_figure(file, cells):
    """The figure's data: time against distance and volume, one line per partner, query, algorithm and bucket."""
    fields = ["partner", "query", "algorithm", "bucket", "percent", "objects", "mean_us", "median_us", "p10_us",
              "p90_us", "least_us", "greatest_us", "greatest_object"]
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(fields)
    for one in cells:
        row = {**one, "bucket": one["bucket"]["kind"], "percent": one["bucket"]["percent"]}
        writer.writerow([f"{row[field]:.5g}" if isinstance(row[field], float) else row[field] for field in fields])
    runs.write_whole(file, out.getvalue())


def write_report(folder: pathlib.Path):
    """Writes results.json and figure.csv, prints the table. @raises Failure if no unit is measured"""
    units = runs.results(folder)
    if not units:
        raise runs.Failure(f"{folder}: no pair is measured yet")
    summary = summary_of(units)
    context = next((unit["context"] for unit in units if "context" in unit), {})
    runs.write(folder / "results.json", {"context": context, "benchmarks": rows_of(units), "collection": summary})
    write_figure(folder / "figure.csv", summary["cells"])
    print(f"{len(units)} pairs of {len(summary['objects'])} objects.")
    print("\n".join(table(summary)))
    sys.stdout.flush()
    for title, entries in (("Sets that were not made as chosen", summary["sets_not_made"]),
                           ("Algorithms that did not end", summary["not_measured"]), ("Faults", summary["faults"])):
        counted = collections.Counter((each.get("algorithm") or each.get("row", "").split("/pair:")[0], each["why"])
                                      for each in entries)
        if counted:
            print(f"\n{title}: {len(entries)}")
            for (what, why), count in counted.most_common(20):
                print(f"  {count} x {what + ': ' if what else ''}{why}")
