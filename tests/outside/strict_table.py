#!/usr/bin/env python3
"""The figures of a study as a table in Markdown, in the meanings of the paper's Table 1.

    tests/outside/strict_table.py FOLDER/runs.csv

A row for each problem and variant: pairs of given grasps of one problem (`NAME-given-K`) are taken together.
Counts are means over the runs that were solved and verified, medians in brackets.
"""

import csv
import re
import statistics
import sys

COLUMNS = [
    ("generated", "generated_nodes"),
    ("kept", "kept_nodes"),
    ("GS_n components", "grasp_components"),
    ("paths in GS_n used", "used_grasp_edges"),
    ("transfer edges used", "used_transfer_edges"),
    ("decompositions", "decompositions"),
    ("failed", "failed_decompositions"),
    ("stability tests", "stability-test.calls"),
    ("collision tests", "collision_tests"),
]


def family(name):
    """The problem that a scenario is a pair of."""
    return re.sub(r"-given-\d+$", " (given)", name)


def solved(row):
    return row["status"] == "solved" and row["verified"] == "true"


def mean_and_median(rows, key):
    values = [float(row[key]) for row in rows if row.get(key)]
    if not values:
        return "-"
    mean, median = statistics.mean(values), statistics.median(values)
    return f"{mean:.1f} ({median:.0f})" if mean < 1000 else f"{mean:.0f} ({median:.0f})"


def line(cells):
    return "| " + " | ".join(cells) + " |"


def table(rows):
    keys = list(dict.fromkeys((family(row["scenario"]), row["variant"]) for row in rows))
    head = ["problem", "variant", "solved", "s, median", "s, slowest"]
    head += [name for name, _ in COLUMNS] + ["with a path in GS_n"]
    lines = [line(head), line(["---", "---"] + ["--:"] * (len(head) - 2))]
    for problem, variant in keys:
        runs = [row for row in rows if (family(row["scenario"]), row["variant"]) == (problem, variant)]
        good = [row for row in runs if solved(row)]
        times = [float(row["planning_s"]) for row in good] or [float("nan")]
        with_path = sum(int(row["used_grasp_edges"]) > 0 for row in good)
        cells = [problem, variant, f"{len(good)} of {len(runs)}"]
        cells += [f"{statistics.median(times):.3f}", f"{max(times):.2f}"]
        cells += [mean_and_median(good, key) for _, key in COLUMNS] + [f"{with_path} of {len(good)}"]
        lines.append(line(cells))
    return "\n".join(lines)


if __name__ == "__main__":
    with open(sys.argv[1], newline="", encoding="utf-8") as file:
        print(table(list(csv.DictReader(file))))
