"""A sampler in twenty lines: contacts at random points, and inverse kinematics."""

import numpy as np
import regrasp as rg


class PointsFirst(rg.Sampler):
    """Contacts at random points of the surface, and inverse kinematics."""

    def sample(
        self, task: rg.Task, request: rg.PoseRequest, holding: list[int], context: rg.Context
    ) -> rg.Configuration | None:
        for _ in range(2000):
            pose = np.eye(4) if request.pose is None else request.pose
            if request.kind == "anywhere":
                pose[:3, :3] = context.rotation()
                pose[:3, 3] = [context.uniform(a, b) for a, b in zip(*task.workspace, strict=True)]
            elif request.kind == "near":
                pose[:3, 3] += request.radius * context.uniform() * context.direction()
            contacts = [
                task.sample_contact(context) if i in holding else None for i in range(task.finger_count)
            ]
            q = self.close(task, pose, contacts, task.at_rest(pose), context)
            if q is None:
                continue
            reason = task.admit(q, context)
            if reason is None:
                return q
            context.reject(reason)
        return None


if __name__ == "__main__":
    plan = rg.plan("sphere", seed=1, use={"sampler": PointsFirst})
    print(plan, plan.statistics["plugins"]["sampler"])
