"""voxelize makes binary voxels of whatever bandlimit takes, and colors the colours beside them."""

import numpy as np
import pytest

import bandvox


def test_voxels_of_a_cube(cube, tmp_path):
    points, triangles = cube
    points = points * 0.96
    voxels = bandvox.voxelize((points, triangles), voxel_size=0.1)
    array, _ = voxels.to_array()
    assert array.shape == (19, 19, 19) and (array == 1).all()
    mesh = bandvox.Mesh(points, triangles)
    mesh.write(tmp_path / "cube.ply")
    for source in (mesh, tmp_path / "cube.ply"):
        for axis in "xyz":
            other = bandvox.voxelize(source, voxel_size=0.1, axis=axis, backend="cpu")
            np.testing.assert_array_equal(other.to_array()[0], array)


def test_shapes_and_functions_are_the_same():
    shape = bandvox.voxelize("shape:sphere", voxel_size=0.09)
    function = bandvox.voxelize(lambda x, y, z: x * x + y * y + z * z < 1, voxel_size=0.09,
                                bounds=((-1, -1, -1), (1, 1, 1)))
    np.testing.assert_array_equal(shape.to_array()[0], function.to_array()[0])
    share = bandvox.voxelize("shape:sphere", voxel_size=0.09, fraction=True)
    array, _ = share.to_array()
    np.testing.assert_array_equal(array * 8, np.round(array * 8))
    assert array.sum() * 0.09**3 == pytest.approx(4 / 3 * np.pi, rel=0.02)
    most = bandvox.voxelize("shape:sphere", voxel_size=0.09, threshold=1)
    assert most.active_voxel_count == share.active_voxel_count > shape.active_voxel_count


def test_wrong_options_are_named(cube):
    for source, options, words in (
        ("shape:cube", {"axis": "w"}, "'w'"),
        ("shape:cube", {"backend": "gpu"}, "formula"),
        ("shape:cube", {"fraction": True, "threshold": 2}, "exclude"),
        ("shape:cube", {"threshold": 9}, "9"),
        (3, {}, "found a int"),
        (lambda x, y, z: x, {}, "bounds"),
    ):
        with pytest.raises(bandvox.UsageError, match=words):
            bandvox.voxelize(source, **options)

    def fails(x, y, z):
        raise LookupError("no such place")

    with pytest.raises(LookupError, match="no such place"):
        bandvox.voxelize(fails, voxel_size=0.5, bounds=((-1, -1, -1), (1, 1, 1)))


def test_colors_lie_on_the_lattice_of_the_density(cube, tmp_path):
    points, triangles = cube
    shades = (points + 1) / 2
    mesh = bandvox.Mesh(points, triangles, colors=shades)
    np.testing.assert_allclose(mesh.colors, shades)
    density = bandvox.bandlimit(mesh, resolution=32)
    painted = bandvox.colors(mesh, density)
    assert painted.name == "Cd"
    np.testing.assert_allclose(painted.transform, density.transform)
    values, first = painted.to_array()
    # On a face the colour is the place.
    middle = np.round(1 / density.voxel_size[0]).astype(int)
    on_face = tuple(np.array((middle, 0, 0)) - first)
    np.testing.assert_allclose(values[on_face], (1, 0.5, 0.5), atol=0.05)
    assert values.min() >= 0 and values.max() <= 1
    mesh.write(tmp_path / "painted.glb")
    of_file = bandvox.colors(tmp_path / "painted.glb", density)
    np.testing.assert_allclose(of_file.to_array()[0], values, atol=0.01)
    bandvox.write_vdb(tmp_path / "both.vdb", [density, painted])

    with pytest.raises(bandvox.UsageError, match="no colors"):
        bandvox.colors(bandvox.Mesh(points, triangles), density)
    with pytest.raises(bandvox.UsageError, match="colors: found 7"):
        bandvox.Mesh(points, triangles, colors=shades[:7])
    with pytest.raises(bandvox.UsageError, match="0 to 1"):
        bandvox.Mesh(points, triangles, colors=2 * shades)
