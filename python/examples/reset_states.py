"""States of plans as starts of episodes: observation and info, as gymnasium has them."""

from typing import Any

import numpy as np
import numpy.typing as npt
import regrasp as rg

Array = npt.NDArray[np.float64]


class ResetStates:
    """Draws stable states of plans: joints, object's pose, and which fingers hold."""

    def __init__(self, plans: list[rg.Plan]) -> None:
        self.joints = np.concatenate([plan.joints for plan in plans])
        self.poses = np.concatenate([plan.object_poses for plan in plans])
        self.holding = np.concatenate([plan.contacts.holding for plan in plans])

    def reset(self, *, seed: int | None = None) -> tuple[Array, dict[str, Any]]:
        """An observation (joints and position), and what else is known."""
        row = int(np.random.default_rng(seed).integers(len(self.joints)))
        observation = np.concatenate([self.joints[row], self.poses[row, :3, 3]])
        return observation, {"X_HO": self.poses[row], "holding": self.holding[row]}


if __name__ == "__main__":
    states = ResetStates([rg.plan("sphere", seed=seed) for seed in range(3)])
    observation, info = states.reset(seed=0)
    print(len(states.joints), "states;", observation.round(3), info["holding"])
