"""Objects and obstacles: primitives, arrays, trimesh, files."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import ArgumentError
from ._spatial import array, pose_tree


@dataclass(frozen=True)
class Shape:
    """An object's shape, with its mass (kg) and the coefficient of friction between it and the fingertips
    (no unit).
    """

    kind: str
    lengths: Mapping[str, Any]
    mass: float = 0.1
    friction: float = 0.8
    name: str = "object"

    def shape_tree(self) -> dict[str, Any]:
        """The shape alone, as a scenario's tree has it."""
        return {"kind": self.kind, **self.lengths}

    def tree(self) -> dict[str, Any]:
        """A scenario's ``object``."""
        own = {"name": self.name, "mass": float(self.mass), "friction": float(self.friction)}
        return {**own, "shape": self.shape_tree()}


def Sphere(radius: float, **rest: Any) -> Shape:
    """A ball of this radius (m) about the object's origin; `rest` are mass, friction and name."""
    return Shape("sphere", {"radius": float(radius)}, **rest)


def Ellipsoid(semi_axes: Sequence[float], **rest: Any) -> Shape:
    """An ellipsoid along the axes: half its lengths along x, y, z (m)."""
    return Shape("ellipsoid", {"semi_axes": [float(x) for x in semi_axes]}, **rest)


def Cuboid(size: Sequence[float], **rest: Any) -> Shape:
    """A box along the axes: its edge lengths (m)."""
    return Shape("cuboid", {"size": [float(x) for x in size]}, **rest)


def Cylinder(radius: float, height: float, **rest: Any) -> Shape:
    """A cylinder along z (m)."""
    return Shape("cylinder", {"radius": float(radius), "height": float(height)}, **rest)


def Capsule(radius: float, height: float, **rest: Any) -> Shape:
    """A capsule along z: radius, and height of the cylinder between the two half balls (m)."""
    return Shape("capsule", {"radius": float(radius), "height": float(height)}, **rest)


def Torus(ring_radius: float, tube_radius: float, **rest: Any) -> Shape:
    """A torus about z (m)."""
    return Shape("torus", {"ring_radius": float(ring_radius), "tube_radius": float(tube_radius)}, **rest)


def Mesh(source: Any, facets: npt.ArrayLike | None = None, **rest: Any) -> Shape:
    """A closed mesh.

    Parameters
    ----------
    source : path, array_like (V, 3), or trimesh.Trimesh
        An STL, OBJ, PLY or COLLADA file; the vertices (m); or a mesh of trimesh.
    facets : array_like of int, (F, 3), optional
        Counter-clockwise indices of vertices seen from outside, where `source` is vertices.
    **rest
        `scale` of a file (0.001 for millimetres), mass, friction, name.
    """
    scale = rest.pop("scale", None)
    scaled = {} if scale is None else {"scale": float(scale)}
    if isinstance(source, (str, os.PathLike)):
        return Shape("mesh", {"file": os.path.abspath(source), **scaled}, **rest)
    if facets is None:
        if not (hasattr(source, "vertices") and hasattr(source, "faces")):
            raise ArgumentError(
                "`facets` are missing: a mesh of arrays has vertices and facets", key="facets"
            )
        source, facets = source.vertices, source.faces
    vertices = array("vertices", source, (None, 3))
    indices = np.asarray(facets)
    if indices.dtype.kind not in "iu" or indices.ndim != 2 or indices.shape[1] != 3:
        message = (
            f"`facets` are {indices.dtype} of shape {indices.shape}, not whole numbers of shape (any, 3)"
        )
        raise ArgumentError(message, key="facets", range="(any, 3)")
    if indices.size and not (0 <= indices.min() and indices.max() < len(vertices)):
        highest = len(vertices) - 1
        message = f"`facets` name a vertex outside 0..={highest}"
        raise ArgumentError(message, key="facets", range=f"0..={highest}")
    return Shape("mesh", {"vertices": vertices.tolist(), "facets": indices.tolist(), **scaled}, **rest)


@dataclass(frozen=True)
class Obstacle:
    """Something fixed to the hand's frame: a shape's tree, or a ball, box or mesh, at a pose (4, 4) in H."""

    shape: Shape | Mapping[str, Any]
    pose: npt.ArrayLike | None = None
    name: str = ""

    def tree(self) -> dict[str, Any]:
        """A scenario's ``obstacle``."""
        shape = self.shape.shape_tree() if isinstance(self.shape, Shape) else dict(self.shape)
        if shape["kind"] == "cuboid":
            shape["kind"] = "box"
        tree = {"name": self.name, "shape": shape}
        return tree if self.pose is None else {**tree, "pose": pose_tree("obstacle.pose", self.pose)}


def object_tree(given: Shape | Mapping[str, Any] | Any) -> dict[str, Any]:
    """A scenario's ``object`` from any of the forms in which it may be given."""
    if isinstance(given, Shape):
        return given.tree()
    if isinstance(given, Mapping):
        return dict(given)
    if hasattr(given, "vertices") and hasattr(given, "faces"):
        return Mesh(given).tree()
    raise TypeError(f"an object is a shape, a dict or a trimesh mesh, not {type(given).__name__}")
