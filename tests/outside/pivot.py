#!/usr/bin/env python3
"""The figures of a study as a table in Markdown: a row a problem, a column a variant, or the other way round.

    tests/outside/pivot.py FOLDER/runs.csv [--by variant] [--cell NAME]

A cell has the runs that were solved and verified, of how many, and medians over them:
`tests` (the default) stability and collision tests, in thousands; `search` generated nodes and seconds;
`plan` regrasps and milliseconds.
"""

import argparse
import csv
import statistics


def solved(row):
    return row["status"] == "solved" and row["verified"] == "true"


def median(rows, key, scale=1.0):
    return scale * statistics.median(float(row[key] or 0) for row in rows)


CELLS = {
    "tests": lambda rows: f"{median(rows, 'stability-test.calls', 1e-3):.1f}, {median(rows, 'collision_tests', 1e-3):.1f}",
    "search": lambda rows: f"{median(rows, 'generated_nodes'):.0f}, {median(rows, 'planning_s'):.2g}",
    "plan": lambda rows: f"{median(rows, 'regrasps'):.0f}, {median(rows, 'planning_s', 1e3):.3g}",
}


def cell(rows, what):
    if not rows:
        return "-"
    good = [row for row in rows if solved(row)]
    return f"{len(good)} of {len(rows)}" + (f": {CELLS[what](good)}" if good else "")


def table(rows, down, across, what):
    rows_down = list(dict.fromkeys(row[down] for row in rows))
    columns = list(dict.fromkeys(row[across] for row in rows))
    lines = [["", *columns], ["---"] + ["--:"] * len(columns)]
    for name in rows_down:
        own = [row for row in rows if row[down] == name]
        lines.append([name] + [cell([row for row in own if row[across] == column], what) for column in columns])
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs")
    parser.add_argument("--by", choices=["scenario", "variant"], default="scenario")
    parser.add_argument("--cell", choices=CELLS, default="tests")
    asked = parser.parse_args()
    with open(asked.runs, newline="", encoding="utf-8") as file:
        found = list(csv.DictReader(file))
    other = {"scenario": "variant", "variant": "scenario"}[asked.by]
    print(table(found, asked.by, other, asked.cell))
