#!/usr/bin/env python3
"""Draws the field of docs/fit.md: values and colours that are known at 100 000 random places of a
cube, where the value is 0.5.

    draw_field.py BANDVOX PICTURE.png"""

import pathlib
import subprocess
import sys
import tempfile

import numpy as np


def cloud(count=100_000):
    """A gyroid that a ball is cut out of, and colours by height."""
    places = np.random.RandomState(1).random_sample((count, 3))
    x, y, z = (4 * np.pi * places).T
    gyroid = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    middle = places - 0.5
    value = 0.5 + 0.3 * gyroid - 6 * ((middle**2).sum(1) - 0.14)
    phase = 6 * middle[:, 2:] + [0, 2.1, 4.2]
    return np.column_stack([places, value, 0.5 + 0.45 * np.cos(phase)])


def main():
    command, picture = sys.argv[1], sys.argv[2]
    with tempfile.TemporaryDirectory() as name:
        table, grid = pathlib.Path(name) / "cloud.csv", pathlib.Path(name) / "field.vdb"
        np.savetxt(table, cloud(), delimiter=",", header="x,y,z,density,r,g,b", comments="",
                   fmt="%.7g")  # fmt: skip
        subprocess.run([command, "fit", table, "--volume", "-o", grid, "-r", "100"], check=True)
        view = "--eye 1.9,1.2,1.48 --lookat 0.5,0.5,0.5 --fov 34".split()
        subprocess.run(
            [command, "render", grid, "-o", picture, "--res", "480x400", "--samples", "4", *view,
             "--shadows", "--background", "1,1,1"],
            check=True,
        )  # fmt: skip


if __name__ == "__main__":
    main()
