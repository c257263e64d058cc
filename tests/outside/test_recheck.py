"""Plans of built-in and random problems, re-checked by other people's programs; planted faults, seen.

Run by itself it takes how many random problems: `test_recheck.py 10000` says how many were solved, wrong, or
ended in exit 4.
"""

import json
import os
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
import trimesh

import mutate
import problems
from judged import Hand
from recheck import Recheck

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
BUILT_IN = sorted(path.stem for path in SCENARIOS.glob("*.toml"))
SEEDS = range(5)
RANDOM = range(0, 100, 20)


@pytest.mark.parametrize("name", BUILT_IN)
def test_built_in_plans(name):
    assert on_all_cores(built_in, [(name, seed) for seed in SEEDS]) == {}


@pytest.mark.parametrize("first", RANDOM)
def test_random_problems(first):
    assert on_all_cores(random_problem, range(first, first + RANDOM.step)) == {}


def on_all_cores(check, inputs):
    """What is wrong with which input."""
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        return {given: wrong for given, wrong in zip(inputs, pool.map(check, inputs)) if wrong}


def built_in(problem):
    name, seed = problem
    with tempfile.TemporaryDirectory() as folder:
        words = [os.environ["REGRASP"], "plan", name, "--seed", str(seed), "-o", "plan.json"]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=300)
        if done.returncode != 0:
            return {"program": done.stderr[-2000:]}
        return Recheck(json.loads((Path(folder) / "plan.json").read_text())).run()


def random_problem(seed):
    with tempfile.TemporaryDirectory() as folder:
        code, found = solve(seed, Path(folder))
    return found or ({} if code in (0, 3) else {"exit": code})


def solve(seed, folder, limit=5):
    """Plans a random problem: the exit code, and what the re-check finds in the plan."""
    path = problems.write(folder, seed)
    words = [
        os.environ["REGRASP"],
        "plan",
        str(path),
        "--seed",
        str(seed),
        "--time-limit",
        str(limit),
        "-o",
        "plan.json",
    ]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=120)
    if done.returncode != 0:
        return done.returncode, {} if done.returncode == 3 else {"program": done.stderr[-2000:]}
    return 0, Recheck(json.loads((folder / "plan.json").read_text())).run()


def test_plans_on_a_scan(regrasp, tmp_path):
    """A ball as a scanner sees it: contacts live on a twin, as near to the mesh as the plan says."""
    scan = trimesh.creation.icosphere(subdivisions=4, radius=0.0275)
    scan.vertices *= 1 + np.random.default_rng(7).normal(size=(len(scan.vertices), 1)) * 2e-4 / 0.0275
    scan.export(tmp_path / "scan.obj")
    (tmp_path / "scan.toml").write_text(
        """[hand]
builtin = "four-finger"
[object]
shape = { kind = "mesh", file = "scan.obj" }
friction = 0.8
[start]
pose = { position = [0.0, 0.0, 0.085] }
[[goal]]
pose = { position = [0.0, 0.0, 0.085], axis = [0.0, 0.0, 1.0], angle_deg = 180.0 }
"""
    )
    regrasp("plan", "scan.toml", "-o", "plan.json", cwd=tmp_path)
    plan = json.loads((tmp_path / "plan.json").read_text())
    assert Recheck(plan).run() == {}
    plan["object"]["contact_surface"]["bound"] /= 20
    assert "contact surface" in Recheck(plan).run()


@pytest.mark.parametrize("name", ["sphere", "allegro-ball", "cube-free"])
def test_the_exported_urdf_moves_as_the_plan_s_hand_does(name, regrasp, tmp_path):
    regrasp("plan", name, "-o", "plan.json", cwd=tmp_path)
    regrasp("export", "plan.json", "--to", "urdf", "-o", ".", cwd=tmp_path)
    plan = json.loads((tmp_path / "plan.json").read_text())
    hand = Hand(plan["scenario"]["problem"]["hand"])
    # The hand's file is the one with joints that move.
    models = [pin.buildModelFromUrdf(str(file)) for file in sorted(tmp_path.glob("*.urdf"))]
    model = max(models, key=lambda model: model.nq)
    data = model.createData()
    states = [q for segment in plan["segments"] for q in segment["states"]][::25]
    for q in states:
        joints = np.concatenate(q["joints"])
        hand.place(joints)
        there = pin.neutral(model)
        for joint, value in zip(hand.joints, joints):
            there[model.joints[model.getJointId(joint["name"])].idx_q] = value
        pin.framesForwardKinematics(model, data, there)
        for f, finger in enumerate(hand.description["finger"]):
            tip = data.oMf[model.getFrameId(f"{finger['name']}-tip")].translation
            assert np.linalg.norm(tip - hand.tip(f)) < 1e-6


def test_every_planted_fault_is_seen(regrasp, tmp_path):
    regrasp("plan", "sphere-tilt", "-o", "plan.json", cwd=tmp_path)
    plan = json.loads((tmp_path / "plan.json").read_text())
    assert len(mutate.FAULTS) >= 20 and Recheck(plan).run() == {}
    assert mutate.unseen(plan) == []


def main():
    counts = Counter()
    for seed in range(int(sys.argv[1])):
        with tempfile.TemporaryDirectory() as folder:
            code, found = solve(seed, Path(folder))
        counts[f"exit {code}"] += 1
        counts["wrong"] += bool(found)
        if found:
            print(seed, found, flush=True)
    print(dict(counts))
    sys.exit(1 if counts["wrong"] else 0)


if __name__ == "__main__":
    main()
