"""Algorithms written in Python."""

from __future__ import annotations

import os
import re
import traceback
from typing import Any, Callable, Mapping

import numpy
from numpy.typing import NDArray

from . import _core, sixdof_rival
from ._errors import BadArgument, BadMesh
from ._meshes import Mesh, mesh
from ._motions import Motion

KINDS = sixdof_rival.KINDS


class NoAnswer(Exception):
    """Raised by an algorithm that has no answer for a pose. status: "failed", "non_finite", "unsupported", ..."""

    def __init__(self, words: str, status: str = "failed"):
        super().__init__(words)
        self.status = status


class Algorithm:
    """An algorithm of your own: derive from this class, and define the queries that it answers.

        class Spheres(sixdof.Algorithm):
            def prepare(self):
                self.radius = (self.a.diagonal + self.b.diagonal) / 2

            def distance(self, pose):
                gap = numpy.linalg.norm(pose[:3, :3] @ self.b.center + pose[:3, 3] - self.a.center)
                return max(0.0, gap - self.radius)

    sixdof.prepare(Spheres, a, b) asks it here. sixdof.bench(Spheres, pairs=[...]) measures it: sixdof-bench starts a
    process of its own for every pair, and each query is timed in it. What a method raises counts as a failed pose.
    """

    name: str = ""  #: a-z, 0-9 and "-"; by default made of the class's name.
    version: str = "1"
    summary: str = ""  #: One line; by default the first line of the class's documentation.
    law: str = "none"  #: What the magnitude of a response is: "none", "depth" or "volume".
    body: str = "mesh"  #: What answers are about: "mesh" or "convex_hull".
    limits: tuple[str, ...] = ()  #: What it does not promise: "own_direction", ... (lib/sixdof/process/README.md).
    parameters: tuple[dict[str, Any], ...] = ()  #: Made by sixdof.parameter().

    a: Mesh  #: Fixed.
    b: Mesh  #: Moving; the same object as `a` where it is a copy.
    settings: dict[str, Any]  #: A value for every parameter.

    def __init__(self, a: Mesh, b: Mesh, settings: dict[str, Any]):
        self.a, self.b, self.settings = a, b, settings
        self.prepare()

    def prepare(self) -> None:
        """Builds what the queries need, once per pair. Raise sixdof.BadMesh for a mesh that cannot be used."""

    def collide(self, pose: NDArray[numpy.float64]) -> bool:
        """Whether both bodies have a point in common. pose: (4, 4), maps points of b's frame to a's frame."""
        raise NotImplementedError

    def distance(self, pose: NDArray[numpy.float64]) -> Any:
        """Distance of the surfaces (length), or a tuple of it and the closest points of a and b in a's frame."""
        raise NotImplementedError

    def respond(self, pose: NDArray[numpy.float64]) -> Mapping[str, Any]:
        """A dict of penalty, force and torque on b in a's frame, and optionally volume, and reference: the point that
        the torque is about, by default the centre of b's bounding box."""
        raise NotImplementedError


    def cast(self, motion: Motion) -> Any:
        """When both bodies first have a point in common: None for never, t from 0 to 1, or a dict of t and optionally
        a and b (the points of contact) and normal (from a to b), in a's frame. motion.pose_at(t) is the pose at t."""
        raise NotImplementedError


def parameter(name: str, default: Any, *, low: float | None = None, high: float | None = None,
              choices: tuple[str, ...] = (), meaning: str = "", unit: str = "1") -> dict[str, Any]:
    """A parameter of a class derived from Algorithm: a number from low to high (an int: whole numbers), or a choice."""
    entry: dict[str, Any] = {"name": name, "meaning": meaning or name, "unit": unit, "default": str(default)}
    if choices:
        return entry | {"choices": list(choices)}
    if low is None or high is None:
        raise BadArgument(f"low, high: both are needed for the parameter {name}, or choices")
    return entry | {"low": low, "high": high, "integer": isinstance(default, int)}


def name_of(algorithm: type[Algorithm]) -> str:
    """The name of a class as rows have it: "BoundingSpheres" is "bounding-spheres"."""
    name = algorithm.name or re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "-", algorithm.__name__).lower().replace("_", "-")
    if not re.fullmatch(r"[a-z0-9-]+", name):
        raise BadArgument(f"algorithm: the name \"{name}\" has characters other than a-z, 0-9 and -")
    return name


def check(algorithm: Any) -> type[Algorithm]:
    """The class itself. Raises BadArgument where it is none, or answers nothing."""
    if not (isinstance(algorithm, type) and issubclass(algorithm, Algorithm)):
        raise BadArgument(f"algorithm: {algorithm!r} is no class derived from sixdof.Algorithm")
    if not answered(algorithm):
        raise BadArgument(f"algorithm: {algorithm.__name__} defines none of {', '.join(KINDS)}")
    return algorithm


def answered(algorithm: type[Algorithm]) -> list[str]:
    """The kinds of query that the class defines."""
    return [kind for kind in KINDS if getattr(algorithm, kind) is not getattr(Algorithm, kind)]


def greeting(algorithm: type[Algorithm]) -> dict[str, Any]:
    """What the program says of the class: the arguments of sixdof_rival.serve()."""
    summary = algorithm.summary or (algorithm.__doc__ or "").strip().partition("\n")[0]
    return {"name": name_of(algorithm), "version": str(algorithm.version), "answers": answered(algorithm),
            "summary": summary or f"the Python class {algorithm.__name__}", "law": algorithm.law,
            "body": algorithm.body, "limits": list(algorithm.limits), "parameters": list(algorithm.parameters)}


def instance(algorithm: type[Algorithm], a: Mesh, b: Mesh, texts: Mapping[str, str]) -> Algorithm:
    """The class prepared for a pair. texts: values of parameters; others have their defaults."""
    known = {each["name"]: each for each in algorithm.parameters}
    for name in texts:
        if name not in known:
            raise BadArgument(f"{name_of(algorithm)}: no parameter {name}; it has {', '.join(known) or 'none'}")
    settings = {name: _value(each, texts.get(name, each["default"])) for name, each in known.items()}
    return algorithm(a, b, settings)


def _value(entry: Mapping[str, Any], text: str) -> Any:
    if "choices" in entry:
        if text not in entry["choices"]:
            raise BadArgument(f"{entry['name']}: \"{text}\" is none of {', '.join(entry['choices'])}")
        return text
    try:
        value = int(text) if entry["integer"] else float(text)
    except ValueError:
        raise BadArgument(f"{entry['name']}: \"{text}\" is no number") from None
    if not entry["low"] <= value <= entry["high"]:
        raise BadArgument(f"{entry['name']}: {text} is not from {entry['low']} to {entry['high']}")
    return value


def asked(algorithm: Algorithm, kind: str) -> Callable[[Any], Any]:
    """The method with words of where an exception was raised, and with complete responses."""
    method = getattr(algorithm, kind)

    def ask(pose: Any) -> Any:
        try:
            answer = method(pose)
        except (NoAnswer, MemoryError):
            raise
        except Exception as e:
            raise NoAnswer(_words(e)) from e
        if kind == "respond" and "reference" not in answer:
            answer = dict(answer, reference=pose[:3, :3] @ algorithm.b.center + pose[:3, 3])
        return answer

    return ask


def _words(error: Exception) -> str:
    """"ZeroDivisionError: division by zero (mine.py:12)"."""
    frame = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} ({os.path.basename(frame.filename)}:{frame.lineno})"


class PythonPair:
    """A class prepared in this process, in the form of _core.PreparedPair. One thread asks, whatever `threads` says."""

    def __init__(self, algorithm: type[Algorithm], a: Mesh, b: Mesh, texts: Mapping[str, str]):
        self._algorithm = instance(algorithm, a, b, texts)
        self._answered = answered(algorithm)

    @property
    def settings(self) -> str:
        return ",".join(f"{name}={value}" for name, value in self._algorithm.settings.items())

    def footprint(self) -> dict[str, float]:
        return {"bytes": 0}

    def collide(self, poses: NDArray[numpy.float64], threads: int) -> dict[str, Any]:
        return self._ask("collide", poses, {"colliding": numpy.zeros(len(poses), dtype=bool)}, {"colliding": "collide"})

    def distance(self, poses: NDArray[numpy.float64], threads: int) -> dict[str, Any]:
        arrays = {"distance": _missing(len(poses)), "points_a": _missing(len(poses), 3),
                  "points_b": _missing(len(poses), 3), "triangles": numpy.full((len(poses), 2), -1)}
        return self._ask("distance", poses, arrays, {"distance": "distance", "points_a": "a", "points_b": "b"})

    def respond(self, poses: NDArray[numpy.float64], threads: int) -> dict[str, Any]:
        vectors = ("force", "torque", "reference")
        arrays = {name: _missing(len(poses), 3) for name in vectors}
        arrays |= {name: _missing(len(poses)) for name in ("penalty", "volume")}
        return self._ask("respond", poses, arrays, {name: name for name in arrays})

    def cast(self, poses: NDArray[numpy.float64], translations: NDArray[numpy.float64],
             rotations: NDArray[numpy.float64], references: NDArray[numpy.float64], threads: int) -> dict[str, Any]:
        motions = [Motion(*each) for each in zip(poses, translations, rotations, references)]
        arrays: dict[str, Any] = {"hit": numpy.zeros(len(motions), dtype=bool), "t": _missing(len(motions))}
        arrays |= {name: _missing(len(motions), 3) for name in ("points_a", "points_b", "normal")}
        return self._ask("cast", motions, arrays,
                         {"hit": "hit", "t": "t", "points_a": "a", "points_b": "b", "normal": "normal"})

    def _ask(self, kind: str, poses: Any, arrays: dict[str, Any], keys: Mapping[str, str]) -> dict[str, Any]:
        method = asked(self._algorithm, kind) if kind in self._answered else None
        status, words = numpy.zeros(len(poses), dtype=numpy.uint8), {}
        for place, pose in enumerate(poses):
            parts = vars(pose).values() if isinstance(pose, Motion) else (pose,)
            finite = pose if all(numpy.isfinite(part).all() for part in parts) else sixdof_rival.NOT_FINITE
            reply = sixdof_rival.timed(method, kind, finite)[1]
            if "status" in reply:
                status[place] = _core.statuses.index(reply["status"])
                words[place] = reply["words"]
                continue
            for array, key in keys.items():
                if key in reply:
                    arrays[array][place] = reply[key]
        return arrays | {"status": status, "words": words}


def _missing(*shape: int) -> NDArray[numpy.float64]:
    return numpy.full(shape, numpy.nan)


def prepare_class(algorithm: Any, a: Mesh, b: Mesh, texts: Mapping[str, str]) -> tuple[str, Mesh, Mesh, PythonPair]:
    """The arguments of Pair."""
    algorithm = check(algorithm)
    return name_of(algorithm), a, b, PythonPair(algorithm, a, b, texts)


def served(algorithm: type[Algorithm]) -> type:
    """The class in the form that sixdof_rival.serve() takes."""

    class Query:
        @staticmethod
        def pose_of(numbers: NDArray[numpy.float64]) -> NDArray[numpy.float64]:
            """The twelve numbers of the protocol as a matrix; not timed."""
            pose = numpy.identity(4)
            pose[:3, :3] = numpy.reshape(numbers[:9], (3, 3))
            pose[:3, 3] = numbers[9:]
            return pose

        @staticmethod
        def motion_of(motion: Any) -> Motion:
            """The same of a motion."""
            vectors = (numpy.array(vector) for vector in (motion.translation, motion.rotation, motion.reference))
            return Motion(Query.pose_of(motion.pose), *vectors)

        def __init__(self, a: Any, b: Any, settings: Mapping[str, str]):
            mesh_a = mesh(a.vertices, a.triangles, name=a.name)
            mesh_b = mesh_a if b is a else mesh(b.vertices, b.triangles, name=b.name)
            try:
                prepared = instance(algorithm, mesh_a, mesh_b, settings)
            except BadMesh as e:
                raise sixdof_rival.BadMesh(str(e)) from e
            except BadArgument as e:
                raise sixdof_rival.BadArgument(str(e)) from e
            for kind in answered(algorithm):
                setattr(self, kind, asked(prepared, kind))

    return Query
