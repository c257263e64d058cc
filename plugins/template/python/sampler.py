"""A sampler: draws a pose and contacts until inverse kinematics and the planner's predicate accept them."""

import dataclasses
import math

import numpy as np
import numpy.typing as npt
import regrasp as rg

Array = npt.NDArray[np.float64]


class Rejection(rg.Sampler):
    """Draws a pose and contacts until they fit."""

    id = "sampler/template"
    references = (
        "Han, Amato, A kinematics-based probabilistic roadmap method for closed chain systems, WAFR 2000",
    )

    @dataclasses.dataclass(frozen=True)
    class Settings:
        """Settings of the sampler."""

        poses: int = rg.setting(100, range=(1, 100_000), doc="Poses of the object that one call tries.")
        contacts: int = rg.setting(
            50, range=(1, 10_000), doc="Contacts that are tried for each finger at one pose."
        )

    def sample(
        self, task: rg.Task, request: rg.PoseRequest, holding: list[int], context: rg.Context
    ) -> rg.Configuration | None:
        """A configuration in which exactly the fingers `holding` hold; None after so many poses."""
        for _ in range(self.settings.poses):
            if context.interrupted:
                return None
            found = self._at(task, draw(task, request, context), holding, context)
            if isinstance(found, rg.Configuration):
                return found
            context.reject(found)
        return None

    def _at(
        self, task: rg.Task, pose: Array, holding: list[int], context: rg.Context
    ) -> rg.Configuration | str:
        """One try at one pose: the configuration, or why there is none."""
        if not task.object_free(pose):
            return "collision"
        q, placed = task.at_rest(pose), list[int]()
        for finger in range(task.finger_count):
            refused: str | None
            if finger in holding:
                q, refused = self._place(task, q, finger, placed, context)
            else:
                refused = task.admit_finger(q, finger, placed, context)
            if refused is not None:
                return refused
            placed.append(finger)
        return task.admit_grasp(q, context) or q

    def _place(
        self, task: rg.Task, q: rg.Configuration, finger: int, placed: list[int], context: rg.Context
    ) -> tuple[rg.Configuration, str | None]:
        """Gives one finger a contact, beside the fingers already placed."""
        reason, joints, contacts, pose = "reach", q.joints, q.contacts, q.pose
        for _ in range(self.settings.contacts):
            contact = task.sample_contact(context)
            found = reach(task, pose, finger, contact, context)
            if found is None:
                continue
            joints[finger], contacts[finger] = found, contact
            tried = rg.Configuration(pose, joints, contacts)
            refused = task.admit_finger(tried, finger, placed, context)
            if refused is None:
                return tried, None
            reason = refused
        return q, reason


def reach(
    task: rg.Task, pose: Array, finger: int, contact: rg.Contact, context: rg.Context
) -> Array | None:
    """Joints that bring the finger to its contact, spare joints drawn at random."""
    near = task.rest(finger)
    lower, upper = task.limits(finger)
    for joint in task.spare(finger):
        near[joint] = context.uniform(lower[joint], upper[joint])
    center = pose[:3, :3] @ contact.tip_center(task.fingertip_radius) + pose[:3, 3]
    return task.ik(finger, center, near)


def draw(task: rg.Task, request: rg.PoseRequest, context: rg.Context) -> Array:
    """A pose of the object as it is asked for."""
    if request.pose is not None:
        pose = request.pose
        if request.kind == "near":
            pose[:3, 3] += request.radius * context.uniform() * context.direction()
            turn = rotation(context.direction(), request.angle * context.uniform())
            pose[:3, :3] = turn @ pose[:3, :3]
        return pose
    pose = np.eye(4)
    pose[:3, 3] = [context.uniform(low, high) for low, high in zip(*task.workspace, strict=True)]
    pose[:3, :3] = context.rotation()
    if task.landmarks and context.uniform() < 0.8:
        # Most poses that a plan needs are turned little from start and goal.
        near = task.landmarks[context.index(len(task.landmarks))]
        pose[:3, :3] = rotation(context.direction(), context.uniform(0.0, 0.8)) @ near[:3, :3]
    return pose


def rotation(axis: Array, angle: float) -> Array:
    """The turn by an angle (rad) about a unit vector (Rodrigues)."""
    x, y, z = axis
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    R: Array = np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K
    return R
