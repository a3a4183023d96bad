"""Results: rows of sixdof-bench and of the studies, as tables."""

from __future__ import annotations

import os
import subprocess
from typing import Any

from . import _core
from ._errors import BenchFailed, Error
from ._programs import program


def read_rows(*files: str | os.PathLike[str]) -> list[dict[str, Any]]:
    """Rows of result files, or of all result files in a folder: one dict for each.

    Keys: name, query, algorithm, settings, pair, bucket ("distance/05"), bucket_kind, percent, scenario, order, cache,
    isolated, approximates, class (empty, or why the row is ranked apart), configurations, label, error, file (index of
    the file); the means processor_mean_ns and wall_mean_ns; and each counter by its name (`sixdof table --help`).
    A row with an error has no counters. Raises BadFile, naming the file.
    """
    return _core.read_results([os.fspath(file) for file in files])[0]


def read_results(*files: str | os.PathLike[str]) -> Any:
    """The same as a pandas.DataFrame; a counter that a row does not have is missing (NaN) there. Needs pandas."""
    return frame_of(read_rows(*files))


def read_context(file: str | os.PathLike[str]) -> dict[str, str]:
    """What a result file says of its run: machine, versions, settings."""
    return _core.read_results([os.fspath(file)])[1][0]["context"]


def frame_of(rows: Any) -> Any:
    """A DataFrame of rows or columns."""
    try:
        import pandas
    except ImportError:
        raise Error("a DataFrame needs pandas, which is not installed; read_rows() works without it") from None
    return pandas.DataFrame(rows)


class Results:
    """What sixdof.bench() measured."""

    files: list[str]  #: The result files, which `sixdof table`, `report` and `compare` read.

    def __init__(self, files: list[str]):
        self.files = files

    @property
    def rows(self) -> list[dict[str, Any]]:
        """As read_rows() gives them."""
        return read_rows(*self.files)

    def frame(self) -> Any:
        """As read_results() gives it."""
        return read_results(*self.files)

    def table(self, *words: str) -> str:
        """The text of `sixdof table`; words: its options, such as "--overview"."""
        done = subprocess.run([program("sixdof"), "table", *self.files, *words], capture_output=True, text=True,
                              check=False)
        if done.returncode != 0:
            raise BenchFailed(done.stderr.strip())
        return done.stdout

    def __str__(self) -> str:
        return self.table()

    def __repr__(self) -> str:
        return f"<Results: {len(self.rows)} rows of {', '.join(self.files)}>"

    def _repr_html_(self) -> str:
        import html
        return f"<pre>{html.escape(self.table())}</pre>"
