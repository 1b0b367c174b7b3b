#!/usr/bin/python3
"""Draws the plots of docs/experiments/README.md and docs/voxelize.md from the tables in data/, and
prints the slopes and constants that they quote. Needs the Debian package python3-matplotlib
(scripts/setup --experiments)."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D
from plot_oversampling import plot_question
from plot_voxelization import plot_voxelization
from tables import COLOURS, FILTERS, column, name_of, read, save, select
from theory import curvature_constant, face_slope


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
    axes[0, 0].legend(handles=[Line2D([], [], color="k", ls=":", lw=1.5)],
                      labels=["theory (7), each filter"], fontsize=8, loc="lower right")
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
    plot_question()
    plot_near_objects()
    plot_lost_detail()
    plot_volume()
    plot_voxelization()


if __name__ == "__main__":
    main()
