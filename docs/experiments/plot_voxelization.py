"""Draws the plot of docs/voxelize.md from the table in data/, and prints what it and
docs/any-mesh.md quote."""

import matplotlib.pyplot as plt
from tables import column, read, save, select

METHODS = (("baseline", "triangle by triangle, then filled (paper, section 2)", "#777777", "s--"),
           ("slices", "GPU, slices (the paper's)", "#c8501e", "o-"),
           ("bits", "GPU, bits", "#1b6ca8", "o-"),
           ("cpu", "CPU, scan conversion", "#2f8f46", "^-"))


def plot_times():
    rows = read("voxel_times")
    shapes = sorted({row["shape"] for row in rows})
    figure, axes = plt.subplots(1, len(shapes), figsize=(11, 4.4), sharey=True)
    print("voxelization: seconds")
    for axis, shape in zip(axes, shapes):
        found = select(rows, shape=shape)
        for method, label, colour, style in METHODS:
            chosen = select(found, method=method)
            axis.plot(column(chosen, "level"), column(chosen, "seconds"), style, color=colour,
                      label=label, ms=5)
            times = ", ".join(f"{row['seconds']:.3g}" for row in chosen)
            print(f"   {shape}, {method}, {chosen[0]['device']}: {times}")
        axis.set_yscale("log")
        axis.set_ylim(1e-3, 400)
        axis.set_xticks(sorted({row["level"] for row in found}))
        axis.set_xlabel("level (2 to that power voxels along the longest side)")
        axis.set_title(f"{shape}, {int(found[0]['triangles'])} triangles")
        axis.grid(alpha=0.3)
    device = select(rows, method="bits")[0]["device"]
    axes[0].set_ylabel(f"seconds; the GPU is {device.split(' ')[0]}")
    axes[1].legend(fontsize=8, loc="upper left")
    save(figure, "voxel_times")


def print_accuracy():
    print("voxelization: mean (largest) distance to the surface, voxels")
    for row in read("voxel_accuracy"):
        what = (f"threshold {row['threshold']:g}" if row["what"] == "voxels"
                else f"density, order {row['order']:g}, cutoff {row['cutoff']}")
        print(f"   {row['shape']}, {what}: {row['mean']:.3g} ({row['largest']:.2g})")


def plot_voxelization():
    plot_times()
    print_accuracy()
