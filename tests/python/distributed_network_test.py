"""bandvox.distributed on a scheduler and two workers that see each other through a network alone:
each is in a network namespace of its own. The workers are of different sizes."""

import contextlib
import os
import pathlib
import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest

import bandvox
import bandvox.distributed as farm

try:
    import distributed
except ImportError:
    pytestmark = pytest.mark.skip(reason="python3-distributed is not installed")

COMMAND = os.path.join(os.environ["BANDVOX_BUILD_DIR"], "apps", "bandvox", "bandvox")
NETWORK = f"10.{200 + os.getpid() % 50}.{os.getpid() % 250}"
# Short, as names of interfaces have to be.
TAG = f"bv{os.getpid() % 100000}"
PORT = 8786


def ip(*words):
    subprocess.run(["ip", *words], check=True, capture_output=True, text=True)


@contextlib.contextmanager
def namespaces(names):
    """Namespaces that a bridge joins; each with the address .2, .3, ... of the network."""
    made = []
    try:
        ip("link", "add", f"{TAG}b", "type", "bridge")
        ip("addr", "add", f"{NETWORK}.1/24", "dev", f"{TAG}b")
        ip("link", "set", f"{TAG}b", "up")
        for i, name in enumerate(names):
            ip("netns", "add", f"{TAG}{name}")
            made.append(f"{TAG}{name}")
            outside, inside = f"{TAG}{i}o", f"{TAG}{i}i"
            ip("link", "add", outside, "type", "veth", "peer", "name", inside)
            ip("link", "set", inside, "netns", made[-1])
            ip("link", "set", outside, "master", f"{TAG}b", "up")
            ip("-n", made[-1], "addr", "add", f"{NETWORK}.{2 + i}/24", "dev", inside)
            ip("-n", made[-1], "link", "set", inside, "up")
            ip("-n", made[-1], "link", "set", "lo", "up")
        yield made
    finally:
        for name in made:
            subprocess.run(["ip", "netns", "del", name], capture_output=True)
        subprocess.run(["ip", "link", "del", f"{TAG}b"], capture_output=True)


def permitted():
    if os.geteuid() != 0:
        return "network namespaces need root"
    if not shutil.which("ip"):
        return "ip (iproute2) is not installed"
    try:
        with namespaces(["t"]):
            return ""
    except subprocess.CalledProcessError as error:
        return f"network namespaces are not permitted here: {error.stderr.strip()}"


@contextlib.contextmanager
def started(namespace, module, *words):
    process = subprocess.Popen(["ip", "netns", "exec", namespace, sys.executable, "-m", module,
                                *words],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    try:
        yield process
    finally:
        process.send_signal(signal.SIGTERM)
        try:
            process.communicate(timeout=20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()


@pytest.fixture(scope="module")
def client():
    reason = permitted()
    if reason:
        pytest.skip(reason)
    with contextlib.ExitStack() as stack:
        places = stack.enter_context(namespaces(["s", "a", "b"]))
        scheduler = f"tcp://{NETWORK}.2:{PORT}"
        stack.enter_context(started(places[0], "distributed.cli.dask_scheduler", "--host",
                                    f"{NETWORK}.2", "--port", str(PORT), "--no-dashboard"))
        for i, (place, threads) in enumerate(zip(places[1:], (1, 2))):
            stack.enter_context(started(
                place, "distributed.cli.dask_worker", scheduler, "--host", f"{NETWORK}.{3 + i}",
                "--nthreads", str(threads), "--nworkers", "1", "--memory-limit",
                f"{1 + i}GB", "--no-dashboard", "--death-timeout", "60"))
        one = stack.enter_context(distributed.Client(scheduler, timeout=60))
        one.wait_for_workers(2, timeout=60)
        yield one


def workers_of(report):
    """How many tasks each has done, by the last number of its address."""
    return {int(address.split(":")[1].rpartition(".")[2]): count
            for address, count in report.workers.items()}


def test_shards_from_two_machines_are_what_one_makes(client, tmp_path):
    report = farm.convert_volume(client, "shape:torus", tmp_path / "torus.vdb", shards=8,
                                 resolution=96, executable=COMMAND)
    assert set(workers_of(report)) == {3, 4} and report.tries == 9
    subprocess.run([COMMAND, "convert", "shape:torus", "-o", tmp_path / "one.vdb", "--resolution",
                    "96", "--quiet"], check=True)
    (ours,), (theirs,) = (bandvox.read_vdb(tmp_path / name) for name in ("torus.vdb", "one.vdb"))
    assert np.array_equal(ours.to_array()[0], theirs.to_array()[0])
    assert ours.to_array()[1] == theirs.to_array()[1]


def test_a_task_goes_where_there_is_room_for_it(client, tmp_path):
    for number in (1, 2, 3):
        shutil.copy(write_cube(tmp_path), tmp_path / f"sim.{number:04d}.obj")
    arguments = (client, "convert", tmp_path / "sim.####.obj", tmp_path / "vol.####.vdb", "1-3")
    for need in ({"threads": 2}, {"memory": 1_500_000_000}):
        report = farm.run_frames(*arguments, resolution=8, executable=COMMAND, **need)
        assert workers_of(report) == {4: 3}, need
    # Each on all threads of its worker.
    said = tmp_path / "said"
    script = tmp_path / "telling"
    script.write_text(f'#!/bin/sh\necho "$*" >> {said}\nexec {COMMAND} "$@"\n')
    script.chmod(0o755)
    farm.run_frames(*arguments, resolution=8, executable=str(script))
    threads = {line.rpartition("--threads ")[2] for line in said.read_text().splitlines()}
    assert threads == {"1", "2"}


def write_cube(folder):
    path = pathlib.Path(folder, "cube.obj")
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n")
    return path
