#!/usr/bin/env python3
"""Re-checks plans from their files alone, by other people's programs: pinocchio, coal, Clarabel.

usage: recheck.py PLAN.json...     prints one line a plan and exits with 1 where one is wrong

Nothing is shared with the project's verifier, not even the resolution: a step is divided by 7, times are
sampled at 1 kHz.
"""

import json
import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pinocchio as pin

from held import Held
from judged import (
    Bodies,
    Hand,
    between,
    facets_of,
    off_the_true_shape,
    pose_of,
    pose_of_state,
    true_facets_of,
)
from played import Played

SUB_STEPS = 7
# What sampling at other instants may find beyond the plan's own figures.
SAMPLED = 1.05


@dataclass
class Faults:
    """What was found wrong: the check's name, how bad, and where."""

    found: dict = field(default_factory=dict)

    def note(self, check, bad, value, place):
        if bad and check not in self.found:
            self.found[check] = f"{check}: {value} at {place}"


class Recheck(Played, Held):
    """One plan, all checks."""

    def __init__(self, plan):
        self.plan, self.faults, self.worst = plan, Faults(), {}
        self.problem = plan["scenario"]["problem"]
        self.tolerances = self.problem["limits"]["tolerances"]
        self.hand = Hand(self.problem["hand"])
        self.segments = plan["segments"]
        self.states = [
            (s, k, q) for s, segment in enumerate(self.segments) for k, q in enumerate(segment["states"])
        ]

    def run(self):
        if not self.form():
            return self.faults.found
        self.shape()
        self.bodies = Bodies(self.plan, self.hand)
        for check in (
            self.ends,
            self.seams,
            self.joints,
            self.played,
            self.contacts,
            self.walk,
            self.holding,
        ):
            check()
        self.certificate()
        return self.faults.found

    def measure(self, check, value, limit, place):
        """Takes in a figure that must not exceed its limit."""
        self.worst[check] = max(self.worst.get(check, 0.0), value)
        self.faults.note(check, not value <= limit, f"{value:.4g} > {limit:.4g}", place)

    def form(self):
        joints = [len(finger["joint"]) for finger in self.problem["hand"]["finger"]]
        for s, k, q in self.states:
            lists = [q["joints"], q.get("velocities") or q["joints"]]
            fits = all([len(row) for row in rows] == joints for rows in lists) and len(q["contacts"]) == len(
                joints
            )
            numbers = np.concatenate(
                [np.concatenate(rows) for rows in lists] + [q["object"]["position"], [q["time"]]]
            )
            self.faults.note("form", not (fits and np.isfinite(numbers).all()), "no sense", (s, k))
            norm = np.linalg.norm(q["object"]["orientation"])
            self.faults.note("quaternions", abs(norm - 1) > 1e-9, norm, (s, k))
        return "form" not in self.faults.found

    def shape(self):
        """The recorded facets lie on the primitive that the scenario names, and close."""
        vertices, facets = facets_of(self.plan)
        off = off_the_true_shape(self.problem["object"]["shape"], vertices)
        if off is not None:
            self.measure("shape", off.max(), 1e-9, "the object's facets")
        edges = facets[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        closed = {(a, b) for a, b in edges} == {(b, a) for a, b in edges}
        self.faults.note("shape", not closed, "the facets do not close", "the object's facets")
        vertices, facets = true_facets_of(self.plan)
        a, b, c = vertices[facets].transpose(1, 0, 2)
        volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
        self.center = ((a + b + c) / 4 * volumes[:, None]).sum(axis=0) / volumes.sum()
        self.length = np.linalg.norm(vertices - self.center, axis=1).max()

    def ends(self):
        """Start, goals in their turn, all goals."""

        def apart(state, wished, check):
            X, Y = pose_of_state(state), pose_of(wished)
            far = np.linalg.norm(X.translation - Y.translation) / self.tolerances["goal_position"]
            turn = np.linalg.norm(pin.log3(X.rotation.T @ Y.rotation)) / self.tolerances["goal_angle"]
            self.measure(check, max(far, turn), 1.0, check)

        first = self.segments[0]["states"][0]
        apart(first, self.problem["start"]["pose"], "start")
        reached = self.plan["goals_reached"]
        self.faults.note(
            "goals", len(reached) != len(self.problem["goal"]) or sorted(reached) != reached, reached, "goals"
        )
        for done, goal in zip(reached, self.problem["goal"]):
            fits = 0 <= done <= len(self.segments)
            self.faults.note("goals", not fits, done, "goals")
            if fits:
                apart(self.segments[done - 1]["states"][-1] if done else first, goal["pose"], "goals")

    def seams(self):
        """Segments share their end states; in a regrasp everything but one finger rests; contact sets."""
        for s, (one, two) in enumerate(zip(self.segments, self.segments[1:])):
            a, b = one["states"][-1], two["states"][0]
            same = all(
                a.get(key) == b.get(key) for key in ("time", "object", "joints", "velocities", "contacts")
            )
            self.faults.note("continuity", not same, "end and start differ", (s + 1, 0))
        for s, segment in enumerate(self.segments):
            states, moving = segment["states"], segment.get("finger")
            self.faults.note("form", (segment["kind"] == "regrasp") != (moving is not None), "finger", s)
            for k, q in enumerate(states):
                for f, contact in enumerate(q["contacts"]):
                    inner = f == moving and 0 < k < len(states) - 1
                    odd = (
                        contact is not None
                        if inner
                        else f != moving and (contact is None) != (states[0]["contacts"][f] is None)
                    )
                    self.faults.note("contact sets", odd, "a finger starts or stops holding", (s, k, f))
                    rests = f == moving or (
                        q["joints"][f] == states[0]["joints"][f] and contact == states[0]["contacts"][f]
                    )
                    self.faults.note("rest", moving is not None and not rests, "a finger moves", (s, k, f))
                self.faults.note(
                    "rest",
                    moving is not None and q["object"] != states[0]["object"],
                    "the object moves",
                    (s, k),
                )

    def joints(self):
        """Positions within their limits; driven joints where their drivers have them."""
        for s, k, q in self.states:
            for f, finger in enumerate(self.problem["hand"]["finger"]):
                at = dict(zip([joint["name"] for joint in finger["joint"]], q["joints"][f]))
                for joint in finger["joint"]:
                    value = at[joint["name"]]
                    self.measure(
                        "joint limits", max(value - joint["upper"], joint["lower"] - value), 1e-9, (s, k, f)
                    )
                    if mimic := joint.get("mimic"):
                        wished = mimic.get("multiplier", 1.0) * at[mimic["joint"]] + mimic.get("offset", 0.0)
                        self.measure("driven joints", abs(value - wished), 1e-9, (s, k, f))

    def contacts(self):
        """Contacts are where the plan has them, on object and fingertip; normals are the surface's."""
        closure = self.tolerances["closure"]
        bound = ((self.plan.get("object") or {}).get("contact_surface") or {}).get("bound")
        for s, k, q in self.states:
            X_HO = pose_of_state(q)
            self.hand.place(np.concatenate(q["joints"]))
            for f, contact in enumerate(q["contacts"]):
                if contact is None:
                    continue
                p, n, _, _ = self.bodies.touch(f, X_HO)
                stated = np.array(contact["point_O"])
                self.measure("contact points", np.linalg.norm(p - stated), closure, (s, k, f))
                on_tip = self.hand.tip(f) + self.hand.link(f).rotation @ np.array(contact["point_F"])
                self.measure("contact points", np.linalg.norm(X_HO.act(stated) - on_tip), closure, (s, k, f))
                off = np.linalg.norm(n - np.array(contact["normal_O"]))
                self.measure("normals", off, self.tolerances["normal"], (s, k, f))
                if bound is not None:
                    gap = abs(self.bodies.touch(f, X_HO, self.bodies.object)[2])
                    self.measure("contact surface", gap, bound + closure, (s, k, f))

    def walk(self):
        """Closure, slip and clearance along the motion that the states mean."""
        self.slip = [None] * len(self.hand.tips)
        self.first = {}
        for s, segment in enumerate(self.segments):
            self.travel(s, segment)

    def travel(self, s, segment):
        states, moving = segment["states"], segment.get("finger")
        heights, before = [], {}
        for k, (a, b) in enumerate(zip(states, states[1:])):
            X, Y = pose_of_state(a), pose_of_state(b)
            q, r = np.concatenate(a["joints"]), np.concatenate(b["joints"])
            for i in range(1 if k else 0, SUB_STEPS + 1):
                f = i / SUB_STEPS
                X_HO = between(X, Y, f)
                self.hand.place(q + (r - q) * f)
                self.sample(s, k, a, moving, X_HO, heights, before)
        if moving is not None:
            self.lift(s, states, moving, heights)

    def sample(self, s, k, state, moving, X_HO, heights, before):
        for f, contact in enumerate(state["contacts"]):
            if f == moving:
                heights.append(self.bodies.touch(f, X_HO)[2:])
            elif contact is not None and moving is None:
                p, n, gap, c = self.bodies.touch(f, X_HO)
                self.measure("closure", abs(gap), self.tolerances["closure"], (s, k, f))
                R_OF = X_HO.rotation.T @ self.hand.link(f).rotation
                self.add_slip(f, before.get(f), (p, n, c, R_OF), (s, k, f))
                before[f] = (p, n, c, R_OF)
        if self.coarse(k):
            self.clearance(s, k, state, moving, X_HO)

    def coarse(self, k):
        """Distances of all pairs are asked of every third step only: there are many."""
        return k % 3 == 0

    def add_slip(self, finger, before, now, place):
        """Slip is the contact point's path over the object less its path over the fingertip, in O."""
        if self.slip[finger] is None:
            self.slip[finger] = np.zeros(3)
        if self.plan["claims"]["transfer_law"] == "fixed-point":
            # Such a contact stays where it was set down.
            first = self.first.setdefault(finger, now[0])
            strayed = np.linalg.norm(now[0] - first)
            self.measure("slip", strayed, self.tolerances["slip"] * SAMPLED, place)
            return
        if before is not None:
            (p, n, c, R), (p2, n2, c2, R2) = before, now
            on_tip, on_tip2 = R.T @ (p - c), R2.T @ (p2 - c2)
            half = R @ pin.exp3(pin.log3(R.T @ R2) / 2)
            step = (p2 - p) - half @ (on_tip2 - on_tip)
            normal = (n + n2) / np.linalg.norm(n + n2)
            self.slip[finger] = self.slip[finger] + step - normal * (normal @ step)
        self.measure("slip", np.linalg.norm(self.slip[finger]), self.tolerances["slip"] * SAMPLED, place)

    def lift(self, s, states, finger, heights):
        """A regrasp rises, moves above the surface and comes down; one that stays low slides."""
        gaps = np.array([gap for gap, _ in heights])
        resolution = self.problem["limits"]["resolution"]
        wanted = min([resolution["lift"], *resolution["retreat"]])
        if gaps.max() < wanted:
            slid = heights[-1][1] - heights[0][1]
            self.slip[finger] = (np.zeros(3) if self.slip[finger] is None else self.slip[finger]) + slid
            self.measure("slip", np.linalg.norm(self.slip[finger]), self.tolerances["slip"], (s, finger))
            return
        self.slip[finger] = None
        self.first.pop(finger, None)
        up = int(np.argmax(gaps >= wanted))
        down = len(gaps) - 1 - int(np.argmax(gaps[::-1] >= wanted))
        if states[0]["contacts"][finger] is not None:
            sunk = np.maximum.accumulate(gaps[: up + 1]) - gaps[: up + 1]
            self.measure("lift", sunk.max(), 2e-6, (s, finger))
        if states[-1]["contacts"][finger] is not None:
            sunk = np.maximum.accumulate(gaps[down:][::-1]) - gaps[down:][::-1]
            self.measure("lift", sunk.max(), 2e-6, (s, finger))
        low = gaps[up : down + 1].min()
        self.faults.note("clearance", low <= self.tolerances["clearance"], low, (s, finger))

    def clearance(self, s, k, state, moving, X_HO):
        for a, b in self.bodies.pairs:
            n, m = self.bodies.bodies[a][0], self.bodies.bodies[b][0]
            if n == "object" and m[0] == "tip" and (m[1] == moving or state["contacts"][m[1]] is not None):
                continue
            far = self.bodies.distance(a, b, X_HO)
            self.least = min(getattr(self, "least", np.inf), far)
            self.faults.note("clearance", far <= self.tolerances["clearance"], far, (s, k, n, m))


def main():
    wrong = 0
    for name in sys.argv[1:]:
        found = Recheck(json.loads(Path(name).read_text())).run()
        wrong += bool(found)
        print(name, "; ".join(found.values()) or "nothing wrong")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
