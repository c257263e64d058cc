"""The same problem with other plugins: one word each."""

from typing import Any

import regrasp as rg

SWAPS: dict[str, dict[str, Any]] = {
    "the paper's choice": {},
    "conic program decides stability": {"use": {"stability-test": "socp"}},
    "samples by projection": {"use": {"sampler": "projection"}},
    "checks edges only when used": {"use": {"graph-strategy": "lazy"}},
    "lift, slide, touch": {"use": {"local-planner.regrasp": "lift-slide-touch"}},
    "linearised cones of 6 edges": {
        "use": {"stability-test": "linearised"},
        "settings": {"stability-test.edges": 6},
    },
}

if __name__ == "__main__":
    for name, changes in SWAPS.items():
        plan = rg.plan("sphere", seed=3, **changes)  # whichever plugins made it, it is verified
        print(f"{name:<34} {plan.statistics['regrasps']:>3} regrasps, {plan.duration:.1f} s of motion")

    # What does not exist, or does not fit, is refused before anything is planned, with what is meant.
    wrong = (("scop", "tolerance", 1e-9), ("linearised", "edges", 2), ("linearised", "edge", 8))
    for plugin, key, value in wrong:
        settings = {f"stability-test.{key}": value}
        try:
            rg.plan("sphere", use={"stability-test": plugin}, settings=settings)
        except rg.PluginError as refused:
            print("refused:", refused)
        else:
            raise AssertionError("it is wrong")
