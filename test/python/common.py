"""What the tests of the Python package share."""

import os
import sys
import unittest

MISSING = 77  # ctest: skipped

try:
    import numpy
    import sixdof
except ImportError as e:
    print(f"skipped: {e}", file=sys.stderr)
    sys.exit(MISSING)


def random_poses(count, size, seed=1):
    """Generic poses: uniform rotations, translations of about `size`."""
    draw = numpy.random.default_rng(seed)
    quaternions = draw.normal(size=(count, 4))
    quaternions /= numpy.linalg.norm(quaternions, axis=1, keepdims=True)
    return sixdof.pose(quaternions, size * draw.normal(size=(count, 3)))


def environment():
    """For programs that import the package."""
    return os.environ | {"PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}


def arguments(count):
    """Takes arguments of the test from the command line."""
    given = sys.argv[1:1 + count]
    del sys.argv[1:1 + count]
    return given if count > 1 else given[0]


main = unittest.main
