#!/usr/bin/env python3
"""Draws the figures of docs/fit.md: the bump of the paper, what is made of it, and its levels.

    draw.py BANDVOX FOLDER"""

import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np
from scipy.interpolate import CloughTocher2DInterpolator

import run

SIDE = 101
SCALE = 3


def png(path, picture):
    rows = b"".join(b"\0" + row.tobytes() for row in picture)
    header = struct.pack(">IIBBBBB", picture.shape[1], picture.shape[0], 8, 0, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, data in (b"IHDR", header), (b"IDAT", zlib.compress(rows, 9)), (b"IEND", b""):
            file.write(struct.pack(">I", len(data)) + kind + data)
            file.write(struct.pack(">I", zlib.crc32(kind + data)))


def shaded(surface):
    """Seen from above, lit from the left: shades of 101 x 101 normals, interpolated between them."""
    line = np.linspace(0.03, 0.97, SIDE)
    x, y = (a.ravel() for a in np.meshgrid(line, line, indexing="ij"))
    step = 1e-4

    def slope(dx, dy):
        ahead = surface(np.column_stack([x + dx, y + dy]))
        behind = surface(np.column_stack([x - dx, y - dy]))
        return (ahead - behind) / (2 * step)

    normal = np.stack([-slope(step, 0), -slope(0, step), np.ones_like(x)])
    normal /= np.linalg.norm(normal, axis=0)
    light = np.array([-0.75, 0.3, 0.6]) / np.linalg.norm([-0.75, 0.3, 0.6])
    shade = np.nan_to_num(np.clip(light @ normal, 0, 1)).reshape(SIDE, SIDE)
    fine = np.linspace(0, SIDE - 1, SCALE * (SIDE - 1))
    shade = np.stack([np.interp(fine, np.arange(SIDE), row) for row in shade])
    shade = np.stack([np.interp(fine, np.arange(SIDE), row) for row in shade.T])
    return (255 * shade[::-1] ** 0.8).astype(np.uint8)


def side_by_side(pictures):
    gap = np.full((pictures[0].shape[0], 8), 255, np.uint8)
    parts = [part for picture in pictures for part in (gap, picture)]
    return np.hstack(parts[1:])


def terrain(x, y):
    """Hills and a valley that winds."""
    valley = y - 0.5 - 0.15 * np.sin(7 * x)
    hills = np.sin(9 * x + 4 * y) * np.cos(11 * y - 3 * x) + 0.4 * np.sin(21 * x) * np.sin(17 * y)
    return 0.08 * hills - 0.25 * np.exp(-40 * valley**2)


def contour_points(function, lines=12, side=160):
    """Places where contour lines cross the lines of a grid, as a map that was digitised has them."""
    line = np.linspace(0, 1, side)
    heights = function(*np.meshgrid(line, line, indexing="ij"))
    found = []
    for level in np.linspace(heights.min(), heights.max(), lines + 2)[1:-1]:
        for i, j in np.argwhere((heights[:-1] < level) != (heights[1:] < level)):
            part = (level - heights[i, j]) / (heights[i + 1, j] - heights[i, j])
            found.append([line[i] + part / (side - 1), line[j], level])
    return np.array(found)


def main():
    command, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    # The corners are known as well, so that all see the whole square.
    points = np.vstack([np.random.RandomState(0).random_sample((96, 2)),
                        [[0, 0], [0, 1], [1, 0], [1, 1]]])  # fmt: skip
    values = run.bump(*points.T)
    with tempfile.TemporaryDirectory() as temporary:
        bandvox = run.Bandvox(command, pathlib.Path(temporary))
        ours = bandvox.fit(points, values)
        theirs = CloughTocher2DInterpolator(points, values, tol=1e-12, maxiter=5000)
        figures = [lambda places: run.bump(*places.T), theirs, ours]
        png(folder / "fit-bump.png", side_by_side([shaded(figure) for figure in figures]))
        levels = [bandvox.fit(points, values, f"1..{last}") for last in (1, 2, 3, 4)]
        known = contour_points(terrain)
        made = bandvox.fit(known[:, :2], known[:, 2], tolerance="1e-4")
        places = np.full((SCALE * (SIDE - 1),) * 2, 255, np.uint8)
        pixels = np.clip((known[:, :2] - 0.03) / 0.94 * places.shape[0], 0, places.shape[0] - 1)
        places[places.shape[0] - 1 - pixels[:, 1].astype(int), pixels[:, 0].astype(int)] = 0
        truth = shaded(lambda at: terrain(*at.T))
        png(folder / "fit-terrain.png", side_by_side([places, shaded(made), truth]))
        print(f"terrain: {len(known)} places")
        png(folder / "fit-levels.png", side_by_side([shaded(level) for level in levels]))


if __name__ == "__main__":
    main()
