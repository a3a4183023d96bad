"""Algorithms, and pairs of meshes that are prepared for queries."""

from __future__ import annotations

import dataclasses
from typing import Any

from . import _core
from ._answers import Answers, Collisions, Distances, Impacts, Responses
from ._errors import BadArgument, BadMesh
from ._meshes import Mesh, as_mesh
from ._motions import as_motions
from ._poses import as_poses
from ._programs import program

KINDS = {"collide": Collisions, "distance": Distances, "respond": Responses}


@dataclasses.dataclass(frozen=True)
class AlgorithmInfo:
    """What is known of an algorithm before it is prepared."""

    name: str  #: As prepare() takes it.
    version: str  #: Of the library behind it.
    summary: str  #: One line.
    answers: tuple[str, ...]  #: Of "collide", "distance", "respond", "cast".
    law: str  #: What the magnitude of a response is: "none", "depth" (length) or "volume" (length^3).
    approximates: bool  #: Whether it answers for an approximation of the bodies, such as spheres.
    body: str  #: What answers are about: "mesh" or "convex_hull".
    runtime: str  #: Of a program that bench/rivals/setup made ready: "native", "python", "node", "wasm"; else empty.
    parameters: tuple[dict[str, Any], ...]  #: Each with name, meaning, unit, default, and low and high, or choices.


def algorithms() -> dict[str, AlgorithmInfo]:
    """Every registered algorithm by its name: this project's own, those of libraries, rivals that are set up."""
    return {each["name"]: AlgorithmInfo(**each) for each in _core.algorithms()}


class Pair:
    """Two meshes that an algorithm is prepared for: a (fixed) and b (moving).

    poses: an array of shape (..., 4, 4) of matrices [R t; 0 1] that map points of B's frame to A's frame, in the
    meshes' length unit. Answers have the shape of `poses` without its last two axes.

    threads: 1: poses are asked in their order by the calling thread. N: by at most N threads in no order, 0: by as many
    as there are processors. Each thread has a prepared query of its own: N times the memory and, once, N times the
    preparation. Answers are the same; those of algorithms that start from their last answer may differ in rounding.

    Other Python threads run while poses are asked. Ctrl-C ends a call.
    """

    def __init__(self, name: str, a: Mesh, b: Mesh, prepared: Any):
        self.name, self.a, self.b = name, a, b
        self._prepared = prepared

    @property
    def settings(self) -> str:
        """The value of every parameter: "name=value,name=value"."""
        return self._prepared.settings

    def footprint(self) -> dict[str, float]:
        """"bytes" of the prepared structures of one thread (0: not known), and counts that explain them."""
        return self._prepared.footprint()

    def collide(self, poses: Any, *, threads: int = 1) -> Collisions:
        """Whether the bodies touch or overlap (of some algorithms: the surfaces)."""
        return self._ask("collide", poses, threads)  # type: ignore[return-value]

    def distance(self, poses: Any, *, threads: int = 1) -> Distances:
        """Distances of the surfaces, 0 where they meet, with closest points."""
        return self._ask("distance", poses, threads)  # type: ignore[return-value]

    def respond(self, poses: Any, *, threads: int = 1) -> Responses:
        """Force and torque that push B out of A; of some algorithms the overlap volume."""
        return self._ask("respond", poses, threads)  # type: ignore[return-value]

    def cast(self, poses: Any, translation: Any, rotation: Any = None, *, reference: Any = None,
             threads: int = 1) -> Impacts:
        """When b first touches a while it moves from `poses`, t from 0 to 1: a point of b, the centre of its box, moves
        by `translation` (length), and b rotates about it by `rotation`, axis times angle (radians); both of shape
        (..., 3), in a's frame. reference: another point, in b's frame. All arguments are broadcast together."""
        _check_threads(threads)
        arrays, shape = as_motions(poses, translation, rotation, reference, self.b.center)
        answers = Impacts(self._prepared.cast(*arrays, threads), shape)
        answers.warn(self.name)
        return answers

    def _ask(self, kind: str, poses: Any, threads: int) -> Answers:
        _check_threads(threads)
        matrices, shape = as_poses(poses)
        answers = KINDS[kind](getattr(self._prepared, kind)(matrices, threads), shape)
        answers.warn(self.name)
        return answers

    def __repr__(self) -> str:
        return f"<Pair: {self.name} ({self.settings or 'no settings'}), a {self.a!r}, b {self.b!r}>"


def _check_threads(threads: Any) -> None:
    if not isinstance(threads, int) or threads < 0:
        raise BadArgument(f"threads: {threads!r} is no number of threads (0: all processors)")


def prepare(algorithm: Any, a: Any, b: Any = None, *, isolate: bool = False, query_timeout: float = 10.0,
            **parameters: Any) -> Pair:
    """Prepares an algorithm for two meshes.

    algorithm: a name (algorithms() lists them) or a class derived from sixdof.Algorithm. a, b: a Mesh, a file, a
    model's name, or an object with `vertices` and `faces`; b moves and is by default a copy of a. isolate: run it in a
    process of its own, so that a crash, or a query of more than `query_timeout` seconds, costs that pose and not this
    process; each query then takes some 20 us more. parameters: of the algorithm, such as spheres=500 or profile="tuned";
    a bool is "on" or "off".

    Raises BadMesh if a mesh cannot be used (the message names it), BadArgument for an unknown name or parameter.
    """
    mesh_a = as_mesh(a, "a")
    mesh_b = mesh_a if b is None or b is a else as_mesh(b, "b")
    texts = {name: text_of(value) for name, value in parameters.items()}
    if isinstance(algorithm, type):
        if isolate:
            raise BadArgument("isolate: a class is isolated by sixdof.bench() only")
        from ._algorithm import prepare_class
        return Pair(*prepare_class(algorithm, mesh_a, mesh_b, texts))
    if not isinstance(algorithm, str):
        raise BadArgument(f"algorithm: {type(algorithm).__name__} is neither a name nor a class")
    try:
        prepared = _core.prepare(algorithm, mesh_a, mesh_b, texts, program("sixdof-bench") if isolate else "",
                                 query_timeout)
    except BadMesh as e:
        raise BadMesh(f"{algorithm} cannot use a or b: {e}") from None
    return Pair(algorithm, mesh_a, mesh_b, prepared)


def text_of(value: Any) -> str:
    """The value of a parameter as the command line takes it."""
    if isinstance(value, bool):
        return "on" if value else "off"
    return repr(float(value)) if isinstance(value, float) else str(value)
