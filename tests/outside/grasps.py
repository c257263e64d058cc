"""Whether contacts hold an object, asked of Clarabel: closure, and weight and load within limits."""

import clarabel
import numpy as np
from scipy import sparse


def tangents(n):
    """Two unit vectors orthogonal to a normal and to each other."""
    t = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    t /= np.linalg.norm(t)
    return t, np.cross(n, t)


def columns(points, normals, gamma):
    """The 6 × 3n map (4n with torsion) from contact forces (normal, tangents, torsion) to wrenches."""
    blocks = []
    for p, n in zip(points, normals):
        directions = [-n, *tangents(-n)]
        block = [np.concatenate([d, np.cross(p, d)]) for d in directions]
        if gamma > 0:
            block.append(np.concatenate([np.zeros(3), -n]))
        blocks.append(np.array(block).T)
    return np.hstack(blocks)


def slack(points, normals, mu, gamma=0.0, load=None, most=None, drags=None):
    """The largest t for which balanced forces exist with f_n - t ≥ |(f_t/μ, m/γ)| at every contact.

    Without a load the normal forces sum to 1; with one they are at most `most - t` each. Points are
    taken from the centre, in units of length. `drags` are the torques about the normals, per unit of
    normal force, with which contacts drag while they spin.
    """
    G = columns(points, normals, gamma)
    width, n = G.shape[1] // max(len(points), 1), len(points)
    for i, drag in enumerate(drags or []):
        G[3:, width * i] += drag * np.asarray(normals[i])
    scale = np.tile([1.0, mu, mu, gamma][:width], n)
    if n < 2 or mu <= 0:
        return -np.inf
    if np.linalg.matrix_rank(G * scale, tol=1e-9) < 6:
        return -np.inf
    equal = [np.append(row, 0.0) for row in G * scale]
    right = list(np.zeros(6) if load is None else -np.asarray(load))
    if load is None:
        equal.append(np.append(np.tile([1.0] + [0.0] * (width - 1), n), 0.0))
        right.append(1.0)
    rows, b, cones = equal, right, [clarabel.ZeroConeT(len(equal))]
    if load is not None:
        for i in range(n):
            row = np.zeros(width * n + 1)
            row[width * i], row[-1] = 1.0, 1.0
            rows.append(row)
            b.append(most)
        cones.append(clarabel.NonnegativeConeT(n))
    for i in range(n):
        for j in range(width):
            row = np.zeros(width * n + 1)
            row[width * i + j] = -1.0
            if j == 0:
                row[-1] = 1.0
            rows.append(row)
            b.append(0.0)
        cones.append(clarabel.SecondOrderConeT(width))
    q = np.zeros(width * n + 1)
    q[-1] = -1.0
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    A = sparse.csc_matrix(np.array(rows))
    P = sparse.csc_matrix((len(q), len(q)))
    solved = clarabel.DefaultSolver(P, q, A, np.array(b), cones, settings).solve()
    if "Solved" not in str(solved.status):
        return -np.inf
    return solved.x[-1]


def edges_of(cone, spins):
    """The edges (t1, t2, torsion) of a recorded cone; of a round one 64 on its surface, without torsion."""
    if "elliptic" in cone:
        mu = cone["elliptic"]["mu"]
        return [(mu * np.cos(a), mu * np.sin(a), 0.0) for a in np.arange(64) * 2 * np.pi / 64]
    edges = [(*edge["tangential"], edge["torsion"]) for edge in cone["polyhedral"]]
    if not spins:
        return edges
    flat = [edge for edge in edges if edge[2] == 0.0]
    for a in (edge for edge in edges if edge[2] > 0.0):
        for b in (edge for edge in edges if edge[2] < 0.0):
            s = a[2] / (a[2] - b[2])
            flat.append(tuple(np.array(a) + s * (np.array(b) - np.array(a))))
    return flat


def edge_wrenches(point, normal, edges, length):
    """The wrenches of edges at a point (over the length) with this outward normal."""
    n = -np.asarray(normal)
    t1 = np.cross(n, [1.0, 0.0, 0.0] if abs(n[0]) < 0.6 else [0.0, 1.0, 0.0])
    t1 /= np.linalg.norm(t1)
    t2 = np.cross(n, t1)
    forces = [n + x * t1 + y * t2 for x, y, _ in edges]
    return [
        np.concatenate([f, np.cross(point, f) + n * (m / length)]) for f, (_, _, m) in zip(forces, edges)
    ]


def spanning(wrenches):
    """The largest t with shares λ ≥ t of all wrenches that sum to 1 and balance; closure where t > 0."""
    W = np.array(wrenches).T
    n = W.shape[1] if W.size else 0
    if n < 7 or np.linalg.matrix_rank(W, tol=1e-9) < 6:
        return -np.inf
    equal = np.vstack([np.hstack([W, np.zeros((6, 1))]), np.append(np.ones(n), 0.0)])
    above = np.hstack([-np.eye(n), np.ones((n, 1))])
    b = np.concatenate([np.zeros(6), [1.0], np.zeros(n)])
    q = np.zeros(n + 1)
    q[-1] = -1.0
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    A = sparse.csc_matrix(np.vstack([equal, above]))
    P = sparse.csc_matrix((n + 1, n + 1))
    cones = [clarabel.ZeroConeT(7), clarabel.NonnegativeConeT(n)]
    solved = clarabel.DefaultSolver(P, q, A, b, cones, settings).solve()
    return solved.x[-1] if "Solved" in str(solved.status) else -np.inf


def margin_at_most(points, normals, mu, gamma=0.0, tries=4000, seed=1):
    """An upper bound of the closure margin: the least of max_i h_i(w) over many unit w."""
    random = np.random.default_rng(seed)
    w = random.normal(size=(tries, 6))
    for _ in range(6):
        w /= np.linalg.norm(w, axis=1, keepdims=True)
        values = support(w, points, normals, mu, gamma)
        best = w[np.argsort(values)[: tries // 10]]
        spread = 0.3 * np.linalg.norm(best - best[0], axis=1).mean() + 1e-3
        w = np.vstack([best, np.repeat(best, 9, axis=0) + spread * random.normal(size=(9 * len(best), 6))])
    w /= np.linalg.norm(w, axis=1, keepdims=True)
    return support(w, points, normals, mu, gamma).min()


def support(w, points, normals, mu, gamma):
    """max_i h_i(w): how far the contacts reach along w with unit normal force."""
    a, b = w[:, :3], w[:, 3:]
    reach = []
    for p, n in zip(points, normals):
        v = a + np.cross(b, p)
        v_n = v @ -n
        v_t = v - np.outer(v_n, -n)
        reach.append(v_n + np.sqrt(mu**2 * (v_t**2).sum(axis=1) + (gamma * (b @ n)) ** 2))
    return np.max(reach, axis=0)
