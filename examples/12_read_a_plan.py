#!/usr/bin/env python3
"""Reads a plan file, with nothing but Python's standard library.

    regrasp plan sphere -o plan.json
    python3 examples/12_read_a_plan.py plan.json

A plan file is JSON and stands alone. Units are SI; a pose is that of the object's frame O in the hand's frame H; normals point outward, from
the object to the fingertip; quaternions are w, x, y, z.
"""

import json
import math
import sys
from pathlib import Path


def rotated(quaternion, vector):
    """The vector turned by the unit quaternion."""
    w, x, y, z = quaternion
    a, b, c = vector
    # v + 2 w (u × v) + 2 u × (u × v), u the quaternion's vector part
    t = (2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a))
    return [
        a + w * t[0] + y * t[2] - z * t[1],
        b + w * t[1] + z * t[0] - x * t[2],
        c + w * t[2] + x * t[1] - y * t[0],
    ]


def turn(first, second):
    """The angle between two orientations (rad)."""
    cosine = abs(sum(a * b for a, b in zip(first, second, strict=True)))
    return 2 * math.acos(min(1.0, cosine))


def contact_H(state, finger):
    """Where a finger touches, in the hand's frame (m); None where it is free."""
    contact = state["contacts"][finger]
    if contact is None:
        return None
    pose = state["object"]
    offset = rotated(pose["orientation"], contact["point_O"])
    return [p + q for p, q in zip(pose["position"], offset, strict=True)]


def row(number, segment, fingers):
    """One line about a segment."""
    first, last = segment["states"][0], segment["states"][-1]
    if segment["kind"] == "regrasp":
        finger = segment["finger"]
        path = math.dist(contact_H(first, finger), contact_H(last, finger)) if first["contacts"][finger] and last["contacts"][finger] else 0.0
        what = f"regrasp   {fingers[finger]} moves its contact by {1000 * path:.1f} mm"
    else:
        angle = math.degrees(turn(first["object"]["orientation"], last["object"]["orientation"]))
        way = math.dist(first["object"]["position"], last["object"]["position"])
        what = f"transfer  the object turns by {angle:.1f}°, moves by {1000 * way:.1f} mm"
    return f"{number:>3}  {first['time']:5.2f} s to {last['time']:5.2f} s  {what}"


def check(plan):
    """What every plan keeps, as far as it can be seen without kinematics; raises AssertionError."""
    segments = plan["segments"]
    for before, after in zip(segments, segments[1:]):
        assert before["states"][-1]["object"] == after["states"][0]["object"], "segments join"
        assert before["states"][-1]["joints"] == after["states"][0]["joints"], "segments join"
    for segment in segments:
        times = [state["time"] for state in segment["states"]]
        assert all(a < b for a, b in zip(times, times[1:])), "time goes on"
        for state in segment["states"]:
            assert abs(math.hypot(*state["object"]["orientation"]) - 1) < 1e-9, "orientations are unit quaternions"
            for contact in filter(None, state["contacts"]):
                assert abs(math.hypot(*contact["normal_O"]) - 1) < 1e-9, "normals are unit vectors"
        if segment["kind"] == "regrasp":
            poses = [state["object"] for state in segment["states"]]
            assert all(pose == poses[0] for pose in poses), "the object rests while a finger moves"


def main(words):
    if len(words) != 1:
        sys.exit("usage: 12_read_a_plan.py PLAN (`regrasp plan sphere -o plan.json` makes one)")
    path = Path(words[0])
    try:
        plan = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        sys.exit(f"{path}: {error}")
    if not isinstance(plan, dict) or plan.get("format") != "regrasp-plan" or plan.get("version") not in (1, 2):
        sys.exit(f"{path}: this is no plan file of version 1 or 2")
    check(plan)

    fingers = [finger["name"] for finger in plan["scenario"]["problem"]["hand"]["finger"]]
    states = sum(len(segment["states"]) for segment in plan["segments"])
    print(f"{plan['scenario']['name']}, seed {plan['seed']}: {len(plan['segments'])} segments, {states} states")
    for number, segment in enumerate(plan["segments"]):
        print(row(number, segment, fingers))
    margin = (plan["certificate"] or {}).get("closure_margin")
    if margin:
        print(f"smallest margin of force closure: {margin['value']:.3f} at {margin['where']['time']:.2f} s")


if __name__ == "__main__":
    main(sys.argv[1:])
