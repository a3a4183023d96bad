"""Motions of B: arrays of starts, translations and rotation vectors, and one motion as an algorithm in Python gets it."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy
from numpy.typing import NDArray

from ._errors import BadArgument
from ._poses import as_poses


@dataclasses.dataclass(frozen=True)
class Motion:
    """A motion of b from t = 0 to 1. The point `reference` of b moves straight, and b rotates about it."""

    pose: NDArray[numpy.float64]  #: (4, 4), the start: maps points of b's frame to a's frame.
    translation: NDArray[numpy.float64]  #: (3,), of the reference point, in a's frame (length).
    rotation: NDArray[numpy.float64]  #: (3,), axis times angle (radians), in a's frame; may exceed pi.
    reference: NDArray[numpy.float64]  #: (3,), in b's frame.

    def pose_at(self, t: float) -> NDArray[numpy.float64]:
        """The pose at a time, of shape (4, 4). It differs from the program's by some roundings."""
        turned = _rotation(t * self.rotation) @ self.pose[:3, :3]
        point = self.pose[:3, :3] @ self.reference + self.pose[:3, 3] + t * self.translation
        pose = numpy.identity(4)
        pose[:3, :3] = turned
        pose[:3, 3] = point - turned @ self.reference
        return pose


def _rotation(vector: NDArray[numpy.float64]) -> NDArray[numpy.float64]:
    """Rodrigues' formula."""
    angle = float(numpy.linalg.norm(vector))
    if angle == 0.0:
        return numpy.identity(3)
    x, y, z = vector / angle
    cross = numpy.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return numpy.identity(3) + numpy.sin(angle) * cross + 2.0 * numpy.sin(0.5 * angle) ** 2 * (cross @ cross)


def as_motions(poses: Any, translation: Any, rotation: Any, reference: Any,
               centre: NDArray[numpy.float64]) -> tuple[list[NDArray[numpy.float64]], tuple[int, ...]]:
    """Arrays of shape (n, 4, 4) and three of (n, 3), and the shape of the motions: the arguments broadcast together."""
    matrices, of_poses = as_poses(poses)
    vectors = {"translation": translation, "rotation": numpy.zeros(3) if rotation is None else rotation,
               "reference": centre if reference is None else reference}
    arrays = {name: _vectors(value, name) for name, value in vectors.items()}
    try:
        shape = numpy.broadcast_shapes(of_poses, *(array.shape[:-1] for array in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise BadArgument(f"poses {of_poses + (4, 4)}, {shapes}: these shapes do not fit each other") from None
    starts = numpy.broadcast_to(matrices.reshape(*of_poses, 4, 4), (*shape, 4, 4))
    flat = [numpy.ascontiguousarray(starts).reshape(-1, 4, 4)]
    for array in arrays.values():
        flat.append(numpy.ascontiguousarray(numpy.broadcast_to(array, (*shape, 3))).reshape(-1, 3))
    return flat, shape


def _vectors(values: Any, name: str) -> NDArray[numpy.float64]:
    try:
        array = numpy.asarray(values, dtype=numpy.float64)
    except (TypeError, ValueError) as e:
        raise BadArgument(f"{name}: {e}") from None
    if array.shape[-1:] != (3,):
        raise BadArgument(f"{name}: the shape is {array.shape}, not (..., 3)")
    return array
