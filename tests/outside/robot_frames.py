"""A hand as `regrasp hand --json` has it, with forward kinematics of its own: to be compared with what others make of the same file."""

import json

import numpy as np


def rotation(axis, angle):
    """The matrix of a turn (Rodrigues)."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def pose(description):
    """A 4 × 4 matrix of a pose of the hand file."""
    X = np.eye(4)
    description = description or {}
    X[:3, 3] = description.get("position", [0, 0, 0])
    if "orientation" in description:
        w, x, y, z = np.asarray(description["orientation"]) / np.linalg.norm(description["orientation"])
        X[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    elif "axis" in description:
        X[:3, :3] = rotation(description["axis"], np.radians(description["angle_deg"]))
    return X


class Hand:
    """Fingers, joints and shapes of a hand's description."""

    def __init__(self, text):
        whole = json.loads(text)
        self.description, self.report = whole["hand"], whole["report"]
        self.fingers = self.description["finger"]

    def random_positions(self, random):
        """A position within its limits for each joint, by name; driven joints where their drivers have them."""
        joints = [joint for finger in self.fingers for joint in finger["joint"]]
        positions = {joint["name"]: random.uniform(joint["lower"], joint["upper"]) for joint in joints}
        for joint in joints:
            if joint.get("mimic"):
                mimic = joint["mimic"]
                positions[joint["name"]] = mimic["multiplier"] * positions[mimic["joint"]] + mimic["offset"]
        return positions

    def frames(self, positions):
        """The moved frame of every joint in the hand's frame, by name, with the joint's description."""
        frames = {}
        for finger in self.fingers:
            X = pose(finger.get("base"))
            for joint in finger["joint"]:
                X = X @ pose(joint.get("origin"))
                turn = np.eye(4)
                turn[:3, :3] = rotation(joint["axis"], positions[joint["name"]])
                X = X @ turn
                frames[joint["name"]] = (X, joint)
        return frames
