"""Meshes: from files, models and arrays."""

from __future__ import annotations

import os
from typing import Any

import numpy

from . import _core
from ._core import Mesh
from ._errors import BadArgument, BadFile, BadMesh

__all__ = ["Mesh", "load", "mesh"]


def load(name_or_file: str | os.PathLike[str]) -> Mesh:
    """Reads a mesh from a file, or makes or reads a model by its name.

    A string with a "." or a "/" names a file (PLY, OBJ, STL, OFF, glTF, 3DS, COLLADA, FBX and others); other strings
    name models: "torus-1k" is made, "elephant" must have been fetched (`sixdof models list`). A pathlib.Path is a file.

    Coordinates keep the file's length unit and axes (COLLADA is scaled to metres).
    Raises BadFile, naming the file and the place in it, or BadArgument for an unknown model.
    """
    if isinstance(name_or_file, os.PathLike):
        path = os.fspath(name_or_file)
        name_or_file = path if os.sep in path else os.path.join(os.curdir, path)
    if not isinstance(name_or_file, str):
        raise BadArgument(f"name_or_file: {type(name_or_file).__name__} is neither text nor a path")
    return _core.load(name_or_file)


def mesh(vertices: Any, triangles: Any = None, *, name: str = "") -> Mesh:
    """A mesh from arrays, or from an object that has them.

    vertices: float array of shape (n, 3), in any length unit, or an object with the attributes `vertices` and `faces`
    (or `triangles`), such as trimesh.Trimesh. triangles: integer array of shape (m, 3) of vertex indices,
    counter-clockwise seen from outside. name: shown in messages and tables.

    Vertices with equal coordinates are welded, vertices without a triangle and triangles with a repeated vertex
    dropped, so the arrays of the mesh may be shorter. The data are copied.
    Raises BadMesh, naming the argument and the element.
    """
    if triangles is None:
        for attribute in ("faces", "triangles"):
            if hasattr(vertices, "vertices") and hasattr(vertices, attribute):
                return mesh(vertices.vertices, getattr(vertices, attribute), name=name)
        raise BadArgument("triangles: missing, and `vertices` is no object with `vertices` and `faces`")
    points = _array(vertices, "vertices", "fiu")
    faces = _array(triangles, "triangles", "iu")
    return _core.build_mesh(points.astype(numpy.float64), faces.astype(numpy.int64), name)


def named_mesh(vertices: Any, triangles: Any, name: str) -> Mesh:
    """mesh() as pickle calls it."""
    return mesh(vertices, triangles, name=name)


def _array(values: Any, argument: str, kinds: str) -> numpy.ndarray:
    """The values as an array of shape (n, 3) whose type is of these kinds."""
    try:
        array = numpy.asarray(values)
    except ValueError as e:
        raise BadMesh(f"{argument}: {e}") from None
    if array.ndim != 2 or array.shape[1] != 3:
        raise BadMesh(f"{argument}: the shape is {array.shape}, not (n, 3)")
    if array.dtype.kind not in kinds:
        wanted = "integers" if kinds == "iu" else "numbers"
        raise BadMesh(f"{argument}: the type is {array.dtype}, not {wanted}")
    return array


def as_mesh(value: Any, argument: str) -> Mesh:
    """A mesh of what a user passed as one: a mesh, an object with arrays, a name or a file."""
    if isinstance(value, Mesh):
        return value
    try:
        if isinstance(value, (str, os.PathLike)):
            return load(value)
        if hasattr(value, "vertices"):
            return mesh(value)
    except (BadArgument, BadMesh, BadFile) as e:
        raise type(e)(f"{argument}: {e}") from None
    raise BadArgument(f"{argument}: {type(value).__name__} is no mesh, no name or file, and has no `vertices`")
