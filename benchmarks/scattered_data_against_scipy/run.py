#!/usr/bin/env python3
"""How near surfaces come to functions of which they know the values at some places: bandvox fit, and
what SciPy and multilevel B-splines make of the same points. Needs NumPy and SciPy.

    run.py BANDVOX [--large]"""

import argparse
import json
import pathlib
import re
import resource
import subprocess
import tempfile
import time

import numpy as np
from scipy.interpolate import CloughTocher2DInterpolator, RBFInterpolator
from scipy.spatial import Delaunay

import multilevel_splines

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]


def bump(x, y):
    return 0.25 * np.exp(-16 * ((x - 0.5) ** 2 + (y - 0.5) ** 2))


def franke_functions():
    def peak(width):
        return lambda x, y: np.exp(-width * ((x - 0.5) ** 2 + (y - 0.5) ** 2)) / 3

    return [
        lambda x, y: 0.75 * np.exp(-((9 * x - 2) ** 2 + (9 * y - 2) ** 2) / 4)
        + 0.75 * np.exp(-((9 * x + 1) ** 2) / 49 - (9 * y + 1) / 10)
        + 0.5 * np.exp(-((9 * x - 7) ** 2 + (9 * y - 3) ** 2) / 4)
        - 0.2 * np.exp(-((9 * x - 4) ** 2) - (9 * y - 7) ** 2),
        lambda x, y: (np.tanh(9 * y - 9 * x) + 1) / 9,
        lambda x, y: (1.25 + np.cos(5.4 * y)) / (6 * (1 + (3 * x - 1) ** 2)),
        peak(81 / 16),
        peak(81 / 4),
        lambda x, y: np.sqrt(64 - 81 * ((x - 0.5) ** 2 + (y - 0.5) ** 2)) / 9 - 0.5,
    ]


def franke_places():
    """The sets of places that the tests have."""
    text = (REPOSITORY / "tests/scatter/test_points.cpp").read_text()
    sets = {}
    for name, body in re.findall(r"const Places& (\w+)\(\) \{(.*?)return places;", text, re.S):
        pairs = re.findall(r"\{(-?[\d.]+),\s*(-?[\d.]+)\}", body)
        sets[name] = np.array(pairs, dtype=float)
    return sets


class Bandvox:
    def __init__(self, command, folder):
        self.command, self.folder = command, folder

    def fit(self, points, values, *options):
        table, patches = self.folder / "points.npy", self.folder / "surface.bpt"
        np.save(table, np.column_stack([points, values]))
        command = [self.command, "fit", table, "-o", patches, "--quiet", *options]
        subprocess.run(command, check=True)
        numbers = np.array(patches.read_text().split()[1:], dtype=float).reshape(-1, 50)
        return self.evaluator(numbers[:, 2:].reshape(-1, 4, 4, 3))

    @staticmethod
    def evaluator(patches):
        xs, ys = np.unique(patches[:, 0, 0, 0]), np.unique(patches[:, 0, 0, 1])
        ordinates = patches[..., 2].reshape(len(xs), len(ys), 4, 4)

        def bernstein(t):
            s = 1 - t
            return np.stack([s**3, 3 * s * s * t, 3 * s * t * t, t**3], -1)

        def locate(edges, end, places):
            size = (end - edges[0]) / len(edges)
            at = (places - edges[0]) / size
            cell = np.clip(at.astype(int), 0, len(edges) - 1)
            return cell, bernstein(at - cell)

        def evaluate(places):
            i, u = locate(xs, patches[:, -1, -1, 0].max(), places[:, 0])
            j, v = locate(ys, patches[:, -1, -1, 1].max(), places[:, 1])
            return np.einsum("na,nab,nb->n", u, ordinates[i, j], v)

        return evaluate


def errors(points, function, surface):
    line = np.linspace(0, 1, 101)
    grid = np.stack(np.meshgrid(line, line, indexing="ij"), -1).reshape(-1, 2)
    grid = grid[Delaunay(points).find_simplex(grid) >= 0]
    difference = surface(grid) - function(*grid.T)
    return np.abs(difference).max(), np.sqrt(np.mean(difference**2))


def methods(bandvox):
    def thin_plate(points, values):
        return RBFInterpolator(points, values, kernel="thin_plate_spline", degree=1)

    def clough_tocher(points, values):
        return CloughTocher2DInterpolator(points, values, tol=1e-12, maxiter=5000)

    return {
        "bandvox": bandvox.fit,
        "Clough-Tocher": clough_tocher,
        "thin plate": thin_plate,
        "multilevel": multilevel_splines.fit,
    }


def compare_small(bandvox):
    found = {}
    for name, method in methods(bandvox).items():
        each = []
        for seed in range(20):
            points = np.random.RandomState(seed).random_sample((100, 2))
            each.append(errors(points, bump, method(points, bump(*points.T))))
        found[name] = np.median(each, 0)
    print("f0, medians of 20 sets of 100 places: largest error, root mean square")
    for name, (largest, rms) in found.items():
        print(f"  {name:14} {largest:.2e} {rms:.2e}")
    for name, points in franke_places().items():
        for index, function in enumerate(franke_functions()):
            each = {
                method: errors(points, function, make(points, function(*points.T)))
                for method, make in methods(bandvox).items()
            }
            least = min(each, key=lambda method: each[method][1])
            row = "  ".join(f"{m} {e[0]:.2e} {e[1]:.2e}" for m, e in each.items())
            print(f"{name} F{index + 1}: {row}; least: {least}", flush=True)


def compare_large(bandvox, most=7):
    function = franke_functions()[0]
    print("places, seconds of the command, seconds of Clough-Tocher, largest error on 1001 x 1001")
    for power in range(3, most + 1):
        points = np.random.RandomState(5).random_sample((10**power, 2))
        values = function(*points.T)
        table, samples = bandvox.folder / "points.npy", bandvox.folder / "samples.npy"
        statistics = bandvox.folder / "stats.json"
        np.save(table, np.column_stack([points, values]))
        start = time.perf_counter()
        subprocess.run(
            [bandvox.command, "fit", table, "-o", samples, "--samples", "1001", "--quiet",
             "--stats", statistics],
            check=True,
        )  # fmt: skip
        ours = time.perf_counter() - start
        memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        made = np.load(samples)[..., 0]
        x = np.linspace(points[:, 0].min(), points[:, 0].max(), made.shape[0])
        y = np.linspace(points[:, 1].min(), points[:, 1].max(), made.shape[1])
        largest = np.abs(made - function(x[:, None], y[None, :])).max()
        start = time.perf_counter()
        if power <= 6:
            CloughTocher2DInterpolator(points, values)
        theirs = time.perf_counter() - start
        residual = json.loads(statistics.read_text())["counts"]["levels"][-1]["largest"]
        print(f"  1e{power} {ours:.2f} {theirs:.2f} {largest:.2e}, residual {residual:.1e}, "
              f"at most {memory:.0f} MB so far", flush=True)  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bandvox")
    parser.add_argument("--large", action="store_true", help="from 1e3 to 1e7 places")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bandvox = Bandvox(arguments.bandvox, pathlib.Path(folder))
        if arguments.large:
            compare_large(bandvox)
        else:
            compare_small(bandvox)


if __name__ == "__main__":
    main()
