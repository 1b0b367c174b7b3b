"""Bézier patches of NumPy become a drawing of lines.

python3 patches_to_drawing.py FOLDER writes saddle.svg and saddle.pdf there.
"""

import pathlib
import sys

import numpy as np

import bandvox


def saddle() -> bandvox.Patches:
    """z = x² - y² over a square, as a patch of degree 2 and 2, which it is exactly."""
    x, y = np.meshgrid([-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0], indexing="ij")
    # The control values of t² on [-1, 1] are 1, -1, 1.
    square = np.array([1.0, -1.0, 1.0])
    return bandvox.Patches([np.stack([x, y, square[:, None] - square[None, :]], axis=-1)])


def main(folder: pathlib.Path) -> None:
    patches = saddle()
    middle = patches.position(0, [(0.5, 0.5)])[0]
    drawing = bandvox.outline(patches, up=(0, 0, 1), from_=(1, -2, 0.5), page=(120, 90))
    drawing.save(folder / "saddle.svg")
    drawing.save(folder / "saddle.pdf")
    seen = [path for path in drawing.paths if path.hidden == 0]
    print(f"{len(seen)} of {len(drawing.paths)} lines are seen; its middle is at {middle}")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
