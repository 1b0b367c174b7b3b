"""fit and fit_volume give what their values say, as functions, files and grids."""

import threading

import numpy as np
import pytest

import bandvox


def height(x, y):
    return np.exp(-3 * (x * x + y * y)) + 0.3 * x * y


@pytest.fixture(scope="module")
def places():
    return np.random.RandomState(2).uniform(-1, 1, (300, 2))


@pytest.fixture(scope="module")
def surface(places):
    return bandvox.fit(places, height(*places.T))


def test_the_surface_has_the_values(surface, places):
    values = height(*places.T)
    np.testing.assert_allclose(surface(*places.T), values, atol=1e-11)
    inside = np.random.RandomState(3).uniform(-0.8, 0.8, (200, 2))
    np.testing.assert_allclose(surface(*inside.T), height(*inside.T), atol=0.02)
    assert surface.levels[-1]["largest"] < 1e-11 and surface.columns == 1
    assert surface.rectangle == pytest.approx((*places.min(axis=0), *places.max(axis=0)))


def test_shapes_go_together(surface):
    x, y = np.linspace(-0.5, 0.5, 7), np.linspace(-0.4, 0.4, 5)[:, None]
    assert surface(x, y).shape == (5, 7)
    assert surface.gradient(x, y).shape == (5, 7, 2)
    assert surface.normals(x, 0).shape == (7, 3)
    assert isinstance(surface(0.1, 0.2), float)
    np.testing.assert_array_equal(surface(x, y)[2], surface(x, y[2, 0]))
    assert surface(np.zeros((0, 3)), 0).shape == (0, 3)
    with pytest.raises(ValueError):
        surface(np.zeros(3), np.zeros(4))
    with pytest.raises(bandvox.UsageError, match="x: found an array of shape .* of <U4"):
        surface("here", 0)
    with pytest.raises(bandvox.UsageError, match="column is 1"):
        surface(0, 0, column=1)


def test_derivatives_are_those_of_the_values(surface):
    x, y = np.random.RandomState(4).uniform(-0.8, 0.8, (2, 50))
    h = 1e-4
    gradient = surface.gradient(x, y)
    dx = (surface(x + h, y) - surface(x - h, y)) / (2 * h)
    dy = (surface(x, y + h) - surface(x, y - h)) / (2 * h)
    np.testing.assert_allclose(gradient, np.column_stack([dx, dy]), atol=1e-5)
    expected = np.column_stack([-dx, -dy, np.ones_like(dx)])
    expected /= np.linalg.norm(expected, axis=1)[:, None]
    np.testing.assert_allclose(surface.normals(x, y), expected, atol=1e-5)
    ahead, behind = surface.gradient(x + h, y), surface.gradient(x - h, y)
    dxx, dxy = ((ahead - behind) / (2 * h)).T
    dyy = ((surface.gradient(x, y + h) - surface.gradient(x, y - h)) / (2 * h))[:, 1]
    steep = 1 + dx * dx + dy * dy
    gaussian = (dxx * dyy - dxy * dxy) / steep**2
    mean = ((1 + dy * dy) * dxx - 2 * dx * dy * dxy + (1 + dx * dx) * dyy) / (2 * steep**1.5)
    np.testing.assert_allclose(surface.curvature(x, y), np.column_stack([gaussian, mean]),
                               atol=1e-2)


def test_patches_samples_and_meshes_are_the_surface(surface):
    patches = surface.patches()
    uv = np.random.RandomState(5).random_sample((4, 2))
    for patch in (0, len(patches) // 2, len(patches) - 1):
        x, y, z = patches.position(patch, uv).T
        np.testing.assert_allclose(surface(x, y), z, atol=1e-12)
        np.testing.assert_allclose(surface.normals(x, y), patches.normal(patch, uv), atol=1e-9)
    samples = surface.sample(33)
    x0, y0, x1, y1 = surface.rectangle
    x, y = np.linspace(x0, x1, samples.shape[0]), np.linspace(y0, y1, samples.shape[1])
    np.testing.assert_allclose(samples[..., 0], surface(x[:, None], y), atol=1e-12)
    mesh = surface.mesh(17)
    np.testing.assert_allclose(surface(*mesh.points[:, :2].T), mesh.points[:, 2], atol=1e-12)


def test_levels_add_up(surface):
    count = len(surface.levels)
    x, y = np.random.RandomState(6).uniform(-0.9, 0.9, (2, 40))
    coarse, fine = surface.part(1, 2), surface.part(3, count)
    np.testing.assert_allclose(coarse(x, y) + fine(x, y), surface(x, y), atol=1e-12)
    assert np.abs(coarse(x, y) - surface(x, y)).max() > 1e-4
    with pytest.raises(bandvox.UsageError, match=f"expected some of 1 to {count}"):
        surface.part(2, count + 1)


def test_files_hold_the_surface(surface, tmp_path):
    for name in ("s.bpt", "s.npy", "s.exr", "s.ply", "s.obj", "s.stl", "s.glb"):
        surface.save(tmp_path / name, samples=17)
        assert (tmp_path / name).stat().st_size > 0
    np.testing.assert_allclose(np.load(tmp_path / "s.npy"), surface.sample(17))
    read = bandvox.Patches.read(tmp_path / "s.bpt")
    for ours, theirs in zip(surface.patches().nets, read.nets):
        np.testing.assert_allclose(ours, theirs, atol=1e-12)
    for name in ("s.svg", "s.vdb", "s"):
        with pytest.raises(bandvox.UsageError, match="expected .bpt"):
            surface.save(tmp_path / name)


def test_the_solid_under_the_surface(surface):
    density = surface.density(resolution=48, base=-1)
    x0, y0, x1, y1 = surface.rectangle
    samples = surface.sample(257)[..., 0]
    mean = (samples[1:, 1:] + samples[1:, :-1] + samples[:-1, 1:] + samples[:-1, :-1]).mean() / 4
    volume = (x1 - x0) * (y1 - y0) * (mean + 1)
    assert density.metadata["bandvox_grid_volume"] == pytest.approx(volume, rel=1e-3)
    with pytest.raises(bandvox.UsageError):
        surface.density(base=5)


def test_files_and_columns(places, tmp_path):
    table = np.column_stack([places, height(*places.T), places[:, 0]])
    np.save(tmp_path / "table.npy", table)
    np.savetxt(tmp_path / "table.csv", table, delimiter=",", header="x,y,a,b", comments="",
               fmt="%.17g")
    both = bandvox.fit(tmp_path / "table.npy")
    assert both.columns == 2 and "table.npy" in repr(both)
    named = bandvox.fit(tmp_path / "table.csv", columns=["x", "y", "b"])
    arrays = bandvox.fit(places, table[:, 2:])
    x, y = places.T
    np.testing.assert_allclose(both(x, y, column=1), x, atol=1e-11)
    np.testing.assert_allclose(named(x, y), x, atol=1e-11)
    np.testing.assert_array_equal(arrays(x, y, column=1), both(x, y, column=1))
    with pytest.raises(bandvox.UsageError, match="a file alone"):
        bandvox.fit(tmp_path / "table.csv", np.zeros(3))
    with pytest.raises(bandvox.UsageError, match="a file alone"):
        bandvox.fit(places)


def test_noise_and_tolerance(places):
    values = height(*places.T) + np.random.RandomState(7).normal(0, 0.05, len(places))
    smooth = bandvox.fit(places, values, smooth=0.05)
    off = smooth(*places.T) - values
    assert np.sqrt(np.mean(off**2)) == pytest.approx(0.05, rel=0.1)
    with pytest.raises(bandvox.ResultError, match="by tolerance"):
        bandvox.fit(places, values, tolerance=1e-6, max_level=2)
    with pytest.warns(bandvox.BandvoxWarning, match="by tolerance"):
        coarse = bandvox.fit(places, values, max_level=2)
    assert len(coarse.levels) <= 2
    with pytest.raises(bandvox.UsageError, match="exclude"):
        bandvox.fit(places, values, tolerance=0.1, smooth=0.1)


def test_wrong_points_are_named(places):
    values = height(*places.T)
    for wrong, others, words in (
        (places[:, :1], values, r"places: found an array of shape \(300, 1\) of float64"),
        (places, values[1:], r"values: found an array of shape \(299,\) of float64; .*\(300,\)"),
        (places, np.full(300, "a"), "values: found"),
    ):
        with pytest.raises(bandvox.UsageError, match=words):
            bandvox.fit(wrong, others)
    with pytest.raises(bandvox.InputError):
        bandvox.fit(np.zeros((2, 2)), [0, 1])
    with pytest.raises(bandvox.InputError):
        bandvox.fit(places, np.where(values > 0.5, np.nan, values))


def test_threads_read_one_surface(surface):
    x, y = np.random.RandomState(8).uniform(-0.9, 0.9, (2, 20000))
    expected = surface(x, y)
    found = [None] * 8
    threads = [threading.Thread(target=lambda i=i: found.__setitem__(i, surface(x, y)))
               for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for values in found:
        np.testing.assert_array_equal(values, expected)


@pytest.fixture(scope="module")
def cloud():
    places = np.random.RandomState(9).uniform(-1, 1, (400, 3))
    x, y, z = places.T
    return places, np.column_stack([np.sin(x) + y * z, x, y, z])


def test_a_volume_has_the_values(cloud):
    places, values = cloud
    volume = bandvox.fit_volume(places, values, tolerance=1e-6)
    for column in range(4):
        np.testing.assert_allclose(volume(places, column=column), values[:, column], atol=5e-6)
    assert volume.columns == 4 and volume.largest <= 1e-6
    assert volume.covers(places).all()
    assert not volume.covers([(50, 0, 0)])[0]
    np.testing.assert_allclose(volume.bounds, [places.min(axis=0), places.max(axis=0)])

    grid = volume.grid(name="heat", voxel_size=0.1)
    assert grid.name == "heat" and isinstance(grid, bandvox.Grid)
    array, first = grid.to_array(((-5, -5, -5), (5, 5, 5)))
    index = np.argwhere(np.ones(array.shape)) + first
    np.testing.assert_allclose(array.ravel(), volume(0.1 * index), atol=1e-5)
    vectors = volume.grid(name="Cd", column=1, columns=3, resolution=20)
    assert isinstance(vectors, bandvox.VectorGrid)
    with pytest.raises(bandvox.UsageError, match="column is 2"):
        volume.grid(column=2, columns=3)
    with pytest.raises(bandvox.UsageError, match="expected 1, or 3"):
        volume.grid(columns=2)


def test_a_volume_of_a_file(cloud, tmp_path):
    places, values = cloud
    np.save(tmp_path / "cloud.npy", np.column_stack([places, values[:, 0]]))
    volume = bandvox.fit_volume(tmp_path / "cloud.npy", tolerance=1e-6, reach=0.7)
    assert volume.reach == pytest.approx(0.7)
    np.testing.assert_allclose(volume(places), values[:, 0], atol=5e-6)
    with pytest.raises(bandvox.UsageError, match=r"\(n, 3\)"):
        bandvox.fit_volume(places[:, :2], values)
