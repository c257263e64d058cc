#!/usr/bin/env python3
"""Grasps in bulk as other people's programs see them: arrays in numpy, the scene in pinocchio and coal, and MuJoCo.

usage: bulk.py GRASPS.xml [COUNT [SECONDS]]     how many of so many grasps stay, at friction × 1 and × 0.8
"""

import json
import sys

import mujoco
import numpy as np
import pinocchio as pin

from judged import Bodies, pose_of_state
from recheck import Recheck

# How far an object may move (m, rad) and still be where it was.
STAYS = (5e-3, np.radians(10.0))


def states_of(arrays):
    """The grasps of an archive in the form of a plan's states, but for where contacts are on the fingertips."""
    ends = np.cumsum(
        [
            len(finger["joint"])
            for finger in json.loads(str(arrays["grasps_problem"]))["scenario"]["problem"]["hand"]["finger"]
        ]
    )
    states = []
    for g in range(len(arrays["margin"])):
        contacts, forces = [], []
        for f, holds in enumerate(arrays["holding"][g]):
            point, normal, force = (
                arrays[name][g, f].tolist() for name in ("contact_point_O", "contact_normal_O", "force_O")
            )
            contacts.append({"point_O": point, "normal_O": normal} if holds else None)
            forces.append(force if holds and np.isfinite(force).all() else None)
        state = {
            "time": 0.0,
            "object": {
                "position": arrays["object_position"][g].tolist(),
                "orientation": arrays["object_orientation"][g].tolist(),
            },
            "joints": [row.tolist() for row in np.split(arrays["joints"][g], ends[:-1])],
            "contacts": contacts,
        }
        if any(force is not None for force in forces):
            state["forces"] = forces
        states.append(state)
    return states


class Grasps(Recheck):
    """Every grasp by itself, as the only state of a segment."""

    def __init__(self, arrays, picked):
        plan = json.loads(str(arrays["grasps_problem"]))
        states = states_of(arrays)
        plan["segments"] = [{"kind": "transfer", "states": [states[g]]} for g in picked]
        super().__init__(plan)

    def run(self):
        if not self.form():
            return self.faults.found
        self.shape()
        self.bodies = Bodies(self.plan, self.hand)
        self.on_fingertips()
        for check in (self.joints, self.contacts, self.holding):
            check()
        for s, k, q in self.states:
            X_HO = pose_of_state(q)
            self.hand.place(np.concatenate(q["joints"]))
            self.clearance(s, k, q, None, X_HO)
        return self.faults.found

    def on_fingertips(self):
        """Where each contact is on its fingertip: a radius from the centre, against the normal."""
        for _, _, q in self.states:
            X_HO = pose_of_state(q)
            self.hand.place(np.concatenate(q["joints"]))
            for f, contact in enumerate(q["contacts"]):
                if contact is not None:
                    inward_H = X_HO.rotation @ -np.array(contact["normal_O"])
                    contact["point_F"] = (self.hand.link(f).rotation.T @ inward_H * self.hand.radius).tolist()


def stays(model, key, seconds):
    """Whether the object stays where it is while the motors aim where the keyframe says."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, key)
    place = slice(model.nq - 7, model.nq - 4)
    before, turned = data.qpos[place].copy(), data.qpos[-4:].copy()
    for _ in range(int(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)
    if not np.isfinite(data.qpos).all():
        return False
    moved = np.linalg.norm(data.qpos[place] - before)
    turn = pin.log3(rotation(turned).T @ rotation(data.qpos[-4:]))
    return moved < STAYS[0] and np.linalg.norm(turn) < STAYS[1]


def rotation(q):
    w, x, y, z = q
    return pin.Quaternion(w, x, y, z).normalized().toRotationMatrix()


def share_that_stays(path, count, friction, seconds):
    """How many of the first grasps stay, as a share, with the friction multiplied."""
    model = mujoco.MjModel.from_xml_path(str(path))
    model.geom_friction[:, 0] *= friction
    keys = range(min(count, model.nkey))
    return sum(stays(model, key, seconds) for key in keys) / len(keys)


def main():
    path, count, seconds = sys.argv[1], int(sys.argv[2]) if sys.argv[2:] else 500, float((sys.argv[3:] or [2])[0])
    for friction in (1.0, 0.8):
        print(f"friction x {friction}: {share_that_stays(path, count, friction, seconds):.3f} stay {seconds} s")


if __name__ == "__main__":
    main()
