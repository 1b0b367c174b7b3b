#!/usr/bin/python3
"""Writes scan.vdb: what a CT scanner would make of a head of ellipsoids, in Hounsfield units.

    examples/scenes/scan.py [SCAN.vdb]

Air is -1000, tissue about 40, bone 900. Slices are 2 mm apart, pixels 1 mm wide, the stack leans by
12 degrees as under a tilted gantry, and there is noise. Values are shifted so that air is 0, the
background of a grid. Needs Debian's python3-numpy and python3-openvdb.
"""

import sys

import numpy as np
import pyopenvdb as vdb

WIDTH, SLICES = 200, 110
PIXEL, SLICE = 1.0, 2.0  # mm
AIR = -1000


def ellipsoid(place, center, radii, turn=0.0):
    """Below 0 inside, in about mm near the surface."""
    x, y, z = (p - c for p, c in zip(place, center))
    c, s = np.cos(turn), np.sin(turn)
    x, y = c * x + s * y, -s * x + c * y
    r = np.sqrt((x / radii[0]) ** 2 + (y / radii[1]) ** 2 + (z / radii[2]) ** 2)
    return (r - 1) * min(radii)


def main():
    rng = np.random.RandomState(3)
    i = (np.arange(WIDTH) - (WIDTH - 1) / 2) * PIXEL
    k = (np.arange(SLICES) - (SLICES - 1) / 2) * SLICE
    place = np.meshgrid(i, i, k, indexing="ij")

    def solid(distance):
        # A detector sees a millimetre at a time.
        return np.clip(0.5 - distance / 1.5, 0, 1)

    skin = solid(ellipsoid(place, (0, 0, 0), (74, 88, 96)))
    skull = solid(np.maximum(ellipsoid(place, (0, 2, 4), (66, 79, 86)),
                             -ellipsoid(place, (0, 2, 4), (59, 72, 79))))
    eyes = np.maximum(*(solid(ellipsoid(place, (side * 28, 70, 6), (14, 20, 12)))
                        for side in (-1, 1)))
    nose = solid(ellipsoid(place, (0, 76, -22), (9, 20, 15)))
    mouth = solid(ellipsoid(place, (0, 70, -52), (26, 26, 7)))
    jaw = solid(np.maximum(ellipsoid(place, (0, 34, -56), (46, 44, 26)),
                           -ellipsoid(place, (0, 24, -48), (40, 42, 26))))
    bone = np.maximum(skull, jaw) * (1 - eyes) * (1 - nose) * (1 - mouth)
    units = AIR + skin * (40 - AIR) + bone * (900 - 40)
    units += rng.normal(0, 12, units.shape)
    grid = vdb.FloatGrid()
    grid.copyFromArray(np.maximum(units - AIR, 0).astype(np.float32), tolerance=60)
    grid.name = "density"
    lean = np.tan(np.radians(12)) * SLICE
    grid.transform = vdb.createLinearTransform([[PIXEL, 0, 0, 0], [0, PIXEL, 0, 0],
                                                [0, lean, SLICE, 0], [0, 0, 0, 1]])
    vdb.write(sys.argv[1] if len(sys.argv) > 1 else "scan.vdb", grids=[grid])


if __name__ == "__main__":
    main()
