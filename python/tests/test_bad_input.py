"""What an adversary tries: every refusal is an exception that names the argument, and nothing is harmed."""

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import regrasp as rg

BENCH = rg.Bench("sphere")
PLAN = rg.plan("sphere", seed=1)


def other_hand() -> rg.Configuration:
    return rg.Configuration(np.eye(4), [[0.0] * 3] * 3, [None] * 3)


def endless() -> dict[str, Any]:
    tree: dict[str, Any] = {}
    tree["hand"] = tree
    return tree


def spoilt(value: float) -> dict[str, Any]:
    tree = PLAN.to_dict()
    tree["segments"][0]["states"][1]["time"] = value
    return tree


CALLS: dict[str, tuple[Callable[[], object], type[Exception], str]] = {
    "count": (lambda: BENCH.sample_contacts(-1), rg.ArgumentError, "`count` = -1 is outside 0"),
    "memory": (lambda: BENCH.sample_contacts(10**12), rg.ArgumentError, "`count`"),
    "holding": (lambda: BENCH.sample_grasps(1, holding=[9]), rg.ArgumentError, "`holding` = 9 is outside 0..=3"),
    "tries": (lambda: BENCH.sample_grasps(1, tries=10**30), rg.ArgumentError, "`tries`"),
    "another hand": (lambda: BENCH.margins([other_hand()]), rg.ArgumentError, "another hand"),
    "grasps": (lambda: rg.grasps("sphere", -1), rg.ArgumentError, "`count`"),
    "grasps' time": (lambda: rg.grasps("sphere", 3, time_limit=float("nan")), rg.ArgumentError, "`time_limit`"),
    "time": (lambda: rg.plan("sphere", time_limit="soon"), rg.ArgumentError, "`time_limit`"),  # type: ignore[arg-type]
    "nodes": (lambda: rg.plan("sphere", max_nodes=-1), rg.ArgumentError, "`max_nodes` = -1"),
    "threads": (lambda: rg.plan("sphere", threads=-1), rg.ArgumentError, "`threads` = -1"),
    "progress": (lambda: rg.plan("sphere", progress="yes"), TypeError, "`progress`"),  # type: ignore[arg-type]
    "use": (lambda: rg.plan("sphere", use=["rlg"]), TypeError, "`use` is a dict"),  # type: ignore[arg-type]
    "no plugin": (lambda: rg.plan("sphere", use={"sampler": {}}), rg.PluginError, "names no plugin"),
    "no slot": (lambda: rg.plan("sphere", settings={"poses": 3}), rg.ArgumentError, "`poses` is no setting"),
    "no word": (lambda: rg.plan("sphere", settings={3: 3}), rg.ArgumentError, "`3` is no setting"),  # type: ignore[dict-item]
    "NaN": (lambda: rg.plan("sphere", settings={"sampler.poses": np.nan}), rg.ArgumentError, "`sampler.poses`"),
    "endless": (lambda: rg.plan(endless()), rg.ArgumentError, "holds itself"),
    "no plan": (lambda: rg.Plan.from_dict(spoilt(np.nan)), rg.PlanFileError, r"segments\[0\].states\[1\].time"),
    "finger": (lambda: rg.Hand.built_in("four-finger").fk(1.5, [0, 0, 0]), TypeError, "`finger`"),  # type: ignore[arg-type]
    "length": (
        lambda: rg.closure_margin(np.eye(3), np.eye(3), length="a"),  # type: ignore[arg-type]
        rg.ArgumentError,
        "`length`",
    ),
    "a word for a list": (lambda: rg.compare("sphere", {"sampler": "rlg"}), rg.ArgumentError, "is a list"),
    "an empty list": (lambda: rg.compare("sphere", {"sampler": []}), rg.ArgumentError, "is empty"),
    "no seeds": (lambda: rg.compare("sphere", {"sampler": ["rlg"]}, seeds=0), rg.ArgumentError, "`seeds`"),
}


@pytest.mark.parametrize(("call", "kind", "words"), CALLS.values(), ids=CALLS.keys())
def test_it_is_refused_with_its_name(call: Callable[[], object], kind: type[Exception], words: str) -> None:
    with pytest.raises(kind, match=words):
        call()


def test_numbers_of_numpy_are_numbers() -> None:
    plan = rg.plan("sphere", seed=np.uint8(1), settings={"graph-strategy.end": np.float32(0.5)})
    assert plan.seed == 1 and plan.scenario["plugins"]["graph-strategy"]["settings"]["end"] == 0.5


def test_a_plan_without_a_motion_has_empty_arrays() -> None:
    plan = rg.Plan.from_dict(PLAN.to_dict() | {"segments": [], "goals_reached": []})
    assert plan.joints.shape == (0, 12) and plan.contacts.holding.shape == (0, 4) and plan.duration == 0
    assert not plan.verify() and len(plan.to_frame()) == 0


class Elsewhere(rg.Sampler):
    """Answers for another hand."""

    def sample(self, task: Any, request: Any, holding: Any, context: Any) -> rg.Configuration:
        return other_hand()


class NoNumber(rg.StabilityTest):
    """Has no margin."""

    def test(self, grasp: rg.Grasp) -> bool:
        return bool(rg.force_closure(grasp.points, grasp.normals, grasp.friction))

    def margin(self, grasp: rg.Grasp, length: Any, center: Any) -> tuple[float, float]:
        return float("nan"), float("nan")


class NoAction(rg.GraphStrategy):
    """Answers with a word."""

    def decide(self, graph: rg.Graph, context: rg.Context) -> Any:
        return "stop"


class Nothing(rg.Sampler):
    """Defines nothing."""


class NoFraction(rg.LocalPlanner):
    """Says neither how far it came nor why it stopped."""

    def connect(self, task: Any, start: Any, target: Any, context: Any) -> Any:
        return [], 0.5, None


@pytest.mark.parametrize(
    ("slot", "kind", "error", "words"),
    [
        ("sampler", Elsewhere, ValueError, "other fingers or joints than this hand"),
        ("sampler", Nothing, NotImplementedError, "`Nothing` defines no `sample`"),
        ("graph-strategy", NoAction, TypeError, "`decide` answers with an Action"),
    ],
)
def test_answers_of_plugins_that_are_none_are_named(
    slot: str, kind: type[rg.Plugin], error: type[Exception], words: str
) -> None:
    with pytest.raises(error, match=words):
        rg.plan("sphere", use={slot: kind}, max_nodes=50)


def test_nonsense_of_plugins_breaks_a_law() -> None:
    assert not rg.conformance.check(NoNumber) and not rg.conformance.check(NoFraction)


def test_points_that_lie_nowhere_are_no_paths() -> None:
    contacts = BENCH.sample_contacts(6, seed=1)
    ends = rg.SurfacePoints(contacts.facets[::-1].copy(), contacts.points[::-1], contacts.normals[::-1])
    lost = replace(ends, facets=np.full(6, 10**6, np.uint32))
    try:
        assert len(BENCH.geodesics(contacts, lost)) == 6
    except rg.RegraspError as refusal:
        assert str(refusal)


def test_ctrl_c_ends_a_long_batch() -> None:
    import _thread
    import signal

    # A shell that starts programs in the background has them ignore it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    normals = np.random.default_rng(0).normal(size=(60_000, 4, 3))
    timer = threading.Timer(0.3, _thread.interrupt_main)
    start = time.perf_counter()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        # A minute's work.
        rg.closure_margin(0.03 * normals, normals, 0.6)
    assert time.perf_counter() - start < 20
