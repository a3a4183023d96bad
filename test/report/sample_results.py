"""Results with every kind of row, and with a name that would be a script if it were markup."""

import json

HOSTILE = "</script><img src=x onerror=\"window.hacked=1\">'{{data}}"


def row(query, algorithm, pair, kind, percent, cpu_ns, **values):
    return {"name": f"{query}/algorithm:{algorithm}/pair:{pair}/{kind}:{percent}", "run_type": "iteration", "cpu_time": cpu_ns,
            "real_time": cpu_ns, "time_unit": "ns", "configurations": 64, "judged": 64, "failed": 0, "mismatch": 0,
            "p50_ns": cpu_ns, "p99_ns": 3 * cpu_ns, "max_ns": 9 * cpu_ns, **values,
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


STRESS = [{"family": family, "algorithm": algorithm, "verdict": verdict, "cases": 12, "worst": 0.1, "unit": "size", "case": HOSTILE,
           "words": HOSTILE, "reproduction": f"sixdof query --a a.off --b b.off --algorithm '{algorithm}'"}
          for family in ("scale", HOSTILE)
          for algorithm, verdict in (("exact", "exact"), ("vps", "within declared resolution"), (HOSTILE, "wrong"), ("ist", "declared unsupported"))]
