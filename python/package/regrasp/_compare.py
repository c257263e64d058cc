"""Comparisons of plugins: studies as tables, made here or on a Dask cluster."""

from __future__ import annotations

import itertools
import os
import sys
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _regrasp
from ._errors import ArgumentError, StudyError
from ._planning import MOST, Callback, Teller, preset_name, seconds, setting_text, slot_and_key, whole
from ._plot import study_figure
from ._roles import chosen
from ._scenario import Scenario

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure

Level = tuple[str, "str | None", list[tuple[str, str]]]


@dataclass(frozen=True)
class Study:
    """A study that was made: its folder, and its tables.

    Attributes
    ----------
    folder : Path
        What ``regrasp compare`` writes too: ``runs.csv``, ``summary.md``, ``report.html`` and the journal.
    """

    folder: Path

    @property
    def runs(self) -> pandas.DataFrame:
        """A row for each run; needs pandas."""
        import pandas

        return pandas.read_csv(self.folder / "runs.csv")

    @property
    def summary(self) -> str:
        """The summary with intervals and tests, as Markdown."""
        return (self.folder / "summary.md").read_text()

    def plot(self, figure: Figure | None = None) -> Figure:
        """Draws which share of each variant's runs is solved and verified within a time, a panel a scenario.

        Needs pandas and matplotlib; `figure` as for :meth:`Plan.plot`.
        """
        return study_figure(self.runs, figure)

    def _repr_markdown_(self) -> str:
        return self.summary


def compare(
    scenarios: Any | Sequence[Any],
    vary: Mapping[str, Sequence[Any]],
    *,
    seeds: int = 30,
    first_seed: int = 0,
    output: str | os.PathLike[str] | None = None,
    threads: int = 1,
    time_limit: float | None = None,
    skip_unsupported: bool = False,
    progress: bool | Callback = False,
    client: Any = None,
    chunks: int | None = None,
) -> Study:
    """Plans every scenario with every combination of plugins and settings and with every seed.

    Parameters
    ----------
    scenarios : scenario or sequence of scenarios
        Each as for :func:`regrasp.plan`.
    vary : dict
        Slots and what to fill them with, ``{"sampler": ["rlg", "projection"]}``, settings and their values,
        ``{"graph-strategy.end": [0.3, 0.8]}``, or presets, ``{"preset": ["paper", "default"]}``; plugins may
        be classes. All combinations are made, the first of all is the baseline.
    seeds, first_seed : int
        How many seeds, and the first of them.
    output : path, optional
        The study's folder. What it already holds of the same study is kept: a study that was stopped is
        resumed. A new
        temporary folder by default.
    threads : int
        How many runs are made at once.
    time_limit : float, optional
        Most seconds for one run.
    skip_unsupported : bool
        Leave out what a variant's plugins do not support, instead of refusing the study.
    progress : bool or callable
        As for :func:`regrasp.plan`.
    client : dask.distributed.Client, optional
        Make the runs on its workers, `chunks` parts of the study at a time; each part can be made again, by
        another
        worker, without a change of its rows. Files that scenarios name must be where workers find them.
        Classes of plugins must be importable there, from a file that is the same:
        their files travel as digests, and a worker whose file differs refuses its part.
    chunks : int, optional
        How many parts; four for each thread of the workers by default.

    Returns
    -------
    Study

    Raises
    ------
    StudyError
        The folder holds another study, or a part of it cannot be made.
    """
    several = isinstance(scenarios, Sequence) and not isinstance(scenarios, (str, bytes))
    given: list[Any] = list(scenarios) if several else [scenarios]
    if not given:
        raise ArgumentError("`scenarios` are none: there is nothing to plan", key="scenarios")
    place = Path(tempfile.mkdtemp(prefix="regrasp-study-")) if output is None else Path(output)
    vary = {path: _levels(path, values) for path, values in vary.items()}
    factors = [[_level(path, value) for value in values] for path, values in vary.items()]
    request: dict[str, Any] = {
        "factors": factors,
        "seeds": whole("seeds", seeds, 1, MOST),
        "first_seed": whole("first_seed", first_seed),
        "time_limit": seconds("time_limit", time_limit),
        "threads": whole("threads", threads, 1, 256),
        "shard": None,
        "skip_unsupported": skip_unsupported,
        "versions": _plugin_files(itertools.chain.from_iterable(vary.values())),
        "output": os.fspath(place),
    }
    if client is not None:
        from ._dask import make

        make(client, given, _classes(vary.values()), request, chunks)
        return Study(place)
    natives = [Scenario.of(scenario).native for scenario in given]
    with Teller(progress) as tell:
        complete = _regrasp.run_study(natives, request, tell)
    if not complete:
        raise StudyError(f"the study is not complete; `{place}` keeps what was made: call again to go on")
    return Study(place)


def _levels(path: str, values: Any) -> list[Any]:
    if isinstance(values, (str, type)) or not isinstance(values, Iterable):
        message = f"`vary[{path!r}]` is a list such as ['rlg', 'projection'], not {values!r}"
        raise ArgumentError(message, key=f"vary.{path}", value=repr(values))
    levels = list(values)
    if not levels:
        raise ArgumentError(f"`vary[{path!r}]` is empty: there is nothing to compare", key=f"vary.{path}")
    return levels


def _level(path: str, value: Any) -> Level:
    if path == "preset":
        return path, preset_name(value), []
    if "." not in path.removeprefix("local-planner."):
        plugin, settings = chosen(path, value)
        return path, plugin, [
            (key, setting_text(f"{path}.{key}", setting)) for key, setting in settings.items()
        ]
    slot, key = slot_and_key(path)
    return slot, None, [(key, setting_text(path, value))]


def _classes(values: Iterable[Sequence[Any]]) -> list[type]:
    """The classes of plugins among what is varied."""
    kinds = (value if isinstance(value, type) else type(value) for some in values for value in some)
    return [kind for kind in kinds if hasattr(kind, "role")]


def _plugin_files(values: Iterable[Any]) -> dict[str, str]:
    """Digests of the files that classes of plugins come from, by name; a class of a notebook has none."""
    return {
        f"plugin {Path(file).name}": digest for file, digest in class_files(_classes([list(values)])).items()
    }


def class_files(classes: Iterable[type]) -> dict[str, str]:
    """Files of classes, with their digests."""
    files = {getattr(sys.modules.get(kind.__module__), "__file__", None) for kind in classes}
    return {file: _regrasp.digest(Path(file).read_bytes()) for file in sorted(file for file in files if file)}
