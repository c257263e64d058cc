"""Exceptions: each carries what it knows as fields, for programs, and says it in words, for people."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._plan import Plan, Verdict


class RegraspError(Exception):
    """Whatever this package refuses.

    Attributes
    ----------
    fields : dict
        The data behind the message; each entry is an attribute of the exception as well.
    """

    def __init__(self, message: str, **fields: Any) -> None:
        super().__init__(message)
        self.fields = fields
        for name, value in fields.items():
            setattr(self, name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        return (_remake, (type(self), str(self), self.fields))


class ScenarioError(RegraspError, ValueError):
    """A scenario is refused.

    Attributes
    ----------
    file : str or None
        The file, the name of a built-in scenario, or what the tree was called.
    key : str or None
        The path of the key, such as ``goal[1].pose.position``.
    line : int or None
        The line in the file, counted from 1.
    value, range : str or None
        The value that was given and the range that is allowed, with its unit.
    remedy : str or None
        The likely fix.
    """

    file: str | None = None
    key: str | None = None
    line: int | None = None
    value: str | None = None
    range: str | None = None
    remedy: str | None = None


class NoPlan(RegraspError):
    """No plan within the budget.

    Attributes
    ----------
    reason : str
        Where the run got stuck.
    stopped_by : str or None
        ``max-nodes`` or ``time-limit`` where a budget ended the search.
    advice : str
        What is worth trying.
    rejections : dict of str to dict of str to int
        How often the plugin in each slot said no, by cause.
    warnings : list of str
        What is doubtful about the scenario.
    partial : Plan or None
        The verified motion to those goals that were reached.
    """

    reason: str = ""
    stopped_by: str | None = None
    advice: str = ""
    rejections: dict[str, dict[str, int]] = {}
    warnings: list[str] = []
    partial: Plan | None = None


class VerificationError(RegraspError):
    """A plan does not verify.

    Attributes
    ----------
    verdict : Verdict
        The verifier's answer, with the checks that fail.
    plan : Plan
        The plan.
    """

    verdict: Verdict
    plan: Plan


class PluginError(RegraspError):
    """A plugin is not there, refuses its settings, cannot be built, or failed.

    Attributes
    ----------
    plugin : str or None
        The plugin's id.
    slot : str or None
        The slot that it was to fill.
    key : str or None
        The setting.
    remedy : str or None
        Ids or slots that fit.
    """

    plugin: str | None = None
    slot: str | None = None
    key: str | None = None
    remedy: str | None = None


class PlanFileError(RegraspError, ValueError):
    """A plan cannot be read, written or shown."""


class StudyError(RegraspError, ValueError):
    """A study cannot be made, resumed or merged."""


class ArgumentError(RegraspError, ValueError):
    """An argument is outside its range, or an array has another shape.

    Attributes
    ----------
    key, value, range : str
        The argument, what was given, and what is allowed.
    """

    key: str = ""
    value: str = ""
    range: str = ""


CLASSES: dict[str, type[RegraspError]] = {
    kind.__name__: kind
    for kind in (
        RegraspError,
        ScenarioError,
        NoPlan,
        VerificationError,
        PluginError,
        PlanFileError,
        StudyError,
        ArgumentError,
    )
}


def _remake(kind: type[RegraspError], message: str, fields: dict[str, Any]) -> RegraspError:
    return kind(message, **fields)


def make(kind: str, message: str, fields: str) -> RegraspError:
    """The exception of the class ``kind``, its fields from JSON text: called by the native module."""
    known = {name: value for name, value in json.loads(fields).items() if value not in (None, "", [])}
    return CLASSES[kind](message, **known)
