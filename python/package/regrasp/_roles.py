"""The six roles in Python: a class of one of these kinds replaces a part of the planner.

A class is used by ``plan(..., use={"stability-test": MyTest})``, or registered by :func:`register` and then
named by its
id. A plan made with it is verified like any other. The planner calls it on threads of its own, with the GIL
held: more
threads than one help where the time goes into the planner's other parts. All methods must be pure: equal
arguments and an
equal random stream give equal answers.
"""

from __future__ import annotations

import dataclasses
import inspect
import json
import math
import re
import types
import typing
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, TypeVar

import numpy as np
import numpy.typing as npt

from . import _regrasp
from ._errors import PluginError
from ._regrasp import Configuration, Contact, Context, Graph, Grasp, PoseRequest, Target, Task

Array = npt.NDArray[np.float64]
Kind = TypeVar("Kind", bound="type[Plugin]")


@dataclass(frozen=True)
class NoSettings:
    """The settings of a plugin that has none."""


def setting(default: Any, *, range: tuple[float, float] | None = None, unit: str = "1", doc: str = "") -> Any:
    """A field of a plugin's settings.

    Parameters
    ----------
    default : int, float, bool or str
        What stands where nothing is given.
    range : pair of numbers, optional
        The least and the greatest value.
    unit : str
        The unit of a number, "1" where it has none.
    doc : str
        What it is.
    """
    return dataclasses.field(default=default, metadata={"range": range, "unit": unit, "doc": doc})


@dataclass(frozen=True)
class Parts:
    """What a plugin may prepare itself for.

    Attributes
    ----------
    vertices : ndarray, (V, 3)
        Of the object's mesh, in its frame O (m).
    facets : ndarray of int, (F, 3)
        Counter-clockwise indices of vertices seen from outside.
    mass, friction : float
        Of the object (kg; no unit).
    center : ndarray, (3,)
        Its centre of mass in O (m).
    finger_count, fingertip_radius
        Of the hand (m).
    """

    vertices: Array
    facets: npt.NDArray[np.uint32]
    mass: float
    friction: float
    center: Array
    finger_count: int
    fingertip_radius: float


class Plugin:
    """What all roles have in common.

    Attributes
    ----------
    id : str
        ``role/name`` in kebab case; by default made from the class's name.
    references : sequence of str
        Sources: authors, title, venue, year.
    Settings : type
        A dataclass (see :func:`setting`) or a pydantic model.
    settings : object
        The instance of it that this plugin was built with.
    """

    role: ClassVar[str]
    slots: ClassVar[Sequence[str]] = ()
    id: ClassVar[str] = ""
    references: ClassVar[Sequence[str]] = ()
    Settings: ClassVar[Any] = NoSettings
    settings: Any

    def __init__(self, settings: Any = None) -> None:
        self.settings = type(self).Settings() if settings is None else settings

    def _missing(self, method: str) -> NotImplementedError:
        return NotImplementedError(f"`{type(self).__name__}` defines no `{method}`, which its role needs")

    def prepare(self, parts: Parts) -> None:
        """Called once when the plugin is built, for one object and hand."""


class ContactModel(Plugin):
    """Which wrenches a contact can transmit."""

    role = "contact-model"
    fewest_contacts: int = 3

    def cone(
        self, finger: int, contact: Contact, mu: float
    ) -> tuple[float, float] | Sequence[Sequence[float]]:
        """The cone of one finger's contact under the friction coefficient `mu`.

        Returns
        -------
        pair of float, or sequence of three floats
            Friction and torsional radius (m) of an elliptic cone, |f_t|²/μ² + m²/γ² ≤ f_n²; or the edges of
            a polyhedral one
            at unit normal force: tangential forces along t1 = any_orthogonal(n) and t2 = n × t1, n the
            inward normal, and
            torsion (m).
        """
        raise self._missing("cone")


class StabilityTest(Plugin):
    """Whether a grasp is stable. It knows elliptic cones."""

    role = "stability-test"

    def test(self, grasp: Grasp) -> bool | None:
        """True where the grasp is stable, False where it is not, None where it is too close to say (taken
        as not).
        """
        raise self._missing("test")

    def margin(self, grasp: Grasp, length: float | None, center: Array | None) -> tuple[float, float]:
        """A certified lower bound of the margin, not positive where not stable, and an upper bound.

        `length` (m) divides torques and `center` (m, in O) is what they are taken about; None: the grasp's
        own.
        """
        return (0.0, math.inf) if self.test(grasp) else (0.0, 0.0)


class Surface(Plugin):
    """The object's surface as fingertips see it."""

    role = "surface"

    def sample(self, context: Context) -> Contact:
        """A random contact, uniform over the area that a fingertip can touch."""
        raise self._missing("sample")

    def geodesic(
        self, start: Contact, end: Contact, context: Context
    ) -> tuple[Sequence[tuple[Contact, float]], float] | None:
        """The shortest path: waypoints, each with what the tip's centre travelled (m), and the length (m).

        The first waypoint is `start` at 0, the last is `end`; None where the fingertip cannot follow.
        """
        raise self._missing("geodesic")

    def project(self, point: Array, hint: int | None) -> tuple[Contact, float]:
        """The contact closest to a fingertip's centre (m, in O), and the signed distance (m); negative
        inside.
        """
        raise self._missing("project")

    def walk(self, contact: Contact, direction: Array, distance: float) -> Contact:
        """The contact reached by walking straight ahead along `direction` for `distance` (m)."""
        raise self._missing("walk")

    def edge_distance(self, contact: Contact) -> float:
        """Distance (m) to the nearest sharp edge; infinite where there is none."""
        raise self._missing("edge_distance")


class Sampler(Plugin):
    """Random configurations in which given fingers hold the object."""

    role = "sampler"

    def sample(
        self, task: Task, request: PoseRequest, holding: list[int], context: Context
    ) -> Configuration | None:
        """One random admissible configuration with exactly the fingers `holding` in contact, or None.

        What is returned has passed ``task.admit``. Count every failed try: ``context.reject("reach")``.
        """
        raise self._missing("sample")

    def close(
        self, task: Task, pose: Array, contacts: list[Contact | None], near: Configuration, context: Context
    ) -> Configuration | None:
        """The joints for given contacts, close to `near`; None if some finger cannot reach."""
        joints = []
        for finger, contact in enumerate(contacts):
            if contact is None:
                joints.append(near.joints[finger])
                continue
            center = pose[:3, :3] @ contact.tip_center(task.fingertip_radius) + pose[:3, 3]
            found = task.ik(finger, center, near.joints[finger])
            if found is None:
                context.reject("reach")
                return None
            joints.append(found)
        return Configuration(pose, joints, contacts)


class LocalPlanner(Plugin):
    """Connects two configurations inside one kind of subspace; say which by `slots`."""

    role = "local-planner"
    slots: ClassVar[Sequence[str]] = ("local-planner.grasp",)

    def connect(
        self, task: Task, start: Configuration, target: Target, context: Context
    ) -> tuple[Sequence[Configuration], float, str | None]:
        """Goes from `start` towards `target`.

        Returns
        -------
        states : sequence of Configuration
            The states after `start`, each valid, and so the motion between them, to half of the tolerances.
        fraction : float
            How much of the motion was made; 1 exactly when the target was reached.
        stop : str or None
            Why it stopped short, such as ``"collision"``; None exactly when `fraction` is 1.
        """
        raise self._missing("connect")


@dataclass(frozen=True)
class Action:
    """What the planner does next; made by the methods below."""

    code: tuple[str, int, int, str]

    @classmethod
    def explore(cls, link: str | int = "components") -> Action:
        """Sample a node anywhere; join it to ``"components"``, to so many nearest nodes unchecked, or to
        ``"none"``.
        """
        return cls(("explore", 0, 0, str(link)))

    @classmethod
    def extend(cls, node: int, link: str | int = "components") -> Action:
        """Sample a node near this one, and join it."""
        return cls(("extend", node, 0, str(link)))

    @classmethod
    def connect(cls, a: int, b: int, kind: Literal["grasp", "transfer-regrasp"] = "grasp") -> Action:
        """Try an edge between two nodes."""
        return cls(("connect", a, b, kind))

    @classmethod
    def check(cls, edge: int) -> Action:
        """Check an unchecked edge."""
        return cls(("check", edge, 0, ""))

    @classmethod
    def query(cls) -> Action:
        """Search the graph for a path and decompose it."""
        return cls(("query", 0, 0, ""))

    @classmethod
    def stop(cls) -> Action:
        """Give up."""
        return cls(("stop", 0, 0, ""))


class GraphStrategy(Plugin):
    """What to do next with the manipulation graph."""

    role = "graph-strategy"

    def decide(self, graph: Graph, context: Context) -> Action:
        """The next action; the view of the graph is the only memory."""
        raise self._missing("decide")

    def next(self, graph: Graph, context: Context) -> tuple[str, int, int, str]:
        """What the planner calls."""
        action = self.decide(graph, context)
        if not isinstance(action, Action):
            raise TypeError(f"`decide` answers with an Action, such as Action.explore(), not {action!r}")
        return action.code


ROLES = (ContactModel, StabilityTest, Surface, Sampler, LocalPlanner, GraphStrategy)


def plugin_id(kind: type[Plugin]) -> str:
    """The id of a class: its own, or one made from its name."""
    if kind.id:
        return kind.id
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "-", kind.__name__.strip("_"))
    return f"{kind.role}/{words.lower().replace('_', '-')}"


def register(kind: Kind) -> Kind:
    """Registers a class under its id, in the place of one that had the id before; usable as a decorator.

    At most 32 ids in one process.
    """
    if not (inspect.isclass(kind) and issubclass(kind, ROLES)) or kind in ROLES:
        raise TypeError(f"a plugin is a class derived from a role, such as StabilityTest, not {kind!r}")
    name = plugin_id(kind)
    if not re.fullmatch(rf"{kind.role}/[a-z0-9]+(-[a-z0-9]+)*", name):
        raise PluginError(f"the id `{name}` should be `{kind.role}/…` in kebab case", plugin=name)
    doc = inspect.getdoc(kind) or name
    slots = list(kind.slots) or [kind.role]
    schema = json.dumps(settings_schema(kind))
    _regrasp.register(name, slots, doc.splitlines()[0], list(kind.references), schema, kind)
    return kind


def settings_schema(kind: type[Plugin]) -> dict[str, Any]:
    """The JSON schema of a plugin's settings."""
    own = kind.Settings
    if hasattr(own, "model_json_schema"):
        schema: dict[str, Any] = own.model_json_schema() | {"additionalProperties": False}
        return schema
    hints = typing.get_type_hints(own)
    properties = {field.name: _property(field, hints[field.name]) for field in dataclasses.fields(own)}
    doc = inspect.getdoc(own) or ""
    return {
        "title": own.__name__,
        "description": doc,
        "type": "object",
        "properties": properties,
        "additionalProperties": False,
    }


def _property(field: dataclasses.Field[Any], hint: Any) -> dict[str, Any]:
    if field.default is dataclasses.MISSING:
        raise PluginError(f"the setting `{field.name}` needs a default", key=field.name)
    property = _type(field.name, hint) | {
        "default": field.default,
        "description": field.metadata.get("doc", ""),
    }
    if (bounds := field.metadata.get("range")) is not None:
        property |= {"minimum": bounds[0], "maximum": bounds[1]}
    if property["type"] in ("number", "integer"):
        property["x-unit"] = field.metadata.get("unit", "1")
    return property


def _type(name: str, hint: Any) -> dict[str, Any]:
    known = {float: "number", int: "integer", bool: "boolean", str: "string"}
    if typing.get_origin(hint) is Literal:
        return {"type": "string", "enum": list(typing.get_args(hint))}
    if typing.get_origin(hint) in (list, tuple, Sequence) and not isinstance(hint, types.UnionType):
        return {"type": "array", "items": _type(name, typing.get_args(hint)[0])}
    if hint not in known:
        raise PluginError(f"the setting `{name}` is of a type that no scenario can hold: {hint}", key=name)
    return {"type": known[hint]}


def _settings(kind: type[Plugin], text: str) -> Any:
    # Keys and ranges were held against the schema before.
    return kind.Settings(**json.loads(text.strip() or "{}"))


def check_settings(kind: type[Plugin], text: str) -> None:
    """Refuses settings, given as JSON; called by the native module."""
    _settings(kind, text)


def build(
    kind: type[Plugin],
    text: str,
    vertices: Array,
    facets: list[list[int]],
    object: tuple[float, float, Array],
    hand: tuple[int, float],
) -> Plugin:
    """A plugin for one object and hand; called by the native module."""
    plugin = kind(_settings(kind, text))
    mass, friction, center = object
    indices = np.asarray(facets, dtype=np.uint32).reshape(-1, 3)
    plugin.prepare(Parts(vertices, indices, mass, friction, center[0], *hand))
    return plugin


def chosen(slot: str, plugin: Any) -> tuple[str, dict[str, Any]]:
    """The id of what is to fill a slot, and the settings that come with it; classes and instances are
    registered.
    """
    if isinstance(plugin, str):
        return plugin, {}
    if isinstance(plugin, Mapping):
        given = dict(plugin)
        if "use" not in given:
            example = '{"use": "rlg", "poses": 200}'
            message = f"`use[{slot!r}]` names no plugin: give its id beside its settings, such as {example}"
            raise PluginError(message, slot=slot, key="use")
        return str(given.pop("use")), given
    kind = plugin if inspect.isclass(plugin) else type(plugin)
    if not issubclass(kind, ROLES):
        raise TypeError(
            f"`use[{slot!r}]` is an id, a class of a plugin, or an instance of one, not {plugin!r}"
        )
    register(kind)
    if inspect.isclass(plugin):
        return plugin_id(kind), {}
    own = plugin.settings
    values = own.model_dump() if hasattr(own, "model_dump") else dataclasses.asdict(own)
    return plugin_id(kind), values
