"""Plans: the motion as arrays, the certificate, the verifier's verdict."""

from __future__ import annotations

import json
import logging
import os
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _regrasp
from ._errors import PlanFileError, VerificationError
from ._figures import Figures, figures
from ._plot import plan_figure
from ._scenario import not_finite, plain
from ._spatial import matrices
from ._view import View, facts, frame

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure

Array = npt.NDArray[np.float64]
logger = logging.getLogger("regrasp")


@dataclass(frozen=True)
class Check:
    """One check of the verifier: its worst value over the plan, the limit of that, both in ``unit``, and
    where.
    """

    name: str
    ok: bool
    worst: float | None
    limit: float
    unit: str
    place: dict[str, Any]


@dataclass(frozen=True)
class Verdict:
    """The verifier's answer on a plan; true where the plan is valid."""

    valid: bool
    checks: list[Check]

    def __bool__(self) -> bool:
        return self.valid

    @property
    def failures(self) -> list[Check]:
        """The checks that are not met."""
        return [check for check in self.checks if not check.ok]

    @classmethod
    def of(cls, tree: dict[str, Any]) -> Verdict:
        """The verdict from the verifier's own tree."""
        names = ("name", "ok", "worst", "limit", "unit", "place")
        return cls(
            tree["valid"], [Check(**{name: check.get(name) for name in names}) for check in tree["checks"]]
        )


@dataclass(frozen=True)
class Segment:
    """A part of the motion: the object moves and the tips roll, or it rests and one finger moves.

    Attributes
    ----------
    kind : str
        ``transfer`` or ``regrasp``.
    finger : int or None
        The finger that moves, counted from 0, for regrasps.
    first, last : int
        Rows of the plan's arrays; consecutive segments share a row.
    """

    kind: str
    finger: int | None
    first: int
    last: int

    @property
    def rows(self) -> slice:
        """The segment's rows in the plan's arrays, both ends included: ``plan.joints[segment.rows]``."""
        return slice(self.first, self.last + 1)


@dataclass(frozen=True)
class Contacts:
    """Where the fingertips touch: S states, F fingers; NaN where a finger does not hold.

    Attributes
    ----------
    points_O : ndarray, (S, F, 3)
        Contact points in the object's frame (m).
    normals_O : ndarray, (S, F, 3)
        Outward unit normals in the object's frame: from the object to the fingertip.
    points_F : ndarray, (S, F, 3)
        Contact points in the fingertips' frames (m): origin at the ball's centre, axes of the last link.
    holding : ndarray of bool, (S, F)
        Which fingers hold.
    """

    points_O: Array
    normals_O: Array
    points_F: Array
    holding: npt.NDArray[np.bool_]


class Plan:
    """A plan: a motion that the verifier can judge.

    All arrays are read-only, in SI units; S is the number of distinct states, J that of all joints, F that
    of fingers.
    Between two states joints and position move linearly and orientation by slerp.
    """

    def __init__(self, native: _regrasp.Plan, summary: dict[str, Any] | None = None) -> None:
        self._native = native
        self._summary = summary or {}

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Plan:
        """Reads a plan file; raises :class:`PlanFileError` for anything else."""
        return cls(_regrasp.Plan.read(os.fspath(path)))

    @classmethod
    def from_dict(cls, tree: dict[str, Any]) -> Plan:
        """A plan from the tree of its file, as :meth:`to_dict` gives it."""
        try:
            text = json.dumps(tree, default=plain, allow_nan=False)
        except (TypeError, ValueError, RecursionError) as error:
            place = not_finite(tree) if "range float" in str(error) else ""
            where = f"`{place}`: " if place else ""
            raise PlanFileError(f"the given tree is no plan: {where}{error}") from error
        return cls(_regrasp.Plan.parse(text, "the given tree"))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the plan file; a failure leaves what was there before."""
        self._native.write(os.fspath(path))

    def to_json(self) -> str:
        """The text of the plan file."""
        return self._native.text()

    def to_dict(self) -> dict[str, Any]:
        """The tree of the plan file."""
        tree: dict[str, Any] = json.loads(self.to_json())
        return tree

    def verify(self, *, strict: bool = False) -> Verdict:
        """Has the independent verifier judge the plan at ten times its resolution.

        Parameters
        ----------
        strict : bool
            Raise :class:`VerificationError` where the plan is not valid, instead of saying so.
        """
        verdict = Verdict.of(json.loads(self._native.verify()))
        if strict and not verdict:
            raise refused(self, verdict)
        return verdict

    @cached_property
    def _head(self) -> dict[str, Any]:
        head: dict[str, Any] = json.loads(self._native.head())
        return head

    @cached_property
    def _arrays(self) -> dict[str, Array]:
        arrays = self._native.arrays()
        for array in arrays.values():
            array.flags.writeable = False
        return arrays

    @property
    def times(self) -> Array:
        """Seconds from the motion's start, (S,)."""
        return self._arrays["time"]

    @property
    def joints(self) -> Array:
        """Joint positions (rad; m where prismatic), finger after finger, base to tip: (S, J), as
        :attr:`joint_names`.
        """
        return self._arrays["joints"]

    @property
    def positions(self) -> Array:
        """Positions of the object's origin in the hand's frame (m), (S, 3)."""
        return self._arrays["pose"][:, :3]

    @property
    def orientations(self) -> Array:
        """Orientations of the object in the hand's frame as unit quaternions w, x, y, z: (S, 4)."""
        return self._arrays["pose"][:, 3:]

    @cached_property
    def object_poses(self) -> Array:
        """Poses X_HO of the object in the hand's frame, (S, 4, 4)."""
        poses = matrices(self.positions, self.orientations)
        poses.flags.writeable = False
        return poses

    @cached_property
    def contacts(self) -> Contacts:
        """Where the fingertips touch."""
        contact = self._arrays["contact"]
        holding = ~np.isnan(contact[:, :, 0, 0])
        return Contacts(contact[:, :, 0], contact[:, :, 1], contact[:, :, 2], holding)

    @property
    def velocities(self) -> Array | None:
        """Joint velocities (rad/s; m/s), (S, J), for cubics through the joints; None in plans without."""
        return self._arrays.get("velocity")

    @property
    def forces(self) -> Array | None:
        """Forces of the fingertips on the object, in O (N), (S, F, 3): NaN where free or unknown."""
        return self._arrays.get("force")

    @property
    def efforts(self) -> Array | None:
        """What the joints must give for :attr:`forces`, Jᵀf, weights of links apart (N·m; N), (S, J)."""
        return self._arrays.get("effort")

    @cached_property
    def figures(self) -> Figures:
        """Margin, clearance, friction that is needed and efforts' shares, state by state.

        The verifier measures margins and clearances: below half a millisecond a state, when first asked.
        """
        return figures(self, self._native.series())

    @cached_property
    def segments(self) -> list[Segment]:
        """Transfers and regrasps, in turn."""
        return [Segment(*segment) for segment in self._native.segments()]

    @property
    def goals_reached(self) -> list[int]:
        """How many of :attr:`segments` there are up to each goal, in turn."""
        return list(self._head["goals_reached"])

    @property
    def duration(self) -> float:
        """Seconds that the motion takes."""
        return float(self.times[-1]) if len(self.times) else 0.0

    @property
    def certificate(self) -> dict[str, Any] | None:
        """What the verifier certifies: margin, clearance, slip, closure, each with its place; None before
        it has.
        """
        certificate: dict[str, Any] | None = self._head["certificate"]
        return certificate

    @property
    def statistics(self) -> dict[str, Any]:
        """How the search went: nodes, regrasps, calls and rejections by slot, times by phase (s)."""
        statistics: dict[str, Any] = self._head["statistics"]
        return statistics

    @property
    def scenario(self) -> dict[str, Any]:
        """The resolved scenario: ``name``, ``problem``, and the ``plugins`` with all their settings."""
        scenario: dict[str, Any] = self._head["scenario"]
        return scenario

    @property
    def claims(self) -> dict[str, Any]:
        """What the plan claims of contacts and stability, to which the verifier holds it."""
        claims: dict[str, Any] = self._head["claims"]
        return claims

    @property
    def seed(self) -> int:
        """The seed of all random streams."""
        return int(self._head["seed"])

    @property
    def planning_time(self) -> float | None:
        """Seconds that planning took, verification apart; None for a plan from a file."""
        return self._summary.get("planning_s")

    @property
    def verification_time(self) -> float | None:
        """Seconds that verification took; None for a plan from a file."""
        return self._summary.get("verification_s")

    @property
    def warnings(self) -> list[str]:
        """What the planner found doubtful about the scenario."""
        return list(self._summary.get("warnings", []))

    @property
    def finger_names(self) -> list[str]:
        """Names of the fingers."""
        return [finger["name"] for finger in self.scenario["problem"]["hand"]["finger"]]

    @cached_property
    def joint_names(self) -> list[str]:
        """Names of the columns of :attr:`joints`, ``finger/joint``."""
        return [
            f"{finger['name']}/{joint.get('name') or index}"
            for finger in self.scenario["problem"]["hand"]["finger"]
            for index, joint in enumerate(finger["joint"])
        ]

    def to_frame(self) -> pandas.DataFrame:
        """The states as a table: a row a state, indexed by time, with segment and kind; needs pandas.

        The object's pose stands in ``object.x`` to ``object.z`` and ``object.qw`` to ``object.qz``, as in the
        tables of ``regrasp export``.
        """
        import pandas

        segment = np.zeros(len(self.times), dtype=int)
        for number, part in enumerate(self.segments):
            segment[part.first + 1 : part.last + 1] = number
        columns: dict[str, Any] = {
            "segment": segment,
            "kind": [self.segments[number].kind for number in segment],
        }
        columns |= dict(zip(("object.x", "object.y", "object.z"), self.positions.T, strict=True))
        turned = ("object.qw", "object.qx", "object.qy", "object.qz")
        columns |= dict(zip(turned, self.orientations.T, strict=True))
        columns |= dict(zip(self.joint_names, self.joints.T, strict=True))
        columns |= dict(
            zip((f"{name}/holds" for name in self.finger_names), self.contacts.holding.T, strict=True)
        )
        return pandas.DataFrame(columns, index=pandas.Index(self.times, name="time"))

    def export(self, format: str, folder: str | os.PathLike[str], *, name: str = "plan") -> list[Path]:
        """Writes the plan for other programs, and says where.

        Parameters
        ----------
        format : str
            ``urdf``, ``mjcf``, ``gltf``, ``csv`` or ``npz``.
        folder : path
            It is made where there is none; files of the same name give way.
        name : str
            How the files' names begin.
        """
        files, notes = self._native.export(format, name)
        for note in notes:
            logger.info("%s", note)
        place = Path(folder)
        place.mkdir(parents=True, exist_ok=True)
        for file, content in files:
            (place / file).write_bytes(content)
        return [place / file for file, _ in files]

    def page(self) -> str:
        """The page that plays the plan in a browser, as HTML that needs no network."""
        return self._native.page()

    @cached_property
    def view(self) -> View:
        """The page in a notebook, led from Python: ``plan.view.time = 1.3``, ``plan.view.play()``."""
        return View(self)

    def plot(self, figure: Figure | None = None) -> Figure:
        """Draws joints, efforts, friction and clearance over time, with their limits; needs matplotlib.

        Parameters
        ----------
        figure : matplotlib.figure.Figure, optional
            What to draw into, such as ``plt.figure()`` for a window; a new figure by default, which a
            notebook shows as the value of its cell.

        Returns
        -------
        matplotlib.figure.Figure
            Efforts and friction are those of :attr:`forces`; a plan without shows its margin instead.
        """
        return plan_figure(self, figure)

    def _repr_html_(self) -> str:
        return frame(self.page(), facts(self))

    def __len__(self) -> int:
        return len(self.segments)

    def __iter__(self) -> Iterator[Segment]:
        return iter(self.segments)

    def __repr__(self) -> str:
        kinds = [segment.kind for segment in self.segments]
        return (
            f"<Plan {self.scenario['name']!r}: {kinds.count('transfer')} transfers, "
            f"{kinds.count('regrasp')} regrasps, {len(self.times)} states, {self.duration:.1f} s>"
        )

    def __eq__(self, other: object) -> bool:
        return self.to_json() == other.to_json() if isinstance(other, Plan) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.to_json())

    def __reduce__(self) -> tuple[Any, ...]:
        return (_from_json, (self.to_json(), self._summary))


def refused(plan: Plan, verdict: Verdict) -> VerificationError:
    """The exception for a plan that does not verify."""
    names = ", ".join(check.name for check in verdict.failures)
    return VerificationError(f"the plan does not verify: {names}", verdict=verdict, plan=plan)


def _from_json(text: str, summary: dict[str, Any]) -> Plan:
    return Plan(_regrasp.Plan.parse(text, "a pickled plan"), summary)
