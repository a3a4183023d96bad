"""Signals of scenarios: forces along a path of one body into another, and what they should be."""

from __future__ import annotations

import os
from typing import Any, Mapping

import numpy
from numpy.typing import NDArray

from . import _core
from ._answers import _STATUSES
from ._queries import text_of
from ._results import frame_of


class Signals:
    """A recorded response with its ideal, one row per step. Forces on B in A's frame; torques about the scenario's
    reference point. A step without an answer has ok False and, as a device would get, zero force and torque."""

    scenario: str  #: "Ia", "Ib", "II", "III" or "IV".
    law: str  #: Of the ideal.
    algorithm: str
    version: str  #: Of the algorithm.
    settings: str  #: Of the algorithm.
    rate_hz: float  #: Steps per second.
    poses: NDArray[numpy.float64]  #: X_AB, shape (n, 4, 4).
    force: NDArray[numpy.float64]  #: Shape (n, 3).
    torque: NDArray[numpy.float64]  #: Shape (n, 3).
    ideal_force: NDArray[numpy.float64]  #: Shape (n, 3).
    ideal_torque: NDArray[numpy.float64]  #: Shape (n, 3).
    measures: dict[str, float]  #: sigma_F, gamma_F_deg, ... (`sixdof quality`); empty for signals of a file.
    status: NDArray[numpy.object_]  #: "ok", "failed", ..., shape (n,).
    ok: NDArray[numpy.bool_]  #: Whether there is an answer, shape (n,).
    first_failure: str  #: Words of the first step without an answer; empty if there is none, and for a file.

    def __init__(self, raw: Mapping[str, Any]):
        self.measures, self.first_failure = {}, ""
        vars(self).update(raw)
        self.status = _STATUSES[raw["status"]]
        self.ok = numpy.asarray(raw["status"]) == 0
        self.time = numpy.arange(len(self.ok)) / self.rate_hz  #: Of each step in seconds, shape (n,).

    def frame(self) -> Any:
        """A pandas.DataFrame: time (s), ok, status, force_x, ..., ideal_torque_z."""
        columns = {"time": self.time, "ok": self.ok, "status": self.status}
        for name in ("force", "torque", "ideal_force", "ideal_torque"):
            for place, axis in enumerate("xyz"):
                columns[f"{name}_{axis}"] = getattr(self, name)[:, place]
        return frame_of(columns)

    def __repr__(self) -> str:
        return f"<Signals: {self.algorithm} in scenario {self.scenario}, {len(self.ok)} steps>"


def scenarios() -> list[str]:
    """Names of all scenarios."""
    return _core.scenarios()


def record(scenario: str, algorithm: str, *, steps: int = 1000, law: str = "own",
           shape: Mapping[str, Any] | None = None, out: str | os.PathLike[str] | None = None,
           **parameters: Any) -> Signals:
    """Asks an algorithm for its response along a scenario's path, as `sixdof quality` does.

    law: of the ideal: "own" is the algorithm's. shape: parameters of the scenario. out: a file for the signals, which
    read_signals() and `sixdof report` read. parameters: of the algorithm; `ist` has a finer resolution along the
    paper's paths than elsewhere, where neither `spheres` nor `spheres_b` is given.
    """
    return Signals(_core.record_signals(scenario, {name: text_of(value) for name, value in (shape or {}).items()},
                                        algorithm, {name: text_of(value) for name, value in parameters.items()},
                                        steps, law, "" if out is None else os.fspath(out)))


def read_signals(file: str | os.PathLike[str]) -> Signals:
    """Reads a file of record() or of `sixdof quality -o`. Raises BadFile, naming the file."""
    return Signals(_core.read_signals(os.fspath(file)))
