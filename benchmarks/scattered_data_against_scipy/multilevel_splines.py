"""Multilevel B-spline approximation, plainly: S. Lee, G. Wolberg, S. Y. Shin, "Scattered Data
Interpolation with Multilevel B-Splines", IEEE Transactions on Visualization and Computer Graphics 3
(1997). Values at places of the rectangle from 0 to 1, or any other that is given."""

import numpy as np


def weights(t):
    """The four uniform cubic B-splines at places t of a cell."""
    s = 1 - t
    return np.stack([s**3, 4 + t * t * (3 * t - 6), 4 + s * s * (3 * s - 6), t**3], -1) / 6


class Level:
    """A net of (cells + 3)^2 control points."""

    def __init__(self, low, size, cells):
        self.low, self.size, self.cells = low, size, cells
        self.net = np.zeros((cells + 3, cells + 3))

    def places(self, points):
        at = np.clip((points - self.low) / self.size, 0, 1) * self.cells
        cell = np.minimum(at.astype(int), self.cells - 1)
        w = weights(at - cell)
        return cell, w[:, 0, :, None] * w[:, 1, None, :]

    def approximate(self, points, values):
        """Each control point is a mean of what the points near it would have it be."""
        cell, w = self.places(points)
        share = w**2
        wanted = w * (values / share.sum((1, 2)))[:, None, None]
        above, below = np.zeros_like(self.net), np.zeros_like(self.net)
        for a in range(4):
            for b in range(4):
                index = cell[:, 0] + a, cell[:, 1] + b
                np.add.at(above, index, share[:, a, b] * wanted[:, a, b])
                np.add.at(below, index, share[:, a, b])
        self.net = np.divide(above, below, out=np.zeros_like(above), where=below > 0)

    def evaluate(self, points):
        cell, w = self.places(points)
        total = np.zeros(len(points))
        for a in range(4):
            for b in range(4):
                total += w[:, a, b] * self.net[cell[:, 0] + a, cell[:, 1] + b]
        return total


def fit(points, values, levels=10):
    """A function of places: the sum of levels with 1, 2, 4, ... cells."""
    low = points.min(0)
    size = points.max(0) - low
    lacking = values - values.mean()
    nets = []
    for level in range(levels):
        net = Level(low, size, 2**level)
        net.approximate(points, lacking)
        lacking = lacking - net.evaluate(points)
        nets.append(net)
    return lambda places: values.mean() + sum(net.evaluate(places) for net in nets)
