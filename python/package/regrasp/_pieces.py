"""The planner's pieces by themselves, over arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _regrasp
from ._errors import ArgumentError
from ._planning import MOST, native_changes, seed_of, whole
from ._regrasp import Configuration
from ._scenario import Scenario
from ._spatial import Array, array, numbers_of


def _grasps(
    points: npt.ArrayLike, normals: npt.ArrayLike, friction: npt.ArrayLike, torsion: npt.ArrayLike
) -> tuple[bool, Array, Array, Array]:
    """Whether one grasp alone is given, and points, unit normals and cones of all."""
    alone = np.ndim(points) == 2
    p = array("points", np.asarray(points)[None] if alone else points, (None, None, 3))
    n = array("normals", np.asarray(normals)[None] if alone else normals, p.shape)
    lengths = np.linalg.norm(n, axis=-1, keepdims=True)
    if (lengths < 1e-9).any():
        raise ArgumentError("`normals` hold one of the length 0", key="normals")
    cones = np.empty((*p.shape[:2], 2))
    for column, (key, value) in enumerate((("friction", friction), ("torsion", torsion))):
        numbers = numbers_of(key, value)
        if not np.isfinite(numbers).all() or (numbers < 0).any():
            raise ArgumentError(f"`{key}` holds numbers outside 0..", key=key, range="0..")
        try:
            cones[..., column] = np.broadcast_to(numbers, p.shape[:2])
        except ValueError as error:
            raise ArgumentError(f"`{key}` has shape {numbers.shape}, not {p.shape[:2]}", key=key) from error
    return alone, p, np.ascontiguousarray(n / lengths), cones


def force_closure(
    points: npt.ArrayLike, normals: npt.ArrayLike, friction: npt.ArrayLike = 0.8, torsion: npt.ArrayLike = 0.0
) -> npt.NDArray[np.bool_]:
    """Whether grasps are force closure: some forces within the friction cones resist every small wrench.

    Exact for elliptic cones; too close to the boundary counts as not closed. About a microsecond for a grasp.

    Parameters
    ----------
    points : array_like, (N, K, 3) or (K, 3)
        Contact points (m) of N grasps of K contacts each, 1 to 8, in the object's frame.
    normals : array_like, same shape
        Outward normals, of any length but 0.
    friction, torsion : array_like, broadcast to (N, K)
        Coefficients of friction (no unit) and torsional radii (m); 0 torsion is a point contact.

    Returns
    -------
    ndarray of bool, (N,), or () for one grasp
    """
    alone, p, n, cones = _grasps(points, normals, friction, torsion)
    verdicts = _regrasp.force_closure(p, n, cones)
    return verdicts[0] if alone else verdicts


def closure_margin(
    points: npt.ArrayLike,
    normals: npt.ArrayLike,
    friction: npt.ArrayLike = 0.8,
    torsion: npt.ArrayLike = 0.0,
    *,
    center: npt.ArrayLike | None = None,
    length: float | None = None,
) -> Array:
    """Bounds of the closure margin: the largest ball of wrenches that unit total normal force resists.

    Source: Ferrari and Canny, "Planning optimal grasps", ICRA 1992, with the sum of the normal forces
    bounded.

    Parameters
    ----------
    points, normals, friction, torsion
        As for :func:`force_closure`.
    center : array_like, (3,), optional
        The point that torques are taken about (m); each grasp's own centroid where absent.
    length : float, optional
        What torques are divided by (m); each grasp's own size where absent. Give both to compare grasps.

    Returns
    -------
    ndarray, (N, 2), or (2,) for one grasp
        A certified lower bound, 0 or less where the grasp is not closed, and an upper bound.
    """
    alone, p, n, cones = _grasps(points, normals, friction, torsion)
    about = None if center is None else array("center", center, (3,)).tolist()
    if length is not None and not 0 < float(numbers_of("length", length)) < np.inf:
        raise ArgumentError(
            f"`length` = {length} is outside 0..", key="length", value=str(length), range="0.."
        )
    margins = _regrasp.closure_margins(p, n, cones, about, length)
    return margins[0] if alone else margins


def internal_forces(
    points: npt.ArrayLike, normals: npt.ArrayLike, friction: npt.ArrayLike = 0.8, torsion: npt.ArrayLike = 0.0
) -> Array:
    """Forces on the object that balance each other, strictly inside every cone: the proof of closure.

    Returns
    -------
    ndarray, (N, K, 3), or (K, 3) for one grasp
        In the object's frame, in units of the proof (their scale is free); NaN where the grasp is not closed.
    """
    alone, p, n, cones = _grasps(points, normals, friction, torsion)
    forces = _regrasp.internal_forces(p, n, cones)
    return forces[0] if alone else forces


def wrench_cones(
    points: npt.ArrayLike, normals: npt.ArrayLike, friction: npt.ArrayLike = 0.8, *, edges: int = 8
) -> Array:
    """Edges of friction cones as wrenches about the frame's origin: force, then torque.

    Parameters
    ----------
    points, normals, friction
        As for :func:`force_closure`.
    edges : int
        Of each cone's inscribed pyramid, 3 or more.

    Returns
    -------
    ndarray, (N, K, edges, 6), or (K, edges, 6) for one grasp
        At unit normal force: forces along the inward normal.
    """
    edges = whole("edges", edges, 3, 100_000)
    alone, p, n, cones = _grasps(points, normals, friction, 0.0)
    inward = -n
    other = np.where(np.abs(inward[..., :1]) < 0.9, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    t1 = np.cross(inward, other)
    t1 /= np.linalg.norm(t1, axis=-1, keepdims=True)
    t2 = np.cross(inward, t1)
    angles = 2 * np.pi * np.arange(edges) / edges
    round_ = np.cos(angles)[:, None] * t1[..., None, :] + np.sin(angles)[:, None] * t2[..., None, :]
    forces = inward[..., None, :] + cones[..., :1, None] * round_
    torques = np.cross(p[..., None, :], forces)
    wrenches = np.concatenate([forces, torques], axis=-1)
    return wrenches[0] if alone else wrenches


@dataclass(frozen=True)
class SurfacePoints:
    """Contacts on the object: `facets` (N,), `points` (N, 3) in O (m), outward `normals` (N, 3)."""

    facets: npt.NDArray[np.uint32]
    points: Array
    normals: Array

    def __len__(self) -> int:
        return len(self.facets)


@dataclass(frozen=True)
class Holding:
    """What holds the object at rest in N grasps: F fingers, J joints; NaN where no forces do.

    Attributes
    ----------
    forces : ndarray, (N, F, 3)
        Of the fingertips on the object, in O (N): NaN where a finger does not hold.
    efforts : ndarray, (N, J)
        What the joints give for them, Jᵀf, weights of links apart (N·m; N).
    friction_share : ndarray, (N,)
        The largest share of the friction that a force relies on. Above 1 no forces within friction and
        efforts hold the weight, and these are the nearest.
    effort_share : ndarray, (N,)
        The largest share of its effort limit that a joint gives.
    mass : ndarray, (N,)
        The largest mass (kg), to a hundredth, that the grasp carries within friction and efforts; 0 for none.
    """

    forces: Array
    efforts: Array
    friction_share: Array
    effort_share: Array
    mass: Array

    def __len__(self) -> int:
        return len(self.mass)


@dataclass(frozen=True)
class Way:
    """How far a local planner came; true where it reached its end.

    Attributes
    ----------
    states : list of Configuration
        The start, and what was reached from there in turn.
    fraction : float
        The share of the way that was made, 0 to 1.
    reason : str or None
        Why it stopped short.
    """

    states: list[Configuration]
    fraction: float
    reason: str | None

    def __bool__(self) -> bool:
        return self.reason is None


class Bench:
    """A scenario with its plugins built, for calls by hand: its surface, its sampler, its stability test, its
    local planners.

    Parameters
    ----------
    scenario : Scenario, dict, str or path
        As for :func:`regrasp.plan`.
    use, settings : dict, optional
        As for :func:`regrasp.plan`.
    """

    def __init__(
        self,
        scenario: Any,
        *,
        use: Mapping[str, Any] | None = None,
        settings: Mapping[str, Any] | None = None,
    ) -> None:
        self.scenario = Scenario.of(scenario)
        self._native = _regrasp.Bench(self.scenario.native, native_changes(use, settings, None, None))

    def sample_contacts(self, count: int, *, seed: int = 0) -> SurfacePoints:
        """Random contacts, uniform over what a fingertip can touch."""
        number = whole("count", count, 0, MOST)
        return SurfacePoints(**self._native.sample_contacts(number, seed_of(seed)))

    def closest_points(self, centers: npt.ArrayLike) -> tuple[SurfacePoints, Array]:
        """The contacts closest to fingertip centres (N, 3) in O (m), and signed distances (N,) (m),
        negative inside.
        """
        arrays = self._native.closest_points(array("centers", centers, (None, 3)))
        distances = arrays.pop("distances")
        return SurfacePoints(**arrays), distances

    def geodesics(self, starts: SurfacePoints, ends: SurfacePoints) -> Array:
        """Lengths (N,) of the shortest paths on the surface (m); infinite where a fingertip cannot follow."""
        facets = (
            np.ascontiguousarray(starts.facets, np.uint32),
            np.ascontiguousarray(ends.facets, np.uint32),
        )
        return self._native.geodesics(_sides(starts), _sides(ends), facets)

    def sample_grasps(
        self, count: int, *, seed: int = 0, holding: Sequence[int] | None = None, tries: int | None = None
    ) -> list[Configuration]:
        """Random admissible configurations in which the fingers `holding` (all by default) hold the object.

        Fewer than `count` where `tries` samples, ten times as many by default, do not give as many.
        """
        number = whole("count", count, 0, MOST)
        highest = len(self.scenario.problem["hand"]["finger"]) - 1
        fingers = None if holding is None else [whole("holding", finger, 0, highest) for finger in holding]
        most = 10 * number if tries is None else whole("tries", tries, 0, 2**63)
        return self._native.sample_grasps(number, seed_of(seed), fingers, most)

    def margins(self, configurations: Sequence[Configuration]) -> Array:
        """Bounds (N, 2) of what the scenario's stability test gives configurations, about the object's
        centre of mass.
        """
        return self._native.margins(list(configurations))

    def holds(self, configurations: Sequence[Configuration], *, share: float = 1.0) -> Holding:
        """What holds the object's weight at rest in configurations, and how much they would carry.

        Forces are the analytic centre of those within the joints' efforts that need at most `share` (0.01
        to 1) of the friction; where there are none, those that need least of it. Source: Han, Trinkle, Li,
        "Grasp analysis as linear matrix inequality problems", T-RA 2000. Contacts must share one elliptic
        cone.
        """
        part = float(numbers_of("share", share))
        if not 0.01 <= part <= 1:
            message = f"`share` = {part} is outside 0.01..=1"
            raise ArgumentError(message, key="share", value=str(part), range="0.01..=1")
        return Holding(**self._native.holds(list(configurations), part))

    def connect(
        self,
        starts: Configuration | Sequence[Configuration],
        ends: Any,
        *,
        finger: int | None = None,
        seed: int = 0,
    ) -> Way | list[Way]:
        """Goes from configurations to others by the scenario's local planners.

        Parameters
        ----------
        starts : Configuration, or sequence of N
            Where to begin.
        ends : Configuration, array_like (4, 4), or sequence of N
            A configuration of the same fingers is reached within GS_n, its contacts sliding; or, with
            `finger`, by that finger alone. A pose X_HO is where the object goes, the fingertips rolling.
        finger : int, optional
            The finger that regrasps.
        seed : int
            Of all random choices.

        Returns
        -------
        Way, or list of N
            Planners of poses may stop on the way; the others arrive, or stay.
        """
        alone = isinstance(starts, Configuration)
        begin = [starts] if isinstance(starts, Configuration) else list(starts)
        single = isinstance(ends, Configuration) or np.shape(ends) == (4, 4)
        targets = [ends] * len(begin) if single else list(ends)
        if len(targets) != len(begin):
            message = f"`ends` has {len(targets)} entries, `starts` {len(begin)}"
            raise ArgumentError(message, key="ends", value=str(len(targets)), range=str(len(begin)))
        to = [_end(f"ends[{i}]", target, finger) for i, target in enumerate(targets)]
        ways = [Way(*way) for way in self._native.connect(begin, to, seed_of(seed))]
        return ways[0] if alone else ways


def _end(key: str, target: Any, finger: int | None) -> Any:
    if isinstance(target, Configuration):
        return target if finger is None else (target, whole("finger", finger, 0, 255))
    if finger is not None:
        raise ArgumentError("with `finger` the ends are configurations", key="ends", value=repr(target))
    return array(key, target, (4, 4)).tolist()


def _sides(contacts: SurfacePoints) -> tuple[Array, Array]:
    return array("points", contacts.points, (None, 3)), array("normals", contacts.normals, (None, 3))


def sample_grasps(scenario: Any, count: int, **options: Any) -> list[Configuration]:
    """Random nodes of a scenario's graph, by its own sampler: :meth:`Bench.sample_grasps`.

    That is what a plan's search draws, near start and goals, from which a finger can be lifted.
    :func:`regrasp.grasps` is for many grasps: distinct, verified, on threads, anywhere that the hand reaches,
    by a search of its own which no sampler takes part in.
    """
    return Bench(scenario).sample_grasps(count, **options)
