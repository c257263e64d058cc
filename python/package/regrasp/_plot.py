"""Plots of plans and studies; needs matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._spatial import Array

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ._plan import Plan

LIMIT: dict[str, Any] = {"linestyle": "--", "linewidth": 0.8}
GIVEN: dict[str, Any] = LIMIT | {"color": "crimson"}


def plan_figure(plan: Plan, figure: Figure | None) -> Figure:
    """Joints, efforts, friction (or margin) and clearance of a plan over time."""
    fingers = plan.scenario["problem"]["hand"]["finger"]
    each = ["joints"] if plan.efforts is None else ["joints", "efforts"]
    wide = ["margin" if plan.forces is None else "friction", "clearance"]
    rows: list[Any] = [[f"{row} {i}" for i in range(len(fingers))] for row in each]
    rows += [[row] * len(fingers) for row in wide]
    drawn = _figure(figure, (max(8.0, 2.6 * len(fingers)), 2.1 * len(rows)))
    axes: dict[str, Axes] = drawn.subplot_mosaic(rows, sharex=True)
    first = 0
    for i, finger in enumerate(fingers):
        joints, columns = finger["joint"], slice(first, first + len(finger["joint"]))
        first = columns.stop
        bounds = [(joint["lower"], joint["upper"]) for joint in joints]
        names = [joint.get("name") or f"joint {j}" for j, joint in enumerate(joints)]
        _lines(axes[f"joints {i}"], plan, plan.joints[:, columns], bounds, names)
        axes[f"joints {i}"].set_title(finger["name"])
        if plan.efforts is not None:
            bounds = [(-joint["effort"], joint["effort"]) for joint in joints]
            _lines(axes[f"efforts {i}"], plan, plan.efforts[:, columns], bounds)
    turning = all(joint["kind"] == "revolute" for finger in fingers for joint in finger["joint"])
    axes["joints 0"].set_ylabel("joints (rad)" if turning else "joints (rad; m)")
    axes["joints 0"].legend(fontsize="x-small")
    if plan.efforts is not None:
        axes["efforts 0"].set_ylabel("efforts (N·m)" if turning else "efforts (N·m; N)")
        _friction(axes["friction"], plan)
    if "margin" in axes:
        _bounded(axes["margin"], plan, plan.figures.margin, 0.0, "closure margin (1)")
    tolerance = plan.scenario["problem"]["limits"]["tolerances"]["clearance"]
    _bounded(axes["clearance"], plan, 1e3 * plan.figures.clearance, 1e3 * tolerance, "clearance (mm)")
    axes["clearance"].set_xlabel("time (s); regrasps shaded, limits dashed")
    drawn.suptitle(plan.scenario["name"])
    return drawn


def _figure(figure: Figure | None, size: tuple[float, float]) -> Figure:
    """The figure that is given, or one that a notebook shows once: as the value of its cell."""
    if figure is not None:
        return figure
    import matplotlib.pyplot as plt

    made = plt.figure(figsize=size, layout="constrained")
    plt.close(made)
    return made


def _lines(
    ax: Axes,
    plan: Plan,
    columns: Array,
    bounds: list[tuple[float, float]],
    names: list[str] | None = None,
) -> None:
    for j, (column, ends) in enumerate(zip(columns.T, bounds, strict=True)):
        (line,) = ax.plot(plan.times, column, label=names[j] if names else None)
        for end in ends:
            ax.axhline(end, color=line.get_color(), **LIMIT)
    _shade(ax, plan)


def _friction(ax: Axes, plan: Plan) -> None:
    for name, column in zip(plan.finger_names, plan.figures.friction.T, strict=True):
        ax.plot(plan.times, column, label=name)
    ax.axhline(plan.scenario["problem"]["object"]["friction"], label="given", **GIVEN)
    ax.set_ylim(bottom=0)
    ax.set_ylabel("friction needed (1)")
    ax.legend(fontsize="x-small", ncols=3)
    _shade(ax, plan)


def _bounded(ax: Axes, plan: Plan, values: Array, least: float, label: str) -> None:
    ax.plot(plan.times, values)
    ax.axhline(least, label="least allowed", **GIVEN)
    ax.set_ylabel(label)
    ax.legend(fontsize="x-small")
    _shade(ax, plan)


def _shade(ax: Axes, plan: Plan) -> None:
    for segment in plan:
        if segment.kind == "regrasp":
            ax.axvspan(plan.times[segment.first], plan.times[segment.last], color="0.5", alpha=0.12, lw=0)


def study_figure(runs: pandas.DataFrame, figure: Figure | None) -> Figure:
    """Which share of the runs of each variant is solved and verified within a time; a panel a scenario."""
    scenarios = list(dict.fromkeys(runs["scenario"]))
    drawn = _figure(figure, (4.2 * len(scenarios), 3.4))
    panels = drawn.subplots(1, len(scenarios), sharey=True, squeeze=False)[0]
    for ax, scenario in zip(panels, scenarios, strict=True):
        for variant, some in runs[runs["scenario"] == scenario].groupby("variant", sort=False):
            solved = (some["status"] == "solved") & (some["verified"].astype(str).str.lower() == "true")
            times = np.sort(some.loc[solved, "planning_s"].to_numpy(dtype=float))
            shares = np.arange(1, len(times) + 1) / len(some)
            ax.step(times, shares, where="post", marker=".", label=f"{variant}: {len(times)} of {len(some)}")
        ax.set(title=scenario, xscale="log", xlabel="planning time (s)", ylim=(0, 1.05))
        ax.legend(fontsize="x-small")
    panels[0].set_ylabel("share of runs solved and verified (1)")
    return drawn
