"""Ctrl-C stops work within a second."""

import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import bandvox

PROGRAM = """
import bandvox, sys
print("starting", flush=True)
try:
    bandvox.bandlimit("shape:tree", resolution=3000)
except KeyboardInterrupt:
    print("interrupted", flush=True)
    sys.exit(7)
"""


def test_an_interruption_ends_the_work():
    process = subprocess.Popen([sys.executable, "-c", PROGRAM], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "starting\n"
    time.sleep(1)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert out == "interrupted\n"
    assert process.returncode == 7


@pytest.fixture(scope="module")
def noise():
    """A grid that takes long enough to pack."""
    return bandvox.Grid.from_array(np.random.RandomState(1).random_sample((160, 160, 160)) + 1)


def interrupt(stage, fraction):
    signal.raise_signal(signal.SIGINT)


def test_nothing_is_written_when_writing_is_interrupted(noise, tmp_path):
    def fails(stage, fraction):
        assert stage in ("", "writing")
        raise LookupError(stage)

    for write in (noise.write, lambda path, **options: bandvox.write_vdb(path, [noise], **options)):
        with pytest.raises(KeyboardInterrupt):
            write(tmp_path / "noise.vdb", compression="zip", threads=1, progress=interrupt)
        with pytest.raises(LookupError):
            write(tmp_path / "noise.vdb", compression="zip", threads=1, progress=fails)
    assert list(tmp_path.iterdir()) == []


def test_reading_is_interrupted(noise, tmp_path):
    noise.write(tmp_path / "noise.vdb", compression="zip")
    with pytest.raises(KeyboardInterrupt):
        bandvox.read_vdb(tmp_path / "noise.vdb", threads=1, progress=interrupt)
    assert len(bandvox.read_vdb(tmp_path / "noise.vdb")) == 1


def interrupt_soon():
    """Ctrl-C while what follows is at work."""
    signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
    signal.setitimer(signal.ITIMER_REAL, 0.2)


def test_reading_between_voxels_is_interrupted(noise):
    places = np.random.RandomState(2).random_sample((20_000_000, 3)) * 150
    field = bandvox.Reconstruction(noise)
    interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        field.hessian(places)


def test_no_more_rows_are_asked_of_a_function_when_interrupted():
    calls = []

    def slow(x, y, z):
        calls.append(time.monotonic())
        time.sleep(0.01)
        return np.zeros_like(x)

    interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        bandvox.bandlimit(slow, bounds=((-1, -1, -1), (1, 1, 1)), resolution=40)
    assert len(calls) < 200


def test_a_turntable_is_interrupted(noise):
    with pytest.raises(KeyboardInterrupt):
        bandvox.turntable(noise, 100000, progress=interrupt)


def test_joining_is_interrupted():
    parts = [bandvox.bandlimit("shape:cube", resolution=400, shard=(i, 2)) for i in (1, 2)]
    with pytest.raises(KeyboardInterrupt):
        bandvox.join_shards(parts, threads=1, progress=interrupt)
    assert bandvox.join_shards(parts).active_voxel_count > 400**3


def normals(count):
    """Places of the unit ball's surface."""
    made = np.random.RandomState(4).normal(size=(count, 3))
    return made / np.linalg.norm(made, axis=1)[:, np.newaxis]


@pytest.fixture(scope="module")
def surface():
    random = np.random.RandomState(3)
    return bandvox.fit(random.random_sample((50, 2)), random.random_sample(50), tension=1000)


@pytest.mark.parametrize("name, samples", [("a.npy", 12000), ("a.exr", 6000), ("a.ply", 6000)])
def test_writing_a_surface_is_interrupted(surface, name, samples, tmp_path):
    interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        surface.save(tmp_path / name, samples=samples)
    assert list(tmp_path.iterdir()) == []


def test_sampling_a_surface_is_interrupted(surface):
    interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        surface.mesh(samples=8000)
    interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        surface.sample(samples=8000, quantities=["mean"])


def test_fitting_points_in_space_is_interrupted():
    places = normals(200_000)
    interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        bandvox.bandlimit_points(places, normals=places)
    interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        bandvox.fit_volume(places, places[:, 0])
