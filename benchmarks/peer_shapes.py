"""Meshes that are made up: closed, so that all programs see the same solid, and in [-1, 1]."""

import numpy


def write_ply(path, points, triangles):
    """A binary .ply of points (n, 3) and triangles (m, 3)."""
    faces = numpy.zeros(len(triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = triangles
    header = ("ply\nformat binary_little_endian 1.0\n"
              f"element vertex {len(points)}\nproperty float x\nproperty float y\n"
              f"property float z\nelement face {len(faces)}\n"
              "property list uchar int vertex_indices\nend_header\n")
    with open(path, "wb") as file:
        file.write(header.encode())
        file.write(numpy.asarray(points, dtype="<f4").tobytes())
        file.write(faces.tobytes())


def quads_around(rows, columns, is_closed):
    """Triangles of a lattice of rows that close on themselves, and whose last meets the first if
    that is wanted."""
    last = rows if is_closed else rows - 1
    row, column = numpy.meshgrid(numpy.arange(last), numpy.arange(columns), indexing="ij")
    after, beside = (row + 1) % rows, (column + 1) % columns
    a, b = row * columns + column, row * columns + beside
    c, d = after * columns + column, after * columns + beside
    return numpy.concatenate([numpy.stack([a, c, b], -1).reshape(-1, 3),
                              numpy.stack([b, c, d], -1).reshape(-1, 3)])


def ball(rows):
    """Points of the unit sphere on circles of latitude, and triangles with the two poles."""
    columns = 2 * rows
    latitude = numpy.arange(1, rows) / rows * numpy.pi
    longitude = numpy.arange(columns) / columns * 2 * numpy.pi
    t, p = numpy.meshgrid(latitude, longitude, indexing="ij")
    points = numpy.stack([numpy.sin(t) * numpy.cos(p), numpy.sin(t) * numpy.sin(p),
                          numpy.cos(t)], -1).reshape(-1, 3)
    north, south, count = len(points), len(points) + 1, len(points) - columns
    here = numpy.arange(columns)
    beside = (here + 1) % columns
    caps = [numpy.stack([numpy.full(columns, north), here, beside], -1),
            numpy.stack([numpy.full(columns, south), count + beside, count + here], -1)]
    return (numpy.concatenate([points, [[0, 0, 1], [0, 0, -1]]]),
            numpy.concatenate([quads_around(rows - 1, columns, False), *caps]))


def noise(triangles):
    """A ball with bumps of three sizes, of about so many triangles."""
    points, corners = ball(int(round((triangles / 4) ** 0.5)))
    x, y, z = points.T
    radius = (0.85 + 0.04 * numpy.sin(9 * x) * numpy.sin(8 * y + 1) * numpy.sin(7 * z + 2)
              + 0.02 * numpy.sin(40 * x) * numpy.sin(37 * y) + 0.02 * numpy.sin(33 * z)
              + 0.004 * numpy.sin(300 * x) * numpy.sin(280 * y) * numpy.sin(310 * z))
    return points * radius[:, None], corners


def gear(steps=2048, rings=96):
    """A wheel with 24 round teeth and six thicker places: a surface of revolution that waves."""
    around = numpy.arange(steps) / steps * 2 * numpy.pi
    turn = numpy.arange(rings) / rings * 2 * numpy.pi
    a, t = numpy.meshgrid(around, turn, indexing="ij")
    tube = 0.28 * (1 + 0.15 * numpy.sin(6 * a) * numpy.cos(2 * t))
    radius = 0.58 + 0.06 * numpy.tanh(4 * numpy.sin(24 * a)) + tube * numpy.cos(t)
    points = numpy.stack([radius * numpy.cos(a), tube * numpy.sin(t), radius * numpy.sin(a)], -1)
    return points.reshape(-1, 3), quads_around(steps, rings, True)[:, ::-1]


def flake(depth=3, rows=24):
    """Balls that carry smaller ones, six each, which cut into them."""
    unit, corners = ball(rows)
    directions = numpy.concatenate([numpy.eye(3), -numpy.eye(3)])
    points, triangles, count = [], [], 0
    generation = [(numpy.zeros(3), 0.42)]
    for _ in range(depth + 1):
        following = []
        for middle, radius in generation:
            points.append(middle + radius * unit)
            triangles.append(corners + count)
            count += len(unit)
            following += [(middle + 1.2 * radius * d, 0.45 * radius) for d in directions]
        generation = following
    return numpy.concatenate(points), numpy.concatenate(triangles)


def terrain(side=700):
    """Hills on a block: a height field with walls and a floor, of one skin."""
    line = numpy.linspace(-1, 1, side)
    x, y = numpy.meshgrid(line, line, indexing="ij")
    height = 0.2 + sum(0.25 / 2**k * numpy.sin(3 * 2**k * x + k) * numpy.cos(2.7 * 2**k * y - k)
                       for k in range(6))
    top = numpy.stack([x, y, height], -1).reshape(-1, 3)
    floor = numpy.stack([x, y, numpy.full_like(x, -0.5)], -1).reshape(-1, 3)
    i, j = numpy.meshgrid(numpy.arange(side - 1), numpy.arange(side - 1), indexing="ij")
    a = (i * side + j).reshape(-1)
    upper = numpy.concatenate([numpy.stack([a, a + side, a + 1], -1),
                               numpy.stack([a + 1, a + side, a + side + 1], -1)])
    inner = numpy.arange(side)
    border = numpy.concatenate([inner[:-1] * side, (side - 1) * side + inner[:-1],
                                inner[:0:-1] * side + side - 1, inner[:0:-1]])
    following = numpy.roll(border, -1)
    lower = len(top)
    walls = numpy.concatenate([numpy.stack([border, following, border + lower], -1),
                               numpy.stack([following, following + lower, border + lower], -1)])
    return (numpy.concatenate([top, floor]),
            numpy.concatenate([upper, upper[:, ::-1] + lower, walls[:, ::-1]]))


SHAPES = {"gear": gear, "flake": flake, "terrain": terrain}
