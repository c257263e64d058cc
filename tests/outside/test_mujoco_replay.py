"""Plans carried out in MuJoCo by `mujoco_replay.py`: objects arrive by friction alone, and not without it."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).with_name("mujoco_replay.py")


def replay(*words):
    """Exit code, standard output and standard error of the script."""
    done = subprocess.run([sys.executable, SCRIPT, *map(str, words)], capture_output=True, text=True, timeout=300)
    return done.returncode, done.stdout, done.stderr


# Soft fingers drag the object along where the plan lets them spin: not every plan of theirs arrives, this one does.
@pytest.fixture(scope="module", params=[("sphere", 1), ("sphere-soft", 0)], ids=lambda param: param[0])
def planned(request, regrasp, tmp_path_factory):
    scenario, seed = request.param
    folder = tmp_path_factory.mktemp(scenario)
    regrasp("plan", scenario, "--seed", seed, "-o", "plan.json", cwd=folder)
    regrasp("export", "plan.json", "--to", "mjcf", "-o", "exported", cwd=folder)
    return folder


def test_the_object_arrives(planned, regrasp):
    code, out, err = replay(planned / "plan.json", "--json", "-o", planned / "replay.json")
    assert (code, err) == (0, "")
    told, plan = json.loads(out), json.loads((planned / "plan.json").read_text())
    assert told["arrived"] and told["reason"] is None
    assert [(part["kind"], part["finger"]) for part in told["segments"]] == [
        (part["kind"], plan["scenario"]["problem"]["hand"]["finger"][part["finger"]]["name"] if part["kind"] == "regrasp" else None)
        for part in plan["segments"]
    ]
    for part in told["segments"]:
        assert 0 < part["distance_m"] < 5e-3 and 0 < part["angle_rad"] < 0.0873 and part["failure"] is None
    soft = plan["claims"]["contact"]["cone"]["gamma"] > 0
    assumed = told["assumed"]
    assert assumed["condim"] == (4 if soft else 3) and (assumed["torsional_friction_m"] > 0) == soft
    assert assumed["friction"] == plan["scenario"]["problem"]["object"]["friction"]
    # A replay made elsewhere is shown beside the plan as one of ours is.
    regrasp("view", "plan.json", "--replay", "replay.json", "-o", "view.html", cwd=planned)


def test_an_exported_folder_gives_the_same_as_the_plan(planned):
    of_plan, of_folder = (json.loads(replay(planned / name, "--json")[1]) for name in ("plan.json", "exported"))
    assert of_folder.pop("seed") is None and of_plan.pop("seed") is not None
    assert of_folder == of_plan


@pytest.mark.parametrize("change", [("--friction-scale", "0.1"), ("--mass-scale", "50")])
def test_the_object_falls_where_friction_is_far_lower_or_it_is_far_heavier(planned, change):
    code, out, err = replay(planned / "exported", "--json", *change)
    told = json.loads(out)
    assert code == 4 and not told["arrived"] and err.strip() == told["reason"]
    assert "dropped in segment" in told["reason"] and told["segments"][-1]["failure"]["what"] == "the object strayed"


def test_bad_input_is_refused_with_what_to_do(planned, tmp_path):
    (tmp_path / "bad.json").write_text("{}")
    for words, said in [
        ([tmp_path / "none.json"], "there is no such file"),
        ([tmp_path], "*.mjcf.xml"),
        ([tmp_path / "bad.json"], "bad.json"),
        ([planned / "plan.json", "--regrasp", "no-such-program"], "--regrasp"),
        ([planned / "plan.json", "-o", tmp_path / "no" / "where.json"], "where.json"),
        ([planned / "plan.json", "--slowdown", "0"], "--slowdown"),
        ([planned / "plan.json", "--gravity", "1,2"], "--gravity"),
    ]:
        code, _, err = replay(*words)
        assert code == 2 and said in err, (words, err)
