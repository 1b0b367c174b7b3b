"""Heights that were measured with errors, at scattered places, become a smooth terrain.

python3 heights_to_terrain.py FOLDER writes terrain.ply, terrain.bpt and terrain.vdb there.
"""

import pathlib
import sys

import numpy as np

import bandvox


def main(folder: pathlib.Path) -> None:
    random = np.random.default_rng(7)
    places = random.uniform(-1, 1, (400, 2))
    x, y = places.T
    heights = np.exp(-4 * (x * x + y * y)) + 0.2 * x
    measured = heights + random.normal(0, 0.01, len(heights))

    surface = bandvox.fit(places, measured, smooth=0.01, rectangle=(-1, -1, 1, 1))
    surface.save(folder / "terrain.ply", samples=65)
    surface.save(folder / "terrain.bpt")
    surface.density(resolution=96).write(folder / "terrain.vdb")

    off = np.sqrt(np.mean((surface(x, y) - heights) ** 2))
    steepest = np.linalg.norm(surface.gradient(x, y), axis=-1).max()
    print(f"off by {off:.4f} where heights were measured to 0.01; steepest slope {steepest:.2f}")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
