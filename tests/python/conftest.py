"""Tests of the Python package, which lies in the build folder: PYTHONPATH says where."""

import numpy as np
import pytest

import bandvox


@pytest.fixture(scope="session")
def torus():
    return bandvox.bandlimit("shape:torus", resolution=48)


@pytest.fixture(scope="session")
def cube():
    """A cube of side 2 around the origin: points and triangles."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))]
    return corners, np.array(triangles)
