"""Grasps in bulk, opened by numpy and MuJoCo, re-checked by pinocchio, coal and Clarabel; planted faults, seen."""

import json
import subprocess
import sys
from pathlib import Path

import mujoco
import numpy as np
import pandas
import pytest

from bulk import Grasps, share_that_stays

SCENARIOS = ["sphere", "allegro-cube", "bracket", "sphere-five"]
COUNT = 100


@pytest.fixture(scope="module", params=SCENARIOS)
def arrays(request, regrasp, tmp_path_factory):
    folder = tmp_path_factory.mktemp(request.param)
    regrasp("grasps", request.param, "-n", COUNT, "--graph", "-o", "g.npz", cwd=folder)
    return dict(np.load(folder / "g.npz", allow_pickle=False))


def test_arrays_have_the_shapes_that_are_documented(arrays):
    f, j = len(arrays["finger_names"]), len(arrays["joint_names"])
    shapes = {
        "pose": (COUNT,),
        "object_position": (COUNT, 3),
        "object_orientation": (COUNT, 4),
        "joints": (COUNT, j),
        "holding": (COUNT, f),
        "liftable": (COUNT, f),
        "facet": (COUNT, f),
        "contact_point_O": (COUNT, f, 3),
        "contact_normal_O": (COUNT, f, 3),
        "force_O": (COUNT, f, 3),
        "efforts": (COUNT, j),
        "margin": (COUNT,),
        "clearance": (COUNT,),
        "friction": (COUNT,),
        "effort_share": (COUNT,),
    }
    assert {name: arrays[name].shape for name in shapes} == shapes
    assert json.loads(str(arrays["grasps_info"]))["format"] == "regrasp-grasps"
    assert not (arrays["liftable"] & ~arrays["holding"]).any()
    assert (np.isnan(arrays["contact_point_O"]).any(axis=-1) == ~arrays["holding"]).all()
    a, b = arrays["edges"].T
    assert (arrays["pose"][a] == arrays["pose"][b]).all()


def test_nothing_is_wrong_with_them(arrays):
    assert Grasps(arrays, range(COUNT)).run() == {}


def test_planted_faults_are_seen(arrays):
    faults = [("object_position", 1e-4), ("joints", 1e-2), ("contact_point_O", 1e-4), ("force_O", 0.3)]
    for name, much in faults:
        spoilt = {**arrays, name: arrays[name] + much}
        assert Grasps(spoilt, range(8)).run(), name


def test_no_two_are_near(arrays):
    spread = json.loads(str(arrays["grasps_info"]))["spread"]
    for g in range(COUNT):
        same = (arrays["holding"] == arrays["holding"][g]).all(axis=1)
        same[: g + 1] = False
        moved = np.linalg.norm(arrays["object_position"] - arrays["object_position"][g], axis=1)
        points = arrays["contact_point_O"] - arrays["contact_point_O"][g]
        apart = np.nanmax(np.linalg.norm(points, axis=-1), axis=1, initial=0.0, where=arrays["holding"])
        turned = 2 * np.arccos(np.clip(abs(arrays["object_orientation"] @ arrays["object_orientation"][g]), 0, 1))
        near = same & (moved < spread) & (apart < spread) & (turned * 0.02 < spread)
        assert not near.any()


@pytest.mark.parametrize("name", ["sphere", "allegro-cube"])
def test_mujoco_opens_them_and_most_stay(name, regrasp, tmp_path):
    regrasp("grasps", name, "-n", 40, "-o", "g.xml", cwd=tmp_path)
    regrasp("grasps", name, "-n", 40, "-o", "g.npz", cwd=tmp_path)
    arrays, model = np.load(tmp_path / "g.npz"), mujoco.MjModel.from_xml_path(str(tmp_path / "g.xml"))
    assert model.nkey == 40
    assert np.abs(model.key_qpos[:, : arrays["joints"].shape[1]] - arrays["joints"]).max() < 1e-12
    assert np.abs(model.key_qpos[:, -7:-4] - arrays["object_position"]).max() < 1e-12
    assert share_that_stays(tmp_path / "g.xml", 40, 1.0, 1.0) >= 0.9


def test_lines_and_resets_hold_the_same(regrasp, tmp_path):
    for end in ["npz", "jsonl", "reset.npz"]:
        regrasp("grasps", "sphere", "-n", 30, "-o", f"g.{end}", cwd=tmp_path)
    arrays, resets = np.load(tmp_path / "g.npz"), np.load(tmp_path / "g.reset.npz")
    lines = [json.loads(line) for line in (tmp_path / "g.jsonl").read_text().splitlines()]
    assert [line["grasp"] for line in lines] == list(range(30))
    assert np.array_equal([sum(line["joints"], []) for line in lines], arrays["joints"])
    assert np.array_equal([line["object"]["orientation"] for line in lines], arrays["object_orientation"])
    assert np.abs(resets["joint_pos"] - arrays["joints"]).max() < 1e-6
    assert resets["object_quat"].dtype == np.float32
    assert np.allclose(resets["joint_effort"], arrays["efforts"], equal_nan=True)


def test_pandas_reads_the_lines(regrasp, tmp_path):
    regrasp("grasps", "sphere", "-n", 30, "-o", "g.jsonl", cwd=tmp_path)
    regrasp("grasps", "sphere", "-n", 30, "-o", "g.npz", cwd=tmp_path)
    frame, arrays = pandas.read_json(tmp_path / "g.jsonl", lines=True), np.load(tmp_path / "g.npz")
    assert len(frame) == 30 and np.allclose(frame["margin"], arrays["margin"])


def test_a_parquet_table_holds_the_same(regrasp, tmp_path):
    regrasp("grasps", "allegro-cube", "-n", 30, "--graph", "-o", "g.npz", cwd=tmp_path)
    example = Path(__file__).parents[2] / "examples" / "16_grasps_as_parquet.py"
    command = [sys.executable, str(example), "g.npz", "g.parquet"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and "30 grasps" in done.stdout, done.stderr
    arrays, frame = np.load(tmp_path / "g.npz"), pandas.read_parquet(tmp_path / "g.parquet")
    assert len(frame) == 30 and frame["friction"].notna().any()
    for name in ["joints", "object_position", "efforts"]:
        assert np.array_equal(np.stack(frame[name]), arrays[name], equal_nan=True)
    points = np.array([[list(point) for point in grasp] for grasp in frame["contact_point_O"]])
    assert np.array_equal(points, arrays["contact_point_O"], equal_nan=True)


def test_every_form_opens_in_its_tool(regrasp, tmp_path):
    """The atlas and the results of a protocol too: tables in pandas, documents in json."""
    regrasp("atlas", "--hands", "free-fingertips", "--shapes", "cube", "--size", "50mm", "--goals", 4, "-o", "a", cwd=tmp_path)
    cells, attempts = (pandas.read_csv(tmp_path / "a" / f"{name}.csv") for name in ("cells", "attempts"))
    assert len(cells) == 1 and len(attempts) == 4
    assert json.loads((tmp_path / "a" / "atlas.json").read_text())["format"] == "regrasp-atlas"
    regrasp("suite", "hidex", "-o", "s", cwd=tmp_path)
    results = json.loads((tmp_path / "s" / "results.json").read_text())
    assert results["format"] == "regrasp-suite" and len(results["trials"]) == 60
