"""Triangles of NumPy become a band-limited volume and a picture.

python3 mesh_to_volume.py FOLDER writes octahedron.vdb and octahedron.png there.
"""

import pathlib
import sys

import numpy as np

import bandvox


def octahedron() -> bandvox.Mesh:
    corners = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)])
    triangles = np.array([(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4),
                          (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)])
    return bandvox.Mesh(corners, triangles)


def main(folder: pathlib.Path) -> None:
    density = bandvox.bandlimit(octahedron(), resolution=96)
    density.write(folder / "octahedron.vdb")
    bandvox.render(density, width=320, height=240, samples=2).write(folder / "octahedron.png")
    volume = density.metadata["bandvox_grid_volume"]
    print(f"{density.active_voxel_count} voxels hold {volume:.6f}; the solid holds {4 / 3:.6f}")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
