"""The native half of the package; private, but for the classes that the package exports."""

from collections.abc import Callable, Sequence
from typing import Any, Literal, final

import numpy as np
import numpy.typing as npt

_Array = npt.NDArray[np.float64]
_Triple = Sequence[float] | _Array
_Matrix = Sequence[Sequence[float]] | _Array

@final
class Contact:
    """Where a fingertip touches, or could touch, the object."""

    def __new__(cls, point: _Triple, normal: _Triple, facet: int = 0) -> Contact: ...
    @property
    def facet(self) -> int:
        """The facet that holds the point, or another coordinate of the surface plugin."""
    @property
    def point(self) -> _Array:
        """The point in O (m), (3,)."""
    @property
    def normal(self) -> _Array:
        """The outward unit normal in O, (3,)."""
    def tip_center(self, radius: float) -> _Array:
        """The centre of a fingertip of this radius (m) that touches here, in O."""

@final
class Grasp:
    """Contacts that hold the object, 1 to 8, each with an elliptic cone."""

    def __new__(
        cls,
        points: Sequence[_Triple] | _Array,
        normals: Sequence[_Triple] | _Array,
        friction: float = 0.8,
        torsion: float = 0.0,
        gravity: _Triple = ...,
    ) -> Grasp: ...
    @property
    def fingers(self) -> list[int]:
        """The finger of each contact."""
    @property
    def points(self) -> _Array:
        """Contact points in O (m), (K, 3)."""
    @property
    def normals(self) -> _Array:
        """Outward unit normals in O, (K, 3)."""
    @property
    def friction(self) -> _Array:
        """Coefficients of friction, (K,)."""
    @property
    def torsion(self) -> _Array:
        """Torsional radii (m), (K,); 0 for point contacts."""
    @property
    def gravity(self) -> _Array:
        """Acceleration of gravity in O (m/s²), (3,)."""
    def __len__(self) -> int: ...

@final
class Configuration:
    """The object's pose, the joints of every finger, and which fingers touch where."""

    def __new__(
        cls, pose: _Matrix, joints: Sequence[_Triple], contacts: Sequence[Contact | None]
    ) -> Configuration: ...
    @property
    def pose(self) -> _Array:
        """X_HO, (4, 4)."""
    @property
    def joints(self) -> list[_Array]:
        """Joint positions of each finger (rad; m where prismatic)."""
    @property
    def contacts(self) -> list[Contact | None]:
        """The contact of each finger; None where it does not hold."""

@final
class Context:
    """The random stream and the counts of one call: the only source of randomness that a plugin may use."""

    def __new__(cls, seed: int = 0) -> Context: ...
    def uniform(self, low: float = 0.0, high: float = 1.0) -> float: ...
    def normal(self) -> float: ...
    def index(self, count: int) -> int: ...
    def direction(self) -> _Array:
        """A random unit vector, (3,)."""
    def rotation(self) -> _Array:
        """A random rotation, (3, 3)."""
    def word(self) -> int:
        """64 random bits: ``numpy.random.default_rng(context.word())``."""
    def reject(self, reason: str) -> None:
        """Counts one "no" with its reason, such as ``"reach"``."""
    @property
    def interrupted(self) -> bool:
        """Whether the run is to stop: long loops of a plugin look at it."""

@final
class PoseRequest:
    """Where the object's pose comes from in a sample."""

    @property
    def kind(self) -> Literal["anywhere", "near", "at"]: ...
    @property
    def pose(self) -> _Array | None: ...
    @property
    def near(self) -> Configuration | None: ...
    @property
    def radius(self) -> float: ...
    @property
    def angle(self) -> float: ...

@final
class Target:
    """Where a local planner is to go."""

    @property
    def kind(self) -> Literal["grasp", "transfer", "regrasp"]: ...
    @property
    def configuration(self) -> Configuration | None:
        """The end, for ``grasp``."""
    @property
    def pose(self) -> _Array | None:
        """The object's pose at the end, for ``transfer``."""
    @property
    def finger(self) -> int | None:
        """The finger that moves, for ``regrasp``."""
    @property
    def contact(self) -> Contact | None:
        """Its contact at the end; None if it ends free."""
    @property
    def joints(self) -> _Array | None:
        """Its joints at the end."""

@final
class Task:
    """Services and the other roles, lent for the time of one call."""

    @property
    def finger_count(self) -> int: ...
    @property
    def fingertip_radius(self) -> float: ...
    @property
    def gravity(self) -> _Array: ...
    @property
    def friction(self) -> float:
        """The coefficient to plan with: the object's, less the planner's margin."""
    @property
    def workspace(self) -> list[_Array]:
        """Lowest and highest coordinates of the object's origin in H (m)."""
    @property
    def landmarks(self) -> list[_Array]:
        """The object's poses at start and goals."""
    @property
    def clearance(self) -> float:
        """The distance that free bodies are to keep (m), between the stored states too."""
    @property
    def lift(self) -> float:
        """The height above the surface from which a finger counts as lifted (m)."""
    @property
    def regrasp_step(self) -> float:
        """The longest step of a fingertip between two states of a regrasp (m)."""
    def spare(self, finger: int) -> list[int]:
        """The joints of a finger, by number, that a fingertip's position leaves free."""
    def rest(self, finger: int) -> _Array: ...
    def limits(self, finger: int) -> list[_Array]: ...
    def fk(self, finger: int, joints: _Triple) -> _Array: ...
    def ik(self, finger: int, point: _Triple, near: _Triple) -> _Array | None: ...
    def sample_contact(self, context: Context) -> Contact: ...
    def project(self, point: _Triple, hint: int | None = None) -> tuple[Contact, float]: ...
    def walk(self, contact: Contact, direction: _Triple, distance: float) -> Contact: ...
    def edge_distance(self, contact: Contact) -> float: ...
    def geodesic(
        self, start: Contact, end: Contact, context: Context
    ) -> tuple[list[tuple[Contact, float]], float] | None: ...
    def grasp(
        self, q: Configuration, holding: Sequence[int] | None = None, moving: bool = False
    ) -> Grasp: ...
    def is_stable(self, grasp: Grasp, context: Context) -> bool: ...
    def liftable(self, grasp: Grasp, context: Context) -> list[int]: ...
    def object_free(self, pose: _Matrix) -> bool: ...
    def finger_free(
        self, finger: int, joints: _Triple, pose: _Matrix, touches: bool = True, clear: float = 0.0
    ) -> bool: ...
    def is_free(self, q: Configuration) -> bool: ...
    def admit(self, q: Configuration, context: Context) -> str | None:
        """Why the configuration may not become a node; None where it may."""
    def admit_finger(
        self, q: Configuration, finger: int, placed: Sequence[int], context: Context
    ) -> str | None:
        """What :meth:`admit` asks of one finger of `q` beside the fingers `placed`: None where it may stay."""
    def admit_grasp(self, q: Configuration, context: Context) -> str | None:
        """What :meth:`admit` asks of the grasp as a whole, once every finger may stay."""
    def way_free(
        self, q: Configuration, finger: int, way: Sequence[_Triple], clear: float
    ) -> list[bool]:
        """Whether each posture of a finger that moves alone, the rest of `q` at rest, touches nothing.

        `clear` (m) is what its tip keeps from the object.
        """
    def at_rest(self, pose: _Matrix) -> Configuration: ...

@final
class Graph:
    """The manipulation graph, lent for the time of one call."""

    @property
    def node_count(self) -> int: ...
    @property
    def generated(self) -> tuple[int, int]: ...
    @property
    def start(self) -> int: ...
    @property
    def goals(self) -> list[int]: ...
    @property
    def components(self) -> list[int]: ...
    @property
    def joined(self) -> bool: ...
    @property
    def edges(self) -> list[tuple[int, int, int, str, str]]:
        """Number, ends, kind and verdict of every edge."""
    @property
    def history(self) -> list[tuple[str, str, list[int], int]]:
        """Each action of the past, what it came to, the nodes that it made, and how many components fewer
        it left.
        """
    def component(self, node: int) -> int: ...
    def distance(self, a: int, b: int) -> float: ...
    def attempted(self, a: int, b: int, kind: str = "grasp") -> bool: ...
    def configuration(self, node: int) -> Configuration: ...
    def shortest_path(self) -> list[int]: ...

@final
class Plan:
    @staticmethod
    def read(path: str) -> Plan: ...
    @staticmethod
    def parse(text: str, name: str) -> Plan: ...
    def write(self, path: str) -> None: ...
    def text(self) -> str: ...
    def head(self) -> str: ...
    def segments(self) -> list[tuple[str, int | None, int, int]]: ...
    def arrays(self) -> dict[str, _Array]: ...
    def export(self, format: str, stem: str) -> tuple[list[tuple[str, bytes]], list[str]]: ...
    def verify(self) -> str: ...
    def page(self) -> str: ...
    def series(self) -> tuple[_Array, _Array]: ...

@final
class Solved:
    @property
    def plan(self) -> Plan | None: ...
    @property
    def summary(self) -> str: ...

@final
class Scenario:
    @staticmethod
    def load(name: str) -> Scenario: ...
    @staticmethod
    def parse(text: str, file: str, folder: str) -> Scenario: ...
    def remarks(self) -> list[str]: ...
    def describe(self) -> str: ...

@final
class Hand:
    @staticmethod
    def load(tree: str, folder: str) -> Hand: ...
    def describe(self) -> str: ...
    def urdf(self, stem: str) -> list[tuple[str, bytes]]: ...
    def fk(self, finger: int, joints: _Array) -> _Array: ...
    def fingertips(self, joints: _Array) -> _Array: ...
    def jacobian(self, finger: int, joints: _Array) -> _Array: ...
    def ik(self, finger: int, centers: _Array, near: _Array) -> _Array: ...

@final
class Bench:
    def __new__(cls, scenario: Scenario, changes: dict[str, Any]) -> Bench: ...
    def sample_contacts(self, count: int, seed: int) -> dict[str, Any]: ...
    def closest_points(self, centers: _Array) -> dict[str, Any]: ...
    def geodesics(
        self,
        starts: tuple[_Array, _Array],
        ends: tuple[_Array, _Array],
        facets: tuple[npt.NDArray[np.uint32], npt.NDArray[np.uint32]],
    ) -> _Array: ...
    def sample_grasps(
        self, count: int, seed: int, holding: list[int] | None, tries: int
    ) -> list[Configuration]: ...
    def margins(self, configurations: list[Configuration]) -> _Array: ...
    def holds(self, configurations: list[Configuration], share: float) -> dict[str, _Array]: ...
    def connect(
        self,
        starts: list[Configuration],
        ends: list[Configuration | tuple[Configuration, int] | list[list[float]]],
        seed: int,
    ) -> list[tuple[list[Configuration], float, str | None]]: ...

def grasps(
    scenario: Scenario, asked: dict[str, Any], threads: int, changes: dict[str, Any]
) -> bytes: ...
def solve(
    scenario: Scenario,
    seed: int,
    threads: int,
    changes: dict[str, Any],
    callback: Callable[[str, int, int, int], None] | None,
) -> Solved: ...
def scenarios() -> list[tuple[str, str]]: ...
def force_closure(points: _Array, normals: _Array, cones: _Array) -> npt.NDArray[np.bool_]: ...
def closure_margins(
    points: _Array, normals: _Array, cones: _Array, center: list[float] | None, length: float | None
) -> _Array: ...
def internal_forces(points: _Array, normals: _Array, cones: _Array) -> _Array: ...
def register(
    id: str, slots: list[str], summary: str, references: list[str], schema: str, class_: type
) -> None: ...
def registered() -> list[str]: ...
def role_schema(id: str) -> str | None: ...
def run_study(
    scenarios: list[Scenario],
    request: dict[str, Any],
    callback: Callable[[str, int, int, int], None] | None,
) -> bool: ...
def merge_studies(parts: list[str], output: str) -> None: ...
def digest(bytes: bytes) -> str: ...
def conformance(id: str, settings: str, geodesic_tolerance: float | None) -> str: ...
def plugin_package(role: str, name: str) -> list[tuple[str, str]]: ...
def plugins() -> str: ...
