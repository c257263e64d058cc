"""Hands."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _regrasp
from ._errors import ArgumentError
from ._spatial import Array, array

#: What a scenario's ``hand`` calls files of these endings; all others are URDF.
KINDS = {".toml": "file", ".json": "file", ".xml": "mjcf", ".mjcf": "mjcf"}


@dataclass(frozen=True)
class Finger:
    """One finger: names, and limits of its joints (rad; m where prismatic), base to tip."""

    name: str
    joints: list[str]
    lower: Array
    upper: Array
    velocity: Array
    effort: Array
    rest: Array
    spare: list[int]
    closed_form: bool


class Hand:
    """A hand: a built-in one, a hand file, a URDF or an MJCF. Read and checked when it is made.

    Parameters
    ----------
    tree : dict
        The tree of a scenario's ``hand``.

    Raises
    ------
    ScenarioError
        The hand cannot be read; the exception says where, and why.
    """

    def __init__(self, tree: Mapping[str, Any]) -> None:
        self.tree = dict(tree)
        self._native = _regrasp.Hand.load(json.dumps({"hand": self.tree}), "")

    @classmethod
    def built_in(cls, name: str) -> Hand:
        """A hand of the package, such as ``four-finger``."""
        return cls({"builtin": name})

    @classmethod
    def from_file(cls, path: str | os.PathLike[str], **options: Any) -> Hand:
        """A hand from a hand file, a URDF or an MJCF.

        Parameters
        ----------
        path : path
            A hand file (``.toml``, ``.json``), a MuJoCo model (``.xml``, ``.mjcf``), or a URDF.
        **options
            How a robot description is read: `tips`, `fingertip_radius`, `tip_offset`, `palm`, `packages`,
            `keyframe` (of an MJCF), `mesh_pieces`, and the limits that it may not say.
        """
        place = Path(path).absolute()
        return cls({KINDS.get(place.suffix.lower(), "urdf"): os.fspath(place), **options})

    @staticmethod
    def tree_of(hand: Hand | str | Mapping[str, Any]) -> dict[str, Any]:
        """A scenario's ``hand`` from any of the forms in which it may be given."""
        if isinstance(hand, Hand):
            return hand.tree
        return {"builtin": hand} if isinstance(hand, str) else dict(hand)

    @cached_property
    def _described(self) -> dict[str, Any]:
        described: dict[str, Any] = json.loads(self._native.describe())
        return described

    @property
    def notes(self) -> list[str]:
        """What was chosen because the file does not say it."""
        return list(self._described["notes"])

    @property
    def description(self) -> dict[str, Any]:
        """The hand with everything resolved, as hand files and plans have it."""
        description: dict[str, Any] = self._described["description"]
        return description

    @property
    def fingertip_radius(self) -> float:
        """Radius of every fingertip's ball (m)."""
        return float(self._described["fingertip_radius"])

    @cached_property
    def fingers(self) -> list[Finger]:
        """The fingers, in turn."""
        return [_finger(tree) for tree in self._described["fingers"]]

    @property
    def joint_names(self) -> list[str]:
        """Names of all joints, as :meth:`to_urdf` and exported files have them, in the order of
        :attr:`Plan.joints`: those of the hand, with the finger in front where two are the same.
        """
        return list(self._described["joint_names"])

    def to_urdf(self, folder: str | os.PathLike[str] | None = None) -> str:
        """The hand as URDF, for pinocchio, Drake, PyBullet and others.

        The link ``hand`` has the hand's frame; each fingertip's link is called ``NAME-tip`` after its finger
        and has its origin at the ball's centre. Masses of links are nominal: hands have none.

        Parameters
        ----------
        folder : path, optional
            Where ``hand.urdf`` and the meshes that it names are written too; it is made where there is none.

        Returns
        -------
        str
            The text of the URDF.
        """
        files = self._native.urdf("hand")
        if folder is not None:
            place = Path(folder)
            place.mkdir(parents=True, exist_ok=True)
            for name, content in files:
                (place / name.replace(".hand.urdf", ".urdf")).write_bytes(content)
        return files[0][1].decode()

    def _finger(self, finger: int | str) -> int:
        if isinstance(finger, str):
            names = [known.name for known in self.fingers]
            if finger not in names:
                message = f"there is no finger {finger!r}; there are {', '.join(names)}"
                raise ArgumentError(message, key="finger", value=finger)
            return names.index(finger)
        highest = len(self.fingers) - 1
        if not hasattr(finger, "__index__"):
            raise TypeError(f"`finger` is a number, 0..={highest}, or a name, not {finger!r}")
        if not 0 <= finger <= highest:
            message = f"`finger` = {finger} is outside 0..={highest}"
            raise ArgumentError(message, key="finger", value=str(finger), range=f"0..={highest}")
        return int(finger)

    def fk(self, finger: int | str, joints: npt.ArrayLike) -> Array:
        """Centres of a fingertip in the hand's frame (m).

        Parameters
        ----------
        finger : int or str
            Its number from 0, or its name.
        joints : array_like, (N, J) or (J,)
            Joint positions of that finger (rad; m where prismatic).

        Returns
        -------
        ndarray, (N, 3) or (3,)
        """
        index, alone = self._finger(finger), np.ndim(joints) == 1
        q = array("joints", np.atleast_2d(np.asarray(joints)), (None, len(self.fingers[index].joints)))
        centers = self._native.fk(index, q)
        return centers[0] if alone else centers

    def fingertips(self, joints: npt.ArrayLike) -> Array:
        """Centres of all fingertips in the hand's frame (m).

        Parameters
        ----------
        joints : array_like, (N, J) or (J,)
            Joint positions of all fingers, finger after finger, as :attr:`Plan.joints` has them.

        Returns
        -------
        ndarray, (N, F, 3) or (F, 3)
        """
        alone = np.ndim(joints) == 1
        count = sum(len(finger.joints) for finger in self.fingers)
        centers = self._native.fingertips(array("joints", np.atleast_2d(np.asarray(joints)), (None, count)))
        return centers[0] if alone else centers

    def jacobian(self, finger: int | str, joints: npt.ArrayLike) -> Array:
        """Jacobians of a fingertip's centre in the hand's frame, (N, 3, J) or (3, J): velocity per joint
        speed.
        """
        index, alone = self._finger(finger), np.ndim(joints) == 1
        q = array("joints", np.atleast_2d(np.asarray(joints)), (None, len(self.fingers[index].joints)))
        jacobians = self._native.jacobian(index, q)
        return jacobians[0] if alone else jacobians

    def ik(self, finger: int | str, centers: npt.ArrayLike, near: npt.ArrayLike | None = None) -> Array:
        """Joint positions within the limits that bring a fingertip to given centres, exact to 1e-9 m.

        Parameters
        ----------
        finger : int or str
            Its number from 0, or its name.
        centers : array_like, (N, 3) or (3,)
            Where the fingertip's centre is to be, in the hand's frame (m).
        near : array_like, (N, J) or (J,), optional
            Of several solutions the closest to this is taken; the rest posture by default.

        Returns
        -------
        ndarray, (N, J) or (J,)
            NaN where a centre is out of reach.
        """
        index, alone = self._finger(finger), np.ndim(centers) == 1
        c = array("centers", np.atleast_2d(np.asarray(centers)), (None, 3))
        count = len(self.fingers[index].joints)
        start = self.fingers[index].rest if near is None else np.asarray(near)
        if start.ndim == 1:
            start = np.broadcast_to(start, (len(c), len(start)))
        postures = self._native.ik(index, c, array("near", start, (len(c), count)))
        return postures[0] if alone else postures

    def __repr__(self) -> str:
        return f"<Hand: {', '.join(f'{f.name} ({len(f.joints)} joints)' for f in self.fingers)}>"


def _finger(tree: dict[str, Any]) -> Finger:
    numbers = {key: np.asarray(tree[key]) for key in ("lower", "upper", "velocity", "effort", "rest")}
    return Finger(**(tree | numbers))
