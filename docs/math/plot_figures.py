"""Draws the figures of pages here that no measurement is needed for: docs/math/plot_figures.py"""

import pathlib

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import numpy as np

IMAGES = pathlib.Path(__file__).resolve().parents[1] / "images"


def save(figure, name):
    # The same bytes every time.
    plt.rcParams["svg.hashsalt"] = name
    figure.savefig(IMAGES / name, bbox_inches="tight", metadata={"Date": None})


def draw_cascade():
    k = np.linspace(0, 4, 801)
    figure, axis = plt.subplots(figsize=(6, 3.4))
    kept = np.ones_like(k)
    for stage in range(1, 21):
        kept = kept * (2 / 3 + np.cos(2 * np.pi * k / 2 ** stage) / 3)
        if stage in (1, 2, 3):
            held = k <= 2 ** (stage - 1)  # by the samples that it begins with
            axis.plot(k[held], kept[held], lw=1, label="one halving" if stage == 1 else f"{stage} halvings")
    axis.plot(k, kept, "k", lw=1.6, label="many")
    axis.axvline(0.5, color="0.6", ls=":", lw=1)
    axis.text(0.53, 0.93, "Nyquist", color="0.4")
    axis.set_xlabel("frequency, cycles per control point")
    axis.set_ylabel("kept of a wave")
    axis.set_ylim(0, 1.02)
    axis.legend()
    save(figure, "filter-cascade.svg")


def solid_angles(corners, places):
    """Of triangles (n, 3, 3) from places (m, 3), summed: van Oosterom and Strackee, equation 8."""
    total = np.zeros(len(places))
    for triangle in corners:
        a, b, c = (corner - places for corner in triangle)
        la, lb, lc = (np.linalg.norm(d, axis=1) for d in (a, b, c))
        across = np.einsum("ij,ij->i", a, np.cross(b, c))
        along = (la * lb * lc + np.einsum("ij,ij->i", a, b) * lc + np.einsum("ij,ij->i", b, c) * la +
                 np.einsum("ij,ij->i", c, a) * lb)
        total += 2 * np.arctan2(across, along)
    return total


def open_ball(rings=24, slices=48):
    """A unit ball without the part above z = 0.5."""
    polar = np.linspace(np.pi / 3, np.pi, rings + 1)
    around = np.linspace(0, 2 * np.pi, slices + 1)

    def place(i, j):
        return np.array([np.sin(polar[i]) * np.cos(around[j]), np.sin(polar[i]) * np.sin(around[j]), np.cos(polar[i])])

    triangles = []
    for i in range(rings):
        for j in range(slices):
            a, b, c, d = place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)
            triangles += [(a, b, c)] * (i + 1 < rings) + [(a, c if i + 1 < rings else b, d)]
    return np.array(triangles)


def draw_winding():
    x, z = np.meshgrid(np.linspace(-1.5, 1.5, 241), np.linspace(-1.3, 1.5, 225))
    places = np.stack([x.ravel(), np.full(x.size, 1e-3), z.ravel()], axis=1)
    winding = solid_angles(open_ball(), places).reshape(x.shape) / (4 * np.pi)
    figure, axis = plt.subplots(figsize=(5.2, 4.4))
    shown = axis.imshow(winding, origin="lower", extent=(-1.5, 1.5, -1.3, 1.5), cmap="PuOr", vmin=-0.2, vmax=1.2)
    axis.contour(x, z, winding, [0.51], colors="k", linewidths=1.5)
    figure.colorbar(shown, label="winding number")
    axis.set_aspect("equal")
    save(figure, "winding-number.svg")


if __name__ == "__main__":
    draw_cascade()
    draw_winding()
