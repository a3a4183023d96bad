"""The program that answers sixdof-bench for a class of the user's: one process for every pair.

The class comes in a file that cloudpickle wrote: classes of scripts and notebooks by their code, those of modules by
their names. So it works wherever the class was defined, and runs no statement of the script again.
"""

from __future__ import annotations

import os
import pathlib
import pickle
import shlex
import sys

import cloudpickle

from . import sixdof_rival
from ._algorithm import Algorithm, greeting, served
from ._errors import BadArgument


def write(algorithm: type[Algorithm], file: pathlib.Path) -> str:
    """Writes the class to a file, and returns the command line of its program.

    Raises BadArgument where the class uses something that cannot be written, such as an open file or a prepared pair.
    """
    try:
        data = cloudpickle.dumps(algorithm)
    except Exception as e:  # of any type: whatever the objects that it uses raise
        words = f"{type(e).__name__}: {e}"
        raise BadArgument(f"algorithm: {algorithm.__name__} uses something that another process cannot get: {words}; "
                          "make it in prepare()") from e
    file.write_bytes(pickle.dumps([os.getcwd() if path == "" else path for path in sys.path]) + data)
    package = str(pathlib.Path(__file__).parent.parent)
    code = f"import sys; sys.path.insert(0, {package!r}); from sixdof._serve import main; main({str(file)!r})"
    return shlex.join([sys.executable, "-c", code])


def main(path: str) -> None:
    """Serves the class of a file until standard input ends."""
    replies = os.dup(1)
    os.dup2(2, 1)  # what the user's modules print while they are loaded is no reply
    with open(path, "rb") as file:
        sys.path[:] = pickle.load(file)
        algorithm = pickle.load(file)
    sys.stdout.flush()
    os.dup2(replies, 1)
    os.close(replies)
    sixdof_rival.serve(served(algorithm), **greeting(algorithm))
