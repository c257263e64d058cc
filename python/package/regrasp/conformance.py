"""The laws that make plugins of one role interchangeable, for plugins in Python and built-in ones alike."""

from __future__ import annotations

import inspect
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from . import _regrasp
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


def check(plugin: type[Plugin] | str, settings: Mapping[str, Any] | None = None) -> Report:
    """Puts a plugin through every law of its role.

    Parameters
    ----------
    plugin : class or str
        A class derived from a role, or the id of a registered or built-in plugin.
    settings : dict, optional
        To build it with; its defaults stand for what is absent.

    An exception of the plugin counts as a broken law.
    """
    name = plugin_id(register(plugin)) if inspect.isclass(plugin) else plugin
    text = json.dumps(dict(settings)) if settings else ""
    tree = json.loads(_regrasp.conformance(name, text))
    return Report(tree["plugin"], [Law(**law) for law in tree["checks"]])
