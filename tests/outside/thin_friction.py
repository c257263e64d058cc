#!/usr/bin/env python3
"""Plans for thin friction: how many are found, and how many arrive when friction and mass are not what was planned for.

usage: thin_friction.py [--regrasp PROGRAM] [--seeds FIRST:LAST] [--factor X|most|none] [--time-limit S] [--mujoco] [-o DIR]

The object is a hexagonal prism, 40 mm across its corners and 40 mm tall, of 50 g and friction 0.8, held by `allegro-like` at (75, 0, 20) mm. Each seed gives one
goal: up to 180 degrees about a random axis, and 10 to 30 mm in a random direction. Every plan is replayed as planned, with 0.8 and 0.6 of the
friction, and with twice the mass: in rapier by `regrasp replay`, with `--mujoco` in MuJoCo too.

Needs Python 3.10; with `--mujoco` the packages of requirements.txt.
"""

import argparse
import json
import math
import random
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

REPLAYS = {"as planned": (1.0, 1.0), "friction x 0.8": (0.8, 1.0), "friction x 0.6": (0.6, 1.0), "mass x 2": (1.0, 2.0)}


def prism(radius=0.02, height=0.04):
    """Vertices (m) and facets of a hexagonal prism about the origin."""
    corners = [(radius * math.cos(k * math.pi / 3), radius * math.sin(k * math.pi / 3)) for k in range(6)]
    vertices = [[x, y, z] for z in (-height / 2, height / 2) for x, y in corners]
    facets = []
    for k in range(6):
        n = (k + 1) % 6
        facets += [[k, n, n + 6], [k, n + 6, k + 6]]
    for k in range(1, 5):
        facets += [[0, k + 1, k], [6, 6 + k, 7 + k]]
    return vertices, facets


def direction(rng):
    """A direction, uniform."""
    while True:
        v = [rng.uniform(-1, 1) for _ in range(3)]
        size = math.sqrt(sum(x * x for x in v))
        if 0.05 < size < 1:
            return [x / size for x in v]


def scenario(seed, factor):
    """The scenario file of one problem."""
    rng = random.Random(seed)
    vertices, facets = prism()
    start = [0.075, 0.0, 0.02]
    way, far = direction(rng), rng.uniform(0.01, 0.03)
    goal = [a + far * b for a, b in zip(start, way)]
    axis, angle = direction(rng), rng.uniform(0, 180)
    hold = "" if factor is None else f"[hold]\nfriction_factor = {factor}\n"
    return f"""
name = "prism-{seed}"
[hand]
builtin = "allegro-like"
[object]
name = "prism"
mass = 0.05
friction = 0.8
[object.shape]
kind = "mesh"
vertices = {vertices}
facets = {facets}
[start.pose]
position = {start}
[[goal]]
[goal.pose]
position = {goal}
axis = {axis}
angle_deg = {angle}
{hold}"""


def plan(program, folder, seed, factor, limit):
    """Plans one problem: the plan's file or None, the planner's time (s), and what it prints."""
    file, out = folder / f"{seed}.toml", folder / f"{seed}.json"
    file.write_text(scenario(seed, factor))
    out.unlink(missing_ok=True)
    command = [program, "plan", file, "--seed", seed, "--threads", 1, "--time-limit", limit, "--json", "-o", out]
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    try:
        told = json.loads(done.stdout)
    except json.JSONDecodeError:
        told = {}
    if done.returncode not in (0, 3):
        print(f"seed {seed}: exit {done.returncode}: {done.stderr.strip()[-400:]}", file=sys.stderr)
    return (out if done.returncode == 0 else None), told, done.stderr.strip()[-160:]


def arrives(program, file, scales, in_mujoco):
    """Whether a plan's object arrives under these multiples of friction and mass."""
    friction, mass = scales
    options = [file, "--friction-scale", friction, "--mass-scale", mass, "--json"]
    here = Path(__file__).parent / "mujoco_replay.py"
    command = [sys.executable, here, *options, "--regrasp", program] if in_mujoco else [program, "replay", *options]
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode not in (0, 4):
        print(done.stderr.strip()[-400:], file=sys.stderr)
    return done.returncode == 0


def promised(file):
    """The friction that the plan's certificate promises, as a share of what is given."""
    told = json.loads(file.read_text())
    holds = (told.get("certificate") or {}).get("holds")
    return holds and holds["friction"]["value"] / told["scenario"]["problem"]["object"]["friction"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--regrasp", default="regrasp")
    parser.add_argument("--seeds", default="0:59")
    parser.add_argument("--factor", default="0.6")
    parser.add_argument("--time-limit", default=10)
    parser.add_argument("--mujoco", action="store_true")
    parser.add_argument("-o", "--output")
    args = parser.parse_args()
    first, last = map(int, args.seeds.split(":"))
    factor = {"none": None, "most": '"most"'}.get(args.factor, args.factor)
    folder = Path(args.output or tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    plans, times, kept = [], [], []
    for seed in range(first, last + 1):
        file, told, error = plan(args.regrasp, folder, seed, factor, args.time_limit)
        times.append(told.get("time_s", math.inf))
        if file is None:
            print(f"seed {seed}: {error}")
            continue
        plans.append(file)
        kept.append(promised(file) or math.inf)
    print(f"planned {len(plans)} of {len(times)}, median {statistics.median(times) * 1e3:.0f} ms")
    if plans:
        print(f"promised share of the friction: median {statistics.median(kept):.2f}, largest {max(kept):.2f}")
    for simulator in ["rapier", "MuJoCo"] if args.mujoco else ["rapier"]:
        for name, scales in REPLAYS.items():
            good = [arrives(args.regrasp, file, scales, simulator == "MuJoCo") for file in plans]
            lost = [file.stem for file, ok in zip(plans, good) if not ok]
            print(f"{simulator}, {name}: {sum(good)} of {len(good)} arrive; not: {' '.join(lost) or '-'}", flush=True)


if __name__ == "__main__":
    main()
