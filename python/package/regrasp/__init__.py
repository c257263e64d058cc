"""Regrasp plans how a multi-fingered hand takes an object from one pose to another.

>>> import regrasp as rg
>>> plan = rg.plan("sphere", seed=1)
>>> plan.joints.shape == (len(plan.times), 12)
True

Everything is in SI units; quaternions are w, x, y, z; ``X_HO`` is the pose of the object O in the hand's frame H.
"""

from ._errors import (
    ArgumentError,
    NoPlan,
    PlanFileError,
    PluginError,
    RegraspError,
    ScenarioError,
    VerificationError,
)
from ._hand import Hand
from ._plan import Check, Contacts, Plan, Segment, Verdict
from ._planning import Progress, plan
from ._scenario import Scenario, scenario_text, scenarios
from ._shapes import Capsule, Cuboid, Cylinder, Ellipsoid, Mesh, Obstacle, Shape, Sphere, Torus
from ._spatial import pose

load = Plan.load

__all__ = [
    "ArgumentError",
    "Capsule",
    "Check",
    "Contacts",
    "Cuboid",
    "Cylinder",
    "Ellipsoid",
    "Hand",
    "Mesh",
    "NoPlan",
    "Obstacle",
    "Plan",
    "PlanFileError",
    "PluginError",
    "Progress",
    "RegraspError",
    "Scenario",
    "ScenarioError",
    "Segment",
    "Shape",
    "Sphere",
    "Torus",
    "Verdict",
    "VerificationError",
    "load",
    "plan",
    "pose",
    "scenario_text",
    "scenarios",
]
