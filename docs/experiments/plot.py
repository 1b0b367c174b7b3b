#!/usr/bin/python3
"""Draws the plots of docs/experiments/README.md from the tables in data/, and prints the slopes
and constants that it quotes. Needs the Debian package python3-matplotlib (scripts/setup
--experiments)."""

import csv
import math
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402  (comes with matplotlib)

HERE = os.path.dirname(os.path.abspath(__file__))
FILTERS = ((2, 0.16), (4, 0.25), (8, 0.35))
COLOURS = {2: "#1b6ca8", 4: "#c8501e", 8: "#2f8f46"}
# Least errors that tell something: beside sampling, the two routes leave up to a third of them.
FLOORS = {"largest_error": 3e-5, "rms_error": 3e-6}


def read(name):
    def parse(word):
        try:
            return float(word)
        except ValueError:
            return word

    with open(os.path.join(HERE, "data", name + ".csv"), encoding="utf-8") as file:
        return [{key: parse(word) for key, word in row.items()} for row in csv.DictReader(file)]


def select(rows, **wanted):
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def column(rows, key):
    return np.array([row[key] for row in rows], dtype=float)


def save(figure, name):
    figure.tight_layout()
    path = os.path.join(HERE, "plots", name + ".png")
    figure.savefig(path, dpi=100)
    # A palette is enough, and makes files of a third of the size.
    with Image.open(path) as image:
        image.convert("RGB").quantize(96).save(path, optimize=True)
    plt.close(figure)


def name_of(order, cutoff):
    return f"order {order}, cutoff {cutoff}"


# --- closed forms -------------------------------------------------------------------------------

def face_slope(order, cutoff):
    """s'(0), the slope of a flat face's density on the face, per voxel."""
    return 2 * cutoff * math.gamma(1 + 1 / order)


def pole_error(order, cutoff, radius, samples):
    """The error on the pole of a sphere that lies on a sample (README.md, equation 2)."""
    q = np.linspace(0, 1.5 * cutoff * 2 ** (2 / order), 4001)
    along = np.linspace(0, q[-1], 1201)
    k = np.hypot(q[:, None], along[None, :])
    slices = 2 * np.trapz(np.exp(-(k / cutoff) ** order), along, axis=1)
    error = 0
    terms = 60
    for j in range(1, terms + 1):
        chirp = radius / (j * samples)
        integral = np.trapz(2 * np.pi * q * slices * np.exp(1j * np.pi * chirp * q ** 2), q)
        error += (chirp * integral).real / (np.pi * j * samples)
    # The terms that are left fall as 1/j², the chirp being nothing for them.
    return error + pole_limit(order, cutoff, radius, samples) * 6 / math.pi ** 2 / (terms + 0.5)


def pole_limit(order, cutoff, radius, samples):
    """The same for many samples (equation 3)."""
    center = 4 * math.pi * cutoff ** 3 * math.gamma(3 / order) / order
    return math.pi / 6 * radius * center / samples ** 2


def edge_width(order, cutoff):
    """Voxels between the densities 5 and 95 % of a flat face, by integrating its slope."""
    r = np.linspace(0, 8, 4001)
    k = np.linspace(0, 4 * cutoff, 4001)
    slope = 2 * np.trapz(np.exp(-(k / cutoff) ** order) * np.cos(2 * np.pi * np.outer(r, k)), k,
                         axis=1)
    density = 0.5 - np.concatenate(([0], np.cumsum((slope[1:] + slope[:-1]) / 2))) * r[1]
    return 2 * r[np.argmax(density < 0.05)]


def rms_limit(order, cutoff, samples, lattice_sum):
    """RMS error of a solid with normals in all directions (equation 4)."""
    energy = (4 * math.pi * cutoff ** 3 * math.gamma(3 / order)
              / (order * 2 ** (3 / order)))
    return np.sqrt(lattice_sum / (8 * math.pi ** 3) * energy
                   / edge_width(order, cutoff)) / samples ** 2


# Σ 1/|m|⁴ over whole m ≠ 0, and the same with the six poles' errors added in phase.
SUM_APART = 16.5323
SUM_IN_PHASE = SUM_APART - 6 * math.pi ** 4 / 90 + 12 * (math.pi ** 2 / 6) ** 2


def curvature_constant(order, cutoff):
    """The surface at 0.5 of a ball lies this over its radius inside, voxels² (equation 6)."""
    return (math.gamma(1 - 1 / order) / math.gamma(1 + 1 / order)
            / (4 * math.pi ** 2 * cutoff ** 2))


# --- 1: oversampling ----------------------------------------------------------------------------

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
    axes[0, 0].legend(fontsize=7.5, loc="lower left")
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


# --- 2: near objects ----------------------------------------------------------------------------

def plot_near_objects():
    rows = read("near_objects")
    figure, axes = plt.subplots(1, 3, figsize=(12, 4.2), sharey=True)
    cases = (("plates", 0, "two flat faces"), ("balls", 4, "two balls of radius 4 voxels"),
             ("balls", 16, "two balls of radius 16 voxels"))
    print("2. gap at which surfaces merge; least gap from which on they move by < 0.1, < 0.01")
    for axis, (objects, radius, title) in zip(axes, cases):
        for order, cutoff in FILTERS:
            found = select(rows, objects=objects, radius=radius, order=order)
            gap, moved = column(found, "gap"), column(found, "displacement")
            axis.plot(gap, moved, "-", color=COLOURS[order], label=name_of(order, cutoff))
            merging = found[0]["merging_gap"]
            axis.axvline(merging, color=COLOURS[order], ls=":", lw=1)
            limits = [gap[np.nonzero(np.abs(moved) >= most)[0][-1] + 1] for most in (0.1, 0.01)]
            print(f"   {title}, order {order}: {merging:.2f}; {limits[0]:.2f}, {limits[1]:.2f}; "
                  f"extreme {np.nanmin(moved):.3f} at gap {gap[np.nanargmin(moved)]:.2f}, "
                  f"alone {found[0]['alone']:.4f}")
        axis.axhline(0, color="k", lw=0.6)
        axis.set_title(title)
        axis.set_xlabel("gap, voxels (dotted: where they merge)")
        axis.set_xlim(0, 8)
        axis.grid(alpha=0.3)
    axes[0].set_ylim(-0.3, 1)
    axes[0].set_ylabel("displacement towards the other, voxels")
    axes[0].legend(fontsize=8)
    save(figure, "near_objects")


# --- 3: lost detail -----------------------------------------------------------------------------

def plot_lost_detail():
    rounding, thinnest = read("rounding"), read("thinnest")
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.4))
    styles = ("o-", "s--", "^:")
    print("3. times the cutoff: shortfall or thickness")
    for axis, rows, kind, key, names in (
            (axes[0], rounding, "place", "shortfall", ("corner", "edge")),
            (axes[1], thinnest, "solid", "thickness", ("plate", "square rod", "ball"))):
        for order, _ in FILTERS:
            for name, style in zip(names, styles):
                found = select(rows, order=order, **{kind: name})
                x, y = column(found, "cutoff"), column(found, key)
                axis.plot(x, y, style, color=COLOURS[order], ms=4, lw=1.2,
                          label=f"order {order}, {name}")
                print(f"   order {order}, {name}: {np.min(x * y):.4f} to {np.max(x * y):.4f}; "
                      f"{y[-1]:.2f} voxels at {x[-1]}")
        axis.set_xlabel("cutoff, cycles per voxel")
        axis.set_ylim(bottom=0)
        axis.grid(alpha=0.3)
        axis.legend(fontsize=8)
    axes[0].set_ylabel("from the true corner or edge to the surface, voxels")
    axes[1].set_ylabel("thinnest that survives: thickness, diameter, voxels")
    save(figure, "lost_detail")


# --- 4: volume ----------------------------------------------------------------------------------

def plot_volume():
    rows = read("volume")
    solids = (("ball", "ball: diameter, voxels"), ("cube", "cube: side, voxels"),
              ("plate", "plate 32 x 32: thickness, voxels"),
              ("rod", "rod, 32 long: thickness, voxels"))
    figure, axes = plt.subplots(2, 4, figsize=(12.5, 6), sharey="row")
    for i, (solid, label) in enumerate(solids):
        for order, cutoff in FILTERS:
            found = select(rows, solid=solid, order=order)
            size = column(found, "size")
            axes[0, i].plot(size, column(found, "keeping_iso"), "o-", ms=4, lw=1.2,
                            color=COLOURS[order], label=name_of(order, cutoff))
            axes[1, i].plot(size, 100 * column(found, "volume_error"), "o-", ms=4, lw=1.2,
                            color=COLOURS[order])
            if solid == "ball":
                x = np.linspace(4, 24, 60)
                slope = face_slope(order, cutoff) * curvature_constant(order, cutoff)
                axes[0, i].plot(x, 0.5 - slope / (x / 2), ":", color=COLOURS[order], lw=1.5)
        axes[0, i].axhline(0.5, color="k", lw=0.6)
        axes[1, i].axhline(0, color="k", lw=0.6)
        axes[1, i].set_xlabel(label)
        for axis in axes[:, i]:
            axis.grid(alpha=0.3)
    axes[0, 0].set_ylabel("iso-value that keeps the volume")
    axes[1, 0].set_ylabel("volume error at 0.5, %")
    axes[0, 2].legend(fontsize=8)
    save(figure, "volume")

    print("4. volume error at 0.5 of the largest ball and cube, over theory or square of side")
    for order, cutoff in FILTERS:
        ball = select(rows, solid="ball", order=order)[-1]
        cube = select(rows, solid="cube", order=order)[-1]
        theory = -3 * curvature_constant(order, cutoff) / (ball["size"] / 2) ** 2
        print(f"   order {order}: constant (6) {curvature_constant(order, cutoff):.3f}, ball "
              f"{ball['volume_error'] / theory:.3f}, cube "
              f"{cube['volume_error'] * cube['size'] ** 2:.2f}")


def main():
    os.makedirs(os.path.join(HERE, "plots"), exist_ok=True)
    rows = plot_oversampling()
    plot_faces(rows)
    plot_radius()
    plot_cost(rows)
    plot_near_objects()
    plot_lost_detail()
    plot_volume()


if __name__ == "__main__":
    main()
