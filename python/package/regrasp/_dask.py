"""Studies on the workers of a Dask cluster, by parts."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Any

from . import _regrasp
from ._compare import class_files
from ._errors import ArgumentError, StudyError
from ._roles import register
from ._scenario import Scenario

Files = dict[str, bytes]


def make(
    client: Any, scenarios: list[Any], classes: list[type], request: dict[str, Any], chunks: int | None
) -> None:
    """Makes the parts of a study on the client's workers, and joins them in the request's folder."""
    parts = chunks or 4 * max(1, sum(client.nthreads().values()))
    if not 1 <= parts <= 100_000:
        raise ArgumentError(f"`chunks` = {parts} is outside 1..=100000", key="chunks", range="1..=100000")
    tasks = [Scenario.of(scenario) for scenario in scenarios]
    digests = {kind.__name__: _digest(kind) for kind in classes}
    # Parts are pure in their arguments: a worker that dies costs its part, which another makes again.
    futures = [
        client.submit(part, tasks, classes, digests, {**request, "shard": (number, parts)}, pure=True)
        for number in range(1, parts + 1)
    ]
    with tempfile.TemporaryDirectory(prefix="regrasp-parts-") as place:
        folders = [
            _write(Path(place) / f"part-{number}", files)
            for number, files in enumerate(client.gather(futures), start=1)
        ]
        _regrasp.merge_studies(folders, request["output"])


def part(
    tasks: list[Scenario], classes: list[type], digests: dict[str, str], request: dict[str, Any]
) -> Files:
    """Makes one part of a study in a folder of its own, and gives that folder's files; runs on a worker."""
    for kind in classes:
        if _digest(kind) != digests[kind.__name__]:
            raise StudyError(
                f"the file of the plugin `{kind.__name__}` on this worker is not the one of the study"
            )
        register(kind)
    natives = [task.native for task in tasks]
    with tempfile.TemporaryDirectory(prefix="regrasp-part-") as place:
        complete = _regrasp.run_study(natives, {**request, "output": place}, None)
        if not complete:
            raise StudyError("the part was stopped")
        files = [file for file in Path(place).rglob("*") if file.is_file()]
        return {file.relative_to(place).as_posix(): file.read_bytes() for file in files}


def _digest(kind: type) -> str:
    return next(iter(class_files([kind]).values()), "")


def _write(folder: Path, files: Files) -> str:
    folder.mkdir()
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    return os.fspath(folder)
