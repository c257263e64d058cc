"""Plans: their arrays, their files, and how planning ends."""

import json
import logging
import pickle

import numpy as np
import pytest
import regrasp as rg


@pytest.fixture(scope="module")
def plan() -> rg.Plan:
    return rg.plan("sphere", seed=1)


def test_the_arrays_have_one_row_for_each_distinct_state(plan: rg.Plan) -> None:
    tree = plan.to_dict()
    states = sum(len(segment["states"]) for segment in tree["segments"]) - (len(tree["segments"]) - 1)
    assert plan.times.shape == (states,) and (np.diff(plan.times) > 0).all()
    assert plan.joints.shape == (states, 12) and len(plan.joint_names) == 12
    assert plan.object_poses.shape == (states, 4, 4)
    assert plan.contacts.holding.shape == (states, 4)
    last = tree["segments"][-1]["states"][-1]
    assert plan.joints[-1].tolist() == [q for finger in last["joints"] for q in finger]
    assert plan.positions[-1].tolist() == last["object"]["position"]


def test_segments_share_their_border_rows(plan: rg.Plan) -> None:
    tree = plan.to_dict()
    assert plan.segments[0].first == 0 and plan.segments[-1].last == len(plan.times) - 1
    for segment, stored in zip(plan.segments, tree["segments"], strict=True):
        assert segment.kind == stored["kind"] and segment.finger == stored.get("finger")
        assert plan.times[segment.rows].tolist() == [state["time"] for state in stored["states"]]


def test_poses_take_contacts_to_the_fingertips(plan: rg.Plan) -> None:
    hand = rg.Hand.built_in("four-finger")
    contacts, X_HO = plan.contacts, plan.object_poses
    for finger in range(4):
        rows = contacts.holding[:, finger]
        tips_O = contacts.points_O[rows, finger] + hand.fingertip_radius * contacts.normals_O[rows, finger]
        tips_H = np.einsum("nij,nj->ni", X_HO[rows, :3, :3], tips_O) + X_HO[rows, :3, 3]
        assert np.abs(tips_H - hand.fk(finger, plan.joints[rows, 3 * finger : 3 * finger + 3])).max() < 2e-5


def test_arrays_are_read_only(plan: rg.Plan) -> None:
    for array in (plan.times, plan.joints, plan.object_poses, plan.contacts.points_O):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0


def test_the_seed_decides_and_threads_do_not(plan: rg.Plan) -> None:
    def motion(plan: rg.Plan) -> str:
        return json.dumps(plan.to_dict()["segments"])

    assert motion(rg.plan("sphere", seed=1, threads=2)) == motion(plan)
    assert motion(rg.plan("sphere", seed=2)) != motion(plan)


def test_a_plan_survives_its_file_and_pickling(plan: rg.Plan, tmp_path) -> None:
    path = tmp_path / "plan.json"
    plan.save(path)
    assert rg.load(path) == plan and pickle.loads(pickle.dumps(plan)) == plan
    assert rg.Plan.from_dict(plan.to_dict()) == plan
    assert rg.load(path).verify().valid


def test_a_spoilt_plan_is_refused(plan: rg.Plan) -> None:
    tree = plan.to_dict()
    tree["segments"][0]["states"][1]["object"]["position"][2] += 0.01
    spoilt = rg.Plan.from_dict(tree)
    verdict = spoilt.verify()
    assert not verdict and "closure" in " ".join(check.name for check in verdict.failures)
    with pytest.raises(rg.VerificationError) as refusal:
        spoilt.verify(strict=True)
    assert refusal.value.plan is spoilt and refusal.value.verdict == verdict


def test_plans_of_other_versions_and_other_files_are_refused(plan: rg.Plan, tmp_path) -> None:
    with pytest.raises(rg.PlanFileError, match="version 99"):
        rg.Plan.from_dict(plan.to_dict() | {"version": 99})
    (tmp_path / "sphere.toml").write_text(rg.scenario_text("sphere"))
    with pytest.raises(rg.PlanFileError, match="not JSON"):
        rg.load(tmp_path / "sphere.toml")
    with pytest.raises(rg.PlanFileError, match="does not exist"):
        rg.load(tmp_path / "none.json")
    with pytest.raises(rg.PlanFileError, match="folder does not exist"):
        plan.save(tmp_path / "none" / "plan.json")


def test_states_of_other_lengths_are_refused(plan: rg.Plan) -> None:
    tree = plan.to_dict()
    tree["segments"][0]["states"][1]["joints"][0].pop()
    with pytest.raises(rg.PlanFileError, match="other fingers or joints"):
        rg.Plan.from_dict(tree).joints  # noqa: B018


def test_the_table_has_names_and_times() -> None:
    plan = rg.plan("cubic", seed=1)
    frame = plan.to_frame()
    assert len(frame) == len(plan.times) and frame.index.name == "time"
    assert set(frame["kind"]) == {"transfer", "regrasp"}
    assert (frame[plan.joint_names].to_numpy() == plan.joints).all()


def test_the_page_shows_in_a_notebook(plan: rg.Plan) -> None:
    html = plan._repr_html_()
    assert html.startswith("<iframe srcdoc=") and "&quot;" in html
    assert "<canvas" in plan.page() or "three" in plan.page()


def test_no_plan_says_why_and_what_to_try() -> None:
    slippery = rg.Scenario(
        object=rg.Sphere(0.03, friction=0.02),
        start=rg.pose(z=0.085),
        goals=[rg.pose(z=0.085, axis="z", angle_deg=180)],
    )
    with pytest.raises(rg.NoPlan) as failure:
        slippery.plan(seed=0, max_nodes=20)
    error = failure.value
    assert error.stopped_by == "max-nodes" and "max_nodes" in error.advice and "--" not in error.advice
    assert error.partial is None and "goal 1" in error.reason
    assert error.rejections and all(
        count > 0 for causes in error.rejections.values() for count in causes.values()
    )
    assert isinstance(pickle.loads(pickle.dumps(error)), rg.NoPlan)


def test_a_time_limit_ends_the_search() -> None:
    with pytest.raises(rg.NoPlan) as failure:
        rg.plan("cubic", time_limit=0.001)
    assert failure.value.stopped_by == "time-limit"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"threads": 0}, "`threads` = 0 is outside 1..=256"),
        ({"time_limit": float("nan")}, "`time_limit`"),
        ({"max_nodes": 0}, "`max_nodes` = 0"),
    ],
)
def test_arguments_have_their_ranges(options: dict, words: str) -> None:
    with pytest.raises(rg.ArgumentError) as refusal:
        rg.plan("sphere", **options)
    assert words in str(refusal.value) and refusal.value.range


def test_plugins_and_settings_are_chosen_and_refused() -> None:
    chosen = rg.plan("sphere", seed=1, use={"stability-test": "socp"}, settings={"graph-strategy.end": 0.8})
    assert chosen.scenario["plugins"]["stability-test"]["id"] == "stability-test/socp"
    assert chosen.scenario["plugins"]["graph-strategy"]["settings"]["end"] == 0.8
    with pytest.raises(rg.PluginError) as refusal:
        rg.plan("sphere", use={"sampler": "rgl"})
    assert refusal.value.slot == "sampler" and "sampler/rlg" in refusal.value.remedy
    with pytest.raises(rg.PluginError, match="did you mean"):
        rg.plan("sphere", use={"samler": "rlg"})


def test_progress_reaches_the_callback_on_this_thread() -> None:
    import threading

    news: list[rg.Progress] = []
    threads = set()

    def tell(progress: rg.Progress) -> None:
        news.append(progress)
        threads.add(threading.get_ident())

    rg.plan("ellip-obst", seed=3, progress=tell)
    assert threads <= {threading.get_ident()}
    assert all(item.stage in ("search", "smoothing") for item in news)


def test_planning_is_logged(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.INFO, logger="regrasp"):
        rg.plan("sphere", seed=1)
    assert "planned in" in caplog.text


def test_a_plan_that_holds_gives_forces_and_efforts() -> None:
    task = rg.Scenario(
        object=rg.Sphere(0.03, mass=0.05),
        start=rg.pose(z=0.085),
        goals=[rg.pose(z=0.085, axis="z", angle_deg=40)],
        hold=rg.Hold(friction_factor=0.8),
    )
    plan = task.plan(seed=1)
    assert plan.forces is not None and plan.efforts is not None
    holding = plan.contacts.holding
    assert holding[~np.isnan(plan.forces[:, :, 0])].all()
    turned = np.einsum("nij,nj->ni", plan.object_poses[:, :3, :3], np.nansum(plan.forces, axis=1))
    assert np.abs(turned - [0, 0, 0.05 * 9.81]).max() < 0.05 * 0.05 * 9.81
    limits = np.concatenate([finger.effort for finger in rg.Hand.built_in("four-finger").fingers])
    assert plan.efforts.shape == plan.joints.shape and (np.abs(plan.efforts) <= limits + 1e-9).all()
    free = np.repeat(~holding, 3, axis=1)
    assert (plan.efforts[free] == 0).all()


def test_plans_without_forces_say_so() -> None:
    tree = rg.plan("sphere", seed=1).to_dict()
    for segment in tree["segments"]:
        for state in segment["states"]:
            state.pop("forces", None)
            state.pop("velocities", None)
    bare = rg.Plan.from_dict(tree)
    assert bare.forces is None and bare.efforts is None and bare.velocities is None
    tree["segments"][0]["states"][0]["forces"] = [[1.0, 0.0, 0.0], None, None, None]
    some = rg.Plan.from_dict(tree)
    assert some.forces is not None and some.efforts is not None
    assert np.isnan(some.forces[0, 1:]).all() and np.isnan(some.forces[1:]).all()
    assert (some.efforts[0, 3:] == 0).all() and np.isnan(some.efforts[1:]).all()
    X_HO, contacts = some.object_poses[0], some.contacts
    hand, force = rg.Hand.built_in("four-finger"), some.object_poses[0][:3, 0]
    moved = contacts.points_O[0, 0] @ X_HO[:3, :3].T + X_HO[:3, 3]
    tip = hand.fk(0, some.joints[0, :3])
    step, work = 1e-6, []
    for joint in range(3):
        q = some.joints[0, :3].copy()
        q[joint] += step
        # The tip's own part of the work; the turn about it adds the moment of the contact's lever.
        work.append(float((hand.fk(0, q) - tip) @ force) / step)
    lever = float(np.linalg.norm(np.cross(moved - tip, force)))
    assert np.abs(some.efforts[0, :3] - work).max() <= lever + 1e-4


def test_velocities_are_those_of_the_joints() -> None:
    tree = rg.plan("sphere", seed=1).to_dict()
    states = [state for segment in tree["segments"] for state in segment["states"]]
    for state in states:
        state["velocities"] = [[0.5 * q for q in finger] for finger in state["joints"]]
    plan = rg.Plan.from_dict(tree)
    assert plan.velocities is not None and (plan.velocities == 0.5 * plan.joints).all()


def test_a_plan_is_exported(tmp_path) -> None:
    plan = rg.plan("sphere", seed=1)
    files = plan.export("csv", tmp_path / "new")
    assert files and all(file.stat().st_size > 0 for file in files)
    with pytest.raises(rg.ArgumentError, match="urdf"):
        plan.export("stl", tmp_path)


def test_a_preset_is_taken_before_what_is_chosen() -> None:
    chosen = rg.plan("sphere", seed=1, preset="paper", use={"sampler": "projection"}, time_limit=60)
    plugins = chosen.scenario["plugins"]
    assert plugins["surface"]["id"].endswith("steiner") and plugins["sampler"]["id"].endswith("projection")
    with pytest.raises(rg.PluginError, match="did you mean `paper`"):
        rg.plan("sphere", preset="papre")
    with pytest.raises(TypeError, match="preset"):
        rg.plan("sphere", preset=3)  # type: ignore[arg-type]
