#!/usr/bin/env python3
"""Solids of points with normals in two ways: what `bandvox convert` makes of them, and the plain sum
over the points as quadrature points of the surface, M. Kazhdan, "Reconstruction of Solid Models from
Oriented Point Sets" (2005): the density is the field whose gradient is the sum of the normals, each
times the area that its point stands for, solved by FFT. Errors of the enclosed volume for balls and
tori, from random points, with noise and without. Needs NumPy, SciPy and pyopenvdb.

    run.py BANDVOX"""

import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy.spatial import cKDTree

VOXEL = 0.02
NEIGHBOURS = 12


def ball(count, random):
    normal = random.standard_normal((count, 3))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return normal, normal, 4 / 3 * np.pi


def torus(count, random, radius=0.75, tube=0.25):
    places, normals = [], []
    while len(places) < count:
        u, v, w = random.random_sample(3) * [2 * np.pi, 2 * np.pi, 1]
        # As many as the surface has area there.
        if w > (radius + tube * np.cos(v)) / (radius + tube):
            continue
        normal = [np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)]
        normals.append(normal)
        places.append([radius * np.cos(u), radius * np.sin(u), 0] + tube * np.array(normal))
    return np.array(places), np.array(normals), 2 * np.pi**2 * radius * tube**2


def areas(points):
    """What each point stands for: a share of the disc that holds its nearest ones."""
    distances, _ = cKDTree(points).query(points, k=NEIGHBOURS + 1)
    # The disc through the last of them holds it by half.
    return np.pi * distances[:, -1] ** 2 / (NEIGHBOURS + 0.5)


def summed_volume(points, normals):
    """The volume of {density > its mean at the points}, on cubic voxels."""
    spacing = np.sqrt(areas(points).mean())
    side = 1.6
    count = 2 * int(np.ceil(side / VOXEL))
    weights = areas(points)[:, None] * normals
    at = (points + side) / VOXEL
    cell = np.floor(at).astype(int)
    field = np.zeros((3, count, count, count))
    for corner in np.ndindex(2, 2, 2):
        share = np.prod(np.where(corner, at - cell, 1 - at + cell), axis=1)
        index = tuple((cell + corner).T)
        for axis in range(3):
            np.add.at(field[axis], index, share * weights[:, axis])
    frequency = 2 * np.pi * np.fft.fftfreq(count, VOXEL)
    half = 2 * np.pi * np.fft.rfftfreq(count, VOXEL)
    k = np.meshgrid(frequency, frequency, half, indexing="ij")
    square = k[0] ** 2 + k[1] ** 2 + k[2] ** 2
    square[0, 0, 0] = 1
    # Wide enough that a point's neighbours are seen.
    sigma = max(1.5 * VOXEL, 1.5 * spacing)
    spectrum = sum(1j * k[axis] * np.fft.rfftn(field[axis]) for axis in range(3)) / square
    spectrum *= np.exp(-square * sigma**2 / 2) / VOXEL**3
    spectrum[0, 0, 0] = 0
    density = np.fft.irfftn(spectrum, s=(count,) * 3)
    level = 0.0
    for corner in np.ndindex(2, 2, 2):
        share = np.prod(np.where(corner, at - cell, 1 - at + cell), axis=1)
        level += np.mean(share * density[tuple((cell + corner).T)])
    return level_volume(density, level)


def level_volume(density, level):
    """What is above a level, with the slope taken into account at the border."""
    slope = np.sqrt(sum(g**2 for g in np.gradient(density)))
    share = 0.5 + (density - level) / np.maximum(slope, 1e-12)
    return np.clip(share, 0, 1).sum() * VOXEL**3


def converted_volume(command, folder, points, normals):
    table, grid, statistics = folder / "points.csv", folder / "solid.vdb", folder / "stats.json"
    np.savetxt(table, np.hstack([points, normals]), delimiter=",", comments="",
               header="x,y,z,nx,ny,nz")  # fmt: skip
    subprocess.run([command, "convert", table, "-o", grid, "--voxel-size", str(VOXEL), "--quiet",
                    "--stats", statistics], check=True)  # fmt: skip
    return json.loads(statistics.read_text())


def main():
    command = sys.argv[1]
    print("shape, points, noise: error of the volume, bandvox convert and plain sum")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for shape in ball, torus:
            for count in 5000, 20000, 100000:
                for noise in 0.0, 0.01:
                    random = np.random.RandomState(7)
                    points, normals, volume = shape(count, random)
                    points = points + 2 * noise * random.standard_normal(points.shape)
                    ours = converted_volume(command, folder, points, normals)
                    found = ours["counts"]["grid_volume"]
                    plain = summed_volume(points, normals)
                    print(f"{shape.__name__} {count} {noise}: {found / volume - 1:+.2%} "
                          f"{plain / volume - 1:+.2%}", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
