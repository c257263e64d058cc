"""What a plan needs along its motion, and what it leaves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ._spatial import Array

if TYPE_CHECKING:
    from ._plan import Plan


@dataclass(frozen=True)
class Figures:
    """Figures of every state; S states, F fingers, J joints. NaN where there is nothing to say.

    Between two states a clearance can be smaller: what :attr:`Plan.certificate` says holds there too.

    Attributes
    ----------
    margin : ndarray, (S,)
        Certified lower bound of the closure margin; of the room to hold the load where the plan claims that.
    clearance : ndarray, (S,)
        The smallest distance of two bodies that may not touch (m).
    friction : ndarray, (S, F)
        The coefficient of friction that each finger's force needs, torques about normals apart.
    effort_share : ndarray, (S, J)
        What each joint gives for the forces, as a share of its limit.
    """

    margin: Array
    clearance: Array
    friction: Array
    effort_share: Array


def figures(plan: Plan, series: tuple[Array, Array]) -> Figures:
    """The figures of a plan; `series` are margin and clearance of its states, segment after segment."""
    merged = [np.full(len(plan.times), np.nan) for _ in series]
    first = 0
    for segment in plan.segments:
        count = segment.last - segment.first + 1
        for column, values in zip(merged, series, strict=True):
            # A border counts for both of its segments: what holds there is the less of the two.
            column[segment.rows] = np.fmin(column[segment.rows], values[first : first + count])
        first += count
    joints = [joint for finger in plan.scenario["problem"]["hand"]["finger"] for joint in finger["joint"]]
    limits = np.array([joint["effort"] for joint in joints])
    efforts = np.full(plan.joints.shape, np.nan) if plan.efforts is None else plan.efforts
    margin, clearance = merged
    return Figures(margin, clearance, _friction(plan), np.abs(efforts) / limits)


def _friction(plan: Plan) -> Array:
    contacts, forces = plan.contacts, plan.forces
    if forces is None:
        return np.full(contacts.holding.shape, np.nan)
    pressing = -np.einsum("sfi,sfi->sf", forces, contacts.normals_O)
    sliding = np.linalg.norm(forces + pressing[..., None] * contacts.normals_O, axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(pressing > 0, sliding / pressing, np.where(sliding > 0, np.inf, np.nan))
