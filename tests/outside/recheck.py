#!/usr/bin/env python3
"""Re-checks plans from their files alone, by other people's programs: pinocchio, coal, Clarabel.

usage: recheck.py PLAN.json...     prints one line a plan and exits with 1 where one is wrong

Nothing is shared with the project's verifier, not even the resolution: a step is divided by 7, times are sampled at 1 kHz.
"""

import json
import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pinocchio as pin

import grasps
from judged import Bodies, Hand, between, facets_of, off_the_true_shape, pose_of, pose_of_state

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


class Recheck:
    """One plan, all checks."""

    def __init__(self, plan):
        self.plan, self.faults, self.worst = plan, Faults(), {}
        self.problem = plan["scenario"]["problem"]
        self.tolerances = self.problem["limits"]["tolerances"]
        self.hand = Hand(self.problem["hand"])
        self.segments = plan["segments"]
        self.states = [(s, k, q) for s, segment in enumerate(self.segments) for k, q in enumerate(segment["states"])]

    def run(self):
        if not self.form():
            return self.faults.found
        self.shape()
        self.bodies = Bodies(self.plan, self.hand)
        for check in (self.ends, self.seams, self.joints, self.played, self.contacts, self.walk, self.holding):
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
            fits = all([len(row) for row in rows] == joints for rows in lists) and len(q["contacts"]) == len(joints)
            numbers = np.concatenate([np.concatenate(rows) for rows in lists] + [q["object"]["position"], [q["time"]]])
            self.faults.note("form", not (fits and np.isfinite(numbers).all()), "no sense", (s, k))
            norm = np.linalg.norm(q["object"]["orientation"])
            self.faults.note("quaternions", abs(norm - 1) > 1e-9, norm, (s, k))
        return "form" not in self.faults.found

    def shape(self):
        """The recorded facets lie on the primitive that the scenario names, and close around the right volume."""
        vertices, facets = facets_of(self.plan)
        off = off_the_true_shape(self.problem["object"]["shape"], vertices)
        if off is not None:
            self.measure("shape", off.max(), 1e-9, "the object's facets")
        edges = facets[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        closed = {(a, b) for a, b in edges} == {(b, a) for a, b in edges}
        self.faults.note("shape", not closed, "the facets do not close", "the object's facets")
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
        self.faults.note("goals", len(reached) != len(self.problem["goal"]) or sorted(reached) != reached, reached, "goals")
        for done, goal in zip(reached, self.problem["goal"]):
            fits = 0 <= done <= len(self.segments)
            self.faults.note("goals", not fits, done, "goals")
            if fits:
                apart(self.segments[done - 1]["states"][-1] if done else first, goal["pose"], "goals")

    def seams(self):
        """Segments share their end states; in a regrasp everything but one finger rests; contact sets."""
        for s, (one, two) in enumerate(zip(self.segments, self.segments[1:])):
            a, b = one["states"][-1], two["states"][0]
            same = all(a.get(key) == b.get(key) for key in ("time", "object", "joints", "velocities", "contacts"))
            self.faults.note("continuity", not same, "end and start differ", (s + 1, 0))
        for s, segment in enumerate(self.segments):
            states, moving = segment["states"], segment.get("finger")
            self.faults.note("form", (segment["kind"] == "regrasp") != (moving is not None), "finger", s)
            for k, q in enumerate(states):
                for f, contact in enumerate(q["contacts"]):
                    inner = f == moving and 0 < k < len(states) - 1
                    odd = contact is not None if inner else f != moving and (contact is None) != (states[0]["contacts"][f] is None)
                    self.faults.note("contact sets", odd, "a finger starts or stops holding", (s, k, f))
                    rests = f == moving or (q["joints"][f] == states[0]["joints"][f] and contact == states[0]["contacts"][f])
                    self.faults.note("rest", moving is not None and not rests, "a finger moves", (s, k, f))
                self.faults.note("rest", moving is not None and q["object"] != states[0]["object"], "the object moves", (s, k))

    def joints(self):
        """Positions within their limits; driven joints where their drivers have them."""
        for s, k, q in self.states:
            for f, finger in enumerate(self.problem["hand"]["finger"]):
                at = dict(zip([joint["name"] for joint in finger["joint"]], q["joints"][f]))
                for joint in finger["joint"]:
                    value = at[joint["name"]]
                    self.measure("joint limits", max(value - joint["upper"], joint["lower"] - value), 1e-9, (s, k, f))
                    if mimic := joint.get("mimic"):
                        wished = mimic.get("multiplier", 1.0) * at[mimic["joint"]] + mimic.get("offset", 0.0)
                        self.measure("driven joints", abs(value - wished), 1e-9, (s, k, f))

    def row(self):
        """All states once: times, joints, velocities."""
        once = [q for s, k, q in self.states if s == 0 or k > 0]
        t = np.array([q["time"] for q in once])
        q = np.array([np.concatenate(state["joints"]) for state in once])
        v = None
        if all(state.get("velocities") for state in once):
            v = np.array([np.concatenate(state["velocities"]) for state in once])
        return t, q, v

    def played(self):
        """What a controller plays at 1 kHz: the cubic through positions and velocities keeps limits, and stays close to the lines."""
        t, q, v = self.row()
        self.faults.note("times", not (np.diff(t) > 0).all(), "time does not increase", np.argmin(np.diff(t)))
        self.faults.note("velocities", v is None, "there are none", "states")
        if "times" in self.faults.found or v is None:
            return
        at_rest = not (v[0].any() or v[-1].any())
        self.faults.note("accelerations", not at_rest, "the motion does not start and end at rest", "ends")
        samples = np.append(np.arange(0.0, t[-1], 1e-3), t[-1])
        positions, steps, f = cubic(t, q, v, samples)
        top = np.array([joint.get("velocity", 2.0) for joint in self.hand.joints])
        steep = np.array([joint.get("acceleration", 20.0) for joint in self.hand.joints])
        still = positions[[0, -1]]
        positions = np.vstack([still[:1], positions[:-1], still[1:]])  # The last, shorter interval is left out.
        speeds = np.abs(np.diff(positions[:-1], axis=0)) / 1e-3 / top
        rates = np.abs(np.diff(positions[:-1], n=2, axis=0)) / 1e-6 / steep
        self.measure("velocities", speeds.max(), 1.01, (samples[speeds.max(axis=1).argmax()], "s"))
        self.measure("accelerations", rates.max(initial=0.0), 1.01, (samples[rates.max(axis=1).argmax()], "s"))
        self.deviation(t, q, v)

    def deviation(self, t, q, v):
        """How far tips are from where the lines have them, all joints at one progress along their line."""
        for f in np.arange(1, SUB_STEPS) / SUB_STEPS:
            h = np.diff(t)[:, None]
            change = np.diff(q, axis=0)
            played = cubic_at(q[:-1], q[1:], v[:-1] * h, v[1:] * h, f)
            square = np.maximum((change**2).sum(axis=1), 1e-300)
            progress = np.clip(((played - q[:-1]) * change).sum(axis=1) / square, 0, 1)[:, None]
            meant = q[:-1] + change * progress
            for step in np.flatnonzero(np.abs(played - meant).max(axis=1) > 1e-7):
                tips = []
                for joints in (played[step], meant[step]):
                    self.hand.place(joints)
                    tips.append([self.hand.tip(f) for f in range(len(self.hand.tips))])
                off = np.linalg.norm(np.subtract(*tips), axis=1).max()
                self.measure("controller", off, self.tolerances["closure"] / 2, (t[step], "s"))

    def contacts(self):
        """Contacts are where the plan has them, on the object and on the fingertip; normals are the surface's."""
        closure = self.tolerances["closure"]
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

    def walk(self):
        """Closure, slip and clearance along the motion that the states mean."""
        self.slip = [None] * len(self.hand.tips)
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
            self.lift(s, states, moving, np.array(heights))

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
        """Slip is the path of the contact point over the object less its path over the fingertip, turned into O."""
        if self.slip[finger] is None:
            self.slip[finger] = np.zeros(3)
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

    def grasp(self, s, q):
        """Points (from the centre, over the length), normals, friction and torsion of the fingers that hold."""
        moving = self.segments[s].get("finger")
        cone = self.plan["claims"]["contact"]["cone"]
        held = [c for f, c in enumerate(q["contacts"]) if c is not None and f != moving]
        points = [(np.array(c["point_O"]) - self.center) / self.length for c in held]
        gamma = cone["gamma"] / self.length if moving is not None else 0.0
        return points, [np.array(c["normal_O"]) for c in held], cone["mu"], gamma

    def holding(self):
        """Grasps are stable by Clarabel, at the ends of segments and every fifth state; claims agree with the scenario."""
        claims, friction = self.plan["claims"], self.problem["object"]["friction"]
        cone = claims["contact"]["cone"]
        if cone is None:
            return
        self.faults.note("claims", not 0 <= cone["mu"] <= friction, cone["mu"], "friction")
        off = np.linalg.norm(np.array(claims["margin"]["center_O"]) - self.center) + abs(claims["margin"]["length"] - self.length)
        self.faults.note("claims", off > 1e-9, off, "centre and length")
        for s, segment in enumerate(self.segments):
            last = len(segment["states"]) - 1
            for k, q in enumerate(segment["states"]):
                if k in (0, last) or (k % 5 == 0 and segment["kind"] == "transfer"):
                    t = self.stable(s, q, claims["criterion"])
                    self.faults.note("stability", t <= 1e-8, t, (s, k))
                self.forces(s, k, q, cone["mu"])

    def stable(self, s, q, criterion):
        points, normals, mu, gamma = self.grasp(s, q)
        if not isinstance(criterion, dict) or "equilibrium" not in criterion:
            return grasps.slack(points, normals, mu, gamma)
        load = criterion["equilibrium"]
        most = load["max_normal_force"]
        weight = np.array(self.problem.get("gravity", [0, 0, -9.81])) * self.problem["object"].get("mass", 0.1)
        w = np.concatenate([pose_of_state(q).rotation.T @ weight, np.zeros(3)])
        pushes = [np.zeros(6)]
        for axis in np.vstack([np.eye(3), -np.eye(3)]):
            pushes.append(np.concatenate([axis * load["disturbance_force"], np.zeros(3)]))
            pushes.append(np.concatenate([np.zeros(3), axis * load["disturbance_torque"] / self.length]))
        return min(grasps.slack(points, normals, mu, gamma, w + push, most) / most for push in pushes)

    def forces(self, s, k, q, mu):
        """Forces that a state carries lie in their cones, bear the weight, and are within the joints' efforts."""
        forces = q.get("forces")
        if not forces:
            return
        X_HO = pose_of_state(q)
        joints = np.concatenate(q["joints"])
        self.hand.place(joints)
        weight = np.array(self.problem.get("gravity", [0, 0, -9.81])) * self.problem["object"].get("mass", 0.1)
        total, moment, efforts = X_HO.rotation.T @ weight, np.zeros(3), np.zeros(len(joints))
        for f, (force, contact) in enumerate(zip(forces, q["contacts"])):
            if force is None or contact is None:
                continue
            force, p, n = (np.array(x) for x in (force, contact["point_O"], contact["normal_O"]))
            pressed = -force @ n
            self.faults.note("forces", np.linalg.norm(force + pressed * n) > mu * pressed + 1e-6, "outside the cone", (s, k, f))
            total, moment = total + force, moment + np.cross(p - self.center, force)
            efforts += self.hand.jacobian(joints, f, X_HO.act(p)).T @ (X_HO.rotation @ force)
        limits = np.array([joint.get("effort", 1.0) for joint in self.hand.joints])
        near = 1e-3 * max(np.linalg.norm(weight), 1e-3)
        self.faults.note("forces", np.linalg.norm(total) > near, f"unbalanced by {np.linalg.norm(total):.3g} N", (s, k))
        self.faults.note("forces", np.linalg.norm(moment) > near * self.length, "unbalanced moment", (s, k))
        self.faults.note("efforts", (np.abs(efforts) > limits * 1.001).any(), np.abs(efforts / limits).max(), (s, k))

    def certificate(self):
        """The plan's figures against what was found here."""
        figures = self.plan.get("certificate") or {}
        def said(key):
            return (figures.get(key) or {}).get("value")
        if said("clearance") is not None and hasattr(self, "least"):
            self.faults.note("certificate", said("clearance") > self.least + 1e-6, (said("clearance"), self.least), "clearance")
        for key, check in (("slip", "slip"), ("closure_residual", "closure")):
            if said(key) is not None and check in self.worst:
                found = self.worst[check]
                self.faults.note("certificate", found > said(key) * 1.15 + 1e-6, (said(key), found), key)
        margin = figures.get("closure_margin")
        if margin:
            where = margin["where"]
            q = self.segments[where["segment"]]["states"][where["state"]]
            most = grasps.margin_at_most(*self.grasp(where["segment"], q))
            self.faults.note("certificate", margin["value"] > most * (1 + 1e-6), (margin["value"], most), "margin")


def cubic_at(a, b, v, w, f):
    """The cubic from a to b with slopes v and w (over the unit interval) at f."""
    g = 1 - f
    return a * (1 + 2 * f) * g * g + b * f * f * (3 - 2 * f) + v * f * g * g - w * f * f * g


def cubic(t, q, v, samples):
    """The played positions at the samples, the step of each and the fraction of it."""
    steps = np.clip(np.searchsorted(t, samples, side="right") - 1, 0, len(t) - 2)
    h = (t[steps + 1] - t[steps])[:, None]
    f = (samples - t[steps])[:, None] / h
    return cubic_at(q[steps], q[steps + 1], v[steps] * h, v[steps + 1] * h, f), steps, f


def main():
    wrong = 0
    for name in sys.argv[1:]:
        found = Recheck(json.loads(Path(name).read_text())).run()
        wrong += bool(found)
        print(name, "; ".join(found.values()) or "nothing wrong")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
