#!/usr/bin/env python3
"""Which margin of a plan tells best whether it survives? The study of book/src/studies/margins.md.

usage: survival.py [--seconds S] [--per-series N] [--threads N] [--regrasp PROGRAM] [--plans DIR] [--tables]

Makes plans and carries them out in rapier (`cargo run --example survival`, for S seconds at most), carries the plans in DIR out in MuJoCo, and
prints the tables from `studies/survival/plans.csv` and `mujoco.csv`. Rows that are there are kept; with --tables nothing is made.

Needs Python 3.11 and the packages of requirements.txt.
"""

import argparse
import csv
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

import ranks

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "studies" / "survival"
# The margins: column, and whether more of it is better.
MARGINS = {
    "closure's Q1": ("closure", 1),
    "wrench ball": ("wrench_ball", 1),
    "equilibrium's factor": ("equilibrium", 1),
    "friction needed": ("friction", -1),
    "effort share": ("effort", -1),
    "segments": ("segments", -1),
}
RAPIER = ["f1m1", "f08m1", "f06m1", "f1m2", "f08m2", "f06m2"]
MUJOCO = {"f1m1": 1.0, "f08m1": 0.8, "f06m1": 0.6}


def rows(path):
    """The rows of a table that hold a plan."""
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return [row for row in csv.DictReader(file) if row.get("solved", "1") == "1"]


def make(args):
    """Plans on until there are enough, or the time is over."""
    command = ["cargo", "run", "--quiet", "--example", "survival", "--", str(FOLDER / "plans.csv")]
    subprocess.run([*command, str(args.seconds), str(args.per_series), str(args.threads), str(args.plans)], cwd=ROOT, check=True)


def carry_out(args):
    """Carries the plans of the folder out in MuJoCo, those that the table does not have."""
    table = FOLDER / "mujoco.csv"
    known = {(row["series"], row["problem"]) for row in rows(table)}
    plans = [plan for plan in sorted(Path(args.plans).glob("*.json")) if name_of(plan) not in known]
    with ThreadPoolExecutor(args.threads) as pool, table.open("a", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        if not known:
            out.writerow(["series", "problem", *MUJOCO])
        for plan, arrived in zip(plans, pool.map(lambda plan: worlds(args.regrasp, plan), plans)):
            out.writerow([*name_of(plan), *arrived])
            file.flush()


def name_of(plan):
    series, _, problem = plan.stem.rpartition("-")
    names = {name.replace(" ", "-"): name for name in SERIES}
    return names[series], problem


def worlds(program, plan):
    """Whether a plan arrives in each of MuJoCo's worlds."""
    replay = Path(__file__).parent / "mujoco_replay.py"
    arrived = []
    for friction in MUJOCO.values():
        command = [sys.executable, str(replay), str(plan), "--friction-scale", str(friction), "--regrasp", program]
        code = subprocess.run(command, capture_output=True, check=False).returncode
        if code not in (0, 4):
            raise RuntimeError(f"{plan}: exit code {code}")
        arrived.append(int(code == 0))
    return arrived


def array(table, worlds):
    """A row a plan: its margins, more being better, then whether it arrives in each world."""

    def margin(row, column, sign):
        text = row[column]
        return sign * float(text) if text else -np.inf

    return np.array([[*(margin(row, *m) for m in MARGINS.values()), *(int(row[w]) for w in worlds)] for row in table])


def beside(names, mean, samples):
    """Prints the best margin beside each other one, then each beside the next."""
    order = [int(k) for k in np.argsort(-mean)]
    for a, b in [(order[0], k) for k in order[1:]] + list(zip(order[1:], order[2:])):
        low, high = ranks.interval(samples[:, a] - samples[:, b])
        apart = mean[a] - mean[b]
        verdict = "tells better" if low > 0 and apart >= 0.05 else "no difference that matters"
        print(f"- {names[a]} beside {names[b]}: {apart:+.2f} ({low:+.2f} to {high:+.2f}): {verdict}")


def tables(groups, worlds):
    """Prints how the margins of the plans go with what they survive."""
    count = len(MARGINS)
    survived = lambda group: group[:, count:].sum(axis=1)
    silent = [name for name, group in groups.items() if len(set(survived(group))) < 2]
    groups = {name: group for name, group in groups.items() if name not in silent}
    if silent:
        print(f"all plans survive equally, left out: {', '.join(silent)}\n")
    print("| plans of | plans | " + " | ".join(MARGINS) + " |\n|---|--:|" + "--:|" * count)
    for name, group in groups.items():
        found = [ranks.spearman(group[:, k], survived(group)) for k in range(count)]
        print(f"| {name} | {len(group)} | " + " | ".join(f"{rho:.2f}" for rho in found) + " |")
    measures = [lambda group, k=k: ranks.spearman(group[:, k], survived(group)) for k in range(count)]
    mean, samples = ranks.means(list(groups.values()), measures, np.random.default_rng(0))
    intervals = [ranks.interval(samples[:, k]) for k in range(count)]
    total = sum(map(len, groups.values()))
    print(f"| mean | {total} | " + " | ".join(f"{rho:.2f}" for rho in mean) + " |")
    print("| 95 % | | " + " | ".join(f"{low:.2f} to {high:.2f}" for low, high in intervals) + " |\n")
    beside(list(MARGINS), mean, samples)
    print("\n| world | arrive | " + " | ".join(MARGINS) + " |\n|---|--:|" + "--:|" * count)
    for w, world in enumerate(worlds):
        arrived = [group[:, count + w] == 1 for group in groups.values()]
        share = sum(a.sum() for a in arrived) / total
        chances = [
            np.nanmean([ranks.chance(g[a, k], g[~a, k]) for g, a in zip(groups.values(), arrived)]) if share < 1 else np.nan
            for k in range(count)
        ]
        print(f"| {world} | {100 * share:.0f} % | " + " | ".join(f"{c:.2f}" for c in chances) + " |")
    print()


SERIES = [
    "four-finger ball",
    "four-finger cube",
    "five-finger ellipsoid",
    "allegro-like ball",
    "allegro-like cube",
    "free-fingertips cube",
]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seconds", type=float, default=1e9)
    parser.add_argument("--per-series", type=int, default=340)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--regrasp", default=os.environ.get("REGRASP", "regrasp"))
    parser.add_argument("--plans", default=str(ROOT / "target" / "survival-plans"))
    parser.add_argument("--tables", action="store_true")
    args = parser.parse_args()
    if not args.tables:
        make(args)
        carry_out(args)
    plans = rows(FOLDER / "plans.csv")
    if not plans:
        sys.exit(f"{FOLDER / 'plans.csv'}: there are no plans yet; run this without --tables")
    of = lambda table, name: [row for row in table if row["series"] == name]
    print("## rapier\n")
    tables({name: array(of(plans, name), RAPIER) for name in SERIES}, RAPIER)
    by_name = {(row["series"], row["problem"]): row for row in plans}
    both = [(by_name[row["series"], row["problem"]], row) for row in rows(FOLDER / "mujoco.csv")]
    if both:
        print("## MuJoCo\n")
        there = [{**plan, **row} for plan, row in both]
        tables({name: array(of(there, name), MUJOCO) for name in SERIES}, list(MUJOCO))
        same = [plan[world] == row[world] for plan, row in both for world in MUJOCO]
        print(f"the simulators agree on {sum(same)} of {len(same)} plans in a world")


if __name__ == "__main__":
    main()
