#!/usr/bin/env python3
"""bench/scripts/response-table prints the numbers of `sixdof equivalent` and `sixdof quality`, and no half table after an error.

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

    grid = ["--grid", "vps:voxel_size=0.06,0.04,0.03", "--grid", "vps:point_spacing=0.06,0.04,0.03"]
    run = table("--program", sixdof, "--scenario", "II", "--algorithm", "vps", "--steps", STEPS, "--tau", "3us", *grid)
    assert run.returncode == 0, run.stderr
    assert "At a mean query time of 3us:" in run.stdout, run.stdout
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in run.stdout.splitlines()]
    row = next(line for line in lines if line[:3] == ["gamma_F_deg", "II", "vps"])
    assert row[3] == "2.4", row
    found = row[4].split()
    assert [word.split("=")[0] for word in found] == ["voxel_size", "point_spacing"], row
    for law, columns, name in (("paper", [6], "gamma_F_deg"), ("own", [7, 8], "gamma_F_deg")):
        command = [sixdof, "quality", "--scenario", "II", "--steps", STEPS, "--json", "--algorithm", "vps", "--law", law]
        command += [word for parameter in found for word in ("--parameter", parameter)]
        value = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)["measures"][name]
        for column in columns:
            assert abs(float(row[column].split()[0]) - value) <= 0.06 * value, (row, law, value)
            assert row[column].endswith("(worse)") == (value > 2.4), (row, law, value)
    prediction = next(line for line in lines if line[:2] == ["vps", "1"])
    assert prediction[-1] == "1.2 %" and all("%" in cell for cell in prediction[2:]), prediction

    missing = table("--program", sixdof + "-is-not-there")
    assert missing.returncode == 1 and "is-not-there" in missing.stderr and not missing.stdout, missing
    unknown = table("--program", sixdof, "--scenario", "V")
    assert unknown.returncode == 2 and "'V'" in unknown.stderr, unknown
    no_unit = table("--program", sixdof, "--scenario", "II", "--algorithm", "vps", "--tau", "3")
    assert no_unit.returncode == 1 and "with a unit" in no_unit.stderr, no_unit
    refused = table("--program", sixdof, "--defaults", "--scenario", "II", "--steps", "0")
    assert refused.returncode == 1 and "steps" in refused.stderr, refused


if __name__ == "__main__":
    main()
