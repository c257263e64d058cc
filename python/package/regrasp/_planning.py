"""``plan``: from a scenario to a verified plan."""

from __future__ import annotations

import json
import logging
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Literal

from . import _regrasp
from ._errors import ArgumentError, NoPlan
from ._plan import Plan, Verdict, refused
from ._roles import chosen
from ._scenario import Scenario, plain
from ._spatial import numbers_of

logger = logging.getLogger("regrasp")


@dataclass(frozen=True)
class Progress:
    """How far a run is.

    Attributes
    ----------
    stage : str
        ``search`` or ``smoothing``.
    goal : int
        The goal that is searched for, counted from 0.
    nodes, components : int
        Of the manipulation graph, while searching.
    segments : int
        Of the motion, while smoothing.
    runs : pair of int
        Of a study: how many have ended, and how many there are.
    """

    stage: Literal["search", "smoothing", "study"]
    goal: int = 0
    nodes: int = 0
    components: int = 0
    segments: int = 0
    runs: tuple[int, int] = (0, 0)


Callback = Callable[[Progress], object]


def plan(
    scenario: Scenario | Mapping[str, Any] | str | os.PathLike[str],
    *,
    seed: int = 0,
    threads: int = 1,
    time_limit: float | None = None,
    max_nodes: int | None = None,
    use: Mapping[str, Any] | None = None,
    settings: Mapping[str, Any] | None = None,
    preset: str | None = None,
    progress: bool | Callback = False,
) -> Plan:
    """Plans, and verifies the plan.

    The GIL is released all the while. The same scenario, settings and seed give the same plan on any number
    of threads.

    Parameters
    ----------
    scenario : Scenario, dict, str or path
        A scenario, its tree, the name of a built-in one, or a TOML or JSON file.
    seed : int
        Of all random choices, 0 to 2⁶⁴ - 1.
    threads : int
        1 to 256.
    time_limit : float, optional
        Seconds after which the search stops; by default when the scenario says, or never.
    max_nodes : int, optional
        The most nodes to generate for each goal; by default as many as the scenario says.
    use : dict, optional
        Slots and what fills them: a plugin's id, such as ``{"stability-test": "socp"}``, a class derived
        from a role, or an
        instance of one with its settings.
    settings : dict, optional
        Settings of the plugins, such as ``{"sampler.poses": 200}``.
    preset : str, optional
        A set of plugins and settings by name, such as ``"paper"``; `use` and `settings` come after it.
    progress : bool or callable, optional
        True shows a bar (by ``tqdm`` where it is installed). A callable is handed a :class:`Progress`, on
        this thread.

    Returns
    -------
    Plan

    Raises
    ------
    ScenarioError
        The scenario cannot be used; the exception says which key, and why.
    NoPlan
        No plan was found within the budget; the exception has rejections, advice, and the part that was
        reached.
    VerificationError
        The plan does not verify.
    PluginError
        A plugin is unknown, refused or failed. An exception of a plugin written in Python comes through as
        it is.
    KeyboardInterrupt
        Ctrl-C, within a tenth of a second.
    """
    checked = Scenario.of(scenario)
    for remark in checked.remarks:
        logger.info("%s", remark)
    changes = native_changes(use, settings, time_limit, max_nodes, preset)
    with Teller(progress) as tell:
        solved = _regrasp.solve(
            checked.native, seed_of(seed), whole("threads", threads, 1, 256), changes, tell
        )
    return _answer(solved)


def whole(key: str, value: Any, least: int | None = None, most: int | None = None) -> int:
    """A whole number, of numpy or of Python's own, within its range."""
    try:
        number = int(value.__index__())
    except AttributeError:
        raise TypeError(f"`{key}` must be a whole number, not {type(value).__name__}") from None
    if (least is not None and number < least) or (most is not None and number > most):
        allowed = f"{'' if least is None else least}..{'' if most is None else f'={most}'}"
        message = f"`{key}` = {number} is outside {allowed}"
        raise ArgumentError(message, key=key, value=str(number), range=allowed)
    return number


def seed_of(seed: Any) -> int:
    """A seed."""
    return whole("seed", seed, 0, 2**64 - 1)


def seconds(key: str, value: Any) -> float | None:
    """A limit of time (s), or None for none."""
    if value is None:
        return None
    number = float(numbers_of(key, value))
    if not 1e-3 <= number <= 1e7:
        allowed = "0.001..=10000000 s"
        message = f"`{key}` = {number} is outside {allowed}"
        raise ArgumentError(message, key=key, value=str(value), range=allowed)
    return number


#: The most things that one call draws: more would fill the memory.
MOST = 10_000_000


def native_changes(
    use: Mapping[str, Any] | None,
    settings: Mapping[str, Any] | None,
    time_limit: float | None,
    max_nodes: int | None,
    preset: str | None = None,
) -> dict[str, Any]:
    """What a caller changes in a scenario, as the native module takes it."""
    chosen_ids = {slot: chosen(slot, plugin) for slot, plugin in _tree("use", use).items()}
    own = [
        (slot, key, setting_text(f"{slot}.{key}", value))
        for slot, (_, values) in chosen_ids.items()
        for key, value in values.items()
    ]
    split = [
        (*slot_and_key(key), setting_text(key, value)) for key, value in _tree("settings", settings).items()
    ]
    return {
        "preset": None if preset is None else preset_name(preset),
        "uses": [(slot, plugin) for slot, (plugin, _) in chosen_ids.items()],
        "settings": own + split,
        "time_limit": seconds("time_limit", time_limit),
        "max_nodes": None if max_nodes is None else whole("max_nodes", max_nodes, 1, MOST),
    }


def preset_name(value: Any) -> str:
    """The name of a preset."""
    if not isinstance(value, str):
        raise TypeError(f"a preset is a name such as 'paper', not {value!r}")
    return value


def _tree(key: str, given: Mapping[str, Any] | None) -> Mapping[str, Any]:
    if given is not None and not isinstance(given, Mapping):
        example = {"use": '{"sampler": "rlg"}', "settings": '{"sampler.poses": 200}'}[key]
        raise TypeError(f"`{key}` is a dict such as {example}, not {given!r}")
    return given or {}


def setting_text(path: str, value: Any) -> str:
    """A setting's value as JSON, of numpy's kinds too."""
    try:
        return json.dumps(value, default=plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise ArgumentError(f"`{path}` = {value!r}: {error}", key=path, value=repr(value)) from error


def slot_and_key(path: str) -> tuple[str, str]:
    """Slot and key of ``local-planner.transfer.max_slip``."""
    parts = path.split(".") if isinstance(path, str) else [""]
    size = 2 if parts[0] == "local-planner" else 1
    if not all(parts) or len(parts) == size:
        message = f"`{path}` is no setting: give its slot and its key, such as `sampler.poses`"
        raise ArgumentError(message, key="settings", value=path)
    return ".".join(parts[:size]), ".".join(parts[size:])


def _answer(solved: _regrasp.Solved) -> Plan:
    summary = json.loads(solved.summary)
    for warning in summary["warnings"]:
        logger.warning("%s", warning)
    plan = None if solved.plan is None else Plan(solved.plan, summary)
    if plan is not None and not summary["verified"]:
        raise refused(plan, Verdict.of(summary["verdict"]))
    if plan is None or summary["status"] != "solved":
        raise _no_plan(summary, plan)
    logger.info("%r, planned in %.1f ms", plan, 1e3 * summary["planning_s"])
    return plan


def _no_plan(summary: dict[str, Any], partial: Plan | None) -> NoPlan:
    plugins = summary["statistics"]["plugins"]
    rejections = {slot: figures["rejections"] for slot, figures in plugins.items() if figures["rejections"]}
    # The command line's options are arguments here.
    advice = summary["advice"].replace("--max-nodes", "max_nodes").replace("--time-limit", "time_limit")
    advice = advice.replace("--seed", "seed")
    return NoPlan(
        f"{summary['reason']}\nto try: {advice}",
        reason=summary["reason"],
        stopped_by=summary["stopped_by"],
        advice=advice,
        rejections=rejections,
        warnings=summary["warnings"],
        partial=partial,
    )


class Teller:
    """Tells a callback, or a bar, how far a run is; shows itself as the native module's callback, or None."""

    def __init__(self, progress: bool | Callback) -> None:
        if not (callable(progress) or isinstance(progress, bool)):
            raise TypeError(f"`progress` is True, False or a callable, not {progress!r}")
        self._callback = progress if callable(progress) else None
        self._bar = _bar() if progress is True else None

    def __enter__(self) -> Callable[[str, int, int, int], None] | None:
        return self._tell if self._callback or self._bar is not None else None

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.close()

    def _tell(self, stage: str, goal: int, count: int, components: int) -> None:
        if stage == "search":
            news = Progress("search", goal=goal, nodes=count, components=components)
        elif stage == "study":
            news = Progress("study", runs=(count, components))
        else:
            news = Progress("smoothing", segments=count)
        if self._callback:
            self._callback(news)
        if self._bar is not None:
            self._bar.set_description(f"goal {goal}" if stage == "search" else stage)
            self._bar.n = count
            self._bar.refresh()


def _bar() -> Any:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        logger.info("`progress=True` shows a bar where `tqdm` is installed")
        return None
    return tqdm(unit=" nodes", leave=False)
