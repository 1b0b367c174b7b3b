"""Reads the tables in data/ and saves the plots, which README.md shows."""

import csv
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402  (comes with matplotlib)

HERE = os.path.dirname(os.path.abspath(__file__))
FILTERS = ((2, 0.16), (4, 0.25), (8, 0.35))
COLOURS = {2: "#1b6ca8", 4: "#c8501e", 8: "#2f8f46"}


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
    os.makedirs(os.path.dirname(path), exist_ok=True)
    figure.savefig(path, dpi=100)
    # A palette is enough, and makes files of a third of the size.
    with Image.open(path) as image:
        image.convert("RGB").quantize(96).save(path, optimize=True)
    plt.close(figure)


def name_of(order, cutoff):
    return f"order {order}, cutoff {cutoff}"
