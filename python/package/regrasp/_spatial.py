"""Poses: 4×4 matrices, and the tree of a scenario's pose."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import ArgumentError

Array = npt.NDArray[np.float64]
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def numbers_of(key: str, value: npt.ArrayLike) -> Array:
    """``value`` as float64 numbers in C order; strided arrays are copied. Complex numbers are refused: what
    numpy would make of them is another array.
    """
    try:
        given = np.asarray(value)
        if given.dtype.kind == "c":
            raise TypeError("complex numbers")
        return np.asarray(given, dtype=np.float64, order="C")
    except (TypeError, ValueError) as error:
        raise ArgumentError(f"`{key}` holds something that is no number: {error}", key=key) from error


def array(key: str, value: npt.ArrayLike, shape: tuple[int | None, ...]) -> Array:
    """``value`` as finite float64 numbers of this shape; None stands for any length."""
    numbers = numbers_of(key, value)
    fits = numbers.ndim == len(shape) and all(
        want in (None, have) for want, have in zip(shape, numbers.shape, strict=True)
    )
    if not fits:
        wanted = "(" + ", ".join("any" if n is None else str(n) for n in shape) + ")"
        raise ArgumentError(f"`{key}` has shape {numbers.shape}, not {wanted}", key=key, range=wanted)
    if not np.isfinite(numbers).all():
        place = tuple(int(i) for i in np.argwhere(~np.isfinite(numbers))[0])
        at = f"{key}{list(place)}" if place else key
        raise ArgumentError(f"`{at}` = {numbers[place]} is outside the finite numbers", key=at)
    return numbers


def matrices(positions: Array, orientations: Array) -> Array:
    """4×4 matrices (N, 4, 4) of positions (N, 3) and unit quaternions w, x, y, z (N, 4)."""
    w, x, y, z = orientations.T
    poses = np.zeros((len(positions), 4, 4))
    poses[:, 0, :3] = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], axis=-1)
    poses[:, 1, :3] = np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], axis=-1)
    poses[:, 2, :3] = np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=-1)
    poses[:, :3, 3] = positions
    poses[:, 3, 3] = 1.0
    return poses


def quaternion(R: Array) -> Array:
    """The unit quaternion w, x, y, z, w ≥ 0, of a rotation matrix (3, 3).

    Source: S. W. Shepperd, "Quaternion from rotation matrix", Journal of Guidance and Control, 1978.
    """
    trace = float(np.trace(R))
    choice = int(np.argmax([trace, R[0, 0], R[1, 1], R[2, 2]]))
    q = np.empty(4)
    if choice == 0:
        q[:] = (1 + trace, R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1])
    else:
        i, j, k = [(0, 1, 2), (1, 2, 0), (2, 0, 1)][choice - 1]
        q[0] = R[k, j] - R[j, k]
        q[1 + i] = 1 + R[i, i] - R[j, j] - R[k, k]
        q[1 + j] = R[j, i] + R[i, j]
        q[1 + k] = R[k, i] + R[i, k]
    q /= np.linalg.norm(q)
    return q if q[0] >= 0 else -q


def pose(
    x: float = 0.0,
    y: float = 0.0,
    z: float = 0.0,
    *,
    quaternion: Sequence[float] | None = None,
    axis: str | Sequence[float] | None = None,
    angle_deg: float | None = None,
) -> Array:
    """A pose as a 4×4 matrix.

    Parameters
    ----------
    x, y, z : float
        Position (m).
    quaternion : four floats, optional
        Orientation w, x, y, z; of any length but 0.
    axis : ``"x"``, ``"y"``, ``"z"`` or three floats, optional
        Orientation as a turn about this axis by `angle_deg`, instead of a quaternion.
    angle_deg : float, optional
        Degrees.

    Returns
    -------
    ndarray, (4, 4)
    """
    position = array("position", (x, y, z), (3,))
    if (axis is None) != (angle_deg is None) or (quaternion is not None and axis is not None):
        raise ArgumentError("give either `quaternion`, or both `axis` and `angle_deg`", key="axis")
    q = np.array([1.0, 0.0, 0.0, 0.0])
    if quaternion is not None:
        q = array("quaternion", quaternion, (4,))
    elif axis is not None and angle_deg is not None:
        if isinstance(axis, str) and axis not in AXES:
            raise ArgumentError(
                f"`axis` = {axis!r} is outside 'x', 'y', 'z' and vectors", key="axis", value=axis
            )
        direction = array("axis", AXES[axis] if isinstance(axis, str) else axis, (3,))
        half = float(np.radians(array("angle_deg", angle_deg, ()))) / 2
        length = float(np.linalg.norm(direction))
        if length < 1e-9:
            raise ArgumentError("`axis` has no direction: its length is 0", key="axis")
        q = np.array([np.cos(half), *(np.sin(half) * direction / length)])
    length = float(np.linalg.norm(q))
    if length < 1e-9:
        raise ArgumentError("`quaternion` has the length 0", key="quaternion")
    matrix: Array = matrices(position[None], (q / length)[None])[0]
    return matrix


def pose_tree(key: str, X: npt.ArrayLike | dict[str, Any]) -> dict[str, Any]:
    """A pose, given as its tree or as a 4×4 matrix, as a scenario's tree has it."""
    if isinstance(X, dict):
        return X
    matrix = array(key, X, (4, 4))
    R = matrix[:3, :3]
    if not (np.allclose(R @ R.T, np.eye(3), atol=1e-6) and np.linalg.det(R) > 0):
        raise ArgumentError(f"`{key}` is no pose: its upper left 3×3 block is not a rotation", key=key)
    if not np.allclose(matrix[3], [0, 0, 0, 1]):
        raise ArgumentError(f"`{key}` is no pose: its last row is not 0, 0, 0, 1", key=key)
    return {"position": matrix[:3, 3].tolist(), "orientation": quaternion(R).tolist()}
