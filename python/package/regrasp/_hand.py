"""Hands."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any


class Hand:
    """A hand: a built-in one, a hand file, or a URDF.

    Parameters
    ----------
    tree : dict
        The tree of a scenario's ``hand``.
    """

    def __init__(self, tree: Mapping[str, Any]) -> None:
        self.tree = dict(tree)

    @classmethod
    def built_in(cls, name: str) -> Hand:
        """A hand of the package, such as ``four-finger``."""
        return cls({"builtin": name})

    @classmethod
    def from_file(cls, path: str | os.PathLike[str], **options: Any) -> Hand:
        """A hand from a URDF or a hand file.

        Parameters
        ----------
        path : path
            ``.urdf`` or ``.xml``, or a hand file in TOML.
        **options
            How a URDF is read: `tips`, `fingertip_radius`, `tip_offset`, `palm`, `packages`, `mesh_pieces`, and the limits
            that it may not say.
        """
        place = Path(path).absolute()
        kind = "file" if place.suffix.lower() in {".toml", ".json"} else "urdf"
        return cls({kind: os.fspath(place), **options})

    @staticmethod
    def tree_of(hand: Hand | str | Mapping[str, Any]) -> dict[str, Any]:
        """A scenario's ``hand`` from any of the forms in which it may be given."""
        if isinstance(hand, Hand):
            return hand.tree
        return {"builtin": hand} if isinstance(hand, str) else dict(hand)
