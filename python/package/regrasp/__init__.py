"""Regrasp plans how a multi-fingered hand takes an object from one pose to another.

>>> import regrasp as rg
>>> plan = rg.plan("sphere", seed=1)
>>> plan.joints.shape == (len(plan.times), 12)
True

Everything is in SI units; quaternions are w, x, y, z; ``X_HO`` is the pose of the object O in the hand's
frame H.
"""

from . import conformance
from ._compare import Study, compare
from ._errors import (
    ArgumentError,
    NoPlan,
    PlanFileError,
    PluginError,
    RegraspError,
    ScenarioError,
    StudyError,
    VerificationError,
)
from ._figures import Figures
from ._grasps import Grasps, grasps
from ._hand import Finger, Hand
from ._pieces import (
    Bench,
    Holding,
    SurfacePoints,
    Way,
    closure_margin,
    force_closure,
    internal_forces,
    sample_grasps,
    wrench_cones,
)
from ._plan import Check, Contacts, Plan, Segment, Verdict
from ._planning import Progress, plan
from ._plugins import PluginInfo, plugins
from ._regrasp import Configuration, Contact, Context, Graph, Grasp, PoseRequest, Target, Task
from ._roles import (
    Action,
    ContactModel,
    GraphStrategy,
    LocalPlanner,
    Parts,
    Plugin,
    Sampler,
    StabilityTest,
    Surface,
    register,
    setting,
)
from ._scenario import Hold, Scenario, scenario_text, scenarios
from ._shapes import Capsule, Cuboid, Cylinder, Ellipsoid, Mesh, Obstacle, Shape, Sphere, Torus
from ._spatial import pose
from ._view import View

load = Plan.load

__all__ = [
    "Action",
    "ArgumentError",
    "Bench",
    "Capsule",
    "Check",
    "Configuration",
    "Contact",
    "ContactModel",
    "Contacts",
    "Context",
    "Cuboid",
    "Cylinder",
    "Ellipsoid",
    "Figures",
    "Finger",
    "Graph",
    "GraphStrategy",
    "Grasp",
    "Grasps",
    "Hand",
    "Hold",
    "Holding",
    "LocalPlanner",
    "Mesh",
    "NoPlan",
    "Obstacle",
    "Parts",
    "Plan",
    "PlanFileError",
    "Plugin",
    "PluginError",
    "PluginInfo",
    "PoseRequest",
    "Progress",
    "RegraspError",
    "Sampler",
    "Scenario",
    "ScenarioError",
    "Segment",
    "Shape",
    "Sphere",
    "StabilityTest",
    "Surface",
    "StudyError",
    "Study",
    "SurfacePoints",
    "Target",
    "Task",
    "Torus",
    "Verdict",
    "VerificationError",
    "View",
    "Way",
    "closure_margin",
    "compare",
    "conformance",
    "force_closure",
    "grasps",
    "internal_forces",
    "load",
    "plan",
    "plugins",
    "pose",
    "register",
    "sample_grasps",
    "scenario_text",
    "scenarios",
    "setting",
    "wrench_cones",
]
