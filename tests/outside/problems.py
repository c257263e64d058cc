"""Random problems of the four-finger hand: all kinds of shapes, friction, obstacles, several goals."""

import json

import numpy as np


def prism(outline, height):
    """A closed mesh over a counter-clockwise outline in the plane, cut into triangles by its ears."""
    n = len(outline)
    low = [[x, y, -height / 2] for x, y in outline]
    high = [[x, y, height / 2] for x, y in outline]
    lid = ears(outline)
    sides = [f for i in range(n) for f in ([i, (i + 1) % n, (i + 1) % n + n], [i, (i + 1) % n + n, i + n])]
    facets = [[c, b, a] for a, b, c in lid] + [[a + n, b + n, c + n] for a, b, c in lid] + sides
    return {"kind": "mesh", "vertices": low + high, "facets": facets}


def ears(outline):
    """Triangles of a simple polygon."""
    left, triangles = list(range(len(outline))), []

    def cross(a, b, c):
        (ax, ay), (bx, by), (cx, cy) = (outline[i] for i in (a, b, c))
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    while len(left) > 3:
        for i, b in enumerate(left):
            a, c = left[i - 1], left[(i + 1) % len(left)]
            others = [p for p in left if p not in (a, b, c)]
            inside = any(min(cross(a, b, p), cross(b, c, p), cross(c, a, p)) >= 0 for p in others)
            if cross(a, b, c) > 0 and not inside:
                triangles.append([a, b, c])
                left.remove(b)
                break
    return triangles + [left]


def centered(outline):
    """The outline with its middle at the origin (m)."""
    points = np.array(outline, float)
    return (points - (points.min(axis=0) + points.max(axis=0)) / 2).tolist()


def shapes(random):
    """One shape of each kind."""
    r = random.uniform
    leg, width = r(0.045, 0.055), r(0.022, 0.028)
    corner = [[0, 0], [leg, 0], [leg, width], [width, width], [width, leg], [0, leg]]
    base, wall, inner = r(0.05, 0.06), r(0.016, 0.02), r(0.022, 0.03)
    trough = [
        [0, 0],
        [base, 0],
        [base, inner],
        [base - wall, inner],
        [base - wall, wall],
        [wall, wall],
        [wall, inner],
        [0, inner],
    ]
    hull = [[0.03 * np.cos(a), 0.03 * np.sin(a)] for a in np.linspace(0, 2 * np.pi, 7)[:-1] + r(0, 0.5)]
    return {
        "sphere": {"kind": "sphere", "radius": r(0.024, 0.034)},
        "ellipsoid": {"kind": "ellipsoid", "semi_axes": [r(0.026, 0.04), r(0.022, 0.03), r(0.022, 0.03)]},
        "cuboid": {"kind": "cuboid", "size": [r(0.036, 0.055) for _ in range(3)]},
        "cylinder": {"kind": "cylinder", "radius": r(0.022, 0.03), "height": r(0.04, 0.07)},
        "capsule": {"kind": "capsule", "radius": r(0.022, 0.028), "height": r(0.02, 0.04)},
        "torus": {"kind": "torus", "ring_radius": r(0.028, 0.034), "tube_radius": r(0.01, 0.014)},
        "convex": prism(hull, r(0.03, 0.05)),
        "corner": prism(centered(corner), r(0.03, 0.045)),
        "trough": prism(centered(trough), r(0.03, 0.045)),
    }


def problem(seed):
    """A scenario, as the tree that its file holds."""
    random = np.random.default_rng(seed)
    all_shapes = shapes(random)
    kind = list(all_shapes)[seed % len(all_shapes)]
    goals = []
    for _ in range(1 + int(random.integers(2))):
        axis = random.normal(size=3)
        axis[2] += 2.0  # Mostly about the vertical: what these fingers can do.
        place = [0.0, 0.0, 0.085] + random.uniform(-0.006, 0.006, 3)
        pose = {"position": place.tolist(), "axis": axis.tolist(), "angle_deg": float(random.uniform(15, 70))}
        goals.append({"pose": pose})
    scenario = {
        "name": f"{kind}-{seed}",
        "hand": {"builtin": "four-finger"},
        "object": {"friction": float(random.uniform(0.4, 0.9)), "mass": 0.1, "shape": all_shapes[kind]},
        "start": {"pose": {"position": [0.0, 0.0, 0.085]}},
        "goal": goals,
    }
    if random.random() < 0.4:
        x = float(random.choice([-0.05, 0.05]))
        bar = {"kind": "capsule", "from": [x, 0.05, 0.06], "to": [x, 0.05, 0.2], "radius": 0.008}
        scenario["obstacle"] = [{"name": "bar", "shape": bar}]
    return scenario


def toml(value):
    """A value in TOML's syntax, in one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def write(folder, seed):
    """Writes a problem into a folder; returns its path."""
    path = folder / f"problem-{seed}.toml"
    path.write_text("".join(f"{key} = {toml(value)}\n" for key, value in problem(seed).items()))
    return path
