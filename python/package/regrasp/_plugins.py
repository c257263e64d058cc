"""The plugins that there are, built in and registered."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from . import _regrasp


@dataclass(frozen=True)
class PluginInfo:
    """A plugin: its id, the slots that it fills, what it is, its sources, and the JSON schema of its
    settings.
    """

    id: str
    slots: list[str]
    summary: str
    references: list[str]
    schema: dict[str, Any]


def plugins(slot: str | None = None) -> list[PluginInfo]:
    """All plugins, or those that fit a slot, by id."""
    found = [PluginInfo(**row) for row in json.loads(_regrasp.plugins())]
    return found if slot is None else [plugin for plugin in found if slot in plugin.slots]
