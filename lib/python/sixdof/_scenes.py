"""Scenes of many bodies with recorded motion, and the questions that are asked in every frame."""

from __future__ import annotations

import dataclasses
import os
from typing import Any, Sequence

import numpy
from numpy.typing import NDArray

from . import _core
from ._errors import BadArgument
from ._meshes import Mesh, as_mesh
from ._poses import as_poses


@dataclasses.dataclass(frozen=True)
class FrameAnswer:
    """The answer to a question in one frame. Bodies are named by their identifiers."""

    pairs: NDArray[numpy.uint32]  #: Shape (k, 2), lower identifier first, sorted.
    distance: NDArray[numpy.float64]  #: Of each pair (length), shape (k,); "touching" and "wrenches": 0; "impacts": t.
    body: NDArray[numpy.uint32]  #: "wrenches" only: which bodies, shape (m,).
    force: NDArray[numpy.float64]  #: On each of them, in the world's frame (area), shape (m, 3).
    torque: NDArray[numpy.float64]  #: About the centre of its box (area times length), shape (m, 3).


class Scene:
    """Bodies with meshes, and their recorded motion."""

    def __init__(self, core: Any):
        self._core = core
        bodies = core.bodies()
        self.name: str = core.name
        self.margin: float = core.margin  #: Of "near" (length).
        self.meshes: list[Mesh] = core.meshes()
        self.ids: NDArray[numpy.uint32] = bodies["id"]  #: Identifiers of bodies, shape (n,).
        self.mesh_of: NDArray[numpy.uint32] = bodies["mesh"]  #: Index into `meshes` of each body, shape (n,).
        self.fixed: NDArray[numpy.bool_] = bodies["fixed"]  #: Whether it never moves, shape (n,).
        self.frames: int = core.frames  #: Their number; the first is the start.
        self._start = bodies["poses"]

    def poses(self) -> NDArray[numpy.float64]:
        """X_WB of every body in every frame, shape (frames, n, 4, 4), in the world's frame."""
        all_poses = numpy.repeat(self._start[None], self.frames, axis=0)
        for frame in range(1, self.frames):
            moved, poses = self._core.frame(frame)
            all_poses[frame:, moved] = poses
        return all_poses

    def vertices(self, mesh: int) -> NDArray[numpy.float64]:
        """Vertices of meshes[mesh] in every frame, shape (frames, k, 3), in the mesh's frame: they move if it deforms."""
        if not 0 <= mesh < len(self.meshes):
            raise BadArgument(f"mesh: {mesh} of {len(self.meshes)} meshes")
        all_vertices = numpy.repeat(numpy.asarray(self.meshes[mesh].vertices)[None], self.frames, axis=0)
        for frame in range(1, self.frames):
            shapes = self._core.shapes(frame)
            if mesh in shapes:
                all_vertices[frame:] = shapes[mesh]
        return all_vertices

    def play(self, question: str = "touching", algorithm: str = "exact") -> tuple[list[FrameAnswer], dict[str, Any]]:
        """Replays the scene to an algorithm (scene_algorithms()). question: "touching", "near", "closest", "wrenches" or
        "impacts", the pairs that first touch between the frame before and this one, at t from 0 to 1.

        Returns the answer of every frame, and a dict: true_pairs, missed, wrong, grazing, nested, largest_error
        (length) against the truth, prepare_s, mean_us and max_us of a frame.
        """
        answers, score = self._core.play(algorithm, question)
        return [FrameAnswer(**answer) for answer in answers], score

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the scene as HDF5, whole or not at all; `sixdof scene` reads it. Raises BadFile."""
        self._core.save(os.fspath(file))

    def __repr__(self) -> str:
        return f"<Scene {self.name}: {len(self.ids)} bodies, {self.frames} frames>"


def load_scene(file: str | os.PathLike[str]) -> Scene:
    """Reads a scene. Raises BadFile, naming the file and the place."""
    return Scene(_core.load_scene(os.fspath(file)))


def make_scene(family: str, **numbers: float) -> Scene:
    """A scene of a family (scene_families()). numbers: bodies, frames, seed, density, size_ratio, moving, step,
    margin; where a mesh deforms amplitude (of its diagonal) and triangles instead of bodies."""
    return Scene(_core.make_scene(family, {name: float(value) for name, value in numbers.items()}))


def scene(meshes: Sequence[Any], mesh_of: Sequence[int], poses: Any, *, fixed: Sequence[bool] | None = None,
          margin: float = 0.0, name: str = "scene") -> Scene:
    """A scene of your own. meshes: as prepare() takes them. mesh_of: the index into `meshes` of each of n bodies, whose
    identifiers are 0 to n - 1. poses: X_WB, shape (frames, n, 4, 4), in the world's frame. fixed: n flags; none by
    default. margin: of the question "near" (length)."""
    matrices, shape = as_poses(poses)
    count = len(mesh_of)
    if len(shape) != 2 or shape[1] != count or count == 0 or shape[0] == 0:
        raise BadArgument(f"poses: the shape is {shape + (4, 4)}, not (frames, {count}, 4, 4)")
    flags = [False] * count if fixed is None else [bool(flag) for flag in fixed]
    if len(flags) != count:
        raise BadArgument(f"fixed: {len(flags)} flags for {count} bodies")
    used = [as_mesh(mesh, f"meshes[{place}]") for place, mesh in enumerate(meshes)]
    indices = [int(index) for index in mesh_of]
    for place, index in enumerate(indices):
        if not 0 <= index < len(used):
            raise BadArgument(f"mesh_of[{place}]: {index} of {len(used)} meshes")
    return Scene(_core.build_scene(used, indices, flags, matrices, float(margin), name))


def scene_algorithms() -> dict[str, dict[str, Any]]:
    """Algorithms for scenes by their names: version, summary, questions."""
    return {each.pop("name"): each for each in _core.scene_algorithms()}


def scene_families() -> dict[str, str]:
    """Families of scenes, and what each stresses."""
    return _core.scene_families()
