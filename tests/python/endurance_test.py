"""A thousand calls leave no memory behind, and threads do not wait for each other."""

import ctypes
import os
import pathlib
import threading

import numpy as np
import pytest

import bandvox


def resident_bytes():
    # What is free in the pools of the C library counts for nothing.
    ctypes.CDLL(None).malloc_trim(0)
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not pathlib.Path("/proc/self/statm").exists(), reason="needs /proc")
@pytest.mark.skipif("BANDVOX_SANITIZED" in os.environ, reason="sanitizers keep what is freed")
def test_a_thousand_calls_leave_nothing_behind(cube, tmp_path):
    places = np.random.RandomState(1).random_sample((30, 2))
    values = places.sum(axis=1)
    net = np.random.RandomState(2).random_sample((1, 4, 4, 3))
    square = np.stack([*np.meshgrid([0, 1], [0, 1], indexing="ij"), np.ones((2, 2))], axis=-1)
    table = tmp_path / "table.npy"
    big = np.random.RandomState(3).random_sample((40, 40, 40)).astype(np.float32)

    def fails(x, y, z):
        raise LookupError("no such place")

    def once():
        grid = bandvox.bandlimit("shape:torus", resolution=16, tolerance=1e-3,
                                 progress=lambda stage, fraction: None)
        grid.to_array()
        bandvox.render(grid, width=12, height=12)._repr_png_()
        bandvox.to_mesh(grid)
        list(bandvox.Grid.from_array(big).blocks())
        bandvox.Reconstruction(grid).gradient(cube[0])
        bandvox.voxelize(cube, voxel_size=0.5)
        bandvox.fit(places, values, tolerance=0.01)(0.5, values)
        bandvox.Patches(net).nets
        bandvox.bandlimit(bandvox.Patches([square]), base=0, voxel_size=0.25)
        bandvox.bandlimit_points(cube[0], radius=0.5, voxel_size=0.25)
        fog = bandvox.SceneObject(grid, mode="volume", translate=(3, 0, 0))
        bandvox.render([grid, fog], width=12, height=12, preview=lambda image: None)
        bandvox.voxelize(cube, voxel_size=0.5, as_="mask").to_array()
        bandvox.write_array(table, grid)
        bandvox.bandlimit_grid(bandvox.read_array(table), threshold=0.5)
        bandvox.info(grid)
        bandvox.compare(grid, grid)
        for wrong in ({"source": 7}, {"source": fails, "bounds": ((0, 0, 0), (1, 1, 1))}):
            with pytest.raises((bandvox.UsageError, LookupError)):
                bandvox.bandlimit(voxel_size=0.5, **wrong)

    # Caches and pools of memory are full by then.
    for _ in range(20):
        once()
    # A thread that works for the first time takes pools of its own, in one of these spans; what
    # each round keeps is in all of them.
    grown = []
    for _ in range(3):
        before = resident_bytes()
        for _ in range(40):
            once()
        grown.append(resident_bytes() - before)
    # More than twenty calls each; 40 kB kept by each round would be 1.6 MB.
    assert min(grown) < 1600 << 10, grown


def test_eight_pictures_are_drawn_at_once(torus):
    # Each waits in the middle of its work until all others are in the middle of theirs: were one to
    # wait for another's end, none would end.
    together = threading.Barrier(8)
    counted = [0]
    found, failed = [None] * 8, []

    def draw(i):
        has_met = False

        def meet(stage, fraction):
            nonlocal has_met
            if not has_met:
                has_met = True
                together.wait(timeout=240)
                counted[0] += 1

        try:
            found[i] = bandvox.render(torus, width=640, height=640, samples=3, threads=1,
                                      progress=meet).image
        except Exception as error:  # Of a thread it would go unseen.
            failed.append(error)

    threads = [threading.Thread(target=draw, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failed
    assert counted == [8]
    for image in found:
        np.testing.assert_array_equal(image, found[0])


def test_python_goes_on_while_pictures_are_drawn(torus):
    rounds = 0
    is_drawn = threading.Event()

    def draw():
        bandvox.render(torus, width=640, height=640, samples=3)

    threads = [threading.Thread(target=draw) for _ in range(8)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        rounds += 1
        is_drawn.wait(1e-4)
    # With the interpreter's lock held, there would be a round between two pictures.
    assert rounds > 80


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_forked_process_works_on():
    before = bandvox.bandlimit("shape:cube", resolution=8, threads=1).metadata["bandvox_grid_volume"]
    child = os.fork()
    if child == 0:
        again = bandvox.bandlimit("shape:cube", resolution=8, threads=1).metadata["bandvox_grid_volume"]
        os._exit(0 if again == before else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
