"""A surface and a local planner in Python, and cones with edges."""

import math

import numpy as np
import regrasp as rg


class Ball(rg.Surface):
    """A ball in closed form: its radius is that of the mesh's vertices."""

    def prepare(self, parts: rg.Parts) -> None:
        self.radius = float(np.linalg.norm(parts.vertices, axis=1).max())

    def _at(self, direction: np.ndarray) -> rg.Contact:
        n = direction / np.linalg.norm(direction)
        return rg.Contact(self.radius * n, n)

    def sample(self, context: rg.Context) -> rg.Contact:
        return self._at(context.direction())

    def geodesic(self, start: rg.Contact, end: rg.Contact, context: rg.Context):
        angle = math.acos(max(-1.0, min(1.0, float(start.normal @ end.normal))))
        return [(start, 0.0), (end, 2 * angle * self.radius)], angle * self.radius

    def project(self, point: np.ndarray, hint: int | None) -> tuple[rg.Contact, float]:
        return self._at(point), float(np.linalg.norm(point)) - self.radius

    def walk(self, contact: rg.Contact, direction: np.ndarray, distance: float) -> rg.Contact:
        tangent = direction - contact.normal * float(direction @ contact.normal)
        tangent /= np.linalg.norm(tangent)
        angle = distance / self.radius
        return self._at(math.cos(angle) * contact.normal + math.sin(angle) * tangent)

    def edge_distance(self, contact: rg.Contact) -> float:
        return math.inf


class Straight(rg.LocalPlanner):
    """The object along a straight line, the fingertips with it; all or nothing."""

    slots = ("local-planner.grasp",)
    steps = 24

    def connect(self, task: rg.Task, start: rg.Configuration, target: rg.Target, context: rg.Context):
        end = target.configuration
        assert target.kind == "grasp" and end is not None and target.pose is None and target.finger is None
        states: list[rg.Configuration] = []
        for step in range(1, self.steps):
            q = self._between(task, start, end, step / self.steps, context)
            if q is None:
                return [], 0.0, "reach"
            if not task.is_free(q):
                return [], 0.0, "collision"
            if not task.is_stable(task.grasp(q, moving=True), context):
                return [], 0.0, "stability"
            states.append(q)
        return [*states, end], 1.0, None

    def _between(self, task, start, end, s: float, context) -> rg.Configuration | None:
        R0, R1 = start.pose[:3, :3], end.pose[:3, :3]
        q = rg._spatial.quaternion(R0.T @ R1)
        angle = 2 * math.acos(min(1.0, q[0]))
        turn = np.eye(4)
        if angle > 1e-9:
            turn = rg.pose(axis=q[1:], angle_deg=math.degrees(s * angle))
        pose = np.eye(4)
        pose[:3, :3] = R0 @ turn[:3, :3]
        pose[:3, 3] = (1 - s) * start.pose[:3, 3] + s * end.pose[:3, 3]
        joints, contacts = [], []
        for finger, (a, b) in enumerate(zip(start.contacts, end.contacts, strict=True)):
            contact = None
            found = start.joints[finger]
            if a is not None and b is not None:
                r = task.fingertip_radius
                contact, _ = task.project((1 - s) * a.tip_center(r) + s * b.tip_center(r), a.facet)
                center = pose[:3, :3] @ contact.tip_center(r) + pose[:3, 3]
                found = task.ik(finger, center, joints_near(start, end, finger, s))
                if found is None:
                    return None
            joints.append(found)
            contacts.append(contact)
        return rg.Configuration(pose, joints, contacts)


def joints_near(start: rg.Configuration, end: rg.Configuration, finger: int, s: float) -> np.ndarray:
    return (1 - s) * start.joints[finger] + s * end.joints[finger]


class Pyramid(rg.ContactModel):
    """Four edges within the friction cone."""

    def cone(self, finger: int, contact: rg.Contact, mu: float) -> list[tuple[float, float, float]]:
        return [(mu, 0.0, 0.0), (0.0, mu, 0.0), (-mu, 0.0, 0.0), (0.0, -mu, 0.0)]


def test_a_surface_in_python_answers() -> None:
    task = rg.Scenario(object=rg.Sphere(0.03), start=rg.pose(z=0.085), goals=[rg.pose(z=0.086)])
    bench = rg.Bench(task, use={"surface": Ball})
    contacts = bench.sample_contacts(20, seed=3)
    assert np.allclose(np.linalg.norm(contacts.points, axis=1), 0.03)
    found, distances = bench.closest_points([[0.05, 0.0, 0.0]])
    assert np.allclose(found.points, [[0.03, 0, 0]]) and np.allclose(distances, 0.02)
    ends = rg.SurfacePoints(contacts.facets[::-1], contacts.points[::-1], contacts.normals[::-1])
    angles = np.arccos(np.clip((contacts.normals * ends.normals).sum(axis=1), -1, 1))
    assert np.allclose(bench.geodesics(contacts, ends), 0.03 * angles)


def test_a_local_planner_in_python_is_asked_and_its_plan_verifies() -> None:
    for seed in range(4):
        # By the graph alone, which relays seldom leave anything to do.
        by_graph = {"graph-strategy.relays": 0}
        plan = rg.plan(
            "cubic", seed=seed, use={"local-planner.grasp": Straight}, settings=by_graph, max_nodes=4000
        )
        figures = plan.statistics["plugins"]["local-planner.grasp"]
        if figures["calls"] > 0:
            assert plan.verify()
            return
    raise AssertionError("no seed asked the planner")


def test_cones_with_edges_reach_built_in_tests() -> None:
    use = {"contact-model": Pyramid, "stability-test": "linearised"}
    plan = rg.plan("sphere", seed=1, use=use)
    assert plan.scenario["plugins"]["contact-model"]["id"] == "contact-model/pyramid"
