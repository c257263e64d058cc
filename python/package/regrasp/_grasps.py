"""Grasps in bulk, as arrays."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _regrasp
from ._planning import MOST, native_changes, seed_of, whole
from ._scenario import Scenario
from ._spatial import Array


@dataclass(frozen=True)
class Grasps:
    """Distinct, verified grasps; G grasps, F fingers, J joints. What does not exist is NaN, or -1.

    Attributes
    ----------
    object_position, object_orientation : ndarray, (G, 3), (G, 4)
        The object's pose in the hand's frame: m; quaternions w, x, y, z.
    joints : ndarray, (G, J)
        rad; m where prismatic.
    holding, liftable : ndarray of bool, (G, F)
        Which fingers hold; which of these may be lifted, the others being stable.
    facet : ndarray of int, (G, F)
        The facet that a finger touches.
    contact_point_O, contact_normal_O : ndarray, (G, F, 3)
        In the object's frame: m; outward.
    force_O, efforts : ndarray, (G, F, 3), (G, J)
        What holds the object's weight: N on the object, in its frame; the joints' N·m.
    margin, clearance, friction, effort_share : ndarray, (G,)
        The verifier's certified margin; smallest distance (m); the coefficient of friction that the forces
        need; the largest share of a joint's effort limit that they take.
    pose : ndarray of int, (G,)
        Number of the pose: grasps of one number differ in fingers and contacts alone.
    edges, edge_finger : ndarray of int, (E, 2), (E,)
        Regrasps: numbers of two grasps, and the finger that moves; empty where they were not asked for.
    """

    object_position: Array
    object_orientation: Array
    joints: Array
    holding: npt.NDArray[np.bool_]
    liftable: npt.NDArray[np.bool_]
    facet: npt.NDArray[np.int64]
    contact_point_O: Array
    contact_normal_O: Array
    force_O: Array
    efforts: Array
    margin: Array
    clearance: Array
    friction: Array
    effort_share: Array
    pose: npt.NDArray[np.int64]
    joint_names: npt.NDArray[np.str_]
    finger_names: npt.NDArray[np.str_]
    info: dict[str, Any]
    edges: npt.NDArray[np.int64] = field(default_factory=lambda: np.empty((0, 2), np.int64))
    edge_finger: npt.NDArray[np.int64] = field(default_factory=lambda: np.empty(0, np.int64))

    def __len__(self) -> int:
        return len(self.margin)


def grasps(
    scenario: Any,
    count: int = 1000,
    *,
    seed: int = 0,
    spread: float = 2e-3,
    per_pose: int = 8,
    per_facet: int | None = None,
    fingers: tuple[int, int] | None = None,
    graph: bool = False,
    threads: int = 1,
    time_limit: float | None = None,
    use: Mapping[str, Any] | None = None,
    settings: Mapping[str, Any] | None = None,
) -> Grasps:
    """Distinct, verified grasps of a scenario's hand and object, as ``regrasp grasps`` finds them.

    Parameters
    ----------
    scenario : Scenario, dict, str or path
        As for :func:`regrasp.plan`; start and goals do not count.
    count : int
        How many; fewer where there are no more, or the time is over.
    seed, threads : int
        The same seed gives the same grasps on any number of threads, and fewer are the first of more.
    spread : float
        How far (m) two grasps are apart at least.
    per_pose : int
        The most grasps of one pose of the object.
    per_facet : int, optional
        The most grasps in which the same fingers touch the same facets.
    fingers : (int, int), optional
        How few and how many fingers hold.
    graph : bool
        Whether to look for the regrasps that connect grasps of one pose.
    time_limit : float, optional
        Seconds.
    use, settings : dict, optional
        As for :func:`regrasp.plan`.
    """
    asked = {
        "count": whole("count", count, 1, MOST),
        "seed": seed_of(seed),
        "spread": float(spread),
        "per_pose": whole("per_pose", per_pose, 1),
        "per_facet": None if per_facet is None else whole("per_facet", per_facet, 1),
        "fingers": fingers,
        "graph": bool(graph),
    }
    changes = native_changes(use, settings, time_limit, None)
    native = Scenario.of(scenario).native
    archive = np.load(io.BytesIO(_regrasp.grasps(native, asked, whole("threads", threads, 1, 256), changes)))
    arrays = {name: archive[name] for name in archive.files}
    arrays.pop("grasps_problem")
    return Grasps(info=json.loads(str(arrays.pop("grasps_info"))), **arrays)
