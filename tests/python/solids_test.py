"""Solids of patches, points, grids and scans are what the command makes of them."""

import os
import pathlib
import re
import subprocess

import numpy as np
import pytest

import bandvox

ROOT = pathlib.Path(__file__).resolve().parents[2]
TEAPOT = ROOT / "examples" / "data" / "teapot.bpt"
BANDVOX = pathlib.Path(os.environ.get("BANDVOX_BUILD_DIR", ""), "apps", "bandvox", "bandvox")
needs_command = pytest.mark.skipif(not BANDVOX.exists(), reason="needs the command")


def command(*words):
    subprocess.run([BANDVOX, *map(str, words)], check=True, capture_output=True)


def assert_same(ours, file):
    """The first grid of a file is, voxel for voxel, ours."""
    theirs = bandvox.read_vdb(file)[0]
    assert ours.bounds == theirs.bounds
    np.testing.assert_array_equal(ours.to_array()[0], theirs.to_array()[0])
    np.testing.assert_array_equal(ours.transform, theirs.transform)
    for name, value in theirs.metadata.items():
        if name.startswith("bandvox_") and name not in ("bandvox_settings", "bandvox_input",
                                                        "bandvox_source"):
            assert ours.metadata[name] == value or value != value, name


def ball(size=32, height=1.2, spread=1.0):
    """Numbers that fall from the middle on, and where they lie."""
    axis = np.linspace(-1, 1, size)
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    return (spread * np.clip(height - np.sqrt(x * x + y * y + z * z), 0, None)).astype(np.float32)


def volume_of(grid):
    return grid.metadata["bandvox_grid_volume"]


def test_patches_are_filled_exactly():
    # z = 1 - x² - y² above the square where it is positive at the corners, over z = -1.
    t = np.array([-0.5, 0.0, 0.5])
    x, y = np.meshgrid(t, t, indexing="ij")
    square = np.array([0.25, -0.25, 0.25])
    net = np.stack([x, y, 1 - square[:, None] - square[None, :]], axis=-1)
    density = bandvox.bandlimit(bandvox.Patches([net]), resolution=48, base=-1)
    assert volume_of(density) == pytest.approx(2 - 2 / 12, rel=1e-4)
    assert density.metadata["bandvox_route"] == "exact"
    with pytest.raises(bandvox.UsageError, match="base"):
        bandvox.bandlimit("shape:torus", base=0)
    with pytest.raises(bandvox.UsageError, match="route is 'sampled'"):
        bandvox.bandlimit(bandvox.Patches([net]), route="sampled", base=-1)
    with pytest.raises(bandvox.UsageError, match="not below the surface"):
        bandvox.bandlimit(bandvox.Patches([net]), base=0.9)


@needs_command
def test_a_file_of_patches_is_what_the_command_makes_of_it(tmp_path):
    with pytest.warns(bandvox.BandvoxWarning):
        of_file = bandvox.bandlimit(TEAPOT, resolution=24)
    with pytest.warns(bandvox.BandvoxWarning):
        of_patches = bandvox.bandlimit(bandvox.Patches.read(TEAPOT), resolution=24)
    command("convert", TEAPOT, "-o", tmp_path / "teapot.vdb", "--resolution", 24)
    assert_same(of_file, tmp_path / "teapot.vdb")
    assert_same(of_patches, tmp_path / "teapot.vdb")


@needs_command
def test_parts_join_to_the_whole(tmp_path):
    parts = [bandvox.bandlimit("shape:torus", resolution=64, tile=40, shard=(i, 3)) for i in (1, 2, 3)]
    whole = bandvox.bandlimit("shape:torus", resolution=64, tile=40)
    joined = bandvox.join_shards(parts[::-1])
    np.testing.assert_array_equal(joined.to_array()[0], whole.to_array()[0])
    with pytest.raises(bandvox.InputError):
        bandvox.join_shards(parts[:2])
    with pytest.raises(bandvox.UsageError, match="part i of n"):
        bandvox.bandlimit("shape:torus", shard="2/3")
    command("convert", "shape:torus", "-o", tmp_path / "part.vdb", "--resolution", 64, "--tile", 40,
            "--shard", "2/3")
    assert_same(parts[1], tmp_path / "part.vdb")


def test_the_iso_value_may_be_that_of_the_volume():
    density = bandvox.bandlimit("shape:sphere", resolution=16, iso="volume")
    expected, _ = bandvox.iso_of_volume(density, density.metadata["bandvox_source_volume"])
    assert density.metadata["bandvox_iso"] == pytest.approx(expected)
    plain = bandvox.bandlimit("shape:sphere", resolution=16)
    np.testing.assert_array_equal(bandvox.to_mesh(plain, iso="volume").points,
                                  bandvox.to_mesh(density).points)
    for wrong in ("area", (1, 2)):
        with pytest.raises(bandvox.UsageError, match="'volume'"):
            bandvox.to_mesh(plain, iso=wrong)


def test_an_error_that_is_asked_for_is_kept():
    options = {"voxel_size": 0.1, "bounds": ((-1, -1, -1), (1, 1, 1))}

    def inside(x, y, z):
        return x * x + y * y + z * z < 1

    loose = bandvox.bandlimit(inside, oversample=4, tolerance=0.05, **options)
    assert 1e-4 < loose.metadata["bandvox_sampling_error"] <= 0.05
    with pytest.raises(bandvox.ResultError, match="sampling error"):
        bandvox.bandlimit(inside, oversample=4, tolerance=1e-4, **options)
    with pytest.raises(bandvox.ResultError, match="odd oversample"):
        bandvox.bandlimit(inside, oversample=3, tolerance=0.05, **options)
    with pytest.raises(bandvox.UsageError, match="oversample has no meaning"):
        bandvox.bandlimit("shape:sphere", oversample=4)


def test_points_become_balls():
    places = np.array([[0, 0, 0], [1.5, 0, 0]])
    apart = bandvox.bandlimit_points(places, radius=0.5, resolution=64)
    assert volume_of(apart) == pytest.approx(2 * 4 / 3 * np.pi * 0.5**3, rel=2e-3)
    each = bandvox.bandlimit_points(places, radius=[0.5, 0.25], resolution=64)
    assert volume_of(each) == pytest.approx(4 / 3 * np.pi * (0.5**3 + 0.25**3), rel=4e-3)
    with pytest.warns(bandvox.BandvoxWarning, match="1 of 2 balls are too small"):
        bandvox.bandlimit_points(places, radius=[0.5, 1e-4], resolution=32)


def test_points_with_normals_become_a_surface():
    ways = np.random.RandomState(5).normal(size=(3000, 3))
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    density = bandvox.bandlimit_points(ways, normals=ways, resolution=24)
    assert volume_of(density) == pytest.approx(4 / 3 * np.pi, rel=0.02)


def test_points_of_which_no_solid_can_be_made(tmp_path):
    places = np.zeros((4, 3)) + np.arange(4)[:, None]
    for options, words in (
        ({}, "without radii and normals"),
        ({"points": "balls"}, "without radii"),
        ({"points": "surface"}, "without normals"),
    ):
        with pytest.raises(bandvox.InputError, match=words):
            bandvox.bandlimit_points(places, **options)
    for options, words in (
        ({"radius": 0}, "radius: found"),
        ({"radius": [1, 2]}, r"radius: found an array of shape \(2,\)"),
        ({"radius": "wide"}, "radius"),
        ({"normals": np.zeros((3, 3))}, "normals: found 3"),
        ({"points": "lines"}, "'lines'"),
        ({"radius": 1, "points": "surface"}, "no meaning"),
        ({"radius": 1, "resolution": 0}, "resolution is 0"),
    ):
        with pytest.raises(bandvox.UsageError, match=words):
            bandvox.bandlimit_points(places, **options)
    with pytest.raises(bandvox.UsageError, match=r"points: found an array of shape \(4, 2\)"):
        bandvox.bandlimit_points(places[:, :2], radius=1)
    with pytest.raises(bandvox.UsageError, match="not finite"):
        bandvox.bandlimit_points([[0, 0, np.nan]], radius=1)


@needs_command
def test_a_file_of_points_is_what_the_command_makes_of_it(tmp_path):
    places = np.random.RandomState(4).uniform(0, 0.3, (30, 3))
    lines = "\n".join(",".join(f"{n:.6g}" for n in row) for row in places)
    (tmp_path / "p.csv").write_text(f"x,y,z\n{lines}\n")
    ours = bandvox.bandlimit_points(tmp_path / "p.csv", radius=0.05, resolution=40)
    command("convert", tmp_path / "p.csv", "-o", tmp_path / "p.vdb", "--radius", 0.05, "--resolution", 40)
    assert_same(ours, tmp_path / "p.vdb")


@needs_command
def test_solids_of_grids_are_what_the_command_makes_of_them(torus, tmp_path):
    distances = bandvox.to_level_set(torus, iso="volume")
    distances.write(tmp_path / "distances.vdb")
    again = bandvox.bandlimit_grid(distances, factor=2)
    command("convert", tmp_path / "distances.vdb", "-o", tmp_path / "again.vdb", "--as", "density",
            "--factor", 2)
    assert_same(again, tmp_path / "again.vdb")
    assert volume_of(again) == pytest.approx(volume_of(torus), rel=5e-3)
    np.save(tmp_path / "scan.npy", ball(spread=1000))
    scan = bandvox.read_array(tmp_path / "scan.npy", spacing=0.1, origin=(1, 2, 3))
    np.testing.assert_allclose(scan.transform[:3, 3], (1, 2, 3))
    for words, threshold in (("300", 300), ("300,700", (300, 700))):
        command("convert", tmp_path / "scan.npy", "-o", tmp_path / "bone.vdb", "--threshold", words,
                "--spacing", 0.1, "--origin", "1,2,3", "--voxel-size", 0.15)
        assert_same(bandvox.bandlimit_grid(scan, threshold=threshold, voxel_size=0.15),
                    tmp_path / "bone.vdb")
    with pytest.raises(bandvox.UsageError, match="density already"):
        bandvox.bandlimit_grid(torus)
    with pytest.raises(bandvox.UsageError, match="got 2"):
        bandvox.bandlimit_grid(scan, threshold=300, factor=2, voxel_size=1)
    for threshold in (-1, (700, 300), (-5, 300)):
        with pytest.raises(bandvox.UsageError, match="threshold is"):
            bandvox.bandlimit_grid(scan, threshold=threshold)


def test_voxels_that_are_no_cubes_become_cubes():
    grid = bandvox.Grid.from_array(ball(), voxel_size=(0.05, 0.1, 0.1))
    density = bandvox.bandlimit_grid(grid, threshold=0.5)
    assert density.voxel_size == pytest.approx((0.05, 0.05, 0.05))
    with pytest.raises(bandvox.UsageError, match="no cubes"):
        bandvox.bandlimit_grid(grid, threshold=0.5, onto=grid)


@needs_command
def test_fog_is_what_the_command_makes(tmp_path):
    density = bandvox.bandlimit("shape:torus", resolution=40)
    command("convert", "shape:torus", "-o", tmp_path / "fog.vdb", "--as", "fog", "--band", 2,
            "--resolution", 40)
    fog = bandvox.to_fog(density, band=2)
    assert fog.grid_class == "fog volume"
    theirs = bandvox.read_vdb(tmp_path / "fog.vdb")[0]
    np.testing.assert_array_equal(fog.to_array()[0], theirs.to_array()[0])


def test_masks(cube, tmp_path):
    points, triangles = cube
    solid = (points * 0.96, triangles)
    mask = bandvox.voxelize(solid, voxel_size=0.1, as_="mask")
    assert isinstance(mask, bandvox.MaskGrid) and mask.active_voxel_count == 19**3
    array, first = mask.to_array()
    assert array.dtype == bool and array.all() and first == (-9, -9, -9)
    mask.write(tmp_path / "mask.vdb", compression="zip")
    (back,) = bandvox.read_vdb(tmp_path / "mask.vdb")
    np.testing.assert_array_equal(back.to_array()[0], array)
    holes = np.random.RandomState(1).random_sample((9, 5, 17)) < 0.5
    sparse = bandvox.MaskGrid.from_array(holes, origin=(3, 0, -1), name="holes")
    np.testing.assert_array_equal(sparse.to_array(((3, 0, -1), (11, 4, 15)))[0], holes)
    assert sum(int(block.sum()) for _, block in sparse.blocks()) == holes.sum()
    # Where a grid is wanted it is 1 where it is active.
    numbers = bandvox.voxelize(solid, voxel_size=0.1)
    np.testing.assert_array_equal(bandvox.to_mesh(mask).points, bandvox.to_mesh(numbers).points)
    with pytest.raises(bandvox.UsageError, match="mask cannot hold"):
        bandvox.voxelize(solid, voxel_size=0.1, as_="mask", fraction=True)


def test_other_numbers_are_read_as_floats(tmp_path):
    openvdb = pytest.importorskip("pyopenvdb")
    grids = []
    for kind, value in ((openvdb.BoolGrid, True), (openvdb.FloatGrid, 2.5)):
        grid = kind()
        grid.name = kind.__name__
        grid.fill((0, 0, 0), (3, 3, 3), value, True)
        grids.append(grid)
    openvdb.write(str(tmp_path / "all.vdb"), grids=grids)
    found = {grid.name: grid for grid in bandvox.read_vdb(tmp_path / "all.vdb")}
    assert isinstance(found["BoolGrid"], bandvox.MaskGrid)
    assert found["FloatGrid"].to_array()[0].max() == 2.5


@needs_command
@pytest.mark.parametrize("name, options, words", [
    ("a.npy", {}, []),
    ("a.npy", {"type": "double", "box": ((0, 0, 0), (3, 4, 5))}, ["--type", "double", "--box", "0,0,0,3,4,5"]),
    ("a.nrrd", {"type": "uint16", "compression": "zip"}, ["--type", "uint16", "--compression", "zip"]),
    ("a.mhd", {}, []),
    ("a.tif", {"type": "uint8", "range": (0, 2)}, ["--type", "uint8", "--range", "0,2"]),
    ("a.####.png", {}, []),
])
def test_arrays_are_written_as_the_command_does(torus, tmp_path, name, options, words):
    torus.write(tmp_path / "torus.vdb")
    (torus,) = bandvox.read_vdb(tmp_path / "torus.vdb")
    ours, theirs = tmp_path / "ours", tmp_path / "theirs"
    for folder in (ours, theirs):
        folder.mkdir()
    bandvox.write_array(ours / name, torus, **options)
    command("convert", tmp_path / "torus.vdb", "-o", theirs / name, *words)
    assert {path.name for path in ours.iterdir()} == {path.name for path in theirs.iterdir()}
    for path in ours.iterdir():
        # Some say when they were written.
        found, expected = (re.sub(rb"\d{4}:\d\d:\d\d \d\d:\d\d:\d\d", b"", file.read_bytes())
                           for file in (path, theirs / path.name))
        assert found == expected, path.name


def test_arrays_that_cannot_be_written(torus, tmp_path):
    for name, options, words in (
        ("a.txt", {}, "unknown kind"),
        ("a.npy", {"type": "complex"}, "'complex'"),
        ("a.npy", {"compression": "zip"}, "never are compressed"),
        ("a.####.png", {"compression": "none"}, "always are"),
        ("a.npy", {"range": (1, 0)}, "lower one first"),
        ("a.npy", {"box": ((0, 0, 0), (-1, 0, 0))}, "box: found"),
        ("a.npy", {"box": ((0, 0, 0.5), (1, 1, 1))}, "whole numbers"),
    ):
        with pytest.raises(bandvox.UsageError, match=words):
            bandvox.write_array(tmp_path / name, torus, **options)
    assert list(tmp_path.iterdir()) == []
    with pytest.warns(bandvox.BandvoxWarning, match="clipped"):
        bandvox.write_array(tmp_path / "a.npy", torus, type="uint8", range=(0.2, 0.8))
    with pytest.raises(bandvox.InputError):
        bandvox.read_array(tmp_path / "none.nrrd")
    with pytest.raises(bandvox.UsageError, match="space"):
        bandvox.read_array(tmp_path / "a.npy", space="up")


def test_files_of_half_say_what_holds_of_them(torus, tmp_path):
    torus.write(tmp_path / "half.vdb", half=True)
    (half,) = bandvox.read_vdb(tmp_path / "half.vdb")
    values = torus.to_array()[0], half.to_array(torus.bounds)[0]
    change = np.abs(values[0] - values[1]).max()
    assert 0 < half.metadata["bandvox_storage_error"] == pytest.approx(change, rel=1e-6)
    assert torus.metadata["bandvox_storage_error"] == 0


def test_usd_volumes_refer_to_their_files(torus, tmp_path):
    bandvox.write_vdb(tmp_path / "torus.usda", [torus])
    assert {path.name for path in tmp_path.iterdir()} == {"torus.usda", "torus.vdb"}
    assert "torus.vdb" in (tmp_path / "torus.usda").read_text()
    with pytest.raises(bandvox.UsageError, match="compression"):
        torus.write(tmp_path / "torus.vdb", compression="gzip")
