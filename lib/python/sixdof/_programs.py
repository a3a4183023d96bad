"""The programs sixdof and sixdof-bench, and the data that come with them."""

from __future__ import annotations

import os
import pathlib
import shutil
import sys

from . import _core
from ._errors import Error

# Where they are: in the installed package, or beside the folder of the package in a build.
_PACKAGE = pathlib.Path(_core.__file__).parent
_ROOTS = (_PACKAGE, _PACKAGE.parents[1])


def program(name: str) -> str:
    """The path of a program. Raises Error where it is not installed."""
    for root in _ROOTS:
        if os.access(root / "bin" / name, os.X_OK):
            return str(root / "bin" / name)
    found = shutil.which(name)
    if found is None:
        raise Error(f"{name}: not found in {_PACKAGE / 'bin'}, nor on the PATH")
    return found


def use_data() -> None:
    """Tells the library where sets and models are; SIXDOF_DATA names another folder."""
    for root in _ROOTS:
        folder = root / "share" / "sixdof"
        if folder.is_dir():
            _core.set_data_folder(str(folder))
            return


def run_sixdof() -> None:
    """Becomes the program sixdof: a console script of the wheel."""
    os.execv(program("sixdof"), ["sixdof", *sys.argv[1:]])


def run_sixdof_bench() -> None:
    """Becomes the program sixdof-bench."""
    os.execv(program("sixdof-bench"), ["sixdof-bench", *sys.argv[1:]])
