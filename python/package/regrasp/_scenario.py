"""Scenarios: from objects, trees, TOML and JSON."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _regrasp
from ._errors import ArgumentError
from ._hand import Hand
from ._shapes import Obstacle, Shape, object_tree
from ._spatial import pose_tree

if TYPE_CHECKING:
    from ._plan import Plan


@dataclass(frozen=True)
class Hold:
    """What the grasps must bear besides being closed: the object's weight, within the joints' efforts.

    Attributes
    ----------
    weight : bool
        Whether the weight must be held.
    friction_factor : float or "most"
        Plan as if friction were this share (0.05 to 1) of what is given; ``"most"``: as little as a plan can
        be made with.
    disturbance : pair of float
        Largest force (N) and torque (N·m) at the centre of mass, in any direction, to be held beside the
        weight.
    max_normal_force : float, optional
        Largest normal force of one contact (N); the efforts alone bound it where absent.
    """

    weight: bool = True
    friction_factor: float | Literal["most"] = 0.8
    disturbance: tuple[float, float] = (0.0, 0.0)
    max_normal_force: float | None = None

    def tree(self) -> dict[str, Any]:
        """A scenario's ``hold``."""
        return {key: value for key, value in asdict(self).items() if value is not None}


class Scenario:
    """A planning problem: hand, object, start, goals, and plugins. Checked when it is made.

    Parameters
    ----------
    hand : Hand or str or dict
        A hand, the name of a built-in one, or the tree of a scenario's ``hand``.
    object : Shape or trimesh.Trimesh or dict
        What the hand holds; a shape carries mass (kg) and friction (no unit).
    start : array_like (4, 4) or dict
        The pose X_HO of the object in the hand's frame at the start (see :func:`regrasp.pose`), or the tree
        of ``start``.
    goals : sequence of array_like (4, 4) or dict
        Where the object goes, in turn: poses X_HO, or trees of ``goal``.
    obstacles : sequence of Obstacle or dict
        What is fixed to the hand's frame.
    gravity : three floats, optional
        Acceleration in the hand's frame (m/s²); (0, 0, -9.81) by default.
    hold : Hold or dict, optional
        What the grasps must bear; without it they are closed, however large the forces.
    name : str
        What messages and plans call it.
    use, limits, extra : dict, optional
        Further parts of the tree: plugins by slot, ``limits``, and any other key of a scenario file.

    Raises
    ------
    ScenarioError
        With the path of the key, the value, the range that is allowed and, where there is one, the likely
        fix.
    """

    # What it was read from: its text, what messages call it, and the folder of the files that it names.
    origin: tuple[str, str, str]
    native: _regrasp.Scenario

    def __init__(
        self,
        *,
        hand: Hand | str | Mapping[str, Any] = "four-finger",
        object: Shape | Mapping[str, Any] | Any,
        start: npt.ArrayLike | Mapping[str, Any],
        goals: Sequence[npt.ArrayLike | Mapping[str, Any]],
        obstacles: Sequence[Obstacle | Mapping[str, Any]] = (),
        gravity: Sequence[float] | None = None,
        hold: Hold | Mapping[str, Any] | None = None,
        name: str = "scenario",
        use: Mapping[str, str | Mapping[str, Any]] | None = None,
        limits: Mapping[str, Any] | None = None,
        extra: Mapping[str, Any] | None = None,
    ) -> None:
        tree: dict[str, Any] = {
            "name": name,
            "hand": Hand.tree_of(hand),
            "object": object_tree(object),
            "start": _end_tree("start", start),
            "goal": [_end_tree(f"goal[{i}]", goal) for i, goal in enumerate(goals)],
        }
        if obstacles:
            tree["obstacle"] = [
                item.tree() if isinstance(item, Obstacle) else dict(item) for item in obstacles
            ]
        if gravity is not None:
            tree["gravity"] = list(gravity)
        if hold is not None:
            tree["hold"] = hold.tree() if isinstance(hold, Hold) else dict(hold)
        if use:
            tree["plugins"] = _plugin_tables(use)
        if limits:
            tree["limits"] = dict(limits)
        self._read(_json(tree | dict(extra or {}), name), name, Path())

    def _read(self, text: str, name: str, folder: Path) -> None:
        self.origin = (text, name, os.fspath(folder.absolute()))
        self.native = _regrasp.Scenario.parse(*self.origin)

    @classmethod
    def _of_text(cls, text: str, name: str, folder: Path) -> Scenario:
        scenario = cls.__new__(cls)
        scenario._read(text, name, folder)
        return scenario

    @classmethod
    def load(cls, name: str | os.PathLike[str]) -> Scenario:
        """The built-in scenario of this name, or else the TOML or JSON file."""
        place = os.fspath(name)
        scenario = cls.__new__(cls)
        scenario.native = _regrasp.Scenario.load(place)
        built_in = dict(_regrasp.scenarios()).get(place)
        text = Path(place).read_text() if built_in is None else built_in
        scenario.origin = (text, place, os.fspath(Path(place).absolute().parent))
        return scenario

    @classmethod
    def from_dict(
        cls, tree: Mapping[str, Any], *, name: str = "scenario", folder: str | os.PathLike[str] = "."
    ) -> Scenario:
        """A scenario from its tree; files that it names are looked for in `folder`."""
        return cls._of_text(_json(tree, name), name, Path(folder))

    @classmethod
    def from_text(
        cls, text: str, *, name: str = "scenario", folder: str | os.PathLike[str] = "."
    ) -> Scenario:
        """A scenario from TOML or JSON text."""
        return cls._of_text(text, name, Path(folder))

    @classmethod
    def of(cls, scenario: Scenario | Mapping[str, Any] | str | os.PathLike[str]) -> Scenario:
        """A scenario from any of the forms in which it may be given."""
        if isinstance(scenario, Scenario):
            return scenario
        if isinstance(scenario, Mapping):
            return cls.from_dict(scenario)
        if isinstance(scenario, (str, os.PathLike)):
            return cls.load(scenario)
        raise TypeError(f"a scenario is a Scenario, dict, name or path, not {type(scenario).__name__}")

    @cached_property
    def _described(self) -> dict[str, Any]:
        described: dict[str, Any] = json.loads(self.native.describe())
        return described

    @property
    def name(self) -> str:
        """What it is called."""
        return str(self._described["name"])

    @property
    def summary(self) -> str:
        """What it shows, in one line."""
        return str(self._described["summary"])

    @property
    def source(self) -> str:
        """Where the problem comes from."""
        return str(self._described["source"])

    @property
    def remarks(self) -> list[str]:
        """What was chosen because neither the scenario nor its files say it."""
        return self.native.remarks()

    @property
    def problem(self) -> dict[str, Any]:
        """The resolved problem: no file names, no defaults left out; SI units."""
        problem: dict[str, Any] = self._described["problem"]
        return problem

    @property
    def plugins(self) -> dict[str, dict[str, Any]]:
        """The plugin in each slot, with the settings that the scenario gives."""
        plugins: dict[str, dict[str, Any]] = self._described["plugins"]
        return plugins

    def plan(self, **options: Any) -> Plan:
        """Plans: :func:`regrasp.plan` with this scenario."""
        from ._planning import plan

        return plan(self, **options)

    def __reduce__(self) -> tuple[Any, ...]:
        return (_unpickle, self.origin)

    def __repr__(self) -> str:
        return f"<Scenario {self.name!r}: {self.summary or self.problem['object']['shape']['kind']}>"


def scenarios() -> list[str]:
    """Names of the built-in scenarios."""
    return [name for name, _ in _regrasp.scenarios()]


def scenario_text(name: str) -> str:
    """The TOML text of a built-in scenario, to start from."""
    return dict(_regrasp.scenarios())[name]


def _json(tree: Mapping[str, Any], name: str) -> str:
    try:
        return json.dumps(tree, default=plain, allow_nan=False, indent=1)
    except (ValueError, RecursionError) as error:
        if isinstance(error, RecursionError) or "Circular" in str(error):
            raise ArgumentError(f"`{name}` holds itself: a scenario is a tree", key=name) from error
        place = not_finite(tree)
        raise ArgumentError(f"`{place or name}`: {error}", key=place) from error


def plain(value: object) -> object:
    """What JSON has no form for: numpy's numbers and arrays, paths."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"a scenario holds numbers, texts, lists and dicts, not {type(value).__name__}")


def not_finite(tree: object, path: str = "") -> str:
    """The path of the first number that is NaN or infinite; empty where there is none."""
    if isinstance(tree, Mapping):
        found = (not_finite(value, f"{path}.{key}" if path else str(key)) for key, value in tree.items())
    elif isinstance(tree, (list, tuple, np.ndarray)):
        found = (not_finite(value, f"{path}[{index}]") for index, value in enumerate(tree))
    else:
        bad = isinstance(tree, (float, np.floating)) and not np.isfinite(tree)
        return path if bad else ""
    return next(filter(None, found), "")


def _end_tree(key: str, end: npt.ArrayLike | Mapping[str, Any]) -> dict[str, Any]:
    if isinstance(end, Mapping):
        return dict(end) if "pose" in end else {"pose": dict(end)}
    return {"pose": pose_tree(key, end)}


def _plugin_tables(use: Mapping[str, str | Mapping[str, Any]]) -> dict[str, Any]:
    tables: dict[str, Any] = {}
    for slot, plugin in use.items():
        table = {"use": plugin} if isinstance(plugin, str) else dict(plugin)
        role, _, part = slot.partition(".")
        if part:
            tables.setdefault(role, {})[part] = table
        else:
            tables[role] = table
    return tables


def _unpickle(text: str, name: str, folder: str) -> Scenario:
    return Scenario.from_text(text, name=name, folder=folder)
