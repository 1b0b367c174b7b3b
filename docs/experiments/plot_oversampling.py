"""The plots of question 1 of README.md, and the slopes that it quotes."""

import math

import matplotlib.pyplot as plt
import numpy as np
from tables import COLOURS, FILTERS, column, name_of, read, save, select
from theory import (SUM_APART, SUM_IN_PHASE, face_slope, pole_error, rms_limit)


# Least errors that tell something: beside sampling, the two routes leave up to a third of them.
FLOORS = {"largest_error": 3e-5, "rms_error": 3e-6}

SOLIDS = (
    ("sphere on samples", "inside", "o", "#1b6ca8"),
    ("sphere between samples", "inside", "s", "#63b3e4"),
    ("hyperboloid", "inside", "^", "#7b4fa3"),
    ("cube on samples", "inside", "D", "#b3261e"),
    ("cube between samples", "inside", "v", "#e59a3c"),
    ("cube 10 deg", "inside", "P", "#2f8f46"),
    ("cube 30 deg", "inside", "X", "#8a8a2b"),
)


def fitted_slope(rows, key):
    kept = [row for row in rows if row["samples_per_voxel"] >= 2 and row[key] > FLOORS[key]]
    if len(kept) < 3:
        return math.nan
    return -np.polyfit(np.log(column(kept, "samples_per_voxel")), np.log(column(kept, key)), 1)[0]


def plot_oversampling():
    rows = read("oversampling")
    p = np.geomspace(1, 32, 26)
    figure, axes = plt.subplots(2, 3, figsize=(12, 8), sharex=True, sharey="row")
    for i, (order, cutoff) in enumerate(FILTERS):
        for line, (key, label) in enumerate((("largest_error", "largest error of the density"),
                                             ("rms_error", "RMS error over the edge's voxels"))):
            axis = axes[line, i]
            for solid, faces, marker, colour in SOLIDS:
                found = select(rows, solid=solid, faces=faces, order=order)
                axis.loglog(column(found, "samples_per_voxel"), column(found, key), marker + "-",
                            color=colour, ms=5, lw=1, label=solid)
            axis.grid(alpha=0.3)
            if i == 0:
                axis.set_ylabel(label)
        axes[0, i].set_title(name_of(order, cutoff))
        axes[0, i].loglog(p, face_slope(order, cutoff) / (2 * p), "k--", lw=1.2,
                          label="theory: flat face, (1)")
        axes[0, i].loglog(p, [pole_error(order, cutoff, 32, s) for s in p], "k:", lw=1.6,
                          label="theory: pole of the sphere, (2)")
        axes[1, i].loglog(p, rms_limit(order, cutoff, p, SUM_IN_PHASE), "k:", lw=1.6,
                          label="theory: sphere on samples, (4)")
        axes[1, i].loglog(p, rms_limit(order, cutoff, p, SUM_APART), "k-.", lw=1.2,
                          label="theory: sphere between samples, (4)")
        axes[1, i].set_xlabel("samples along a voxel's side, R/N")
    for axis in axes.flat:
        axis.set_xticks([1, 2, 4, 8, 16, 32], ["1", "2", "4", "8", "16", "32"])
        axis.minorticks_off()
    axes[0, 2].set_ylim(3e-6, 0.8)
    axes[1, 2].set_ylim(6e-7, 0.8)
    # Where no line runs.
    axes[0, 2].legend(fontsize=7.5, loc="lower left")
    axes[1, 0].legend(handles=axes[1, 0].get_lines()[-2:], fontsize=7.5, loc="lower left")
    save(figure, "oversampling")

    print("1. fitted slopes, R/N >= 2 (largest; RMS), orders 2, 4, 8")
    for solid, faces, _, _ in SOLIDS + (("hyperboloid", "half", "", ""),
                                        ("cube on samples", "half", "", "")):
        words = []
        for order, _ in FILTERS:
            found = select(rows, solid=solid, faces=faces, order=order)
            words.append(f"{fitted_slope(found, 'largest_error'):5.2f};"
                         f"{fitted_slope(found, 'rms_error'):5.2f}")
        print(f"   {solid:24}{faces:8}" + "   ".join(words))
    return rows


def plot_faces(rows):
    figure, axes = plt.subplots(1, 2, figsize=(9, 4), sharey=True)
    for axis, solid in zip(axes, ("cube on samples", "hyperboloid")):
        for order, cutoff in FILTERS:
            for faces, style in (("inside", "o-"), ("half", "s--")):
                found = select(rows, solid=solid, faces=faces, order=order)
                axis.loglog(column(found, "samples_per_voxel"), column(found, "largest_error"),
                            style, color=COLOURS[order], ms=5, lw=1.2,
                            label=f"order {order}, " + ("counted ½" if faces == "half"
                                                        else "counted 1"))
        axis.set_title(solid)
        axis.set_xlabel("samples along a voxel's side, R/N")
        axis.set_xticks([1, 2, 4, 8, 16], ["1", "2", "4", "8", "16"])
        axis.minorticks_off()
        axis.grid(alpha=0.3)
        axis.set_ylim(bottom=2e-5)
    axes[0].set_ylabel("largest error of the density")
    axes[0].legend(fontsize=8, loc="lower left")
    save(figure, "samples_on_faces")


def plot_radius():
    rows = read("sphere_radius")
    order, cutoff = FILTERS[0]
    radii = np.geomspace(4, 128, 21)
    figure, axis = plt.subplots(figsize=(6, 4.2))
    for samples, colour in ((4, "#c8501e"), (8, "#1b6ca8")):
        found = select(rows, samples_per_voxel=samples)
        axis.loglog(column(found, "radius"), column(found, "largest_error"), "o", color=colour,
                    label=f"measured, R/N = {samples}")
        axis.loglog(radii, [pole_error(order, cutoff, r, samples) for r in radii], "-",
                    color=colour, lw=1, label="theory (2)")
        axis.axhline(face_slope(order, cutoff) / (2 * samples), color=colour, ls="--", lw=1,
                     label="flat face (1)")
        for row in found:
            ratio = row["largest_error"] / pole_error(order, cutoff, row["radius"], samples)
            print(f"   sphere of radius {row['radius']:g}, R/N {samples}: "
                  f"{row['largest_error']:.3g}, over theory {ratio:.3f}")
    axis.set_xticks([4, 8, 16, 32, 64, 128], ["4", "8", "16", "32", "64", "128"])
    axis.minorticks_off()
    axis.set_xlabel("radius of the sphere, voxels")
    axis.set_ylabel("largest error of the density")
    axis.set_title(name_of(order, cutoff))
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8)
    save(figure, "sphere_radius")


def plot_cost(rows):
    figure, axis = plt.subplots(figsize=(6.5, 4.4))
    for solid, faces, marker, colour in SOLIDS:
        found = select(rows, solid=solid, faces=faces, order=2)
        seconds, errors = column(found, "cpu_seconds"), column(found, "largest_error")
        axis.loglog(seconds, errors, marker + "-", color=colour, ms=5, lw=1, label=solid)
        if solid == "sphere on samples":
            for row in found:
                axis.annotate(f"{row['samples_per_voxel']:g}",
                              (row["cpu_seconds"], row["largest_error"]), fontsize=8,
                              textcoords="offset points", xytext=(5, 4))
    axis.set_xlabel("processor seconds of sampling and transforms (numbers: R/N)")
    axis.set_ylabel("largest error of the density")
    axis.set_title(name_of(*FILTERS[0]))
    axis.grid(alpha=0.3)
    axis.legend(fontsize=7.5, loc="lower left")
    save(figure, "cost")


def plot_question():
    rows = plot_oversampling()
    plot_faces(rows)
    plot_radius()
    plot_cost(rows)
