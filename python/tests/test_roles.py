"""Plugins in Python: all six roles plan, keep the laws, and fail with their own exceptions."""

import dataclasses
import traceback
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
import regrasp as rg


class GreasyContact(rg.ContactModel):
    """Friction less a share that grease takes."""

    references = ("G. Amontons, De la résistance causée dans les machines, 1699",)

    @dataclasses.dataclass(frozen=True)
    class Settings:
        """Settings of the greasy contact."""

        share: float = rg.setting(0.05, range=(0.0, 0.9), doc="What grease takes of the friction, no unit.")

    def cone(self, finger: int, contact: rg.Contact, mu: float) -> tuple[float, float]:
        return mu * (1 - self.settings.share), 0.0


class ClosureTest(rg.StabilityTest):
    """Force closure, asked of the package itself."""

    references = ("V.-D. Nguyen, Constructing force-closure grasps, IJRR 1988",)

    def test(self, grasp: rg.Grasp) -> bool:
        return bool(rg.force_closure(grasp.points, grasp.normals, grasp.friction, grasp.torsion))

    def margin(self, grasp: rg.Grasp, length: float | None, center: Any) -> tuple[float, float]:
        lower, upper = rg.closure_margin(
            grasp.points, grasp.normals, grasp.friction, grasp.torsion, center=center, length=length
        )
        return float(lower), float(upper)


class FingersFirst(rg.Sampler):
    """Contacts at random points of the surface, and inverse kinematics."""

    @dataclasses.dataclass(frozen=True)
    class Settings:
        """Settings of the sampler."""

        tries: int = rg.setting(400, range=(1, 100000), doc="Tries before it gives up.")

    def _pose(self, task: rg.Task, request: rg.PoseRequest, context: rg.Context) -> np.ndarray:
        if request.kind == "at":
            assert request.pose is not None
            return request.pose
        lower, upper = task.workspace
        pose = np.eye(4)
        pose[:3, :3] = context.rotation()
        pose[:3, 3] = [context.uniform(a, b) for a, b in zip(lower, upper, strict=True)]
        if request.kind == "near":
            assert request.pose is not None
            pose = request.pose.copy()
            pose[:3, 3] += request.radius * context.uniform() * context.direction()
        return pose

    def sample(
        self, task: rg.Task, request: rg.PoseRequest, holding: list[int], context: rg.Context
    ) -> rg.Configuration | None:
        for _ in range(self.settings.tries):
            pose = self._pose(task, request, context)
            rest = task.at_rest(pose)
            contacts = [
                self._reachable(task, pose, finger, context) if finger in holding else None
                for finger in range(task.finger_count)
            ]
            if any(contacts[finger] is None for finger in holding):
                continue
            q = self.close(task, pose, contacts, rest, context)
            if q is None:
                continue
            reason = task.admit(q, context)
            if reason is None:
                return q
            context.reject(reason)
        return None

    def _reachable(
        self, task: rg.Task, pose: np.ndarray, finger: int, context: rg.Context
    ) -> rg.Contact | None:
        for _ in range(20):
            contact = task.sample_contact(context)
            center = pose[:3, :3] @ contact.tip_center(task.fingertip_radius) + pose[:3, 3]
            if task.ik(finger, center, task.rest(finger)) is not None:
                return contact
        context.reject("reach")
        return None


class ExploreAndAsk(rg.GraphStrategy):
    """A node, then a question, in turn."""

    def decide(self, graph: rg.Graph, context: rg.Context) -> rg.Action:
        if graph.joined and (not graph.history or graph.history[-1][0] != "query"):
            return rg.Action.query()
        generated, most = graph.generated
        return rg.Action.explore() if generated < most else rg.Action.stop()


def test_a_contact_model_in_python_plans_and_keeps_the_laws() -> None:
    plan = rg.plan("sphere", seed=1, use={"contact-model": GreasyContact})
    chosen = plan.scenario["plugins"]["contact-model"]
    assert chosen == {"id": "contact-model/greasy-contact", "settings": {"share": 0.05}}
    cones = [plan.claims["contact"].get("cone")]
    assert all(cone is None or abs(cone["mu"] - 0.8 * 0.95) < 1e-12 for cone in cones)
    rg.conformance.check(GreasyContact).assert_passes()


def test_a_stability_test_in_python_gives_the_plan_of_the_one_that_it_asks() -> None:
    ours = rg.plan("sphere", seed=1, use={"stability-test": ClosureTest})
    theirs = rg.plan("sphere", seed=1)
    assert (ours.joints == theirs.joints).all()
    rg.conformance.check(ClosureTest).assert_passes()


def test_a_sampler_in_python_plans() -> None:
    plan = rg.plan("sphere", seed=1, use={"sampler": FingersFirst})
    assert plan.verify() and plan.statistics["plugins"]["sampler"]["calls"] > 0


def test_a_graph_strategy_in_python_plans() -> None:
    plan = rg.plan("sphere", seed=1, use={"graph-strategy": ExploreAndAsk}, threads=2)
    assert plan.verify() and plan.statistics["plugins"]["graph-strategy"]["calls"] > 0


def test_a_liar_is_caught() -> None:
    class Yes(rg.StabilityTest):
        """Everything is stable."""

        def test(self, grasp: rg.Grasp) -> bool:
            return True

    report = rg.conformance.check(Yes)
    assert not report and report.failed and "failed" in str(report)
    slippery = rg.Scenario(
        object=rg.Sphere(0.03, friction=0.1), start=rg.pose(z=0.085), goals=[rg.pose(z=0.09)]
    )
    with pytest.raises(rg.VerificationError) as refusal:
        slippery.plan(seed=1, use={"stability-test": Yes})
    assert "stability" in str(refusal.value)


def test_an_exception_ends_the_call_with_its_own_traceback() -> None:
    class Fails(rg.StabilityTest):
        """Fails after some calls."""

        calls = 0

        def test(self, grasp: rg.Grasp) -> bool:
            Fails.calls += 1
            if Fails.calls > 20:
                raise ZeroDivisionError("my own mistake")
            return bool(rg.force_closure(grasp.points, grasp.normals, grasp.friction))

    with pytest.raises(ZeroDivisionError, match="my own mistake") as failure:
        rg.plan("sphere", seed=1, use={"stability-test": Fails})
    frames = [frame.name for frame in traceback.extract_tb(failure.value.__traceback__)]
    assert "test" in frames


@pytest.mark.parametrize("answer", [0.5, "yes", (1, 2)])
def test_answers_of_the_wrong_type_are_named(answer: object) -> None:
    class Odd(rg.StabilityTest):
        """Answers oddly."""

        def test(self, grasp: rg.Grasp) -> Any:
            return answer

    with pytest.raises(TypeError, match="True, False or None"):
        rg.plan("sphere", seed=1, use={"stability-test": Odd})


def test_values_without_a_way_to_fail_end_the_run_too() -> None:
    class Broken(rg.ContactModel):
        """A cone of nonsense."""

        def cone(self, finger: int, contact: rg.Contact, mu: float) -> tuple[float, float]:
            return float("nan"), 0.0

    with pytest.raises(ValueError, match="a cone is friction and torsional radius"):
        rg.plan("sphere", seed=1, use={"contact-model": Broken})


def test_settings_are_checked_and_kept() -> None:
    plan = rg.plan("sphere", seed=1, use={"contact-model": GreasyContact(GreasyContact.Settings(share=0.1))})
    assert plan.scenario["plugins"]["contact-model"]["settings"] == {"share": 0.1}
    with pytest.raises(rg.PluginError, match=r"0\.\.=0\.9"):
        rg.plan("sphere", use={"contact-model": GreasyContact}, settings={"contact-model.share": 2.0})
    with pytest.raises(rg.PluginError, match="did you mean `share`"):
        rg.plan("sphere", use={"contact-model": GreasyContact}, settings={"contact-model.shar": 0.1})


def test_what_was_lent_is_taken_back() -> None:
    kept: list[rg.Graph] = []

    class Keeps(ExploreAndAsk):
        """Keeps what it was lent."""

        def decide(self, graph: rg.Graph, context: rg.Context) -> rg.Action:
            kept.append(graph)
            return super().decide(graph, context)

    rg.plan("sphere", seed=1, use={"graph-strategy": Keeps})
    # It was lent on the run's own thread: from here it can be neither read nor harmed.
    with pytest.raises(BaseException, match="unsendable|lent for one call"):
        kept[0].node_count  # noqa: B018


def test_registration_says_what_is_wrong() -> None:
    with pytest.raises(TypeError, match="derived from a role"):
        rg.register(int)  # type: ignore[type-var]

    class Named(rg.StabilityTest):
        """Named badly."""

        id = "sampler/named"

    with pytest.raises(rg.PluginError, match="should be `stability-test/…`"):
        rg.register(Named)
    rg.register(GreasyContact)
    assert any(plugin.id == "contact-model/greasy-contact" for plugin in rg.plugins("contact-model"))


def test_a_scenario_may_name_a_registered_class() -> None:
    rg.register(GreasyContact)
    slots: Sequence[str] = ("contact-model",)
    task = rg.Scenario(
        object=rg.Sphere(0.03),
        start=rg.pose(z=0.085),
        goals=[rg.pose(z=0.085, axis="z", angle_deg=20)],
        use={slots[0]: {"use": "greasy-contact", "share": 0.2}},
    )
    assert task.plan(seed=1).scenario["plugins"]["contact-model"]["settings"] == {"share": 0.2}
