"""bandlimit takes files, arrays, meshes and functions, and says what is wrong with others."""

import os
import threading
import warnings

import numpy as np
import pytest

import bandvox


def test_shapes_have_their_volume(torus):
    volume = 2 * np.pi**2 * 0.7 * 0.3**2
    assert torus.metadata["bandvox_source_volume"] == pytest.approx(volume, rel=0.1)
    assert torus.metadata["bandvox_grid_volume"] == pytest.approx(
        torus.metadata["bandvox_source_volume"], rel=1e-4)
    assert "torus" in bandvox.shape_names()


def test_arrays_files_and_meshes_are_the_same(cube, tmp_path):
    points, triangles = cube
    of_arrays = bandvox.bandlimit((points, triangles), voxel_size=0.1)
    mesh = bandvox.Mesh(points, triangles)
    of_mesh = bandvox.bandlimit(mesh, voxel_size=0.1)
    mesh.write(tmp_path / "cube.ply")
    of_file = bandvox.bandlimit(tmp_path / "cube.ply", voxel_size=0.1)
    assert of_file.metadata["bandvox_source"] == "cube.ply"
    assert of_arrays.metadata["bandvox_grid_volume"] == pytest.approx(8, rel=1e-4)
    values, first = of_arrays.to_array()
    for other in (of_mesh, of_file):
        others, others_first = other.to_array()
        assert others_first == first
        np.testing.assert_array_equal(others, values)


def test_a_function_is_sampled():
    def ball(x, y, z):
        return (x * x + y * y + z * z < 1).astype(np.float32)

    grid = bandvox.bandlimit(ball, voxel_size=0.1, bounds=((-1, -1, -1), (1, 1, 1)), oversample=4,
                             tolerance=0.05)
    assert grid.metadata["bandvox_source"] == "ball"
    assert grid.metadata["bandvox_route"] == "sampled"
    assert grid.metadata["bandvox_grid_volume"] == pytest.approx(4 / 3 * np.pi, rel=1e-2)
    exact = bandvox.bandlimit("shape:sphere", voxel_size=0.1)
    assert bandvox.compare(grid, exact, only="values")["maximum"] < 0.05


def test_what_a_function_raises_comes_through():
    def fails(x, y, z):
        raise LookupError("no such place")

    with pytest.raises(LookupError, match="no such place"):
        bandvox.bandlimit(fails, voxel_size=0.2, bounds=((-1, -1, -1), (1, 1, 1)))
    with pytest.raises(bandvox.UsageError, match="bounds"):
        bandvox.bandlimit(fails, voxel_size=0.2)


@pytest.mark.parametrize("given, words", [
    (np.zeros(3), r"shape \(3,\).*expected one number, or numbers of shape"),
    ("a", "<U1.*expected one number"), (None, "object.*expected one number"),
    (1j, "complex"), (np.nan, "found nan.*finite"), (-np.inf, "found -inf")])
def test_a_function_has_to_give_numbers(given, words):
    with pytest.raises(bandvox.UsageError, match=words):
        bandvox.bandlimit(lambda x, y, z: given, voxel_size=0.2, bounds=((-1, -1, -1), (1, 1, 1)))


@pytest.mark.parametrize("bounds", [((1, 1, 1), (-1, -1, -1)), ((0, 0, 0), (1, 1, 0)),
                                    ((np.nan, 0, 0), (1, 1, 1)), ((0, 0, 0), (1, np.inf, 1))])
def test_bounds_have_to_hold_something(bounds):
    with pytest.raises(bandvox.UsageError, match="expected the lowest place"):
        bandvox.bandlimit(lambda x, y, z: 1, voxel_size=0.2, bounds=bounds)


def test_names_of_files_are_text_bytes_or_paths(cube, tmp_path):
    folder = tmp_path / "Größe ☃"
    folder.mkdir()
    bandvox.Mesh(*cube).write(folder / "würfel.ply")
    for path in (folder / "würfel.ply", str(folder / "würfel.ply"), os.fsencode(folder / "würfel.ply")):
        grid = bandvox.bandlimit(path, voxel_size=0.25)
        assert grid.metadata["bandvox_source"] == "würfel.ply"
        assert bandvox.info(path)["file"] == str(folder / "würfel.ply")


def test_errors_name_files_that_have_no_name_in_utf8(tmp_path):
    with pytest.raises(bandvox.InputError, match=r"gr\\xf6n\.obj"):
        bandvox.bandlimit(os.fsdecode(os.fsencode(tmp_path) + b"/gr\xf6n.obj"))
    with pytest.raises(bandvox.InputError, match=r"gr\\xf6n\.vdb"):
        bandvox.read_vdb(os.fsencode(tmp_path) + b"/gr\xf6n.vdb")


def test_names_that_no_file_has_are_refused():
    for use in (bandvox.bandlimit, bandvox.info, bandvox.voxelize, bandvox.outline, bandvox.fit,
                bandvox.bandlimit_points):
        for name in ("a\0.obj", b"a\0.obj"):
            with pytest.raises(bandvox.UsageError, match="zero byte"):
                use(name)


def test_openings_are_a_warning(cube):
    points, triangles = cube
    with pytest.warns(bandvox.BandvoxWarning):
        grid = bandvox.bandlimit((points, triangles[:-1]), voxel_size=0.2)
    assert grid.metadata["bandvox_holes_capped"] == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(bandvox.BandvoxWarning):
            bandvox.bandlimit((points, triangles[:-1]), voxel_size=0.2)


def test_wrong_arguments_are_named(cube, tmp_path):
    points, triangles = cube
    for source, words in (
        ((points[:, :2], triangles), r"points: found an array of shape \(8, 2\) of float64"),
        ((points, triangles.astype(float)), r"triangles: found an array of shape \(12, 3\) of fl"),
        ((points, triangles + 1), "point"),
        ((points, triangles - 1), "-1"),
        (7, "found a int"),
    ):
        with pytest.raises((bandvox.UsageError, bandvox.InputError), match=words):
            bandvox.bandlimit(source)
    with pytest.raises(ValueError, match="cutoff"):
        bandvox.bandlimit("shape:cube", cutoff=3)
    with pytest.raises(bandvox.UsageError, match="'sideways'.*'exact'"):
        bandvox.bandlimit("shape:cube", route="sideways")
    with pytest.raises(bandvox.InputError, match="none.obj"):
        bandvox.bandlimit(tmp_path / "none.obj")
    (tmp_path / "broken.obj").write_text("v 1 2\nf 1 2 3\n")
    with pytest.raises(bandvox.InputError):
        bandvox.bandlimit(tmp_path / "broken.obj")
    with pytest.raises(MemoryError):
        bandvox.bandlimit("shape:sphere", resolution=100_000)


def test_progress_is_told_and_may_stop_the_work():
    told = []
    bandvox.bandlimit("shape:tree", resolution=300,
                      progress=lambda stage, fraction: told.append((stage, fraction)))
    assert told
    assert all(fraction is None or 0 <= fraction <= 1 for _, fraction in told)

    def stop(stage, fraction):
        raise StopAsyncIteration("enough")

    with pytest.raises(StopAsyncIteration, match="enough"):
        bandvox.bandlimit("shape:tree", resolution=600, progress=stop)


def test_threads_change_nothing(torus):
    one = bandvox.bandlimit("shape:torus", resolution=48, threads=1)
    np.testing.assert_array_equal(one.to_array()[0], torus.to_array()[0])
    with pytest.raises(bandvox.UsageError):
        bandvox.bandlimit("shape:torus", resolution=48, threads=-1)


def test_other_threads_of_python_go_on():
    counted = 0
    goes_on = threading.Event()

    def count():
        nonlocal counted
        while not goes_on.is_set():
            counted += 1

    counter = threading.Thread(target=count)
    counter.start()
    before = counted
    bandvox.bandlimit("shape:torus", resolution=128)
    after = counted
    goes_on.set()
    counter.join()
    assert after > before
