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


def sampled(surface):
    """Heights and unit normals of 101 x 101 places a little inside the square, [x][y]."""
    line = np.linspace(0.03, 0.97, SIDE)
    x, y = (a.ravel() for a in np.meshgrid(line, line, indexing="ij"))
    step = 1e-4

    def slope(dx, dy):
        ahead = surface(np.column_stack([x + dx, y + dy]))
        behind = surface(np.column_stack([x - dx, y - dy]))
        return (ahead - behind) / (2 * step)

    normal = np.stack([-slope(step, 0), -slope(0, step), np.ones_like(x)])
    normal /= np.linalg.norm(normal, axis=0)
    places = np.stack([x, y, surface(np.column_stack([x, y]))])
    return places.reshape(3, SIDE, SIDE), normal.reshape(3, SIDE, SIDE)


def brightness(normal):
    """Of a matt surface that is lit from the left."""
    light = np.array([-0.75, 0.3, 0.6]) / np.linalg.norm([-0.75, 0.3, 0.6])
    return np.nan_to_num(np.clip(np.tensordot(light, normal, 1), 0, 1)) ** 0.8


def shaded(surface):
    """Seen from above: shades of 101 x 101 normals, interpolated between them."""
    shade = brightness(sampled(surface)[1])
    fine = np.linspace(0, SIDE - 1, SCALE * (SIDE - 1))
    shade = np.stack([np.interp(fine, np.arange(SIDE), row) for row in shade])
    shade = np.stack([np.interp(fine, np.arange(SIDE), row) for row in shade.T])
    return (255 * shade[::-1]).astype(np.uint8)


def seen_aslant(surface, width=SCALE * (SIDE - 1), height=170, samples=3):
    """Gouraud's shading of 2 x 100 x 100 triangles, in perspective, nearest last."""
    places, normal = sampled(surface)
    eye, target = np.array([-0.9, -1.5, 1.35]), np.array([0.5, 0.5, 0.02])
    ahead = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(ahead, [0, 0, 1])
    right /= np.linalg.norm(right)
    view = np.tensordot([right, np.cross(right, ahead), ahead],
                        places - eye[:, None, None], 1)  # fmt: skip
    w, h = width * samples, height * samples
    focal = 1.95 * w
    x, y = w / 2 + focal * view[0] / view[2], h / 2 - focal * view[1] / view[2]
    corners = np.stack([x, y, brightness(normal), view[2]])
    quads = [corners[:, :-1, :-1], corners[:, 1:, :-1], corners[:, 1:, 1:], corners[:, :-1, 1:]]
    triangles = np.concatenate([np.stack([quads[i].reshape(4, -1) for i in three])
                                for three in ((0, 1, 2), (0, 2, 3))], 2)  # fmt: skip
    picture = np.ones((h, w))
    for k in np.argsort(-triangles[:, 3].mean(0)):
        fill(picture, *triangles[:, :3, k].T)
    picture = picture.reshape(height, samples, width, samples).mean((1, 3))
    return np.round(255 * picture).astype(np.uint8)


def fill(picture, x, y, shade):
    """A triangle, by its corners, with shades that are linear across it."""
    (left, top), (right, bottom) = np.floor([x.min(), y.min()]), np.ceil([x.max(), y.max()]) + 1
    left, top = max(int(left), 0), max(int(top), 0)
    at_x, at_y = np.meshgrid(np.arange(left, min(int(right), picture.shape[1])),
                             np.arange(top, min(int(bottom), picture.shape[0])))  # fmt: skip
    area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
    if area == 0 or at_x.size == 0:
        return
    b = ((at_x - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (at_y - y[0])) / area
    c = ((x[1] - x[0]) * (at_y - y[0]) - (at_x - x[0]) * (y[1] - y[0])) / area
    inside = (b >= 0) & (c >= 0) & (b + c <= 1)
    value = shade[0] + b * (shade[1] - shade[0]) + c * (shade[2] - shade[0])
    picture[at_y[inside], at_x[inside]] = value[inside]


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
        aslant = side_by_side([seen_aslant(figure) for figure in figures])
        above = side_by_side([shaded(figure) for figure in figures])
        png(folder / "fit-bump.png", np.vstack([aslant, above]))
        levels = [bandvox.fit(points, values, "--levels", f"1..{last}") for last in (1, 2, 3, 4)]
        known = contour_points(terrain)
        made = bandvox.fit(known[:, :2], known[:, 2], "--tolerance", "1e-4")
        places = np.full((SCALE * (SIDE - 1),) * 2, 255, np.uint8)
        pixels = np.clip((known[:, :2] - 0.03) / 0.94 * places.shape[0], 0, places.shape[0] - 1)
        places[places.shape[0] - 1 - pixels[:, 1].astype(int), pixels[:, 0].astype(int)] = 0
        truth = shaded(lambda at: terrain(*at.T))
        png(folder / "fit-terrain.png", side_by_side([places, shaded(made), truth]))
        print(f"terrain: {len(known)} places")
        png(folder / "fit-levels.png", side_by_side([seen_aslant(level, 250, 145) for level in levels]))


if __name__ == "__main__":
    main()
