#!/usr/bin/env python3
"""What becomes of the built-in scenarios that hold: how many of their plans arrive in MuJoCo, in worlds that they did not plan for.

usage: held_table.py [--regrasp PROGRAM] [--seeds FIRST:LAST] [--simulator mujoco|rapier] [-o DIR] [SCENARIO …]

Each scenario (by default every built-in one with a `[hold]`) is planned with each seed, and each plan is carried out as it is, with 0.8 of the
friction, and with twice the mass. Prints one row a scenario, ready for the book. Plans that are in DIR already are kept.

Needs Python 3.11 and, for MuJoCo, the packages of requirements.txt.
"""

import argparse
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import thin_friction

WORLDS = ["as planned", "friction x 0.8", "mass x 2"]


def that_hold():
    """The built-in scenarios with a `[hold]`."""
    files = sorted((Path(__file__).parents[2] / "scenarios").glob("*.toml"))
    return [file.stem for file in files if "hold" in tomllib.loads(file.read_text())]


def plans(program, folder, name, seeds):
    """The plans of one scenario, those that fail told."""
    for seed in seeds:
        out = folder / f"{name}-{seed}.json"
        if not out.exists():
            done = subprocess.run(
                [program, "plan", name, "--seed", str(seed), "--threads", "1", "-o", str(out)],
                capture_output=True,
                text=True,
            )
            if done.returncode != 0:
                print(f"{name}, seed {seed}: exit {done.returncode}: {done.stderr.strip()[-300:]}", file=sys.stderr)
                continue
        yield out


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scenarios", nargs="*")
    parser.add_argument("--regrasp", default="regrasp")
    parser.add_argument("--seeds", default="0:19")
    parser.add_argument("--simulator", choices=["mujoco", "rapier"], default="mujoco")
    parser.add_argument("-o", "--output")
    args = parser.parse_args()
    first, last = map(int, args.seeds.split(":"))
    folder = Path(args.output or tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    print("| | plans | " + " | ".join(WORLDS) + " |\n|---|--:|" + "--:|" * len(WORLDS))
    sums, count = [0] * len(WORLDS), 0
    for name in args.scenarios or that_hold():
        files = list(plans(args.regrasp, folder, name, range(first, last + 1)))
        row = []
        for w, world in enumerate(WORLDS):
            scales = thin_friction.REPLAYS[world]
            good = [thin_friction.arrives(args.regrasp, file, scales, args.simulator == "mujoco") for file in files]
            lost = [file.stem.rsplit("-", 1)[1] for file, ok in zip(files, good) if not ok]
            if lost:
                print(f"{name}, {world}: lost with seeds {', '.join(lost)}", file=sys.stderr)
            sums[w] += sum(good)
            row.append(f"{sum(good)}")
        count += len(files)
        print(f"| `{name}` | {len(files)} | " + " | ".join(row) + " |", flush=True)
    print(f"| all | {count} | " + " | ".join(map(str, sums)) + " |")


if __name__ == "__main__":
    main()
