"""A hand and an object of one's own: four fingers round a palm give a nut half a turn."""

import json
import tempfile
from pathlib import Path

import numpy as np
import regrasp as rg


def capsule(length: float) -> dict[str, object]:
    """A link along z (m)."""
    return {"shape": {"kind": "capsule", "from": [0, 0, 0], "to": [0, 0, length], "radius": 0.009}}


def finger(name: str, x: float, y: float, turn: float) -> dict[str, object]:
    """A joint for spreading, two for bending. Metres, radians; fingers differ in name and place."""
    bend, curl = {"link": [capsule(0.070)]}, {"link": [capsule(0.055)], "origin": {"position": [0, 0, 0.070]}}
    return {
        "name": name,
        "base": {"position": [x, y, 0.0], "axis": [0, 0, 1], "angle_deg": turn},
        "tip": [0.0, 0.0, 0.055],  # the fingertip's centre in the last link's frame
        "rest": [0.0, -0.9, 0.6],
        "joint": [
            {"name": f"{name}-spread", "axis": [1, 0, 0], "lower": -0.9, "upper": 0.9},
            {"name": f"{name}-bend", "axis": [0, 1, 0], "lower": -1.2, "upper": 1.4, **bend},
            {"name": f"{name}-curl", "axis": [0, 1, 0], "lower": 0.05, "upper": 2.4, **curl},
        ],
    }


def nut() -> rg.Shape:
    """A hexagonal prism: corners, then facets that are counter-clockwise seen from outside."""
    angles = 2 * np.pi * np.arange(6) / 6
    ring = 0.03 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    vertices = np.concatenate([np.insert(ring, 2, z, axis=1) for z in (-0.025, 0.025)])
    caps = [(0, k + 1, k) for k in range(1, 5)] + [(6, k + 6, k + 7) for k in range(1, 5)]
    sides = [
        facet
        for k, after in ((k, (k + 1) % 6) for k in range(6))
        for facet in ((k, after, after + 6), (k, after + 6, k + 6))
    ]
    return rg.Mesh(vertices, np.array(caps + sides), mass=0.15, friction=0.8)


def problem(hand: rg.Hand) -> rg.Scenario:
    """Half a turn; with everything in it that the files say."""
    return rg.Scenario(
        hand=hand,
        object=nut(),
        start=rg.pose(z=0.09),
        goals=[rg.pose(z=0.09, axis="z", angle_deg=180)],
        name="nut",
    )


if __name__ == "__main__":
    round_ = {"thumb": (0.065, 0.0, 180), "index": (0.0, 0.065, 270), "middle": (-0.065, 0.0, 0)}
    fingers = [finger(name, *place) for name, place in (round_ | {"ring": (0.0, -0.065, 90)}).items()]
    palm = {"shape": {"kind": "box", "size": [0.15, 0.15, 0.02]}, "pose": {"position": [0, 0, -0.02]}}
    tree = {"name": "my-hand", "fingertip_radius": 0.011, "palm": [palm], "finger": fingers}
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder, "my-hand.json")
        place.write_text(json.dumps(tree))
        hand = rg.Hand.from_file(place)
        task = problem(hand)
    print(hand, task.plan(seed=0), sep="\n")
