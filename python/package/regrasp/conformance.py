"""The laws that make plugins of one role interchangeable, for plugins in Python and built-in ones alike."""

from __future__ import annotations

import inspect
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from . import _regrasp
from ._errors import ArgumentError
from ._roles import Plugin, plugin_id, register


@dataclass(frozen=True)
class Law:
    """One law: its name, why it matters, how it ended, and where it was broken."""

    name: str
    why: str
    outcome: Literal["passed", "failed", "not-applicable"]
    words: str


@dataclass(frozen=True)
class Report:
    """Everything that the laws say about one plugin; true where it keeps them all."""

    plugin: str
    checks: list[Law]

    @property
    def failed(self) -> list[Law]:
        """The laws that it breaks."""
        return [law for law in self.checks if law.outcome == "failed"]

    def __bool__(self) -> bool:
        return not self.failed

    def __str__(self) -> str:
        lines = [f"{self.plugin}: {len(self.checks)} laws, {len(self.failed)} broken"]
        lines += [
            f"  {law.outcome:<14} {law.name}" + (f": {law.words}" if law.words else "") for law in self.checks
        ]
        return "\n".join(lines)

    def assert_passes(self) -> None:
        """Raises AssertionError with the whole report where a law is broken: for tests."""
        assert self, str(self)


def check(
    plugin: type[Plugin] | str,
    settings: Mapping[str, Any] | None = None,
    *,
    geodesic_tolerance: float | None = None,
) -> Report:
    """Puts a plugin through every law of its role.

    Parameters
    ----------
    plugin : class or str
        A class derived from a role, or the id of a registered or built-in plugin.
    settings : dict, optional
        To build it with; its defaults stand for what is absent.
    geodesic_tolerance : float, optional
        By how much (relative, no unit) a surface's paths may be longer than the shortest; 0.001 by default.

    An exception of the plugin counts as a broken law.
    """
    name = plugin_id(register(plugin)) if inspect.isclass(plugin) else plugin
    text = json.dumps(dict(settings)) if settings else ""
    if geodesic_tolerance is not None and not 0 <= geodesic_tolerance <= 1:
        value = str(geodesic_tolerance)
        raise ArgumentError(
            f"`geodesic_tolerance` = {value} is outside 0..=1",
            key="geodesic_tolerance",
            value=value,
            range="0..=1",
        )
    tree = json.loads(_regrasp.conformance(name, text, geodesic_tolerance))
    return Report(tree["plugin"], [Law(**law) for law in tree["checks"]])
