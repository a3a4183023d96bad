"""Errors. All derive from Error; those about values are ValueErrors, those about files OSErrors."""


class Error(Exception):
    """Root of all errors of this package."""


class BadArgument(Error, ValueError):
    """An argument that cannot be used; the message names it."""


class BadMesh(Error, ValueError):
    """Geometry that cannot be used: an index out of range, a surface with a border where a closed one is needed."""


class BadFile(Error, OSError):
    """A file that cannot be read or written; the message is "FILE: PLACE: CAUSE" or "FILE: CAUSE"."""


class BenchFailed(Error):
    """sixdof-bench ended with an error; the message has what it said."""


class FailedQueries(UserWarning):
    """Some poses have no answer: their values are masked, and `words` of the answers says why. Or rows could not be run:
    their `error` says why."""
