"""Poses: 4 x 4 matrices that map points of B's mesh frame to A's mesh frame."""

from __future__ import annotations

from typing import Any

import numpy
from numpy.typing import ArrayLike, NDArray

from ._errors import BadArgument


def pose(quaternion: ArrayLike, translation: ArrayLike) -> NDArray[numpy.float64]:
    """Matrices [R t; 0 1] of rotations and translations, shape (..., 4, 4).

    quaternion: shape (..., 4), unit quaternions w, x, y, z. translation: shape (..., 3), in the meshes' length unit.
    """
    q = numpy.asarray(quaternion, dtype=float)
    t = numpy.asarray(translation, dtype=float)
    if q.shape[-1:] != (4,):
        raise BadArgument(f"quaternion: the shape is {q.shape}, not (..., 4)")
    if t.shape[-1:] != (3,):
        raise BadArgument(f"translation: the shape is {t.shape}, not (..., 3)")
    norm = numpy.linalg.norm(q, axis=-1, keepdims=True)
    if not numpy.all(numpy.abs(norm - 1.0) < 1e-6):  # the rounding of components printed with seven digits
        raise BadArgument("quaternion: not of norm 1")
    w, x, y, z = numpy.moveaxis(q / norm, -1, 0)
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    rotation = numpy.moveaxis(numpy.array(rows), (0, 1), (-2, -1))
    shape = numpy.broadcast_shapes(rotation.shape[:-2], t.shape[:-1])
    matrices = numpy.zeros((*shape, 4, 4))
    matrices[..., :3, :3] = rotation
    matrices[..., :3, 3] = t
    matrices[..., 3, 3] = 1.0
    return matrices


def as_poses(poses: Any) -> tuple[NDArray[numpy.float64], tuple[int, ...]]:
    """The poses as an array of shape (n, 4, 4), and the shape before the last two axes."""
    try:
        array = numpy.asarray(poses, dtype=numpy.float64)
    except (TypeError, ValueError) as e:
        raise BadArgument(f"poses: {e}") from None
    if array.shape[-2:] != (4, 4):
        raise BadArgument(f"poses: the shape is {array.shape}, not (..., 4, 4)")
    return numpy.ascontiguousarray(array).reshape(-1, 4, 4), array.shape[:-2]
