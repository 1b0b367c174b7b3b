"""What coarser voxels lose, by filter: the distance of each torus from a fine one.

python3 filters_compared.py FOLDER writes filters.csv there.
"""

import pathlib
import sys
import warnings

import bandvox


def main(folder: pathlib.Path) -> None:
    fine = bandvox.bandlimit("shape:torus", voxel_size=0.02)
    # That a coarse grid holds somewhat less is what is looked at here.
    warnings.simplefilter("ignore", bandvox.BandvoxWarning)
    lines = ["order,cutoff,hausdorff,angle_mean"]
    for order, cutoff in ((2, 0.16), (3, 0.2), (4, 0.25)):
        coarse = bandvox.bandlimit("shape:torus", voxel_size=0.05, order=order, cutoff=cutoff)
        found = bandvox.compare(bandvox.resample(coarse, onto=fine, filter=False), fine)
        lines.append(f"{order},{cutoff},{found['hausdorff']:.5f},{found['angle_mean']:.3f}")
    (folder / "filters.csv").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
