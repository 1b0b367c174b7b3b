"""A function of Python becomes a volume: a gyroid within a ball.

python3 formula_to_volume.py FOLDER writes gyroid.vdb and gyroid.png there.
"""

import pathlib
import sys

import numpy as np

import bandvox
from bandvox.types import Doubles


def gyroid(x: Doubles, y: Doubles, z: Doubles) -> Doubles:
    """1 in walls around sin x cos y + sin y cos z + sin z cos x = 0, 0 elsewhere."""
    u, v, w = 6 * x, 6 * y, 6 * z
    wave = np.sin(u) * np.cos(v) + np.sin(v) * np.cos(w) + np.sin(w) * np.cos(u)
    walls: Doubles = np.where((np.abs(wave) < 0.4) & (x * x + y * y + z * z < 1), 1.0, 0.0)
    return walls


def main(folder: pathlib.Path) -> None:
    density = bandvox.bandlimit(gyroid, resolution=64, bounds=((-1, -1, -1), (1, 1, 1)),
                                oversample=4, tolerance=0.05)
    density.write(folder / "gyroid.vdb")
    bandvox.render(density, width=240, height=240).write(folder / "gyroid.png")
    print(f"walls fill {density.metadata['bandvox_grid_volume'] / (4 / 3 * np.pi):.3f} of the ball")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
