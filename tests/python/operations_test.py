"""Reconstruction, resampling, merging, comparing, surfaces and pictures."""

import threading

import numpy as np
import pytest

import bandvox


def test_reading_between_voxels(torus):
    reading = bandvox.Reconstruction(torus)
    random = np.random.RandomState(5)
    angle = random.random_sample(500) * 2 * np.pi
    points = np.column_stack([np.cos(angle), np.zeros(500), np.sin(angle)])
    points *= (0.3 + random.random_sample(500))[:, None]
    values = reading.value(points)
    gradients = reading.gradient(points)
    assert values.shape == (500,) and gradients.shape == (500, 3)
    # At nodes it is the node's value.
    array, first = torus.to_array()
    node = np.argwhere((array > 0.2) & (array < 0.8))[::50]
    world = (torus.transform @ np.column_stack([node + first, np.ones(len(node))]).T)[:3].T
    np.testing.assert_allclose(reading.value(world), array[tuple(node.T)], atol=2e-5)
    # The gradient and the second derivatives are those of the value.
    step = 1e-3
    for axis in range(3):
        offset = np.eye(3)[axis] * step
        slope = (reading.value(points + offset) - reading.value(points - offset)) / (2 * step)
        np.testing.assert_allclose(gradients[:, axis], slope, atol=0.05)
        bend = (reading.gradient(points + offset) - reading.gradient(points - offset)) / (2 * step)
        np.testing.assert_allclose(reading.hessian(points)[:, axis], bend, atol=3)
    with pytest.raises(bandvox.UsageError, match="points"):
        reading.value(np.zeros(3))


def test_resampling_and_levels(torus):
    coarse = bandvox.resample(torus, factor=2)
    assert coarse.voxel_size == pytest.approx(2 * np.array(torus.voxel_size))
    assert coarse.metadata["bandvox_grid_volume"] == pytest.approx(
        torus.metadata["bandvox_grid_volume"], rel=1e-3)
    onto = bandvox.resample(torus, onto=coarse)
    np.testing.assert_array_equal(onto.to_array()[0], coarse.to_array()[0])
    one, two = bandvox.detail_levels(torus, 2)
    assert two.voxel_size == pytest.approx(4 * np.array(torus.voxel_size))
    assert one.name == "density_level_1"
    with pytest.raises(bandvox.UsageError, match="got 2"):
        bandvox.resample(torus, factor=2, voxel_size=1)
    with pytest.raises(bandvox.UsageError):
        bandvox.resample(torus)


def test_merging_and_comparing(torus):
    blended = bandvox.merge([torus, torus], operation="blend", weights=[1, 3])
    same = bandvox.compare(torus, blended)
    assert same["maximum"] < 1e-6 and same["hausdorff"] < 1e-4
    assert same["volumes"][0] == pytest.approx(same["volumes"][1])
    twice = bandvox.merge([torus, torus], operation="sum")
    assert bandvox.compare(torus, twice, only="values")["maximum"] == pytest.approx(1, abs=0.01)
    with pytest.raises(bandvox.UsageError, match="'union'"):
        bandvox.merge([torus, torus], operation="join")
    with pytest.raises(bandvox.UsageError):
        bandvox.merge([torus])


def test_surfaces(torus, tmp_path):
    mesh = bandvox.to_mesh(torus)
    assert mesh.normals.shape == mesh.points.shape
    edges = np.sort(mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    mesh.write(tmp_path / "torus.ply")
    back = bandvox.Mesh.read(tmp_path / "torus.ply")
    np.testing.assert_allclose(back.points, mesh.points, atol=1e-6)
    with pytest.raises(ValueError):
        mesh.points[0] = 0

    distances = bandvox.to_level_set(torus, band=2)
    array, _ = distances.to_array()
    assert array.min() == pytest.approx(-2 * torus.voxel_size[0], rel=1e-4)
    iso, volume = bandvox.iso_of_volume(torus, torus.metadata["bandvox_source_volume"])
    assert volume == pytest.approx(torus.metadata["bandvox_source_volume"], rel=1e-4)
    assert 0.3 < iso < 0.5


def test_pictures(torus, tmp_path):
    picture = bandvox.render(torus, width=80, height=60, samples=2)
    image, channels = picture
    assert image.shape == (60, 80, 4) and image.dtype == np.float32
    assert channels["depth"].shape == (60, 80)
    seen = image[..., 3] > 0.99
    assert 0.1 < seen.mean() < 0.9
    np.testing.assert_allclose(np.linalg.norm(channels["normal"][seen], axis=-1), 1, atol=1e-3)
    assert picture._repr_png_().startswith(b"\x89PNG")
    picture.write(tmp_path / "torus.exr")
    picture.write(tmp_path / "torus.png")
    with pytest.raises(bandvox.UsageError):
        picture.write(tmp_path / "torus.gif")
    with pytest.raises(bandvox.ResultError):
        bandvox.render(torus, width=16, height=16, eye=(0, 0, 5), lookat=(0, 0, 9))
    with pytest.raises(bandvox.UsageError, match="shading"):
        bandvox.render(torus, shading="nice")


def test_threads_draw_side_by_side(torus):
    expected = bandvox.render(torus, width=64, height=64).image
    found = [None] * 8

    def draw(i):
        found[i] = bandvox.render(torus, width=64, height=64).image

    threads = [threading.Thread(target=draw, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for image in found:
        np.testing.assert_array_equal(image, expected)
