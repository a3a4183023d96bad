#!/usr/bin/env python3
"""bench/response-table prints the numbers of `sixdof quality`, and a message instead of half a table.

usage: response_table_test.py SIXDOF RESPONSE_TABLE
"""
import json
import subprocess
import sys

STEPS = "25"
COLUMNS = {
    "exact": ["exact"],
    "vps": ["vps"],
    "vps-field": ["vps-field"],
    "ist": ["ist"],
    "ist-descent": ["ist-descent"],
    "fcl-contacts": ["fcl-contacts"],
}


def main():
    sixdof, script = sys.argv[1:3]

    def table(*options):
        return subprocess.run([sys.executable, "-B", script, *options], capture_output=True, text=True)

    run = table("--program", sixdof, "--defaults", "--scenario", "II", "--steps", STEPS)
    assert run.returncode == 0, run.stderr
    lines = [line.strip("|").split("|") for line in run.stdout.splitlines() if line.startswith("|")]
    rows = {tuple(cell.strip() for cell in line[:2]): [cell.strip() for cell in line[2:]] for line in lines}
    assert rows["scenario", "measure"] == list(COLUMNS), run.stdout
    assert {scenario for scenario, _ in rows if len(scenario) < 4 and scenario.strip("-")} == {"II"}, run.stdout
    assert all(float(value) > 0 for value in rows["II", "mean ms"]), run.stdout

    for column, (name_of_column, algorithm) in enumerate(COLUMNS.items()):
        command = [sixdof, "quality", "--scenario", "II", "--steps", STEPS, "--json", "--algorithm", *algorithm]
        measures = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)["measures"]
        for name in ("sigma_F", "gamma_F_deg", "leakage"):
            shown = float(rows["II", name][column])
            value = measures[name]
            assert abs(shown - value) <= 0.06 * abs(value), (name_of_column, name, shown, value)

    missing = table("--program", sixdof + "-is-not-there")
    assert missing.returncode == 1 and "is-not-there" in missing.stderr and not missing.stdout, missing
    unknown = table("--program", sixdof, "--scenario", "V")
    assert unknown.returncode == 2 and "'V'" in unknown.stderr, unknown
    refused = table("--program", sixdof, "--defaults", "--scenario", "II", "--steps", "0")
    assert refused.returncode == 1 and "steps" in refused.stderr, refused


if __name__ == "__main__":
    main()
