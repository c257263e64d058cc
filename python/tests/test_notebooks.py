"""The notebooks and examples run, from the first cell to the last."""

import runpy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

HERE = Path(__file__).parent.parent


@pytest.mark.parametrize("path", sorted((HERE / "notebooks").glob("*.ipynb")), ids=lambda path: path.stem)
def test_a_notebook_runs(path: Path) -> None:
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()


#: What an example must come to, by its own figures.
COMES_TO: dict[str, Callable[[dict[str, Any]], bool]] = {
    "pinocchio_model": lambda ran: ran["worst"] < 1e-9,
    "mujoco_replay": lambda ran: ran["distance"] < 5e-3 and ran["angle_deg"] < 5,
    "trimesh_scene": lambda ran: len(ran["scene"].geometry) == 5,
    "reset_states": lambda ran: ran["observation"].shape == (15,) and ran["info"]["holding"].sum() >= 3,
    "viser_scene": lambda ran: np.allclose(ran["tips"][2].position, ran["centers"][-1, 2]),
}


@pytest.mark.parametrize("path", sorted((HERE / "examples").glob("*.py")), ids=lambda path: path.stem)
def test_an_example_runs(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for needed in ("mujoco", "pinocchio", "trimesh", "viser"):
        if f"import {needed}" in path.read_text():
            pytest.importorskip(needed)
    ran = runpy.run_path(str(path), run_name="__main__")
    assert capsys.readouterr().out
    assert COMES_TO.get(path.stem, lambda ran: True)(ran)
