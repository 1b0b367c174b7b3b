"""Small files that are whole, of every format that the command reads; make-broken-files breaks them.

A sample has a name, which the command is given, how it is used (USES of test-broken-files), its bytes,
and files that have to be beside it. It has none of its own if the name stands for several: a folder,
or a pattern. What the command writes is made by it; the rest is put together here.
"""

import base64
import dataclasses
import json
import math
import os
import struct
import subprocess
import zlib

import broken_scans as scans

POINTS = [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1),
          (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]
SIDES = [(0, 3, 2, 1), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)]
TRIANGLES = [corners for a, b, c, d in SIDES for corners in ((a, b, c), (a, c, d))]


@dataclasses.dataclass
class Sample:
    name: str
    use: str
    data: bytes | None
    beside: dict = dataclasses.field(default_factory=dict)
    # The file that is broken if it is not the one that is given: one of `beside`.
    broken: str = ""

    def victim(self):
        """The name of what is broken."""
        return self.broken or self.name

    def content(self):
        return self.beside[self.broken] if self.broken else self.data

    def kind(self):
        return os.path.splitext(self.victim())[1]


def lines(rows, form):
    return "".join(form % row + "\n" for row in rows)


def obj(head=""):
    texts = lines([(0, 0), (1, 0), (1, 1), (0, 1)], "vt %d %d")
    faces = lines([tuple(v for i, c in enumerate(side) for v in (c + 1, i + 1)) for side in SIDES],
                  "f" + " %d/%d" * 4)
    return (head + lines(POINTS, "v %d %d %d") + texts + faces).encode()


def ply(encoding):
    head = (f"ply\nformat {encoding} 1.0\ncomment a cube\nelement vertex 8\n" +
            "".join(f"property float {c}\n" for c in "xyz") +
            "".join(f"property uchar {c}\n" for c in ("red", "green", "blue")) +
            "element face 12\nproperty list uchar int vertex_indices\nend_header\n").encode()
    if encoding == "ascii":
        return head + (lines(POINTS, "%d %d %d 255 0 0") + lines(TRIANGLES, "3 %d %d %d")).encode()
    order = "<" if "little" in encoding else ">"
    return (head + b"".join(struct.pack(order + "3f3B", *p, 255, 0, 0) for p in POINTS) +
            b"".join(struct.pack(order + "B3i", 3, *t) for t in TRIANGLES))


def stl_ascii():
    return ("solid cube\n" + "".join(
        "facet normal 0 0 0\n outer loop\n" + lines([POINTS[i] for i in t], "  vertex %d %d %d") +
        " endloop\nendfacet\n" for t in TRIANGLES) + "endsolid cube\n").encode()


def stl_binary():
    return bytes(80) + struct.pack("<I", 12) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *(v for i in t for v in POINTS[i]), 0) for t in TRIANGLES)


def off():
    return ("OFF\n8 6 0\n" + lines(POINTS, "%d %d %d") + lines(SIDES, "4 %d %d %d %d")).encode()


def gltf(uri, extra=None):
    """The JSON and the buffer of a cube with a camera."""
    buffer = (b"".join(struct.pack("<3f", *p) for p in POINTS) +
              b"".join(struct.pack("<3H", *t) for t in TRIANGLES))
    described = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "children": [1], "scale": [1, 1, 1]},
                  {"camera": 0, "translation": [0, 0, 5]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 4}]}],
        "buffers": [{"byteLength": len(buffer), **({"uri": uri} if uri else {})}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 96},
                        {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3",
                       "min": [-1, -1, -1], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}],
        **(extra or {})}
    if uri == "data":
        described["buffers"][0]["uri"] = ("data:application/octet-stream;base64," +
                                          base64.b64encode(buffer).decode())
    return json.dumps(described, indent=1).encode(), buffer


def glb():
    text, buffer = gltf("")
    text += b" " * (-len(text) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(buffer)) +
            struct.pack("<I4s", len(text), b"JSON") + text +
            struct.pack("<I4s", len(buffer), b"BIN\0") + buffer)


def dae():
    numbers = " ".join(str(v) for p in POINTS for v in p)
    corners = " ".join(str(i) for t in TRIANGLES for i in t)
    return f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="24">{numbers}</float_array><technique_common>
<accessor source="#a" count="8" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>{corners}</p></triangles>
</mesh></geometry></library_geometries>
<library_nodes><node id="n"><instance_geometry url="#g"/></node></library_nodes>
<library_visual_scenes><visual_scene id="s"><node id="m"><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1
</matrix><instance_node url="#n"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
""".encode()


def fbx_tree():
    """Records: name, properties, records below."""
    corners = [i if k < 2 else ~i for t in TRIANGLES for k, i in enumerate(t)]
    return [("FBXHeaderExtension", [], [("FBXHeaderVersion", [1003], []),
                                        ("FBXVersion", [7400], [])]),
            ("GlobalSettings", [], [("Version", [1000], []), ("Properties70", [], [])]),
            ("Objects", [], [
                ("Geometry", [1, "cube", "Mesh"], [
                    ("Vertices", [[float(v) for p in POINTS for v in p]], []),
                    ("PolygonVertexIndex", [corners], []), ("GeometryVersion", [124], [])]),
                ("Model", [2, "cube", "Mesh"], [("Version", [232], []),
                                                ("Properties70", [], [])])]),
            ("Connections", [], [("C", ["OO", 2, 0], []), ("C", ["OO", 1, 2], [])])]


def fbx_text():
    kinds = {"Geometry": "Geometry::", "Model": "Model::"}

    def write(name, properties, below):
        if properties and isinstance(properties[0], list):
            values = ",".join(str(v) for v in properties[0])
            return f"{name}: *{len(properties[0])} {{\n a: {values}\n}}\n"
        words = [f'"{kinds.get(name, "") if i == 1 else ""}{p}"' if isinstance(p, str) else str(p)
                 for i, p in enumerate(properties)]
        inside = "{\n" + "".join(write(*b) for b in below) + "}" if below or not properties else ""
        return f"{name}: {', '.join(words)} {inside}\n"

    return ("; FBX 7.4.0 project file\n" + "".join(write(*r) for r in fbx_tree())).encode()


def fbx_binary():
    def pack(name, value):
        if isinstance(value, int):
            return (b"L" if name in ("Geometry", "Model", "C") else b"I") + struct.pack(
                "<q" if name in ("Geometry", "Model", "C") else "<i", value)
        if isinstance(value, str):
            text = value.encode() + (b"\0\x01" + name.encode()
                                     if name in ("Geometry", "Model") and value != "Mesh" else b"")
            return b"S" + struct.pack("<I", len(text)) + text
        kind = b"d" if isinstance(value[0], float) else b"i"
        packed = zlib.compress(struct.pack(f"<{len(value)}{kind.decode()}", *value))
        return kind + struct.pack("<III", len(value), 1, len(packed)) + packed

    def write(record, place):
        name, properties, below = record
        inside = b"".join(pack(name, p) for p in properties)
        body = name.encode() + inside
        at = place + 13 + len(body)
        for child in below:
            part = write(child, at)
            body, at = body + part, at + len(part)
        if below or not properties:
            body, at = body + bytes(13), at + 13
        return struct.pack("<IIIB", at, len(properties), len(inside), len(name)) + body

    data = b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", 7400)
    for record in fbx_tree():
        data += write(record, len(data))
    return data + bytes(13)


def png(width=4, height=4, channels=3):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I",
                                                                        zlib.crc32(kind + body))
    rows = b"".join(b"\0" + bytes(50 * y + 20 * c for c in range(channels)) * width
                    for y in range(height))
    head = struct.pack(">IIBBBBB", width, height, 8, 2 if channels == 3 else 0, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) +
            chunk(b"IEND", b""))


def radiance():
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n" + bytes((90, 120, 150, 129)) * 8


def meshes():
    text = gltf("cube.bin")
    material = b"newmtl red\nKd 1 0 0\nmap_Kd cube.png\n"
    painted = obj("mtllib cube.mtl\nusemtl red\n")
    beside = {"cube.mtl": material, "cube.png": png()}
    yield Sample("plain.obj", "mesh", obj())
    yield Sample("painted.obj", "paint", painted, beside)
    yield Sample("material.obj", "paint", painted, beside, broken="cube.mtl")
    yield Sample("texture.obj", "paint", painted, beside, broken="cube.png")
    for encoding in ("ascii", "binary_little_endian", "binary_big_endian"):
        yield Sample(f"{encoding}.ply", "mesh", ply(encoding))
    yield Sample("ascii.stl", "mesh", stl_ascii())
    yield Sample("binary.stl", "mesh", stl_binary())
    yield Sample("plain.off", "mesh", off())
    yield Sample("inside.gltf", "mesh", gltf("data")[0])
    yield Sample("beside.gltf", "mesh", text[0], {"cube.bin": text[1]})
    yield Sample("buffer.gltf", "mesh", text[0], {"cube.bin": text[1]}, broken="cube.bin")
    yield Sample("camera.gltf", "camera", gltf("data")[0])
    yield Sample("plain.glb", "mesh", glb())
    yield Sample("plain.dae", "mesh", dae())
    yield Sample("text.fbx", "mesh", fbx_text())
    yield Sample("binary.fbx", "mesh", fbx_binary())


def arrays():
    values = struct.pack("<512f", *((i % 8) / 8 for i in range(512)))
    nrrd = ("NRRD0004\ntype: float\ndimension: 3\nsizes: 8 8 8\nspacings: 1 1 1\nendian: little\n"
            "encoding: %s\n%s\n")
    meta = ("ObjectType = Image\nNDims = 3\nDimSize = 8 8 8\nElementSpacing = 1 1 1\n"
            "ElementType = MET_FLOAT\n%sElementDataFile = %s\n")
    shape = b"{'descr': '<f4', 'fortran_order': False, 'shape': (8, 8, 8), }"
    shape += b" " * (-len(shape) % 64 + 53) + b"\n"
    numbers = " ".join(str((i % 8) / 8) for i in range(512)).encode()
    packer = zlib.compressobj(wbits=31)
    raw = {"values.raw": values}
    yield Sample("plain.npy", "array", b"\x93NUMPY\1\0" + struct.pack("<H", len(shape)) + shape +
                 values)
    yield Sample("raw.nrrd", "array", (nrrd % ("raw", "")).encode() + values)
    yield Sample("gzip.nrrd", "array", (nrrd % ("gzip", "")).encode() + packer.compress(values) +
                 packer.flush())
    yield Sample("text.nrrd", "array", (nrrd % ("ascii", "")).encode() + numbers)
    yield Sample("beside.nhdr", "array", (nrrd % ("raw", "data file: values.raw\n")).encode(), raw)
    yield Sample("raw.mha", "array", (meta % ("", "LOCAL")).encode() + values)
    yield Sample("zlib.mha", "array", (meta % ("CompressedData = True\n", "LOCAL")).encode() +
                 zlib.compress(values))
    yield Sample("beside.mhd", "array", (meta % ("", "values.raw")).encode(), raw)
    yield Sample("values.mhd", "array", (meta % ("", "values.raw")).encode(), raw,
                 broken="values.raw")
    yield Sample("slice.png", "array", png(channels=1))


def stacks():
    for syntax in ("IMPLICIT", "EXPLICIT", "DEFLATED", "BIG_ENDIAN", "JPEG_BASELINE", "RLE"):
        yield Sample(f"{syntax.lower()}.dcm", "array", scans.dicom(getattr(scans, syntax)))
    yield Sample("solid.dcm", "array", scans.dicom(frames=3))
    series = {f"series/{z}.dcm": scans.dicom(z=z) for z in range(3)}
    yield Sample("series", "array", None, series, broken="series/1.dcm")
    for way in ("none", "zip", "packbits"):
        yield Sample(f"{way}.strips.tif", "array", scans.tiff(way, pages=2))
    yield Sample("zip.tiles.tif", "array", scans.tiff("zip", tiled=True))
    yield Sample("motorola.tif", "array", scans.tiff(order=">"))
    tiffs = {f"slices/{z}.tif": scans.tiff() for z in range(3)}
    yield Sample("slices", "array", None, tiffs, broken="slices/2.tif")
    pngs = {f"page.{z}.png": png(channels=1) for z in range(3)}
    yield Sample("page.#.png", "array", None, pngs, broken="page.0.png")


def points():
    """On a ball, with normals and radii as far as they have names."""
    ring = [(math.cos(a) * math.sin(b), math.sin(a) * math.sin(b), math.cos(b))
            for a in (2 * math.pi * i / 12 for i in range(12))
            for b in (math.pi * (j + 0.5) / 6 for j in range(6))]
    names = ("x", "y", "z", "nx", "ny", "nz", "radius")
    rows = [(*p, *p, 0.3) for p in ring]
    yield Sample("balls.csv", "points",
                 (",".join(names) + "\n" + lines(rows, ",".join(["%.4f"] * 7))).encode())
    yield Sample("surface.xyz", "points",
                 lines([r[:6] for r in rows], " ".join(["%.4f"] * 6)).encode())
    yield Sample("bare.txt", "points", lines(ring, "%.4f;%.4f;%.4f").encode())
    for encoding in ("ascii", "binary_little_endian", "binary_big_endian"):
        head = (f"ply\nformat {encoding} 1.0\nelement vertex {len(rows)}\n" +
                "".join(f"property float {n}\n" for n in names) + "end_header\n").encode()
        order = "<" if "little" in encoding else ">"
        body = (lines(rows, " ".join(["%.4f"] * 7)).encode() if encoding == "ascii" else
                b"".join(struct.pack(order + "7f", *r) for r in rows))
        yield Sample(f"points.{encoding}.ply", "points", head + body)


def texts(good):
    scene = {"objects": [{"file": "good.vdb", "color": [0.8, 0.7, 0.6], "roughness": 0.3}],
             "lights": [{"direction": [0, 1, 1], "color": [0.9, 0.9, 0.9], "size": 2}],
             "camera": {"eye": [0, 0, 5], "fov": 40}, "picture": {"res": [16, 16], "samples": 1}}
    rich = {"objects": [{"file": "good.vdb", "transparency": 1, "refraction": 1.5, "scale": 0.5,
                         "translate": [0, 1, 0]},
                        {"file": "good.vdb", "kind": "volume", "density": 2}],
            "lights": [{"position": [3, 2, 1], "color": [5, 5, 5], "size": 0.2}],
            "environment": {"file": "sky.png", "turn": 90, "visible": True},
            "picture": {"res": [12, 12], "samples": 2, "shadows": True, "gather": 1}}
    options = b"# What all shots use.\norder = 2\ncutoff = 0.16\ntolerance = 0.001\nclamp = true\n"
    yield Sample("plain.json", "scene", json.dumps(scene, indent=1).encode(), {"good.vdb": good})
    beside = {"good.vdb": good, "sky.png": png(8, 4)}
    text = json.dumps(rich, indent=1).encode()
    yield Sample("rich.json", "scene", text, beside)
    yield Sample("object.json", "scene", text, beside, broken="good.vdb")
    yield Sample("picture.json", "scene", text, beside, broken="sky.png")
    yield Sample("options.cfg", "config", options)
    yield Sample("picture.cfg", "picture",
                 b"res = 16x16\nsamples = 1\ncolor = 0.8,0.7,0.6\nroughness = 0.3\nshadows = true\n")
    yield Sample("sky.png", "sky", png(8, 4))
    yield Sample("sky.hdr", "sky", radiance())


# What the command writes: name, use, arguments.
WRITTEN = [("blosc.vdb", "volume", ["convert", "shape:torus", "-r", "12"]),
           ("zip.vdb", "volume", ["convert", "shape:cube", "-r", "3", "--compression", "zip"]),
           ("none.vdb", "volume", ["convert", "shape:cube", "-r", "3", "--compression", "none"]),
           ("half.vdb", "volume", ["convert", "shape:torus", "-r", "12", "--half"]),
           ("levels.vdb", "volume", ["convert", "shape:cube", "-r", "12", "--lod", "1"]),
           ("distances.vdb", "volume",
            ["convert", "shape:cube", "-r", "12", "--as", "level-set"]),
           ("colors.vdb", "volume", ["convert", "painted.obj", "-r", "12", "--color"]),
           ("voxels.vdb", "volume", ["voxelize", "shape:torus", "-r", "12"]),
           ("lattice.vdb", "onto", ["convert", "shape:cube", "-r", "8"]),
           ("settings.vdb", "like", ["convert", "shape:cube", "-r", "8"]),
           ("settings.ply", "like", ["convert", "shape:cube", "-r", "8"]),
           ("settings.glb", "like", ["convert", "shape:cube", "-r", "8"]),
           ("second.vdb", "pair", ["convert", "shape:torus", "-r", "12"]),
           ("coarse.vdb", "pair", ["convert", "shape:torus", "-r", "8", "--half"]),
           ("pages.tif", "array", ["convert", "shape:torus", "-r", "12", "--type", "uint16"]),
           ("slice.exr", "array",
            ["convert", "shape:torus", "-r", "12", "--box", "0,0,0,9,9,0"]),
           ("sky.exr", "sky", ["render", "good.vdb", "--res", "8x4"])]


def written(command, folder):
    """Made in a folder that has good.vdb and painted.obj with what is beside it."""
    for name, use, arguments in WRITTEN:
        # A pattern stands for the one slice.
        output = "0." + name if name == "slice.exr" else name
        asked = "#." + name if name == "slice.exr" else name
        subprocess.run([command, *arguments, "-o", asked, "--quiet"], cwd=folder, check=True)
        with open(os.path.join(folder, output), "rb") as file:
            yield Sample(name, use, file.read())


def shards(command, folder):
    """Parts of one volume, of which one is broken."""
    parts = {}
    for i in (1, 2):
        name = f"part{i}.vdb"
        subprocess.run([command, "convert", "shape:torus", "-r", "40", "--tile", "32", "--shard",
                        f"{i}/2", "-o", name, "--quiet"], cwd=folder, check=True)
        with open(os.path.join(folder, name), "rb") as file:
            parts[name] = file.read()
    yield Sample("part1.vdb", "shard", parts.pop("part1.vdb"), parts)


def samples(command, folder):
    """All of them; `folder` is an empty one to work in."""
    good = os.path.join(folder, "good.vdb")
    subprocess.run([command, "convert", "shape:torus", "-r", "12", "-o", good, "--quiet"],
                   check=True)
    with open(good, "rb") as file:
        known = [*meshes(), *arrays(), *stacks(), *points(), *texts(file.read())]
    painted = next(s for s in known if s.name == "painted.obj")
    for name, data in {"painted.obj": painted.data, **painted.beside}.items():
        with open(os.path.join(folder, name), "wb") as file:
            file.write(data)
    return known + list(written(command, folder)) + list(shards(command, folder))
