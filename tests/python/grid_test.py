"""Grids go to arrays, files, pickles and back."""

import pickle

import numpy as np
import pytest

import bandvox


def sample(shape=(12, 9, 20)):
    numbers = np.random.RandomState(3).random_sample(shape).astype(np.float32)
    numbers[numbers < 0.5] = 0
    return numbers


@pytest.mark.parametrize("dtype", ["float32", "float64", "float16", "uint8", "int32", "bool"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_come_back(dtype, order):
    array = np.asarray(sample() * 200, dtype=dtype, order=order)
    grid = bandvox.Grid.from_array(array, origin=(-5, 3, 1000))
    values, first = grid.to_array(((-5, 3, 1000), (6, 11, 1019)))
    assert first == (-5, 3, 1000)
    assert values.dtype == np.float32
    np.testing.assert_array_equal(values, array.astype(np.float32))
    assert grid.active_voxel_count == np.count_nonzero(array)


def test_strided_arrays_are_taken():
    array = sample((24, 9, 40))[::2, :, ::-2]
    values, _ = bandvox.Grid.from_array(array).to_array(((0, 0, 0), (11, 8, 19)))
    np.testing.assert_array_equal(values, array)


def test_vectors_come_back():
    colors = np.random.RandomState(1).random_sample((5, 6, 7, 3)).astype(np.float32)
    grid = bandvox.VectorGrid.from_array(colors, name="Cd")
    values, first = grid.to_array()
    assert first == (0, 0, 0) and grid.name == "Cd"
    np.testing.assert_array_equal(values, colors)


def test_the_transform_acts_on_columns():
    transform = np.array([[0, -2, 0, 5], [3, 0, 0, 6], [0, 0, 4, 7], [0, 0, 0, 1.0]])
    grid = bandvox.Grid.from_array(sample(), transform=transform)
    np.testing.assert_allclose(grid.transform, transform, atol=1e-12)
    assert grid.voxel_size == pytest.approx((3, 2, 4))
    np.testing.assert_allclose(
        bandvox.Grid.from_array(sample(), voxel_size=0.5).transform, np.diag([0.5, 0.5, 0.5, 1]))


def test_blocks_hold_all_that_is_stored():
    array = sample((20, 20, 20))
    grid = bandvox.Grid.from_array(array)
    found = np.zeros((24, 24, 24), dtype=np.float32)
    for (x, y, z), block in grid.blocks():
        assert block.shape == (8, 8, 8)
        with pytest.raises(ValueError):
            block[0, 0, 0] = 1
        found[x:x + 8, y:y + 8, z:z + 8] = block
    np.testing.assert_array_equal(found[:20, :20, :20], array)


def test_a_block_outlives_its_grid():
    blocks = [block for _, block in bandvox.Grid.from_array(np.full((8, 8, 8), 3.0)
                                                            + sample((8, 8, 8))).blocks()]
    assert blocks[0].min() >= 3


def test_files_come_back(torus, tmp_path):
    colors = bandvox.VectorGrid.from_array(np.ones((4, 4, 4, 3)), name="Cd")
    path = tmp_path / "both.vdb"
    bandvox.write_vdb(path, [torus, colors])
    density, back = bandvox.read_vdb(path)
    assert (density.name, back.name) == ("density", "Cd")
    np.testing.assert_array_equal(density.to_array()[0], torus.to_array()[0])
    assert density.metadata["bandvox_cutoff"] == torus.metadata["bandvox_cutoff"]
    torus.write(path, half=True)
    assert len(bandvox.read_vdb(path)) == 1
    with pytest.raises(bandvox.InputError):
        bandvox.read_vdb(tmp_path / "none.vdb")
    path.write_bytes(path.read_bytes()[:1000])
    with pytest.raises(bandvox.InputError):
        bandvox.read_vdb(path)


def test_openvdb_reads_the_same(torus, tmp_path):
    openvdb = pytest.importorskip("pyopenvdb")
    path = tmp_path / "torus.vdb"
    torus.write(path)
    grid = openvdb.read(str(path), "density")
    assert grid.activeVoxelCount() == torus.active_voxel_count
    values, first = torus.to_array()
    array = np.zeros(values.shape, dtype=np.float32)
    grid.copyToArray(array, ijk=first)
    np.testing.assert_array_equal(array, values)


def test_pickles_and_copies(torus):
    back = pickle.loads(pickle.dumps(torus))
    np.testing.assert_array_equal(back.to_array()[0], torus.to_array()[0])
    of_files = {name for name in back.metadata if name.startswith("file_")}
    assert {name: back.metadata[name] for name in back.metadata.keys() - of_files} == torus.metadata
    np.testing.assert_allclose(back.transform, torus.transform)
    copy = torus.copy()
    copy.name = "other"
    assert torus.name == "density"


def test_meshes_are_pickled(torus):
    mesh = bandvox.to_mesh(torus)
    painted = bandvox.Mesh(mesh.points, mesh.triangles, colors=np.abs(mesh.points) % 1)
    for one in (mesh, painted):
        back = pickle.loads(pickle.dumps(one))
        assert back.name == one.name
        for name in ("points", "triangles", "normals", "colors"):
            ours, theirs = getattr(back, name), getattr(one, name)
            assert (ours is None) == (theirs is None), name
            if ours is not None:
                np.testing.assert_array_equal(ours, theirs)


def test_names_of_other_programs_can_be_read(torus, tmp_path):
    path = tmp_path / "torus.vdb"
    named = torus.copy()
    named.name = "grXn"
    named.write(path)
    path.write_bytes(path.read_bytes().replace(b"grXn", b"gr\xf6n"))
    [grid] = bandvox.read_vdb(path)
    assert grid.name == grid.metadata["name"] == r"gr\xf6n"
    assert r"gr\xf6n" in repr(grid)


def test_a_file_of_grids_has_its_ending(torus, tmp_path):
    for write in (torus.write, lambda path: bandvox.write_vdb(path, [torus])):
        with pytest.raises(bandvox.UsageError, match="torus.png.*expected a .vdb"):
            write(tmp_path / "torus.png")
    assert list(tmp_path.iterdir()) == []


def test_arrays_are_of_any_kind_of_number():
    array = np.arange(60).reshape(3, 4, 5)
    for other in (array.tolist(), array.astype(">f8"), np.asfortranarray(array), array.astype("u1"),
                  np.repeat(array, 2, axis=2)[..., ::2]):
        np.testing.assert_array_equal(bandvox.Grid.from_array(other, background=-1).to_array()[0], array)
    array.flags.writeable = False
    np.testing.assert_array_equal(bandvox.Grid.from_array(array, background=-1).to_array()[0], array)


def test_what_is_no_number_is_named():
    hole = sample()
    hole[1, 2, 3] = np.nan
    with pytest.raises(bandvox.UsageError, match=r"found nan at \[1, 2, 3\]"):
        bandvox.Grid.from_array(hole)
    with pytest.raises(bandvox.UsageError, match=r"found nan at \[1, 0, 0, 2\]"):
        bandvox.VectorGrid.from_array([[[[1, 1, 1]]], [[[1, 1, np.nan]]]])
    large = sample().astype(float)
    large[0, 1, 2] = 1e300
    with np.errstate(over="ignore"), pytest.raises(
            bandvox.UsageError, match=r"beyond those of float32 at \[0, 1, 2\]"):
        bandvox.Grid.from_array(large)
    for wrong in ({"tolerance": np.nan}, {"tolerance": -1}, {"background": np.nan},
                  {"background": 1e300},
                  {"voxel_size": np.inf}):
        with pytest.raises(bandvox.UsageError, match="expected"):
            bandvox.Grid.from_array(sample(), **wrong)
    with pytest.raises(bandvox.UsageError, match="<U1"):
        bandvox.Grid.from_array("a")


def test_masked_values_are_not_taken_for_values():
    array = np.ma.masked_greater(sample(), 0.5)
    with pytest.raises(bandvox.UsageError, match="masked values.*filled"):
        bandvox.Grid.from_array(array)
    assert bandvox.Grid.from_array(array.filled(1)).active_voxel_count > 0
    assert bandvox.Grid.from_array(np.ma.array(sample())).active_voxel_count > 0


def test_wrong_arrays_are_named(torus):
    for array, words in ((np.zeros((3, 3)), r"\(3, 3\) of float64"),
                         (np.zeros((3, 3, 0)), r"\(3, 3, 0\)"),
                         (np.zeros((3, 3, 3), dtype=complex), "complex128")):
        with pytest.raises(bandvox.UsageError, match=words):
            bandvox.Grid.from_array(array)
    with pytest.raises(bandvox.UsageError, match="exclude"):
        bandvox.Grid.from_array(sample(), voxel_size=1, transform=np.eye(4))
    with pytest.raises(bandvox.UsageError):
        bandvox.Grid.from_array(sample(), transform=np.zeros((4, 4)))
    moved = np.eye(4)
    moved[0, 3] = np.nan
    with pytest.raises(bandvox.UsageError, match="not finite"):
        bandvox.Grid.from_array(sample(), transform=moved)
    with pytest.raises(bandvox.UsageError, match="3e-15"):
        bandvox.Grid.from_array(sample(), voxel_size=1e-6)
    with pytest.raises(bandvox.UsageError, match="3e-15"):
        bandvox.Grid.from_array(sample(), transform=np.diag([1e-6, 1e-6, 1e-6, 1]))
    with pytest.raises(bandvox.UsageError, match="whole numbers"):
        bandvox.Grid.from_array(sample(), origin=(0.5, 0, 0))
    with pytest.raises(MemoryError):
        torus.to_array(((0, 0, 0), (99999, 99999, 9)))
    with pytest.raises(bandvox.UsageError):
        torus.to_array(((0, 0, 0), (-1, 0, 0)))
    with pytest.raises(bandvox.UsageError, match="bandvox.Grid"):
        bandvox.to_mesh("torus")
