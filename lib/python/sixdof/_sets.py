"""Configuration sets: poses at prescribed distances or overlap volumes."""

from __future__ import annotations

import dataclasses
import os
from typing import Any

import numpy
from numpy.typing import NDArray

from . import _core
from ._errors import BadArgument
from ._meshes import Mesh, as_mesh


@dataclasses.dataclass(frozen=True)
class Poses:
    """Configurations of a bucket."""

    poses: NDArray[numpy.float64]  #: X_AB, shape (n, 4, 4): maps points of B's frame to A's frame.
    cells: NDArray[numpy.uint64]  #: Places in the grid, shape (n,): rotation * number of directions + direction.
    target: float  #: Distance (length) or overlap volume (length^3) of every pose.
    tolerance: float  #: Upper bound of |measured - target|, same unit.


@dataclasses.dataclass(frozen=True)
class Bucket:
    """The configurations of a set that have the same target."""

    set: ConfigurationSet = dataclasses.field(repr=False)
    name: str  #: "distance/05" or "volume/03".
    kind: str  #: "distance" or "volume".
    percent: float  #: Of the diagonal of A's box, or of A's volume.
    nominal: float  #: The percentage as a distance or a volume.
    target: float  #: What the configurations have (length or length^3): just outside contact in bucket 0.
    tolerance: float  #: Upper bound of |measured - target|, same unit.
    largest_residual: float  #: Largest |measured - target| when the set was made, same unit.
    reachable: int  #: Configurations that meet the target.
    oracle: str  #: The method that measured.

    def poses(self, count: int = 0, seed: int = 1) -> Poses:
        """`count` reachable configurations, drawn at random; all if it is 0. A smaller count draws a prefix."""
        if count < 0:
            raise BadArgument(f"count: {count} is negative")
        a, b = self.set.a, self.set.b
        return Poses(**self.set._core.sample(self.name, a, b, count, seed))

    @property
    def translations(self) -> NDArray[numpy.float64]:
        """Shape (rotations, directions): distance of the centres of both boxes (length), NaN where B never meets the
        target; `reachable` counts the others."""
        return self.set._core.translations(self.name)

    @property
    def rotations(self) -> NDArray[numpy.float64]:
        """Shape (rotations, 4): unit quaternions w, x, y, z of R_AB."""
        return self.set._core.rotations(self.name)

    @property
    def directions(self) -> NDArray[numpy.float64]:
        """Shape (directions, 3): unit vectors in A's frame, from the centre of A's box to that of B's."""
        return self.set._core.directions(self.name)


class ConfigurationSet:
    """A configuration set: a pair of meshes, and buckets by their names.

        s = sixdof.load_set("torus-knot-10k")
        sample = s["distance/05"].poses(100)
        error = sixdof.prepare("fcl-rss", s.a, s.b).distance(sample.poses).distance - sample.target
    """

    def __init__(self, core: Any, path: str, a: Any = None, b: Any = None):
        self._core, self.path = core, path
        self._given = {"a": a, "b": b}
        self._meshes: dict[str, Mesh] = {}
        self.buckets = {each["name"]: Bucket(set=self, **each) for each in core.buckets()}

    @property
    def a(self) -> Mesh:
        """The fixed mesh: found by the set's record of its name, path and content hash."""
        return self._mesh("a")

    @property
    def b(self) -> Mesh:
        """The moving mesh, likewise; the same object as `a` where it is a copy."""
        return self.a if self._core.same_mesh else self._mesh("b")

    def _mesh(self, side: str) -> Mesh:
        if side not in self._meshes:
            given = self._given[side]
            found = as_mesh(given, side) if given is not None else self._core.mesh(side == "b", "")
            self._meshes[side] = found
        return self._meshes[side]

    def __getitem__(self, bucket: str) -> Bucket:
        name = bucket.replace(":", "/")
        if name not in self.buckets:
            raise BadArgument(f"bucket: {self.path} has no {bucket}; it has {', '.join(self.buckets)}")
        return self.buckets[name]

    def __iter__(self) -> Any:
        return iter(self.buckets)

    def __repr__(self) -> str:
        return f"<ConfigurationSet {self.path}: {self._core.a_name}, {self._core.b_name}, {', '.join(self.buckets)}>"


def catalogue(manifest: str | os.PathLike[str] | None = None) -> dict[str, dict[str, Any]]:
    """The sets of a manifest by the names of their pairs: a, b (names of meshes), file, buckets. Default: those that
    come with this package. Raises BadFile."""
    entries = _core.catalogue("" if manifest is None else os.fspath(manifest))
    return {entry.pop("pair"): entry for entry in entries}


def load_set(name_or_file: str | os.PathLike[str], *, a: Any = None, b: Any = None) -> ConfigurationSet:
    """Opens a set: the name of a pair of the catalogue, or a file (a "." or a "/" in it). Buckets are read when used.

    a, b: the meshes, where they are not found by what the set says of them: as prepare() takes them. Their content must
    be that of the set. Raises BadFile, naming the file, or BadArgument for an unknown pair.
    """
    file = os.fspath(name_or_file)
    if isinstance(name_or_file, str) and not any(sign in file for sign in "./"):
        sets = catalogue()
        if file not in sets:
            raise BadArgument(f"name_or_file: no pair {file}; the catalogue has {', '.join(sets)}")
        file = sets[file]["file"]
    return ConfigurationSet(_core.open_set(file), file, a, b)
