"""Answers to arrays of poses: values, a mask of the poses without an answer, and why."""

from __future__ import annotations

import collections
import warnings
from typing import Any, Mapping

import numpy
from numpy.typing import NDArray

from . import _core
from ._errors import FailedQueries

_STATUSES = numpy.array(_core.statuses, dtype=object)


class Answers:
    """What all kinds of answers have. `shape` below is that of the poses without their last two axes.

    Values are plain arrays where every pose has an answer. Else they are masked arrays (numpy.ma), masked where there
    is none, and the call has warned (FailedQueries): no NaN passes for an answer.
    """

    ok: NDArray[numpy.bool_]  #: Whether there is an answer, of shape `shape`.
    status: NDArray[numpy.object_]  #: "ok", "unsupported", "failed", "non_finite", "crashed", ..., of shape `shape`.
    words: dict[int, str]  #: Why there is no answer, by the (flat) index of the pose.

    def __init__(self, raw: Mapping[str, Any], shape: tuple[int, ...]):
        self._shape = shape
        self.status = _STATUSES[raw["status"]].reshape(shape)
        self.ok = (numpy.asarray(raw["status"]) == 0).reshape(shape)
        self.words = dict(raw["words"])

    def _field(self, values: NDArray[Any], present: NDArray[numpy.bool_] | None = None) -> NDArray[Any]:
        """Values of all poses, masked where there are none."""
        array = values.reshape(self._shape + values.shape[1:])
        there = self.ok if present is None else self.ok & present.reshape(self._shape)
        if there.all():
            return array
        extra = (1,) * (array.ndim - there.ndim)
        return numpy.ma.array(array, mask=numpy.broadcast_to(~there.reshape(there.shape + extra), array.shape))

    def __len__(self) -> int:
        return len(self.ok)

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.ok.size} poses{self._missing('; ')}>"

    def _missing(self, before: str) -> str:
        if self.ok.all():
            return ""
        counts = collections.Counter(word for word in self.status.ravel() if word != "ok")
        kinds = ", ".join(f"{count} {word}" for word, count in sorted(counts.items()))
        first = min(self.words) if self.words else int(numpy.flatnonzero(~self.ok.ravel())[0])
        return f"{before}{kinds}; the first is poses[{first}]: {self.words.get(first, '')}"

    def warn(self, algorithm: str) -> None:
        """Warns if a pose has no answer."""
        if not self.ok.all():
            words = f"{algorithm}: {int((~self.ok).sum())} of {self.ok.size} poses have no answer"
            warnings.warn(words + self._missing(": "), FailedQueries, stacklevel=4)


class Collisions(Answers):
    """Answers to `collide`."""

    colliding: NDArray[numpy.bool_]  #: Whether the bodies have a point in common, of shape `shape`.

    def __init__(self, raw: Mapping[str, Any], shape: tuple[int, ...]):
        super().__init__(raw, shape)
        self.colliding = self._field(raw["colliding"])

    def __array__(self, dtype: Any = None, copy: Any = None) -> NDArray[Any]:
        return numpy.asanyarray(self.colliding, dtype=dtype)


class Distances(Answers):
    """Answers to `distance`."""

    distance: NDArray[numpy.float64]  #: Between the surfaces, 0 where they meet; in the meshes' length unit.
    points_a: NDArray[numpy.float64]  #: Closest points on A, in A's frame, of shape `shape` + (3,); masked if not given.
    points_b: NDArray[numpy.float64]  #: Closest points on B, in A's frame, likewise.
    triangles_a: NDArray[numpy.int64]  #: Triangles of points_a in A.triangles, of shape `shape`; masked if not given.
    triangles_b: NDArray[numpy.int64]  #: Likewise of points_b in B.triangles.

    def __init__(self, raw: Mapping[str, Any], shape: tuple[int, ...]):
        super().__init__(raw, shape)
        self.distance = self._field(raw["distance"])
        for side, name in enumerate("ab"):
            points, triangles = raw[f"points_{name}"], raw["triangles"][:, side]
            setattr(self, f"points_{name}", self._field(points, numpy.isfinite(points).all(axis=1)))
            setattr(self, f"triangles_{name}", self._field(triangles, triangles >= 0))

    def __array__(self, dtype: Any = None, copy: Any = None) -> NDArray[Any]:
        return numpy.asanyarray(self.distance, dtype=dtype)


class Impacts(Answers):
    """Answers to `cast`: first contacts. t, points and normals are masked where there is no contact."""

    hit: NDArray[numpy.bool_]  #: Whether the bodies have a point in common at any t from 0 to 1, of shape `shape`.
    t: NDArray[numpy.float64]  #: The first such time; 0 for bodies in contact at the start, and for these only.
    points_a: NDArray[numpy.float64]  #: Of contact on A, in A's frame, of shape `shape` + (3,); masked if not given.
    points_b: NDArray[numpy.float64]  #: On B at t, in A's frame, likewise.
    normal: NDArray[numpy.float64]  #: Unit vector from A to B, in A's frame, likewise.

    def __init__(self, raw: Mapping[str, Any], shape: tuple[int, ...]):
        super().__init__(raw, shape)
        self.hit = self._field(raw["hit"])
        self.t = self._field(raw["t"], raw["hit"])
        for name in ("points_a", "points_b", "normal"):
            setattr(self, name, self._field(raw[name], numpy.isfinite(raw[name]).all(axis=1)))

    def __array__(self, dtype: Any = None, copy: Any = None) -> NDArray[Any]:
        return numpy.asanyarray(self.t, dtype=dtype)


class Responses(Answers):
    """Answers to `respond`: the wrench that pushes B out of A, zero where the bodies are apart. All in A's frame."""

    penalty: NDArray[numpy.float64]  #: By the algorithm's law a depth (length) or a volume (length^3), of shape `shape`.
    volume: NDArray[numpy.float64]  #: Of the overlap (length^3), of shape `shape`; masked if the algorithm gives none.
    force: NDArray[numpy.float64]  #: On B, of shape `shape` + (3,): by the volume law in area (length^2).
    torque: NDArray[numpy.float64]  #: On B about `reference`, of shape `shape` + (3,): force times length.
    reference: NDArray[numpy.float64]  #: By convention the centre of B's bounding box, of shape `shape` + (3,).

    def __init__(self, raw: Mapping[str, Any], shape: tuple[int, ...]):
        super().__init__(raw, shape)
        self.volume = self._field(raw["volume"], ~numpy.isnan(raw["volume"]))
        for name in ("penalty", "force", "torque", "reference"):
            setattr(self, name, self._field(raw[name]))
