"""Two records of speed side by side: `python tests/outside/bench_compare.py OLD NEW [--measure planning_s]`.

`cargo bench --bench record -- -o FILE` writes a record. Runs of one scenario and seed belong together, so that what is compared is the ratio new ÷ old
of each pair; its median has an interval of 95 % from 10,000 bootstrap samples of the pairs (B. Efron, R. Tibshirani, "An Introduction to the Bootstrap", 1993,
chapter 13; percentiles). An interval that holds 1 shows nothing, and says so. Of two machines, or of busy ones, it compares machines.
"""

import argparse
import json
import sys

import numpy as np

MEASURES = ("planning_s", "verification_s", "process_s", "floor_s")
SAMPLES = 10_000


def load(path):
    """A record; ends with a message where the file is none."""
    try:
        with open(path) as file:
            record = json.load(file)
    except (OSError, ValueError) as error:
        sys.exit(f"{path}: {error}")
    if not isinstance(record, dict) or record.get("format") != "regrasp-record":
        sys.exit(f"{path}: no record of speed; `cargo bench --bench record -- -o FILE` writes one")
    if record.get("version") != 1:
        sys.exit(f"{path}: version {record.get('version')} of records is not known; 1 is")
    return record


def solved(entry, seeds, measure):
    """The seconds of each seed that was solved."""
    left = [seed for seed in range(seeds) if seed not in set(entry["unsolved"])]
    return dict(zip(left, entry[measure], strict=True))


def ratio(old, new):
    """Median of new ÷ old over the seeds that both solved, and its interval."""
    seeds = sorted(old.keys() & new.keys())
    if not seeds:
        return None
    ratios = np.array([new[seed] / old[seed] for seed in seeds])
    draws = np.random.default_rng(0).integers(0, len(seeds), (SAMPLES, len(seeds)))
    low, high = np.percentile(np.median(ratios[draws], axis=1), (2.5, 97.5))
    return float(np.median(ratios)), float(low), float(high)


def verdict(low, high):
    """What the interval says."""
    if high < 1:
        return "faster"
    return "slower" if low > 1 else "no difference shown"


def compare(old, new, measure):
    """A row for each scenario of both records: name, both medians and worst (ms), the ratio with its interval, the verdict."""
    rows = []
    for name in old["scenarios"].keys() & new["scenarios"].keys():
        before, after = (solved(record["scenarios"][name], record["seeds"], measure) for record in (old, new))
        found = ratio(before, after)
        if found is None:
            rows.append((name, None, None, None, None, None, "no seed solved by both"))
            continue
        ms = [1e3 * float(f(list(times.values()))) for f in (np.median, np.max) for times in (before, after)]
        rows.append((name, ms[0], ms[1], ms[2], ms[3], found, verdict(*found[1:])))
    return sorted(rows, key=lambda row: row[0])


def table(rows):
    """The rows as text."""
    lines = [f"{'ms':<24}{'old':>9}{'new':>9}{'old worst':>11}{'new worst':>11}  new ÷ old (95 %)"]
    for name, old, new, old_worst, new_worst, found, says in rows:
        if found is None:
            lines.append(f"{name:<24}{'':>40}  {says}")
            continue
        middle, low, high = found
        lines.append(f"{name:<24}{old:>9.1f}{new:>9.1f}{old_worst:>11.1f}{new_worst:>11.1f}  {middle:.3f} ({low:.3f}-{high:.3f})  {says}")
    return "\n".join(lines)


def main():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--measure", choices=MEASURES, default="planning_s")
    arguments = parser.parse_args()
    old, new = load(arguments.old), load(arguments.new)
    for key in ("processor", "cores", "compiler"):
        if old["origin"].get(key) != new["origin"].get(key):
            print(f"note: another {key}: {old['origin'].get(key)} and {new['origin'].get(key)}", file=sys.stderr)
    print(table(compare(old, new, arguments.measure)))


if __name__ == "__main__":
    main()
