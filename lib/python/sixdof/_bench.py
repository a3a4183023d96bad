"""Measures algorithms by the program sixdof-bench."""

from __future__ import annotations

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import warnings
import weakref
from typing import Any, Iterable, Mapping, Sequence

from . import _core
from ._algorithm import Algorithm, check, name_of
from ._errors import BadArgument, BenchFailed, FailedQueries
from ._meshes import Mesh, as_mesh
from ._programs import program
from ._queries import text_of
from ._results import Results, read_rows
from ._serve import write

QUERIES = ("prepare", "collide", "distance", "respond")
CAST = "cast"  # Measured where it is asked for: it has rows for each kind and length of motion.


def bench(algorithms: Any, pairs: Sequence[Any], *, queries: Iterable[str] = QUERIES,
          buckets: Iterable[str] | None = None, against: Iterable[str] = ("exact",), sample: int = 256,
          budget: float = 60.0, seed: int = 1, parameters: Mapping[str, Mapping[str, Any]] | None = None,
          manifest: str | os.PathLike[str] | None = None, out: str | os.PathLike[str] | None = None,
          options: Sequence[str] = (), verbose: bool = False) -> Results:
    """Measures algorithms on pairs: times, failures, wrong answers and errors against the truth.

    algorithms: a class derived from sixdof.Algorithm, a name, or a list of these. pairs: names of pairs of the
    catalogue (sixdof.catalogue()), or tuples (a, b) of what prepare() takes as meshes; of such a pair a coarse set is
    made first. queries: of prepare, collide, distance, respond, cast. buckets: such as "distance/05"; all if None. against:
    names of algorithms that are measured as well. sample: poses of a bucket at most; 0: all. budget: seconds for all
    rows. seed: of the poses that are drawn. parameters: values by algorithm and parameter, {"ist": {"spheres": 500}}.
    manifest: another catalogue of sets. out: a folder for the result files, the classes and the meshes that they name;
    without it these live as long as what is returned. options: further words for sixdof-bench. verbose: let sixdof-bench print.

    Each class runs in processes of its own, which get it by cloudpickle: it may be defined in a script, a module or a
    notebook, and use what can be pickled. Queries are timed inside, from the pose to the answer; rows have the time of
    a method that does nothing as empty_call_ns.

    A row that cannot be run, such as one without any answer, has an `error` and costs a warning (FailedQueries).
    Raises BenchFailed with the words of sixdof-bench, BadArgument naming the argument.
    """
    given = list(algorithms) if isinstance(algorithms, (list, tuple)) else [algorithms]
    with_names = [each if isinstance(each, str) else check(each) for each in given]
    known = set(_word_list(queries, "queries"))
    if not known <= {*QUERIES, CAST}:
        raise BadArgument(f"queries: {', '.join(sorted(known - {*QUERIES, CAST}))}: none of {', '.join((*QUERIES, CAST))}")
    if isinstance(pairs, str) or not pairs:
        raise BadArgument("pairs: a list of names of pairs or of tuples (a, b) is needed")
    folder = pathlib.Path(tempfile.mkdtemp(prefix="sixdof-") if out is None else out).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    names = list(dict.fromkeys(each if isinstance(each, str) else name_of(each) for each in [*with_names, *against]))
    measured = Results([])
    if out is None:
        weakref.finalize(measured, shutil.rmtree, folder, ignore_errors=True)
    words = ["--suite", "all", "--sample", str(sample), "--seed", str(seed), *_parameters(parameters or {}), *options]
    words += _externals([each for each in with_names if not isinstance(each, str)], folder)
    runs = list(_runs(pairs, folder, manifest))
    for place, (pair_words, pair_names) in enumerate(runs):
        file = folder / ("results.json" if len(runs) == 1 else f"results-{place}.json")
        row_filter = _filter(known, names, pair_names, buckets)
        file.unlink(missing_ok=True)
        _run([program("sixdof-bench"), *pair_words, *words, "--budget", str(budget / len(runs)), "--out", str(file),
              f"--benchmark_filter={row_filter}"], file, verbose)
        measured.files.append(str(file))
    return measured


def _word_list(values: Iterable[str], argument: str) -> list[str]:
    if isinstance(values, str):
        raise BadArgument(f"{argument}: a list of words is needed, not \"{values}\"")
    return list(values)


def _externals(classes: list[type[Algorithm]], folder: pathlib.Path) -> list[str]:
    """The options that add the classes."""
    words, taken = [], set(_core_names())
    for algorithm in classes:
        name = name_of(algorithm)
        if name in taken:
            raise BadArgument(f"algorithm: the name {name} of {algorithm.__name__} is taken; set its attribute `name`")
        taken.add(name)
        words += ["--external", f"{name}={write(algorithm, folder / f'{name}.class')}"]
    return words


def _core_names() -> list[str]:
    """Names that no class may have; those of rivals may be replaced."""
    return [each["name"] for each in _core.algorithms() if not each["runtime"]]


def _parameters(parameters: Mapping[str, Mapping[str, Any]]) -> list[str]:
    return [word for algorithm, values in parameters.items() for name, value in values.items()
            for word in ("-p", f"{algorithm}:{name}={text_of(value)}")]


def _runs(pairs: Sequence[Any], folder: pathlib.Path, manifest: Any) -> Iterable[tuple[list[str], list[str]]]:
    """Words for sixdof-bench and names of pairs, for every run: one of the catalogue's pairs, one of each other."""
    in_catalogue = [pair for pair in pairs if isinstance(pair, str)]
    if in_catalogue:
        have = {entry["pair"] for entry in _core.catalogue("" if manifest is None else os.fspath(manifest))}
        for pair in in_catalogue:
            if pair not in have:
                raise BadArgument(f"pairs: no pair {pair}; the catalogue has {', '.join(sorted(have))}")
        yield [] if manifest is None else ["--manifest", os.fspath(manifest)], in_catalogue
    for place, pair in enumerate(pairs):
        if isinstance(pair, str):
            continue
        if not (isinstance(pair, (tuple, list)) and len(pair) == 2):
            raise BadArgument(f"pairs[{place}]: neither the name of a pair nor a tuple (a, b)")
        a, b = (_mesh_word(mesh, f"pairs[{place}]", folder / f"pair-{place}-{side}") for mesh, side in zip(pair, "ab"))
        yield ["--a", a, "--b", b], []


def _mesh_word(value: Any, argument: str, folder: pathlib.Path) -> str:
    """How the command line names a mesh: its file or model, or a file that is written."""
    if isinstance(value, str):
        as_mesh(value, argument)  # says what is wrong with it
        return value
    mesh: Mesh = as_mesh(value, argument)
    folder.mkdir(exist_ok=True)
    file = folder / (re.sub(r"[^A-Za-z0-9_-]+", "-", mesh.name).strip("-") or "mesh")
    mesh.save(f"{file}.ply")
    return f"{file}.ply"


def _filter(queries: set[str], algorithms: list[str], pairs: list[str], buckets: Iterable[str] | None) -> str:
    """An expression that matches the names of the wanted rows: QUERY/algorithm:NAME/pair:NAME[/BUCKET]. Casts begin at
    one bucket, contact, whatever buckets are wanted."""
    def any_of(names: Iterable[str]) -> str:
        return "(" + "|".join(names) + ")"

    pair = any_of(pairs) if pairs else "[^/]+"
    places = "[^/]+" if buckets is None else any_of(name.replace("/", ":") for name in _word_list(buckets, "buckets"))
    parts = [f"prepare/algorithm:{any_of(algorithms)}/pair:{pair}"] if "prepare" in queries else []
    asked = [query for query in QUERIES[1:] if query in queries]
    if asked:
        parts.append(f"{any_of(asked)}/algorithm:{any_of(algorithms)}/pair:{pair}/{places}")
    if CAST in queries:
        parts.append(f"{CAST}/algorithm:{any_of(algorithms)}/pair:{pair}/motion:[a-z]+/step:[0-9.]+")
    return f"^{any_of(parts)}$"


def _run(command: list[str], file: pathlib.Path, verbose: bool) -> None:
    done = subprocess.run(command, stdout=None if verbose else subprocess.DEVNULL,
                          stderr=None if verbose else subprocess.PIPE, text=True, check=False)
    if done.returncode == 130:
        raise KeyboardInterrupt
    if done.returncode == 1 and file.exists():  # rows that could not be run have their errors
        errors = [f"{row['name']}: {row['error']}" for row in read_rows(file) if row["error"]]
        warnings.warn(f"{len(errors)} rows could not be run: {errors[0] if errors else ''}", FailedQueries, stacklevel=3)
    elif done.returncode != 0:
        raise BenchFailed(f"sixdof-bench ended with exit code {done.returncode}: {(done.stderr or '').strip()[-2000:]}")
