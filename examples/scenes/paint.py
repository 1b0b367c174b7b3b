#!/usr/bin/python3
"""Gives the points of an obj file colours: dark blotches on a light ground, and a rosy front.

    examples/scenes/paint.py MESH.obj PAINTED.obj
"""

import math
import random
import sys


def main():
    source, target = sys.argv[1:3]
    with open(source, encoding="utf-8") as file:
        lines = file.readlines()
    points = [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]
    low = [min(axis) for axis in zip(*points)]
    high = [max(axis) for axis in zip(*points)]
    size = max(h - l for l, h in zip(low, high))
    rng = random.Random(5)
    blotches = [(rng.choice(points), rng.uniform(0.05, 0.13) * size) for _ in range(14)]

    def color(point):
        dark = max(1 / (1 + math.exp(40 * (math.dist(point, middle) - radius) / size))
                   for middle, radius in blotches)
        rosy = 1 / (1 + math.exp(40 * (point[2] - low[2] - 0.06 * size) / size))
        light = (0.95 - 0.02 * rosy, 0.93 - 0.3 * rosy, 0.88 - 0.25 * rosy)
        return [(1 - dark) * l + dark * d for l, d in zip(light, (0.16, 0.12, 0.1))]

    with open(target, "w", encoding="utf-8") as file:
        remaining = iter(points)
        for line in lines:
            if line.startswith("v "):
                point = next(remaining)
                line = "v " + " ".join(f"{n:.6g}" for n in (*point, *color(point))) + "\n"
            elif line.startswith(("mtllib", "usemtl")):
                continue
            file.write(line)


if __name__ == "__main__":
    main()
