"""A stability test: two contacts press towards each other, and a third stops the turn about their line.

Two point contacts with friction whose joining line lies strictly inside both friction cones balance every
wrench but a torque about that line (Nguyen, "Constructing force-closure grasps", IJRR 1988). If the cones of
the other contacts give torques of both signs about the line, the grasp is force closure. The condition is
sufficient, not necessary: where it fails the answer is None, "I cannot say".
"""

import dataclasses
import itertools
import math

import numpy as np
import numpy.typing as npt
import regrasp as rg

Array = npt.NDArray[np.float64]


class PressedPair(rg.StabilityTest):
    """Two contacts that press towards each other, and others that stop the turn about their line."""

    id = "stability-test/template"
    references = ("Nguyen, Constructing force-closure grasps, IJRR 1988",)

    @dataclasses.dataclass(frozen=True)
    class Settings:
        """Settings of the stability test."""

        least_margin: float = rg.setting(
            1e-4, range=(1e-6, 0.5), doc="The least margin, no unit, that counts as stable."
        )

    def test(self, grasp: rg.Grasp) -> bool | None:
        """True where some pair holds with the rest; None otherwise."""
        return True if self._margin(grasp) >= self.settings.least_margin else None

    def margin(self, grasp: rg.Grasp, length: float | None, center: Array | None) -> tuple[float, float]:
        """The criterion's own margin: comparable between grasps under this test only."""
        margin = self._margin(grasp)
        return (margin, margin) if margin >= self.settings.least_margin else (0.0, math.inf)

    def _margin(self, grasp: rg.Grasp) -> float:
        """The best over all pairs: how far (no unit) cones and torques are from failing."""
        points, inward, mu = grasp.points, -grasp.normals, grasp.friction
        pairs = itertools.combinations(range(len(grasp)), 2)
        return max((pair_margin(points, inward, mu, a, b) for a, b in pairs), default=-math.inf)


def pair_margin(points: Array, inward: Array, mu: Array, a: int, b: int) -> float:
    """The smallest of the pair's slacks in its two cones and of the torques that the others give about its
    line, either way.
    """
    line = points[b] - points[a]
    length = float(np.linalg.norm(line))
    others = [i for i in range(len(points)) if i not in (a, b)]
    if not length > 0 or not others:
        return -math.inf
    along = line / length
    # The torque of a force f about the line is f · lever.
    levers = np.cross(along, points[others] - points[a]) / length
    reaches = [
        max(reach(inward[i], mu[i], sign * lever) for i, lever in zip(others, levers, strict=True))
        for sign in (1.0, -1.0)
    ]
    return min(slack(inward[a], mu[a], along), slack(inward[b], mu[b], -along), *reaches)


def slack(inward: Array, mu: float, direction: Array) -> float:
    """How far inside the cone the direction lies: positive strictly inside."""
    normal = float(direction @ inward)
    return mu * normal - float(np.linalg.norm(direction - inward * normal))


def reach(inward: Array, mu: float, w: Array) -> float:
    """The largest f · w over the cone's forces of unit normal part."""
    normal = float(w @ inward)
    return normal + mu * float(np.linalg.norm(w - inward * normal))
