"""A local planner for the slot `local-planner.regrasp`: lift the finger, slide it over, touch down."""

import dataclasses
import itertools
import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import regrasp as rg

Array = npt.NDArray[np.float64]


class NoWay(Exception):
    """There is no such motion; its one argument is the reason."""


class UpOverDown(rg.LocalPlanner):
    """Lifts the finger, slides it above the surface, touches down; all or nothing."""

    id = "local-planner/template"
    slots = ("local-planner.regrasp",)
    references = (
        "Sahbani, Saut, Perdereau, An efficient algorithm for dexterous manipulation planning, SSD 2007",
    )

    @dataclasses.dataclass(frozen=True)
    class Settings:
        """Settings of the local planner."""

        step: float = rg.setting(
            0.3, range=(0.05, 1.0), doc="The fingertip's step as a part of the problem's `regrasp_step`."
        )

    def connect(
        self, task: rg.Task, start: rg.Configuration, target: rg.Target, context: rg.Context
    ) -> tuple[Sequence[rg.Configuration], float, str | None]:
        """One finger goes from where it is to the target's contact, while the others hold."""
        # It fills one slot, and is asked for the motions of that slot alone.
        assert target.finger is not None and target.joints is not None
        finger = target.finger
        others = [i for i, contact in enumerate(start.contacts) if contact is not None and i != finger]
        if not others or not task.is_stable(task.grasp(start, others), context):
            return [], 0.0, "stability"
        flight = Flight(task, start, finger, self.settings.step * task.regrasp_step, context)
        try:
            way = flight.fly(start.contacts[finger], start.joints[finger], target.contact, target.joints)
        except NoWay as why:
            return [], 0.0, str(why)
        states = [posed(start, finger, joints, None) for joints in way[:-1]]
        return [*states, posed(start, finger, target.joints, target.contact)], 1.0, None


def posed(
    q: rg.Configuration, finger: int, joints: Array, contact: rg.Contact | None
) -> rg.Configuration:
    """The configuration with one finger elsewhere."""
    all_joints, contacts = q.joints, q.contacts
    all_joints[finger], contacts[finger] = joints, contact
    return rg.Configuration(q.pose, all_joints, contacts)


@dataclasses.dataclass
class Flight:
    """What stays the same during one regrasp; `step` is the fingertip's largest (m)."""

    task: rg.Task
    start: rg.Configuration
    finger: int
    step: float
    context: rg.Context

    def fly(
        self, contact: rg.Contact | None, joints: Array, target: rg.Contact | None, end: Array
    ) -> list[Array]:
        """Postures after the first, to `end`."""
        up = [] if contact is None else self.lift(contact, joints)
        down = [] if target is None else self.lift(target, end)
        high, over = (up or [joints])[-1], (down or [end])[-1]
        if contact is not None and target is not None:
            way = up + self.slide(contact, target, high, over)
        else:
            way = up + self.straight(high, over)
        # Down is up, the other way round.
        return way + down[-2::-1] + ([end] if target is not None else [])

    def lift(self, contact: rg.Contact, joints: Array) -> list[Array]:
        """Straight up from a contact."""
        count = self.steps(self.height)
        way = [joints]
        for i in range(1, count + 1):
            way.append(self.above(contact, self.height * i / count, way[-1]))
        return way[1:]

    def slide(self, contact: rg.Contact, target: rg.Contact, start: Array, end: Array) -> list[Array]:
        """Above the shortest path on the surface, from a lifted posture to a lifted posture."""
        found = self.task.geodesic(contact, target, self.context)
        if found is None:
            raise NoWay("surface")
        waypoints, _ = found
        # The tip's way is longer at a height than on the surface; twice is enough for objects larger than it.
        count = self.steps(2 * waypoints[-1][1])
        way = [start]
        for i in range(1, count):
            way.append(self.above(along(waypoints, i / count), self.height, way[-1]))
        return way[1:] + self.straight(way[-1], end)

    def straight(self, start: Array, end: Array) -> list[Array]:
        """All joints at once, from a free posture to a free posture."""
        a, b = self.task.fk(self.finger, start), self.task.fk(self.finger, end)
        # Joints that turn without moving the tip move the links: a radian counts as 50 mm.
        length = max(float(np.linalg.norm(a - b)), 0.05 * float(np.abs(end - start).max()))
        count = self.steps(2 * length)
        way = [start + (end - start) * i / count for i in range(1, count)] + [end]
        return self.free(way, self.task.clearance)

    def above(self, contact: rg.Contact, height: float, near: Array) -> Array:
        """The posture near `near` with the fingertip at a height (m) above a contact."""
        pose, task = self.start.pose, self.task
        center = pose[:3, :3] @ contact.tip_center(task.fingertip_radius + height) + pose[:3, 3]
        found = task.ik(self.finger, center, near)
        if found is None:
            raise NoWay("reach")
        # Close above its contact the tip cannot be as far from the object as other bodies are.
        return self.free([found], min(0.5 * height, task.clearance))[0]

    def free(self, way: list[Array], clear: float) -> list[Array]:
        """The postures, where all of them are free."""
        if not all(self.task.way_free(self.start, self.finger, way, clear)):
            raise NoWay("collision")
        return way

    @property
    def height(self) -> float:
        """A little higher than needed, so that rounding leaves the finger no lower."""
        return 1.01 * self.task.lift

    def steps(self, length: float) -> int:
        """How many steps a way of the tip (m) takes."""
        return max(1, math.ceil(length / self.step))


def along(waypoints: list[tuple[rg.Contact, float]], fraction: float) -> rg.Contact:
    """The contact at a fraction of what the tip's centre travels along a path on the surface."""
    wanted = fraction * waypoints[-1][1]
    for (before, done), (after, travelled) in itertools.pairwise(waypoints):
        if wanted <= travelled and travelled > done:
            s = (wanted - done) / (travelled - done)
            point = before.point + s * (after.point - before.point)
            return rg.Contact(point, between(before.normal, after.normal, s), before.facet)
    return waypoints[-1][0]


def between(a: Array, b: Array, s: float) -> Array:
    """The unit vector at a fraction of the turn from one to another."""
    angle = math.atan2(float(np.linalg.norm(np.cross(a, b))), float(a @ b))
    if angle < 1e-9:
        return b
    return (math.sin((1 - s) * angle) * a + math.sin(s * angle) * b) / math.sin(angle)
