"""The files that blocks of the pages begin with, made of built-in shapes and formulas."""

import pathlib
import shutil
import subprocess
import sys

import numpy as np

import bandvox
from pages import ROOT

sys.path.insert(0, str(ROOT / "scripts"))
from broken_scans import dicom, tiff  # noqa: E402  (small files of scans that are whole)


def two_balls(path):
    bandvox.to_mesh(bandvox.bandlimit("shape:two-balls", resolution=32)).write(path)


def colored(path):
    mesh = bandvox.to_mesh(bandvox.bandlimit("shape:torus", resolution=32))
    points = np.array(mesh.points)
    bandvox.Mesh(points, mesh.triangles, (points - points.min(0)) / np.ptp(points, 0)).write(path)


def bump(size=24, height=1000.0):
    """A ball of `height` in its middle that fades away, C-ordered floats."""
    x, y, z = np.meshgrid(*3 * [np.linspace(-1, 1, size)], indexing="ij")
    return (height * np.clip(1.2 - np.sqrt(x * x + y * y + z * z), 0, 1)).astype(np.float32)


def bump_grid(height, name="density"):
    return bandvox.Grid.from_array(bump(height=height), voxel_size=0.1, name=name)


def convert(*words):
    subprocess.run(["bandvox", "convert", *words], check=True, capture_output=True)


def array(path):
    grid = path.with_name("made.vdb")
    bump_grid(1000).write(grid)
    convert(grid, "-o", path)
    grid.unlink()


def density(path, shape="shape:two-balls", **options):
    bandvox.bandlimit(shape, resolution=24, **options).write(path)


def level_set(path):
    bandvox.write_vdb(path, [bandvox.to_level_set(bandvox.bandlimit("shape:torus", resolution=32))])


def images(path, name="slice.####.png"):
    path.mkdir()
    grid = path.with_name("made.vdb")
    bump_grid(1).write(grid)
    convert(grid, "-o", path / name, "--type", "uint16", "--range", "0,1")
    grid.unlink()


def slices(path):
    images(path.with_name("made"), "slice.####.tif")
    for image in path.with_name("made").iterdir():
        image.rename(path.parent / image.name)
    path.with_name("made").rmdir()


def dicom_series(path, series=1):
    path.mkdir()
    for number in range(series):
        for z in range(4):
            # One more digit at the end of the series' UID and of the slices' own.
            text = dicom(z=z).replace(b"1.2.3.1 ", b"1.2.3.%d" % (number + 1))
            (path / f"{number}-{z}.dcm").write_bytes(text.replace(b"1.2.3.1\0", b"1.2.3.%d\0" % (number + 1)))


def table(path, names, rows):
    path.write_text("\n".join([names, *(",".join(f"{n:.6g}" for n in row) for row in rows)]) + "\n")


def scattered(path):
    places = np.random.default_rng(3).uniform(0, 1, (60, 2))
    values = 2 + np.sin(4 * places[:, 0]) * np.cos(3 * places[:, 1])
    table(path, "x,y,height", np.column_stack([places, values]))


def particles(path):
    table(path, "x,y,z", np.random.default_rng(4).uniform(0, 0.3, (40, 3)))


def oriented_points(path):
    ways = np.random.default_rng(5).normal(size=(2000, 3))
    ways = (ways / np.linalg.norm(ways, axis=1)[:, None]).astype("<f4")
    head = "ply\nformat binary_little_endian 1.0\nelement vertex 2000\n"
    head += "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    path.write_bytes((head + "end_header\n").encode() + np.hstack([ways, ways]).tobytes())


def patches(path):
    shutil.copy(ROOT / "examples" / "data" / "teapot.bpt", path)


def example_data(path):
    path.symlink_to(ROOT / "examples")


def height_field(path):
    places = path.with_name("made.csv")
    scattered(places)
    bandvox.fit(places, max_level=2, tolerance=0.01).save(path)
    places.unlink()


def scenes(path):
    """The files of the gallery's scenes, beside the blocks that name them."""
    for file in (ROOT / "examples" / "scenes").glob("*.*"):
        if file.suffix in (".py", ".json"):
            shutil.copy(file, path.parent / file.name)


# What each name of a file stands for.
MAKERS = {
    "a.vdb": density,
    "after.vdb": lambda path: density(path, cutoff=0.15),
    "b.vdb": lambda path: density(path),
    "ball.vdb": lambda path: density(path, "shape:sphere"),
    "before.vdb": density,
    "block.vdb": lambda path: density(path, "shape:cube"),
    "body.vdb": density,
    "bunny.obj": two_balls,
    "bunny.vdb": density,
    "c.vdb": density,
    "cloud.vdb": lambda path: bump_grid(1).write(path),
    "cow.obj": two_balls,
    "dicom": dicom_series,
    "drill.vdb": lambda path: density(path, "shape:torus"),
    "examples": example_data,
    "hat.vdb": density,
    "head.nrrd": array,
    "heights.csv": scattered,
    "old_sdf.vdb": level_set,
    "painted.obj": colored,
    "part.stl": two_balls,
    "part.vdb": density,
    "particles.csv": particles,
    "scan": images,
    "scan.npy": lambda path: np.save(path, bump(height=100)),
    "scan.nrrd": array,
    "scan.ply": oriented_points,
    "scan.tif": lambda path: path.write_bytes(tiff(pages=8)),
    "scenes": scenes,
    "sim.0001.obj": two_balls,
    "sim.0002.obj": two_balls,
    "sim.0003.obj": two_balls,
    "slice.0000.tif": slices,
    "smoke.vdb": lambda path: bump_grid(1, "heat").write(path),
    "spot.obj": colored,
    "stanford-bunny.obj": two_balls,
    "surface.bpt": height_field,
    "teapot.obj": two_balls,
    "terrain.csv": scattered,
    "two series": lambda path: dicom_series(path.with_name("dicom"), 2),
}


def make(names, folder):
    for name in names:
        MAKERS[name](pathlib.Path(folder) / name)
