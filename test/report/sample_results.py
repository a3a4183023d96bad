"""Results with every kind of row, and with a name that would be a script if it were markup."""

import json

HOSTILE = "</script><img src=x onerror=\"window.hacked=1\">'{{data}}"


def outliers(algorithm, place):
    """Poses on a small model, each with numbers of its own, as sixdof-bench writes them."""
    counters = ["max_ns", "max_least_ns", "error_max", "gamma_max_F_deg", "mismatch"]
    return {"a": "torus-1k", "b": "torus-1k", "command": f"sixdof query --a torus-1k --b torus-1k --algorithm '{algorithm}'",
            "poses": {counter: f"{0.1234567890123456 + place} {i} 0 1 0 0 0" for i, counter in enumerate(counters)},
            "responses": {"gamma_max_F_deg": {"force": [1, 0, 0], "torque": [0, 0, 1], "exact_force": [0, 1, 0],
                                              "exact_torque": [0, 0, 2], "reference": [0.1, 0, 0]}}}


def row(query, algorithm, pair, kind, percent, cpu_ns, **values):
    return {"name": f"{query}/algorithm:{algorithm}/pair:{pair}/{kind}:{percent}", "run_type": "iteration", "cpu_time": cpu_ns,
            "real_time": cpu_ns, "time_unit": "ns", "configurations": 64, "judged": 64, "failed": 0, "mismatch": 0,
            "p10_ns": 0.7 * cpu_ns, "p25_ns": 0.9 * cpu_ns, "p50_ns": cpu_ns, "p75_ns": 1.2 * cpu_ns, "p90_ns": 1.5 * cpu_ns, "p99_ns": 3 * cpu_ns, "max_ns": 9 * cpu_ns, "reachable": 1000 + len(algorithm), **values,
            "outliers": outliers(algorithm, percent),
            "sixdof": {"query": query, "algorithm": algorithm, "settings": {"size": 1}, "pair": pair, "order": "random",
                       "cache": "warm", "bucket": {"kind": kind, "percent": percent}}}


def rows(factor=1.0):
    """Every kind of row, with a name that would be a script if it were markup."""
    made = []
    for i, algorithm in enumerate(["exact", "vps", "ist", HOSTILE]):
        for pair in ("elephant", HOSTILE):
            for percent in (0, 1, 5, 10):
                for query in ("collide", "distance"):
                    made.append(row(query, algorithm, pair, "distance", percent, factor * 1000 * (i + 1) / (1 + percent), error_rms=1e-4 * i,
                                    error_max=1e-3 * i, mismatch=3 if i == 3 else 0))
                made.append(row("respond", algorithm, pair, "volume", percent, 5000 * (i + 1), gamma_F_deg=3.0 * i, gamma_max_F_deg=20.0 * i,
                                magnitude_error_F=0.1 * i, misses=0))
        for scenario in ("Ia", "II"):
            one = row("scenario", algorithm, "", "distance", 0, 900.0, sigma_F=0.02 * i, gamma_F_deg=2.0 * i, nu_F=1.1, leakage=0.0, steps=100)
            one["name"] = f"scenario/{scenario}/algorithm:{algorithm}"
            del one["sixdof"]["bucket"]
            one["sixdof"]["scenario"] = scenario
            made.append(one)
            equal = json.loads(json.dumps(one))
            equal["name"] = f"equivalent/scenario:{scenario}/algorithm:{i}/tau:0.9ms"
            equal["sixdof"]["query"] = "equivalent"
            equal.update(tau_ns=9e5, measured_ns=8e5)
            made.append(equal)
    return made


def cast_rows():
    """Rows of casts, of three steps so that lines have points."""
    made = []
    for i, algorithm in enumerate(["exact", "fcl-cast", HOSTILE]):
        for pair in ("elephant", HOSTILE):
            for motion in ("translation", "tumble"):
                for step in (0.01, 1, 10):
                    one = row("cast", algorithm, pair, "distance", 0, 1000.0 * (i + 1) * (2 + step), hits=48, missed_hits=6 * i,
                              mismatch=6 * i, late_hits=0, late_max=0.0, early=i, early_max=0.01 * i, phantom_hits=0, false_starts=0, grazing=0)
                    one["name"] = f"cast/algorithm:{algorithm}/pair:{pair}/motion:{motion}/step:{step}"
                    one["sixdof"]["order"] = f"{motion}/{step}"
                    del one["outliers"]
                    made.append(one)
    return made


def contact_rows():
    """Rows of contacts and of depths, of several overlaps so that lines have points."""
    made = []
    for i, algorithm in enumerate(["exact-contacts", "fcl-contacts", HOSTILE]):
        for pair in ("elephant", HOSTILE):
            for percent in (1, 5, 10):
                made.append(row("contacts", algorithm, pair, "volume", percent, 2000.0 * (i + 1), contacts_mean=20.0 * percent, contact_normal_deg=2.0 * i,
                                reversed_normals=3 * i, contact_force_deg=1.0 + i, contact_depth_ratio=1.0 - 0.2 * i, uncovered_mean=0.01 * i, astray_mean=0.002 * i))
                made.append(row("depth", algorithm, pair, "volume", percent, 3000.0 * (i + 1), depth_ratio=1.0 - 0.3 * i, too_shallow=10 * i, too_deep=0,
                                too_shallow_max=0.4 * i, too_deep_max=0.0, open_depths=2, depth_width_max=0.01 * percent, depth_of_ray=0.8))
    return made


def scene_rows():
    """Rows of `sixdof-bench --suite scenes` and `--suite deform`."""
    made = []
    for i, algorithm in enumerate(["exact", "fcl-ssap", HOSTILE]):
        for scene in ("pile", HOSTILE):
            for bodies in (100, 1000):
                one = row("scene", algorithm, "", "distance", 0, 1e3, processor_ns=bodies * 100.0 * (i + 1), bodies=bodies, missed_pairs=0,
                          pairs_looked_at=bodies * (i + 2), true_pairs=bodies)
                one["name"] = f"scene/{scene}/n:{bodies}/question:near/algorithm:{algorithm}"
                del one["sixdof"]["bucket"], one["outliers"]
                one["sixdof"] |= {"scenario": scene, "question": "near"}
                made.append(one)
    return made + deform_rows()


def deform_rows():
    made = []
    for i, algorithm in enumerate(["exact", "fcl-refit", "fcl-rebuild"]):
        for scene in ("wave", "twist"):
            for amplitude in (1, 10):
                update, answer = 1e5 * (i + 1), 1e4 * amplitude
                one = row("deform", algorithm, "", "distance", 0, 1e3, processor_ns=update + answer, update_ns=update, answer_ns=answer,
                          amplitude=amplitude, bodies=5, missed_pairs=0, deformed_triangles=20000)
                one["name"] = f"deform/{scene}/amplitude:{amplitude}/question:near/algorithm:{algorithm}"
                del one["sixdof"]["bucket"], one["outliers"]
                one["sixdof"] |= {"scenario": scene, "question": "near"}
                made.append(one)
    return made


def collection():
    """What bench/scripts/collection and growth write beside their rows."""
    cells, ratios, growth = [], [], []
    for i, algorithm in enumerate(["exact", "vps", HOSTILE]):
        for percent in (1, 5, 10):
            cells.append({"partner": "self", "query": "distance", "bucket": {"kind": "distance", "percent": percent}, "algorithm": algorithm,
                          "objects": 30 if i < 2 or percent < 10 else 25, "mean_us": 9.0 * (i + 1), "median_us": 8.0, "least_us": 2.0, "p10_us": 3.0, "p90_us": 90.0, "greatest_us": 200.0, "greatest_object": HOSTILE})
        ratios.append({"partner": "self", "query": "distance", "algorithm": algorithm, "objects": 30, "ratio": 1.0 + i, "p10": 0.9, "p90": 5.0 + i,
                       "worst": [{"object": "bed", "ratio": 12.0}, {"object": HOSTILE, "ratio": 11.0}, {"object": "cup", "ratio": 9.0}],
                       "faster": 3, "least": {"object": "cup", "ratio": 0.5}})
        growth.append({"algorithm": algorithm, "quantity": "distance, us", "points": {"knot": [[1000, 1.0 + i], [4000, 2.0 + i]]},
                       "exponent": 0.4 + 0.1 * i, "half_width": 0.05, "fitted": 12})
    return {"collection": {"cells": cells, "against_exact": ratios}, "growth": growth}


STRESS = [{"family": family, "algorithm": algorithm, "verdict": verdict, "cases": 12, "worst": 0.1, "unit": "size", "case": HOSTILE,
           "words": HOSTILE, "reproduction": f"sixdof query --a a.off --b b.off --algorithm '{algorithm}'"}
          for family in ("scale", HOSTILE)
          for algorithm, verdict in (("exact", "exact"), ("vps", "within declared resolution"), (HOSTILE, "wrong"), ("ist", "declared unsupported"))]
