"""compare, info, view and the columns of fits are what the command says and writes."""

import json
import os
import pathlib
import subprocess

import numpy as np
import pytest

import bandvox

BANDVOX = pathlib.Path(os.environ.get("BANDVOX_BUILD_DIR", ""), "apps", "bandvox", "bandvox")
needs_command = pytest.mark.skipif(not BANDVOX.exists(), reason="needs the command")


def said(*words):
    return subprocess.run([BANDVOX, *map(str, words)], check=True, capture_output=True, text=True).stdout


@pytest.fixture(scope="module")
def folder(torus, cube, tmp_path_factory):
    place = tmp_path_factory.mktemp("files")
    torus.write(place / "torus.vdb")
    bandvox.bandlimit("shape:torus", resolution=40).write(place / "other.vdb")
    bandvox.to_mesh(torus).write(place / "torus.ply")
    points, triangles = cube
    bandvox.Mesh(points, triangles[:-1]).write(place / "open.ply")
    return place


@needs_command
def test_comparisons_are_those_of_the_command(folder):
    (a,), (b,) = (bandvox.read_vdb(folder / name) for name in ("torus.vdb", "other.vdb"))
    ours = bandvox.compare(a, b)
    theirs = json.loads(said("compare", folder / "torus.vdb", folder / "other.vdb", "--json"))
    for name in ("lattices", "maximum", "rms", "mean", "mean_absolute", "voxels"):
        assert ours[name] == theirs["values"][name], name
    assert ours["from_a"]["at_most"] == theirs["surfaces"]["from_a"]["at_most"]
    assert ours["hausdorff"] == theirs["surfaces"]["hausdorff"]
    assert ours["angle_maximum"] == theirs["surfaces"]["angle"]["maximum"]
    assert ours["volumes"] == (theirs["a"]["volume"], theirs["b"]["volume"])
    surfaces = bandvox.compare(a, b, only="surfaces", cuts=0)
    assert "maximum" not in surfaces and surfaces["hausdorff"] != ours["hausdorff"]
    assert "hausdorff" not in bandvox.compare(a, b, only="values")


@needs_command
def test_meshes_are_compared_by_their_surfaces(folder):
    (grid,) = bandvox.read_vdb(folder / "torus.vdb")
    theirs = json.loads(said("compare", folder / "torus.vdb", folder / "torus.ply", "--json"))
    for mesh in (folder / "torus.ply", bandvox.Mesh.read(folder / "torus.ply")):
        ours = bandvox.compare(grid, mesh)
        assert ours["hausdorff"] == theirs["surfaces"]["hausdorff"]
        assert ours["volumes"] == (theirs["a"]["volume"], theirs["b"]["volume"])
    with pytest.raises(bandvox.UsageError, match="a mesh has none"):
        bandvox.compare(grid, folder / "torus.ply", only="values")
    for wrong in ({"only": "edges"}, {"distance_tolerance": 0}, {"cuts": 4}):
        with pytest.raises(bandvox.UsageError):
            bandvox.compare(grid, grid, **wrong)


@needs_command
def test_reports_are_those_of_the_command(folder):
    for name in ("torus.vdb", "torus.ply", "open.ply"):
        assert bandvox.info(folder / name) == json.loads(said("info", folder / name, "--json"))
    (grid,) = bandvox.read_vdb(folder / "torus.vdb")
    of_grid, of_file = bandvox.info(grid), bandvox.info(folder / "torus.vdb")["grids"][0]
    assert of_grid["bandvox"] == of_file["bandvox"] and of_grid["class"] == "fog volume"
    mesh = bandvox.info(bandvox.Mesh.read(folder / "open.ply"))
    assert len(mesh["holes"]) == 1 and mesh["holes"][0]["edges"] == 3 and not mesh["closed"]
    assert mesh["volume"] == pytest.approx(8)
    with pytest.raises(bandvox.InputError):
        bandvox.info(folder / "none.vdb")
    with pytest.raises(bandvox.UsageError, match="found a int"):
        bandvox.info(7)


def test_pages_show_a_grid(torus, tmp_path):
    bandvox.view(tmp_path / "torus.html", torus, title="A <torus>", size=32)
    page = (tmp_path / "torus.html").read_text()
    assert "A &lt;torus&gt;" in page and "<html" in page
    with pytest.warns(bandvox.BandvoxWarning, match="no surface is seen"):
        bandvox.view(tmp_path / "empty.html", torus, iso=3.0, size=32)
    for path, options in (("torus.txt", {}), ("torus.html", {"size": 8})):
        with pytest.raises(bandvox.UsageError):
            bandvox.view(tmp_path / path, torus, **options)


def table(path, names, columns):
    rows = np.column_stack(columns)
    path.write_text("\n".join([names, *(",".join(f"{n:.9g}" for n in row) for row in rows)]) + "\n")


@pytest.fixture(scope="module")
def painted(tmp_path_factory):
    """Heights in a plane and their colours, and the file of them."""
    path = tmp_path_factory.mktemp("tables") / "heights.csv"
    x, y = np.random.RandomState(3).uniform(0, 1, (2, 80))
    table(path, "x,y,height,r,g,b", (x, y, x * y, x, y, 0.5 + 0 * x))
    return path


@needs_command
def test_colors_of_a_surface_are_those_of_the_command(painted, tmp_path):
    surface = bandvox.fit(painted, tolerance=1e-3)
    assert surface.column_names == ["height", "r", "g", "b"]
    density = surface.density(resolution=32)
    colors = bandvox.colors(surface, density)
    said("fit", painted, "-o", tmp_path / "solid.vdb", "--tolerance", 1e-3, "--resolution", 32)
    theirs = {grid.name: grid for grid in bandvox.read_vdb(tmp_path / "solid.vdb")}
    np.testing.assert_array_equal(density.to_array()[0], theirs["density"].to_array()[0])
    np.testing.assert_array_equal(colors.to_array()[0], theirs["Cd"].to_array()[0])
    for name, options, words in (
        ("s.ply", {"samples": 9}, ["--samples", 9]),
        ("s.npy", {"samples": 9, "quantities": ["value", "normal", "mean"]},
         ["--samples", 9, "--quantities", "value,normal,mean"]),
    ):
        surface.save(tmp_path / f"ours-{name}", **options)
        said("fit", painted, "-o", tmp_path / name, "--tolerance", 1e-3, *words)
        assert (tmp_path / f"ours-{name}").read_bytes() == (tmp_path / name).read_bytes()
    read = np.load(tmp_path / "s.npy")
    np.testing.assert_array_equal(surface.sample(9, quantities=["value", "normal", "mean"]), read)
    assert read.shape[2] == 4 * (1 + 3 + 1)
    np.testing.assert_array_equal(surface.part(1, 1).column_names, surface.column_names)
    plain = bandvox.fit(np.random.RandomState(1).uniform(0, 1, (9, 2)), np.arange(9))
    with pytest.raises(bandvox.UsageError, match="no columns named r, g and b"):
        bandvox.colors(plain, density)
    for wrong in ("area", "value"):
        with pytest.raises(bandvox.UsageError, match="quantities: found"):
            surface.sample(9, quantities=["value", wrong])
    with pytest.raises(bandvox.UsageError, match="quantities are for"):
        surface.save(tmp_path / "s.obj", quantities=["dx"])


@needs_command
def test_columns_in_space_become_grids(tmp_path):
    x, y, z = np.random.RandomState(4).uniform(0, 1, (3, 120))
    table(tmp_path / "p.csv", "x,y,z,heat,u,v,w", (x, y, z, x + y, x, y, z))
    volume = bandvox.fit_volume(tmp_path / "p.csv", tolerance=0.05, max_level=3)
    ours = {grid.name: grid for grid in volume.grids(resolution=12)}
    said("fit", tmp_path / "p.csv", "--volume", "-o", tmp_path / "p.vdb", "--resolution", 12, "--tolerance",
         0.05, "--max-level", 3, "--quantities", "value,gradient")
    theirs = {grid.name: grid for grid in bandvox.read_vdb(tmp_path / "p.vdb")}
    assert set(ours) == {"heat", "vel"}
    for name in ours:
        np.testing.assert_array_equal(ours[name].to_array()[0], theirs[name].to_array()[0])
    slope = volume.grid(name="heat_gradient", quantity="gradient", resolution=12)
    np.testing.assert_array_equal(slope.to_array()[0], theirs["heat_gradient"].to_array()[0])
    with pytest.raises(bandvox.UsageError, match="of one column"):
        volume.grid(quantity="gradient", columns=3)


def test_vectors_and_level_sets_go_to_other_lattices(torus):
    colors = bandvox.VectorGrid.from_array(np.full((16, 16, 16, 3), (0.25, 0.5, 1.0)), name="Cd",
                                           voxel_size=0.1)
    coarse = bandvox.resample(colors, factor=2)
    values, _ = coarse.to_array()
    np.testing.assert_allclose(values[values.sum(axis=-1) > 0], [(0.25, 0.5, 1.0)] * coarse.active_voxel_count,
                               atol=1e-4)
    (level,) = bandvox.detail_levels(colors, 1)
    assert level.name == "Cd_level_1" and isinstance(level, bandvox.VectorGrid)
    distances = bandvox.to_level_set(torus)
    half = bandvox.resample(distances, factor=2)
    assert half.grid_class == "level set" and half.name == distances.name
    # What is inside of both is the same but for what a coarser filter takes away.
    assert bandvox.compare(half, distances, only="surfaces")["mean_distance"] < torus.voxel_size[0]
    assert [one.name for one in bandvox.detail_levels(distances, 2)] == ["surface_level_1", "surface_level_2"]
    wide = bandvox.resample(torus, resolution=20)
    assert wide.voxel_size[0] == pytest.approx(59 / 20 * torus.voxel_size[0])


@needs_command
def test_merging_on_other_lattices_is_that_of_the_command(folder, tmp_path):
    (a,), (b,) = (bandvox.read_vdb(folder / name) for name in ("torus.vdb", "other.vdb"))
    merged = bandvox.merge([a, b], operation="blend", resample=True)
    said("merge", folder / "torus.vdb", folder / "other.vdb", "-o", tmp_path / "m.vdb", "--operation", "blend",
         "--resample")
    (theirs,) = bandvox.read_vdb(tmp_path / "m.vdb")
    np.testing.assert_array_equal(merged.to_array(theirs.bounds)[0], theirs.to_array()[0])
    with pytest.raises(bandvox.InputError):
        bandvox.merge([a, b])


def test_drawings_take_pages_by_name_and_volumes_by_theirs(torus):
    assert bandvox.outline(torus, page="A5-landscape", tolerance=0.1).page == (210, 148)
    by_volume = bandvox.outline(torus, iso="volume", tolerance=0.1)
    assert by_volume.svg() != bandvox.outline(torus, tolerance=0.1).svg()
    with pytest.raises(bandvox.UsageError, match="light"):
        bandvox.outline(torus, light=(0, 0, 0))
    for page in ("B5", (1, 2, 3), ("a", "b")):
        with pytest.raises(bandvox.UsageError, match="page"):
            bandvox.outline(torus, page=page)
