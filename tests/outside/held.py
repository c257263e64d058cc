"""Whether the fingers hold the object, by Clarabel, and whether the plan's own figures are true."""

import itertools

import numpy as np

import grasps
from judged import pose_of_state


class Held:
    """The checks of grasps, forces and certificate; part of a re-check."""

    def grasp(self, s, q):
        """Points (from the centre, over the length), normals, friction, torsion of what holds."""
        moving = self.segments[s].get("finger")
        cone = self.plan["claims"]["contact"]["cone"]
        held = [c for f, c in enumerate(q["contacts"]) if c is not None and f != moving]
        points = [(np.array(c["point_O"]) - self.center) / self.length for c in held]
        gamma = cone["gamma"] / self.length if moving is not None else 0.0
        return points, [np.array(c["normal_O"]) for c in held], cone["mu"], gamma

    def holding(self):
        """Grasps are stable at the ends of segments and every fifth state; claims agree with the scenario."""
        claims, friction = self.plan["claims"], self.problem["object"]["friction"]
        cone = claims["contact"]["cone"]
        if cone is None:
            self.own_cones(claims)
            return
        self.faults.note("claims", not 0 <= cone["mu"] <= friction, cone["mu"], "friction")
        off = np.linalg.norm(np.array(claims["margin"]["center_O"]) - self.center) + abs(
            claims["margin"]["length"] - self.length
        )
        self.faults.note("claims", off > 1e-9, off, "centre and length")
        for s, segment in enumerate(self.segments):
            last = len(segment["states"]) - 1
            for k, q in enumerate(segment["states"]):
                if k in (0, last) or (k % 5 == 0 and segment["kind"] == "transfer"):
                    t = self.stable(s, q, claims["criterion"])
                    self.faults.note("stability", t <= 1e-8, t, (s, k))
                self.forces(s, k, q, cone["mu"])

    def own_cones(self, claims):
        """Closure where contacts have cones of their own; other criteria are left out there."""
        cones, friction = claims["contact"].get("cones", []), self.problem["object"]["friction"]
        if claims["criterion"] != "closure" or not cones:
            return
        for cone in cones:
            most = max(np.hypot(x, y) for x, y, _ in grasps.edges_of(cone, False))
            self.faults.note("claims", not most <= friction * (1 + 1e-9), most, "friction of a cone")
        for s, segment in enumerate(self.segments):
            moving, last = segment.get("finger"), len(segment["states"]) - 1
            for k, q in enumerate(segment["states"]):
                if k not in (0, last) and k % 5:
                    continue
                wrenches = []
                for f, c in enumerate(q["contacts"]):
                    if c is not None and f != moving:
                        edges = grasps.edges_of(cones[q["cones"][f]], moving is None)
                        point = (np.array(c["point_O"]) - self.center) / self.length
                        wrenches += grasps.edge_wrenches(point, c["normal_O"], edges, self.length)
                t = grasps.spanning(wrenches)
                self.faults.note("stability", not t > 1e-9, t, (s, k))

    def stable(self, s, q, criterion):
        points, normals, mu, gamma = self.grasp(s, q)
        if not isinstance(criterion, dict):
            return grasps.slack(points, normals, mu, gamma)
        (kind, load), *_ = criterion.items()
        # `holding` counts on a share of the friction; efforts are checked with the forces.
        share = load["friction_factor"] if kind == "holding" else 1.0
        most = load.get("max_normal_force") or 100.0
        weight = np.array(self.problem.get("gravity", [0, 0, -9.81]))
        weight = weight * self.problem["object"].get("mass", 0.1) * load.get("weight", True)
        w = np.concatenate([pose_of_state(q).rotation.T @ weight, np.zeros(3)])
        pushes = [np.zeros(6)]
        for axis in np.vstack([np.eye(3), -np.eye(3)]):
            pushes.append(np.concatenate([axis * load["disturbance_force"], np.zeros(3)]))
            pushes.append(np.concatenate([np.zeros(3), axis * load["disturbance_torque"] / self.length]))
        # Contacts may spin in a transfer; each then drags, one way or the other.
        drag = 0.0
        if self.segments[s].get("finger") is None:
            drag = load.get("drag", 0.0) * self.plan["claims"]["contact"]["cone"]["gamma"] / self.length
        ways = itertools.product([drag, -drag], repeat=len(points)) if drag else [None]
        slacks = [
            grasps.slack(points, normals, share * mu, gamma, w + push, most, way)
            for way in ways
            for push in pushes
        ]
        return min(slacks) / most

    def forces(self, s, k, q, mu):
        """Forces of a state lie in their cones, bear the weight, and are within the efforts. A plan that says
        that its object needs more friction than is given has forces in the cones of that friction."""
        forces = q.get("forces")
        if not forces:
            return
        needed = ((self.plan.get("certificate") or {}).get("holds") or {}).get("friction") or {}
        if not self.problem.get("hold"):
            mu = max(mu, needed.get("value") or 0.0)
        X_HO = pose_of_state(q)
        joints = np.concatenate(q["joints"])
        self.hand.place(joints)
        weight = np.array(self.problem.get("gravity", [0, 0, -9.81])) * self.problem["object"].get(
            "mass", 0.1
        )
        total, moment, efforts = X_HO.rotation.T @ weight, np.zeros(3), np.zeros(len(joints))
        for f, (force, contact) in enumerate(zip(forces, q["contacts"])):
            if force is None or contact is None:
                continue
            force, p, n = (np.array(x) for x in (force, contact["point_O"], contact["normal_O"]))
            pressed = -force @ n
            self.faults.note(
                "forces",
                np.linalg.norm(force + pressed * n) > mu * pressed + 1e-6,
                "outside the cone",
                (s, k, f),
            )
            total, moment = total + force, moment + np.cross(p - self.center, force)
            efforts += self.hand.jacobian(joints, f, X_HO.act(p)).T @ (X_HO.rotation @ force)
        limits = np.array([joint.get("effort", 1.0) for joint in self.hand.joints])
        near = 1e-3 * max(np.linalg.norm(weight), 1e-3)
        self.faults.note(
            "forces", np.linalg.norm(total) > near, f"unbalanced by {np.linalg.norm(total):.3g} N", (s, k)
        )
        self.faults.note("forces", np.linalg.norm(moment) > near * self.length, "unbalanced moment", (s, k))
        self.faults.note(
            "efforts", (np.abs(efforts) > limits * 1.001).any(), np.abs(efforts / limits).max(), (s, k)
        )

    def certificate(self):
        """The plan's figures against what was found here."""
        figures = self.plan.get("certificate") or {}

        def said(key):
            return (figures.get(key) or {}).get("value")

        if said("clearance") is not None and hasattr(self, "least"):
            self.faults.note(
                "certificate",
                said("clearance") > self.least + 1e-6,
                (said("clearance"), self.least),
                "clearance",
            )
        for key, check in (("slip", "slip"), ("closure_residual", "closure")):
            if said(key) is not None and check in self.worst:
                found = self.worst[check]
                self.faults.note("certificate", found > said(key) * 1.15 + 1e-6, (said(key), found), key)
        margin = figures.get("closure_margin")
        if margin:
            where = margin["where"]
            q = self.segments[where["segment"]]["states"][where["state"]]
            most = grasps.margin_at_most(*self.grasp(where["segment"], q))
            self.faults.note(
                "certificate", margin["value"] > most * (1 + 1e-6), (margin["value"], most), "margin"
            )
