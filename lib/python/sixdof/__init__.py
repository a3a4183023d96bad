"""sixdof: exact distances, overlaps and contact forces of triangle meshes, and benchmarks of those who compute them.

    import sixdof
    a, b = sixdof.load("tool.stl"), sixdof.load("part.obj")
    q = sixdof.prepare("exact", a, b)
    d = q.distance(poses)  # poses (n, 4, 4) -> d.distance (n,), d.points_a (n, 3), d.ok (n,)
    w = q.respond(poses)   # w.volume (n,), w.force (n, 3), w.torque (n, 3)
    c = q.cast(poses, translation=[0, 0, -2], rotation=[0, 1, 0])  # c.hit (n,), c.t (n,): when B first touches A

Conventions: A is fixed, B moves. A pose maps points of B's mesh frame to A's mesh frame. Points, forces and torques are
in A's frame, lengths in the meshes' unit.
"""

import numpy as _numpy

from . import _core
from ._errors import BadArgument, BadFile, BadMesh, BenchFailed, Error, FailedQueries
from ._programs import use_data as _use_data

if not _core.takes_numpy_2 and int(_numpy.__version__.partition(".")[0]) >= 2:
    raise ImportError(f"this build of sixdof takes NumPy 1 only, not {_numpy.__version__}: it was made with pybind11 before "
                      "2.12; `pip install .` makes one that takes both")
_use_data()
__version__ = _core.version

from ._algorithm import Algorithm, NoAnswer, parameter  # noqa: E402
from ._answers import Collisions, Distances, Impacts, Responses  # noqa: E402
from ._bench import bench  # noqa: E402
from ._meshes import Mesh, load, mesh  # noqa: E402
from ._motions import Motion  # noqa: E402
from ._poses import pose  # noqa: E402
from ._queries import AlgorithmInfo, Pair, algorithms, prepare  # noqa: E402
from ._results import Results, read_context, read_results, read_rows  # noqa: E402
from ._scenes import (FrameAnswer, Scene, load_scene, make_scene, scene, scene_algorithms,  # noqa: E402
                      scene_families)
from ._sets import Bucket, ConfigurationSet, Poses, catalogue, load_set  # noqa: E402
from ._signals import Signals, read_signals, record, scenarios  # noqa: E402

__all__ = [
    "Algorithm", "AlgorithmInfo", "BadArgument", "BadFile", "BadMesh", "BenchFailed", "Bucket", "Collisions",
    "ConfigurationSet", "Distances", "Error", "FailedQueries", "FrameAnswer", "Impacts", "Mesh", "Motion", "NoAnswer", "Pair", "Poses",
    "Responses", "Results", "Scene", "Signals", "algorithms", "bench", "catalogue", "load", "load_scene", "load_set",
    "make_scene", "mesh", "parameter", "pose", "prepare", "read_context", "read_results", "read_rows", "read_signals",
    "record", "scenarios", "scene", "scene_algorithms", "scene_families",
]
