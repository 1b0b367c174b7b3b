"""Triangles to and from binary .ply files, the way between Blender and the `bandvox` command."""

import numpy as np

_TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4",
          "float": "<f4", "double": "<f8"}


def write(path, points, triangles):
    """Points (n, 3), world units, and triangles (m, 3), counted from 0, wound so that normals point outward."""
    rows = np.empty(len(triangles), [("count", "u1"), ("corners", "<i4", 3)])
    rows["count"] = 3
    rows["corners"] = triangles
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
            "property double x\nproperty double y\nproperty double z\n"
            f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    with open(path, "wb") as stream:
        stream.write(head.encode())
        stream.write(np.ascontiguousarray(points, "<f8").tobytes())
        stream.write(rows.tobytes())


def read(path):
    """Points (n, 3) and triangles (m, 3) of a file as `bandvox convert` writes it.

    Raises ValueError for one that is not binary and little-endian, or has other faces than triangles.
    """
    with open(path, "rb") as stream:
        elements = _read_head(stream, path)
        vertices = _rows(stream, *elements["vertex"])
        faces = _rows(stream, *elements["face"])
    counts, corners = faces.dtype.names[:2]
    if len(faces) and np.any(faces[counts] != 3):
        raise ValueError(f"'{path}' has a face of {faces[counts].max()} corners; expected triangles")
    return np.column_stack([vertices[axis] for axis in "xyz"]).astype(np.float64), faces[corners]


def _read_head(stream, path):
    """The number of rows and NumPy's type of one, for each element; a list counts as one of three."""
    elements, name = {}, ""
    for line in iter(stream.readline, b""):
        words = line.decode("utf-8", "replace").split() or [""]
        if words[0] == "format" and words[1] != "binary_little_endian":
            raise ValueError(f"'{path}' is {words[1]}; expected binary_little_endian")
        if words[0] == "element":
            name = words[1]
            elements[name] = (int(words[2]), [])
        elif words[:2] == ["property", "list"]:
            elements[name][1].extend([(f"{words[4]} count", _TYPES[words[2]]), (words[4], _TYPES[words[3]], 3)])
        elif words[0] == "property":
            elements[name][1].append((words[2], _TYPES[words[1]]))
        elif words[0] == "end_header":
            break
    if not {"vertex", "face"} <= elements.keys():
        raise ValueError(f"'{path}' has elements {', '.join(elements) or 'none'}; expected vertex and face")
    return elements


def _rows(stream, count, fields):
    kind = np.dtype(fields)
    data = stream.read(count * kind.itemsize)
    if len(data) != count * kind.itemsize:
        raise ValueError(f"the file ends after {len(data)} of {count * kind.itemsize} bytes")
    return np.frombuffer(data, kind)
