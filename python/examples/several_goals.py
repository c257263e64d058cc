"""A cube turned to one goal after the other, about the vertical."""

import numpy as np
import regrasp as rg

TURNS_DEG = (90.0, 180.0, 90.0, 0.0)

if __name__ == "__main__":
    cubic = rg.Scenario.load("cubic").problem
    start = cubic["start"]["pose"]["position"]
    task = rg.Scenario(
        hand={"builtin": "four-finger"},
        object=cubic["object"],
        start=rg.pose(*start),
        goals=[rg.pose(*start, axis="z", angle_deg=turn) for turn in TURNS_DEG],
    )
    plan = task.plan(seed=0)
    done = 0
    for turn, end in zip(TURNS_DEG, plan.goals_reached, strict=True):
        segments = plan.segments[done:end]
        regrasps = sum(segment.kind == "regrasp" for segment in segments)
        last = segments[-1].last
        print(
            f"at {turn:>5.1f}° after {plan.times[last]:>5.1f} s: "
            f"{len(segments) - regrasps} transfers and {regrasps} regrasps"
        )
        assert np.allclose(plan.object_poses[last], rg.pose(*start, axis="z", angle_deg=turn), atol=1e-6)
        done = end
