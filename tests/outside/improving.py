#!/usr/bin/env python3
"""What does `--improve` buy? The study of book/src/studies/improving.md.

usage: improving.py [--regrasp PROGRAM] [--seeds N] [--searches N] [--seconds S] [--threads N] [--tables]

Plans every built-in scenario with seeds from 0 on and improves each plan by further searches; prints the tables from `studies/improving.csv`. Rows that
are there are kept, after S seconds no run is begun, and with --tables none at all.

Needs Python 3.11 and the packages of requirements.txt.
"""

import argparse
import csv
import json
import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

import ranks

ROOT = Path(__file__).parents[2]
TABLE = ROOT / "studies" / "improving.csv"
HEAD = ["scenario", "seed", "searches", "first_s", "last_s", "curve"]
AFTER = [0, 1, 2, 5, 10, 20, 40]


def improved(program, name, seed, searches):
    """The row of one run: the curve is `search:regrasps` for each plan that was better than all before."""
    command = [program, "plan", name, "--seed", str(seed), "--improve", f"{searches}x", "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        print(f"{name}, seed {seed}: exit {done.returncode}", file=sys.stderr)
        return [name, seed, searches, "", "", ""]
    curve = json.loads(done.stdout)["improve"]["curve"]
    fewer = [better for k, better in enumerate(curve) if k == 0 or better["cost"] < curve[k - 1]["cost"]]
    steps = " ".join(f"{better['search']}:{better['cost']:.0f}" for better in fewer)
    return [name, seed, searches, f"{fewer[0]['time_s']:.4f}", f"{fewer[-1]['time_s']:.4f}", steps]


def read():
    if not TABLE.exists():
        return []
    with TABLE.open(newline="") as file:
        return list(csv.DictReader(file))


def make(args):
    names = [file.stem for file in sorted((ROOT / "scenarios").glob("*.toml"))]
    known = {(row["scenario"], int(row["seed"])) for row in read()}
    wanted = [(name, seed) for seed in range(args.seeds) for name in names if (name, seed) not in known]
    end = time.monotonic() + args.seconds
    one = lambda job: improved(args.regrasp, *job, args.searches) if time.monotonic() < end else None
    with ThreadPoolExecutor(args.threads) as pool, TABLE.open("a", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        if not known:
            out.writerow(HEAD)
        for row in pool.map(one, wanted):
            if row:
                out.writerow(row)
                file.flush()


def costs(row):
    """Regrasps of the best plan after each number of searches in AFTER."""
    steps = [tuple(map(int, step.split(":"))) for step in row["curve"].split()]
    return [min(cost for search, cost in steps if search <= after) for after in AFTER]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--regrasp", default=os.environ.get("REGRASP", "regrasp"))
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--searches", type=int, default=40)
    parser.add_argument("--seconds", type=float, default=1e9)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--tables", action="store_true")
    args = parser.parse_args()
    if not args.tables:
        make(args)
    solved = [row for row in read() if row["curve"]]
    names = sorted({row["scenario"] for row in solved})
    groups = {name: np.array([costs(row) for row in solved if row["scenario"] == name], float) for name in names}
    random = np.random.default_rng(0)
    print("| scenario | runs | " + " | ".join(f"after {k}" for k in AFTER) + " | saved (95 %) | |")
    print("|---|--:|" + "--:|" * len(AFTER) + "--:|---|")
    for name, group in groups.items():
        saved, samples = ranks.means([group], [lambda g: (g[:, 0] - g[:, -1]).mean()], random)
        low, high = ranks.interval(samples[:, 0])
        verdict = "no difference" if -0.5 <= low and high <= 0.5 else ""
        cells = " | ".join(f"{mean:.1f}" for mean in group.mean(axis=0))
        print(f"| `{name}` | {len(group)} | {cells} | {saved[0]:.1f} ({low:.1f} to {high:.1f}) | {verdict} |")
    some = [group for group in groups.values() if group[:, 0].mean() > 0]
    share = lambda g: 1 - g[:, -1].mean() / g[:, 0].mean() if g[:, 0].mean() > 0 else np.nan
    mean, samples = ranks.means(some, [share], random)
    low, high = ranks.interval(samples[:, 0])
    print(f"\nsaved of all regrasps, mean of {len(some)} scenarios: {100 * mean[0]:.0f} % ({100 * low:.0f} to {100 * high:.0f} %)")
    sums = sum(group.mean(axis=0) for group in groups.values())
    gains = (sums[0] - sums) / (sums[0] - sums[-1])
    print("of what the most searches save, saved after k: " + ", ".join(f"{k}: {100 * g:.0f} %" for k, g in zip(AFTER, gains)))
    ratios = [float(row["last_s"]) / float(row["first_s"]) for row in solved]
    print(f"time of the last improvement over that of the first plan, median of {len(ratios)} runs: {np.median(ratios):.1f}")


if __name__ == "__main__":
    main()
