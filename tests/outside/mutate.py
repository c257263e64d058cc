#!/usr/bin/env python3
"""Plants faults into a sound plan, one at a time: each must be seen by the check that is meant for it.

usage: mutate.py PLAN.json     exits with 1 where a fault is not seen, or the sound plan is refused

A plan with transfers and at least one regrasp shows all of them.
"""

import copy
import json
import sys
from pathlib import Path

import numpy as np

from recheck import Recheck


def states(plan, kind=None):
    return [q for segment in plan["segments"] if kind in (None, segment["kind"]) for q in segment["states"]]


def segment(plan, kind):
    """The longest segment of a kind, its states."""
    return max((s for s in plan["segments"] if s["kind"] == kind), key=lambda s: len(s["states"]))


def middle(plan, kind="transfer"):
    inside = segment(plan, kind)["states"]
    return inside[len(inside) // 2]


def holding(state):
    return next(f for f, contact in enumerate(state["contacts"]) if contact)


def contact(plan, change):
    q = middle(plan)
    change(q["contacts"][holding(q)])


def tilt(c):
    n = np.array(c["normal_O"])
    side = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    n = n + 5e-3 * side
    c["normal_O"] = list(n / np.linalg.norm(n))


def shift(values, index, by):
    values[index] += by


def scale_times(plan, factor):
    for q in states(plan):
        q["time"] *= factor
        q["velocities"] = [[v / factor for v in row] for row in q["velocities"]]


def pause(plan):
    inside = segment(plan, "transfer")["states"]
    fast = max(range(1, len(inside)), key=lambda k: np.abs(np.concatenate(inside[k]["velocities"])).max())
    late = False
    for q in states(plan):
        late = late or q is inside[fast]
        q["time"] += 1.0 if late and q is not inside[fast] else 0.0


def wobble(plan):
    q = middle(plan)
    q["velocities"] = [[v + 0.3 for v in row] for row in q["velocities"]]


def running_start(plan):
    plan["segments"][0]["states"][0]["velocities"][0][0] += 0.01


def seam(plan, change):
    change(plan["segments"][1]["states"][0])


def rotate_object(plan):
    """The object turns through the fingertips, a little in every state of every transfer."""
    turned = 0.0
    for s in plan["segments"]:
        for k, q in enumerate(s["states"]):
            turned += 0.002 if s["kind"] == "transfer" and k else 0.0
            w, x, y, z = q["object"]["orientation"]
            c, d = np.cos(turned / 2), np.sin(turned / 2)
            q["object"]["orientation"] = [c * w - d * z, c * x - d * y, c * y + d * x, c * z + d * w]


def never_lift(plan):
    """A regrasp that drags: joints go straight from the first to the last state."""
    s = segment(plan, "regrasp")
    inside, f = s["states"], s["finger"]
    a, b = np.array(inside[0]["joints"][f]), np.array(inside[-1]["joints"][f])
    for k, q in enumerate(inside):
        part = k / (len(inside) - 1)
        q["joints"][f] = list(a + (b - a) * part)


def sink(plan):
    """A regrasp that goes down again before it is lifted."""
    inside = segment(plan, "regrasp")["states"]
    f = segment(plan, "regrasp")["finger"]
    for key in ("joints", "velocities"):
        inside[1][key][f], inside[2][key][f] = inside[2][key][f], inside[1][key][f]


def obstacle(plan):
    p = plan["segments"][0]["states"][0]["object"]["position"]
    shape = {"kind": "sphere", "radius": 0.005}
    plan["scenario"]["problem"].setdefault("obstacle", []).append(
        {"name": "in the way", "shape": shape, "pose": {"position": [p[0], p[1], p[2] + 0.02]}}
    )
    plan["scenario"]["problem"]["obstacle"][-1]["shape"]["radius"] = 0.03


def release(plan):
    """Two fingers let go for the whole first transfer."""
    for q in plan["segments"][0]["states"]:
        held = [f for f, c in enumerate(q["contacts"]) if c]
        for f in held[2:]:
            q["contacts"][f] = None


def finger(plan):
    return plan["scenario"]["problem"]["hand"]["finger"][0]


def figure(plan, key, factor):
    plan["certificate"][key]["value"] *= factor


def one_joint(state, by):
    state["joints"][0][0] += by


def resting_joint(plan):
    s = segment(plan, "regrasp")
    f = next(f for f in range(len(s["states"][0]["joints"])) if f != s["finger"])
    s["states"][len(s["states"]) // 2]["joints"][f][0] += 1e-7


# name: the fault, and the checks of which at least one is meant to see it.
FAULTS = {
    "a number that is none": (lambda p: middle(p)["joints"][0].__setitem__(0, float("nan")), {"form"}),
    "a joint too few": (lambda p: middle(p)["joints"][0].pop(), {"form"}),
    "a quaternion too long": (lambda p: shift(middle(p)["object"]["orientation"], 0, 1e-3), {"quaternions"}),
    "a joint past its limit": (
        lambda p: finger(p)["joint"][0].update(upper=finger(p)["joint"][0]["lower"] + 1e-3),
        {"joint limits"},
    ),
    "the object off by 50 µm": (
        lambda p: shift(middle(p)["object"]["position"], 2, 50e-6),
        {"closure", "contact points"},
    ),
    "a contact elsewhere on the object": (
        lambda p: contact(p, lambda c: shift(c["point_O"], 0, 2e-4)),
        {"contact points"},
    ),
    "a contact elsewhere on the fingertip": (
        lambda p: contact(p, lambda c: shift(c["point_F"], 1, 2e-4)),
        {"contact points"},
    ),
    "a tilted normal": (lambda p: contact(p, tilt), {"normals"}),
    "times out of order": (lambda p: middle(p).update(time=0.0), {"times"}),
    "too fast": (lambda p: scale_times(p, 0.5), {"velocities", "accelerations"}),
    "steeper than allowed": (lambda p: scale_times(p, 0.9), {"accelerations"}),
    "a stop from full speed": (pause, {"controller"}),
    "velocities of another motion": (wobble, {"controller", "accelerations"}),
    "a running start": (running_start, {"accelerations"}),
    "no velocities": (lambda p: [q.pop("velocities") for q in states(p)], {"velocities"}),
    "a torn seam": (lambda p: seam(p, lambda q: one_joint(q, 1e-9)), {"continuity"}),
    "another contact at a seam": (
        lambda p: seam(p, lambda q: shift(q["contacts"][holding(q)]["point_O"], 0, 1e-9)),
        {"continuity"},
    ),
    "the object moves in a regrasp": (
        lambda p: shift(middle(p, "regrasp")["object"]["position"], 0, 1e-7),
        {"rest"},
    ),
    "a resting finger moves": (resting_joint, {"rest"}),
    "the object slides through the fingers": (rotate_object, {"slip"}),
    "a regrasp that drags": (never_lift, {"slip", "clearance", "lift"}),
    "a regrasp that sinks": (sink, {"lift"}),
    "an obstacle in the way": (obstacle, {"clearance"}),
    "a link grown thick": (
        lambda p: finger(p)["joint"][-1]["link"][0]["shape"].update(radius=0.03),
        {"clearance"},
    ),
    "a longer link": (lambda p: shift(finger(p)["tip"], 2, 5e-4), {"closure", "contact points"}),
    "a larger fingertip": (
        lambda p: p["scenario"]["problem"]["hand"].update(
            fingertip_radius=p["scenario"]["problem"]["hand"]["fingertip_radius"] + 1e-4
        ),
        {"closure"},
    ),
    "more friction than the object has": (
        lambda p: p["claims"]["contact"]["cone"].update(
            mu=p["scenario"]["problem"]["object"]["friction"] * 1.1
        ),
        {"claims"},
    ),
    "too little friction": (lambda p: p["claims"]["contact"]["cone"].update(mu=0.02), {"stability"}),
    "fingers that let go": (release, {"stability"}),
    "a wrong centre": (lambda p: shift(p["claims"]["margin"]["center_O"], 1, 1e-4), {"claims"}),
    "another start": (
        lambda p: shift(p["scenario"]["problem"]["start"]["pose"]["position"], 0, 1e-4),
        {"start"},
    ),
    "another goal": (
        lambda p: shift(p["scenario"]["problem"]["goal"][-1]["pose"]["position"], 0, 1e-4),
        {"goals"},
    ),
    "a goal left out": (lambda p: p["goals_reached"].pop(), {"goals"}),
    "a margin overstated": (lambda p: figure(p, "closure_margin", 20.0), {"certificate"}),
    "a clearance overstated": (lambda p: figure(p, "clearance", 3.0), {"certificate"}),
    "a slip understated": (lambda p: p["certificate"]["slip"].update(value=-1e-5), {"certificate"}),
}


def unseen(plan):
    """The faults that are not seen by what is meant to see them, with what was found instead."""
    missed = []
    for name, (plant, meant) in FAULTS.items():
        broken = copy.deepcopy(plan)
        plant(broken)
        found = Recheck(broken).run()
        if not meant & set(found):
            missed.append(f"{name}: {sorted(found)} instead of {sorted(meant)}")
    return missed


def main():
    plan = json.loads(Path(sys.argv[1]).read_text())
    sound = Recheck(plan).run()
    missed = ([f"the sound plan: {sound}"] if sound else []) + unseen(plan)
    print("\n".join(missed) or f"all {len(FAULTS)} faults are seen")
    sys.exit(1 if missed else 0)


if __name__ == "__main__":
    main()
