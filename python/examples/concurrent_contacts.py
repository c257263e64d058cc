"""The book's tutorial on stability tests, in Python: every contact pushes towards one common point."""

# ANCHOR: plugin
import dataclasses
import functools
import itertools
import math

import numpy as np
import numpy.typing as npt
import regrasp as rg

Array = npt.NDArray[np.float64]


class Concurrent(rg.StabilityTest):
    """Three or more contacts push towards one point between them; sufficient, not necessary."""

    references = (
        "Ponce, Sullivan, Sudsang, Boissonnat, Merlet, On computing four-finger equilibrium and force-closure "
        "grasps of polyhedral objects, IJRR 1997",
    )

    @dataclasses.dataclass(frozen=True)
    class Settings:
        """Settings of the test."""

        least_margin: float = rg.setting(
            1e-4, range=(1e-6, 0.5), doc="The least room, no unit, that the forces must leave in their cones."
        )
        leans: int = rg.setting(
            3, range=(0, 6), doc="How many other points than the middle are tried, to each side of it."
        )

    def test(self, grasp: rg.Grasp) -> bool | None:
        # None and not False: that no part is concurrent proves nothing.
        return True if self._margin(grasp) >= self.settings.least_margin else None

    def margin(self, grasp: rg.Grasp, length: float | None, center: Array | None) -> tuple[float, float]:
        margin = self._margin(grasp)
        return (margin, margin) if margin >= self.settings.least_margin else (0.0, math.inf)

    def _margin(self, grasp: rg.Grasp) -> float:
        """The best over all parts: how far (no unit) forces towards the part's point are from failing."""
        p, n, weights = grasp.points, grasp.normals, parts(len(grasp), self.settings.leans)
        if not len(weights):
            return -math.inf
        inside = weights > 0
        push = (weights @ p)[:, None] / weights.sum(axis=1)[:, None, None] - p
        size = np.where(inside, np.linalg.norm(push, axis=2), 0.0).max(axis=1)
        push /= np.maximum(size, 1e-12)[:, None, None]
        normal = -(push * n).sum(axis=2)
        room = grasp.friction * normal - np.linalg.norm(push + normal[..., None] * n, axis=2)
        # Contacts on one line leave the turn about it free, whatever their forces: |a × b|² of the best pair.
        dots = push @ push.swapaxes(1, 2)
        squares = np.diagonal(dots, axis1=1, axis2=2)
        crossed = squares[:, :, None] * squares[:, None] - dots * dots
        pairs = inside[:, :, None] & inside[:, None]
        spread = np.sqrt(np.where(pairs, crossed, 0.0).max(axis=(1, 2)).clip(0.0))
        return float(np.minimum(np.where(inside, room, math.inf).min(axis=1), spread).max())


@functools.cache
def parts(count: int, leans: int) -> Array:
    """A row for each part of three contacts or more, with each point: their weights in it, 0 outside."""
    rows = []
    for size in range(3, count + 1):
        for chosen in itertools.combinations(range(count), size):
            even = np.zeros(count)
            even[list(chosen)] = 1.0
            rows.append(even)
            for odd, k in itertools.product(chosen, range(1, leans + 1)):
                rows += [np.where(np.arange(count) == odd, 2.0**sign, even) for sign in (k, -k)]
    return np.array(rows).reshape(-1, count)


# ANCHOR_END: plugin

if __name__ == "__main__":
    print(rg.plan("sphere", seed=1, use={"stability-test": Concurrent}))
    rg.conformance.check(Concurrent).assert_passes()
