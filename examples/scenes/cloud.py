#!/usr/bin/python3
"""Writes cloud.vdb: a cumulus of a few balls whose rim is broken up by noise, as fog.

    examples/scenes/cloud.py [CLOUD.vdb]

Needs Debian's python3-numpy and python3-openvdb.
"""

import sys

import numpy as np
import pyopenvdb as vdb

SIDE = 160  # voxels
SEED = 7


def noise(rng, octaves):
    """Sums of smooth random fields, each twice as fine and half as strong as the one before."""
    total = np.zeros((SIDE, SIDE, SIDE), np.float32)
    frequency = np.fft.fftfreq(SIDE)[:, None, None] ** 2
    frequency = frequency + np.fft.fftfreq(SIDE)[None, :, None] ** 2
    frequency = frequency + np.fft.rfftfreq(SIDE)[None, None, :] ** 2
    for octave in range(octaves):
        center = 2.0 ** octave * 3 / SIDE
        band = np.exp(-((np.sqrt(frequency) - center) / (0.4 * center)) ** 2)
        field = np.fft.irfftn(np.fft.rfftn(rng.standard_normal(total.shape)) * band, total.shape)
        total += (field / field.std() * 0.55 ** octave).astype(np.float32)
    return total


def main():
    rng = np.random.RandomState(SEED)
    axis = (np.arange(SIDE) + 0.5) / SIDE * 2 - 1
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    distance = np.full(x.shape, np.inf)
    for cx, cy, cz, radius in [(-0.35, -0.2, 0, 0.38), (0.1, 0, 0.05, 0.48), (0.48, -0.22, -0.05, 0.33),
                               (-0.1, -0.25, 0.35, 0.3), (-0.02, 0.3, -0.1, 0.28)]:
        distance = np.minimum(distance,
                              np.sqrt((x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2) - radius)
    # A flat underside, as where the air reaches the dew point.
    distance = np.maximum(distance, -0.42 - y)
    density = np.clip((0.09 * noise(rng, 5) - distance) / 0.12, 0, 1)
    grid = vdb.FloatGrid()
    grid.copyFromArray(density.astype(np.float32), tolerance=1e-3)
    grid.name = "density"
    grid.gridClass = vdb.GridClass.FOG_VOLUME
    grid.transform = vdb.createLinearTransform(voxelSize=2.0 / SIDE)
    vdb.write(sys.argv[1] if len(sys.argv) > 1 else "cloud.vdb", grids=[grid])


if __name__ == "__main__":
    main()
