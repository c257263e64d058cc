"""The package's pieces beside the best Python peer of each: seconds per call, ours in batches.

    pip install regrasp scipy pin trimesh rtree potpourri3d pygeodesic
    python peers.py [--count N]

A peer is called as its users call it: one grasp or posture at a time where it has no batches (scipy,
pinocchio), in a batch where it has them (trimesh). Every row first checks that both say the same. Figures are
the best of five rounds in processor time, which a busy machine changes little. Prints a table in Markdown.
"""

import argparse
import itertools
import time
from collections.abc import Callable

import numpy as np
import pinocchio
import potpourri3d
import regrasp as rg
import trimesh
from pygeodesic.geodesic import PyGeodesicAlgorithmExact
from scipy.optimize import nnls
from scipy.spatial import ConvexHull

EDGES = 8
#: Calls of peers in a round: they are slow, and have no batches to speak of.
FEW = 300
#: Of exact geodesics, which take half a second each.
EXACT = 10


def seconds(call: Callable[[], object], calls: int) -> float:
    """The best of five rounds, over the number of calls in a round: processor time, of all threads."""
    rounds = []
    for _ in range(5):
        start = time.process_time()
        call()
        rounds.append(time.process_time() - start)
    return min(rounds) / calls


def grasps(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Four contacts on a ball of 3 cm, anywhere."""
    normals = np.random.default_rng(7).normal(size=(count, 4, 3))
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return 0.03 * normals, normals


def wrenches(points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(N, 6, 32): edges of linearised cones, torques over the ball's radius."""
    cones = rg.wrench_cones(points, normals, 0.6, edges=EDGES) / [1, 1, 1, 0.03, 0.03, 0.03]
    return cones.reshape(len(points), -1, 6).swapaxes(1, 2)


def closed_by_nnls(W: np.ndarray) -> np.ndarray | None:
    """Positive factors of edges that cancel, where they span all wrenches."""
    if np.linalg.matrix_rank(W) < 6:
        return None
    x, rest = nnls(W, -W.sum(axis=1))
    return x + 1 if rest < 1e-9 else None


def margin_by_hull(W: np.ndarray) -> float:
    """Distance of the origin from the hull of the edges: Ferrari and Canny's epsilon."""
    return float(-ConvexHull(W.T).equations[:, -1].max())


def closure(count: int) -> list[tuple]:
    points, normals = grasps(count)
    few = min(count, FEW)
    W = wrenches(points[:few], normals[:few])
    verdicts = rg.force_closure(points, normals, 0.6)
    theirs = np.array([closed_by_nnls(w) is not None for w in W])
    assert (theirs <= verdicts[:few]).all() and (theirs == verdicts[:few]).mean() > 0.9
    closed = np.flatnonzero(verdicts)
    p, n, W_closed = points[closed], normals[closed], [w for w, yes in zip(W, theirs) if yes]
    return [
        ("force closure, 4 contacts", seconds(lambda: rg.force_closure(points, normals, 0.6), count),
         "scipy NNLS, 8 edges", seconds(lambda: [closed_by_nnls(w) for w in W], few)),
        ("balanced forces, 4 contacts", seconds(lambda: rg.internal_forces(p, n, 0.6), len(p)),
         "scipy NNLS, 8 edges", seconds(lambda: [closed_by_nnls(w) for w in W_closed], len(W_closed))),
        ("closure margin, 4 contacts", seconds(lambda: rg.closure_margin(p[:5000], n[:5000], 0.6), len(p[:5000])),
         "scipy qhull, 8 edges", seconds(lambda: [margin_by_hull(w) for w in W_closed[:60]], 60)),
    ]  # fmt: skip


class Pinocchio:
    """The four-finger hand in pinocchio."""

    def __init__(self, hand: rg.Hand) -> None:
        self.model = pinocchio.buildModelFromXML(hand.to_urdf())
        self.data = self.model.createData()
        self.columns = [self.model.idx_qs[self.model.getJointId(name)] for name in hand.joint_names]
        self.tips = [self.model.getFrameId(f"{finger.name}-tip") for finger in hand.fingers]

    def posture(self, q: np.ndarray) -> np.ndarray:
        own = np.empty(self.model.nq)
        own[self.columns] = q
        return own

    def fk(self, q: np.ndarray) -> np.ndarray:
        pinocchio.forwardKinematics(self.model, self.data, q)
        return np.array(
            [pinocchio.updateFramePlacement(self.model, self.data, f).translation for f in self.tips]
        )

    def jacobians(self, q: np.ndarray) -> list[np.ndarray]:
        pinocchio.computeJointJacobians(self.model, self.data, q)
        kind = pinocchio.LOCAL_WORLD_ALIGNED
        return [pinocchio.getFrameJacobian(self.model, self.data, f, kind)[:3] for f in self.tips]

    def ik(self, targets: np.ndarray, q: np.ndarray) -> np.ndarray:
        """All fingers at once by damped least squares, as pinocchio's own example has it; to a micrometre."""
        for _ in range(100):
            error = (targets - self.fk(q)).ravel()
            if np.abs(error).max() < 1e-6:
                break
            J = np.concatenate(self.jacobians(q))
            q = q + J.T @ np.linalg.solve(J @ J.T + 1e-8 * np.eye(len(J)), error)
        return q


def kinematics(count: int) -> list[tuple]:
    hand = rg.Hand.built_in("four-finger")
    theirs, generator = Pinocchio(hand), np.random.default_rng(3)
    lower = np.concatenate([finger.lower for finger in hand.fingers])
    upper = np.concatenate([finger.upper for finger in hand.fingers])
    q = generator.uniform(lower, upper, size=(count, len(lower)))
    ends = np.cumsum([0] + [len(finger.joints) for finger in hand.fingers])
    parts = [np.ascontiguousarray(q[:, a:b]) for a, b in itertools.pairwise(ends)]
    few = min(count, FEW)
    own = [theirs.posture(row) for row in q[:few]]
    near = [theirs.posture(row) for row in q[:50] + 0.05]
    centers = hand.fingertips(q)
    assert np.abs(np.array([theirs.fk(row) for row in own]) - centers[:few]).max() < 1e-9
    J = hand.jacobian(1, parts[1])[0]
    assert np.abs(theirs.jacobians(own[0])[1][:, theirs.columns[ends[1] : ends[2]]] - J).max() < 1e-9
    targets = [np.ascontiguousarray(centers[:, i]) for i in range(len(parts))]
    back = [hand.ik(i, some, near=part + 0.05) for i, (some, part) in enumerate(zip(targets, parts))]
    assert all(np.abs(hand.fk(i, some) - targets[i]).max() < 1e-9 for i, some in enumerate(back))
    return [
        ("fingertips of a hand, 4 × 3 joints", seconds(lambda: hand.fingertips(q), count),
         "pinocchio", seconds(lambda: [theirs.fk(row) for row in own], few)),
        ("their Jacobians", seconds(lambda: [hand.jacobian(i, part) for i, part in enumerate(parts)], count),
         "pinocchio", seconds(lambda: [theirs.jacobians(row) for row in own], few)),
        ("joints for 4 fingertips",
         seconds(lambda: [hand.ik(i, t, near=part + 0.05) for i, (t, part) in enumerate(zip(targets, parts))], count),
         "pinocchio, least squares",
         seconds(lambda: [theirs.ik(c, row) for c, row in zip(centers[:50], near)], 50)),
    ]  # fmt: skip


def surfaces(count: int) -> list[tuple]:
    rows = []
    for subdivisions in (3, 4):
        ball = trimesh.creation.icosphere(subdivisions=subdivisions, radius=0.03)
        task = rg.Scenario(object=ball, start=rg.pose(z=0.085), goals=[rg.pose(z=0.086)])
        bench = rg.Bench(task)
        directions = np.random.default_rng(5).normal(size=(count, 3))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        centers = 0.04 * directions
        contacts, distances = bench.closest_points(centers)
        few = min(count, FEW)
        theirs = trimesh.proximity.closest_point(ball, centers[:few])
        assert np.abs(distances[:few] - theirs[1]).max() < 1e-7
        assert np.abs(contacts.points[:few] - theirs[0]).max() < 1e-4
        rows.append((
            f"closest point of a mesh, {len(ball.faces)} facets",
            seconds(lambda bench=bench, centers=centers: bench.closest_points(centers), count),
            "trimesh, in a batch",
            seconds(lambda ball=ball, some=centers[:few]: trimesh.proximity.closest_point(ball, some), few),
        ))  # fmt: skip
    return rows


def geodesics(count: int) -> list[tuple]:
    """Between vertices. One peer finds shortest paths, as we do; the other those that are so nearby."""
    rows = []
    for subdivisions in (3, 5):
        ball = trimesh.creation.icosphere(subdivisions=subdivisions, radius=0.03)
        bench = rg.Bench(rg.Scenario(object=ball, start=rg.pose(z=0.085), goals=[rg.pose(z=0.086)]))
        points, _ = bench.closest_points(4 / 3 * ball.vertices)
        ends = np.random.default_rng(9).integers(len(ball.vertices), size=(2, min(count, 2000)))
        ends = ends[:, ends[0] != ends[1]]
        a, b = (rg.SurfacePoints(points.facets[i], points.points[i], points.normals[i]) for i in ends)
        lengths, few, fewest = bench.geodesics(a, b), ends.T[:FEW], ends.T[:EXACT]
        exact = PyGeodesicAlgorithmExact(ball.vertices, ball.faces)
        flips = potpourri3d.EdgeFlipGeodesicSolver(ball.vertices, ball.faces)
        shortest = [exact.geodesicDistance(*pair)[0] for pair in fewest]
        nearby = [path_length(flips.find_geodesic_path(*pair)) for pair in few]
        # Ours begin and end at contacts of a ball, a hair beside the vertices.
        for theirs in (shortest, nearby):
            shares = lengths[: len(theirs)] / theirs
            assert shares.max() < 1.000_2 and np.median(shares) > 0.999
        ours = seconds(lambda bench=bench, a=a, b=b: bench.geodesics(a, b), len(a))
        piece = f"geodesic on a mesh, {len(ball.faces)} facets"
        peers = (
            ("pygeodesic, exact", exact.geodesicDistance, fewest),
            ("potpourri3d, edge flips, local", flips.find_geodesic_path, few),
        )
        for peer, find, pairs in peers:
            all_of_them = lambda find=find, pairs=pairs: [find(*pair) for pair in pairs]
            rows.append((piece, ours, peer, seconds(all_of_them, len(pairs))))
    return rows


def path_length(path: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=20_000, help="calls in a batch")
    count = parser.parse_args().count
    print("| piece | ours, per call (µs) | peer | per call (µs) | times faster |\n|---|---:|---|---:|---:|")
    for rows in (closure, kinematics, surfaces, geodesics):
        for piece, ours, peer, theirs in rows(count):
            faster = f"{theirs / ours:.0f}" if theirs > ours else f"{theirs / ours:.2f}"
            print(f"| {piece} | {1e6 * ours:.2f} | {peer} | {1e6 * theirs:.1f} | {faster} |", flush=True)


if __name__ == "__main__":
    main()
