"""bandvox.distributed, on workers that are processes of their own."""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import urllib.parse
import urllib.request

import numpy as np
import pytest

import bandvox
import bandvox.distributed as farm

try:
    import distributed
except ImportError:
    pytestmark = pytest.mark.skip(reason="python3-distributed is not installed")

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMAND = os.path.join(os.environ["BANDVOX_BUILD_DIR"], "apps", "bandvox", "bandvox")
CUBE = """v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"""


@pytest.fixture(scope="module")
def client():
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True,
                                  dashboard_address=None, host="127.0.0.1",
                                  memory_limit="4GB") as cluster:
        with distributed.Client(cluster) as one:
            yield one


def on_one_machine(folder, *words):
    whole = folder / "one" / "whole.vdb"
    whole.parent.mkdir()
    subprocess.run([COMMAND, "convert", *words, "-o", whole, "--quiet"], check=True)
    return whole


def expect_same(found, expected):
    """Every voxel, and all that the grids say of themselves."""
    ours, theirs = bandvox.read_vdb(found), bandvox.read_vdb(expected)
    assert [grid.name for grid in ours] == [grid.name for grid in theirs]
    for a, b in zip(ours, theirs):
        (values, first), (others, other_first) = a.to_array(), b.to_array()
        assert first == other_first
        assert np.array_equal(values, others)
        assert a.active_voxel_count == b.active_voxel_count
        unlike = {"file_mem_bytes"}
        assert ({k: v for k, v in a.metadata.items() if k not in unlike} ==
                {k: v for k, v in b.metadata.items() if k not in unlike})


def names_in(folder):
    return sorted(path.name for path in folder.iterdir() if path.name != "one")


def test_eight_shards_are_what_one_machine_makes(client, tmp_path):
    whole = on_one_machine(tmp_path, "shape:torus", "--resolution", "96", "--order", "3")
    seen = []
    report = farm.convert_volume(client, "shape:torus", tmp_path / "torus.vdb", shards=8,
                                 resolution=96, order=3, executable=COMMAND,
                                 progress=lambda *what: seen.append(what))
    expect_same(tmp_path / "torus.vdb", whole)
    assert names_in(tmp_path) == ["torus.vdb"]
    assert report.written == [tmp_path / "torus.vdb"] and not report.failures
    assert report.tries == 9 and sum(report.workers.values()) == 9 and len(report.workers) == 2
    assert [done for done, _, _ in seen] == list(range(1, 10))
    assert seen[-1] == (9, 9, "merge")


def test_shards_of_16_bits_are_joined(client, tmp_path):
    whole = on_one_machine(tmp_path, "shape:torus", "--resolution", "40", "--half")
    farm.convert_volume(client, "shape:torus", tmp_path / "torus.vdb", shards=2, resolution=40,
                        half=True, executable=COMMAND)
    expect_same(tmp_path / "torus.vdb", whole)


def test_files_among_options_hold_on_other_machines(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    here = os.getcwd()
    assert farm.option_words({"like": "first.vdb", "onto": pathlib.Path("a", "b.vdb"), "half": True,
                              "order": 3}) == [f"--like={here}/first.vdb", f"--onto={here}/a/b.vdb",
                                               "--half", "--order=3"]


def test_what_a_task_takes_is_a_number(client, tmp_path):
    assert farm._slots(np.int64(2), None).threads == 2
    for wrong in ({"threads": 0}, {"memory": "1G"}, {"memory": -1}):
        with pytest.raises(ValueError, match="whole number"):
            farm.convert_volume(client, "shape:cube", tmp_path / "cube.vdb", shards=2, **wrong)


def wait_for(holds):
    deadline = time.monotonic() + 60
    while not holds() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert holds()


def is_gone(pid):
    return not os.path.exists(f"/proc/{pid.read_text().strip()}")


def test_a_killed_worker_costs_time_alone(client, tmp_path):
    whole = on_one_machine(tmp_path, "shape:tree", "--resolution", "160")
    # The first run of one part never ends.
    pid = tmp_path / "one" / "pid"
    script = tmp_path / "one" / "hanging"
    script.write_text(f"""#!/bin/sh
case "$*" in *"--shard 5/8"*) mkdir {pid}.first && echo $$ > {pid} && exec sleep 600 ;; esac
exec {COMMAND} "$@"
""")
    script.chmod(0o755)
    pids = client.run(os.getpid)
    killed = []

    def kill_its_worker(*_):
        if killed or not pid.exists():
            return
        killed.extend(worker for worker, keys in client.processing().items()
                      if any("shard-0005" in str(key) for key in keys))
        os.kill(pids[killed[0]], signal.SIGKILL)

    report = farm.convert_volume(client, "shape:tree", tmp_path / "tree.vdb", shards=8,
                                 resolution=160, executable=str(script), progress=kill_its_worker)
    assert len(killed) == 1
    expect_same(tmp_path / "tree.vdb", whole)
    assert names_in(tmp_path) == ["tree.vdb"]
    assert report.tries == 10 and not report.failures
    # What the worker had begun went with it.
    wait_for(lambda: is_gone(pid))
    client.wait_for_workers(2, timeout=60)


def sequence(folder, count, broken=()):
    for number in range(1, count + 1):
        text = "v 0 0 nonsense\n" if number in broken else CUBE
        (folder / f"sim.{number:04d}.obj").write_text(text)


def test_a_broken_one_of_a_hundred_frames_is_named(client, tmp_path):
    sequence(tmp_path, 100, broken={42})
    (tmp_path / "one").mkdir()
    report = farm.run_frames(client, "convert", tmp_path / "sim.####.obj",
                             tmp_path / "one" / "vol.####.vdb", "1-100", keep_going=True,
                             resolution=8, executable=COMMAND)
    assert [(one.name, one.status) for one in report.failures] == [("frame 42", 3)]
    assert "sim.0042.obj" in report.failures[0].message
    assert "frame 42" in str(report)
    expected = {f"vol.{number:04d}.vdb" for number in range(1, 101)} - {"vol.0042.vdb"}
    assert {path.name for path in (tmp_path / "one").iterdir()} == expected
    assert {path.name for path in report.written} == expected
    # Wrong inputs are not tried again.
    assert report.tries == 100
    assert len(report.workers) == 2


def test_the_first_failure_ends_it(client, tmp_path):
    sequence(tmp_path, 6, broken={1})
    with pytest.raises(farm.FarmError, match="frame 1") as caught:
        farm.run_frames(client, "convert", tmp_path / "sim.####.obj", tmp_path / "vol.####.vdb",
                        [1, *range(1, 7)], resolution=8, executable=COMMAND)
    assert len(caught.value.report.failures) == 1
    assert isinstance(caught.value, bandvox.Error)
    assert not [name for name in names_in(tmp_path) if name.startswith(".")]
    assert "vol.0001.vdb" not in names_in(tmp_path)


def test_a_failed_part_leaves_the_output_alone(client, tmp_path):
    (tmp_path / "bad.obj").write_text("v 0 0 nonsense\n")
    (tmp_path / "out.vdb").write_text("what was there")
    with pytest.raises(farm.FarmError, match="shard ./3.*bad.obj"):
        farm.convert_volume(client, tmp_path / "bad.obj", tmp_path / "out.vdb", shards=3,
                            executable=COMMAND)
    assert (tmp_path / "out.vdb").read_text() == "what was there"
    assert names_in(tmp_path) == ["bad.obj", "out.vdb"]


def test_what_is_done_is_skipped(client, tmp_path):
    sequence(tmp_path, 3)
    arguments = (client, "convert", tmp_path / "sim.####.obj", tmp_path / "vol.%04d.vdb")
    first = farm.run_frames(*arguments, "1-3x2", resolution=8, executable=COMMAND)
    assert [path.name for path in sorted(first.written)] == ["vol.0001.vdb", "vol.0003.vdb"]
    before = (tmp_path / "vol.0001.vdb").stat()
    again = farm.run_frames(*arguments, "1-3", resolution=8, skip_existing=True,
                            executable=COMMAND)
    assert [path.name for path in again.written] == ["vol.0002.vdb"]
    assert [path.name for path in sorted(again.skipped)] == ["vol.0001.vdb", "vol.0003.vdb"]
    after = (tmp_path / "vol.0001.vdb").stat()
    assert (after.st_ino, after.st_mtime_ns) == (before.st_ino, before.st_mtime_ns)
    finer = farm.run_frames(*arguments, [1], resolution=9, skip_existing=True, executable=COMMAND)
    assert len(finer.written) == 1 and not finer.skipped
    assert (tmp_path / "vol.0001.vdb").stat().st_ino != before.st_ino


def test_pictures_of_a_turntable(client, tmp_path):
    bandvox.bandlimit("shape:torus", resolution=24).write(tmp_path / "torus.vdb")
    report = farm.run_frames(client, "render", tmp_path / "torus.vdb", tmp_path / "torus.##.png",
                             "1-3", turntable=3, res="16x16", executable=COMMAND)
    assert names_in(tmp_path) == ["torus.01.png", "torus.02.png", "torus.03.png", "torus.vdb"]
    assert len(report.written) == 3


def counts_of(dask_scheduler):
    """What Dask's dashboard draws its bars of progress from."""
    return {name: {state: count for state, count in prefix.active_states.items()
                   if count and state != "forgotten"}
            for name, prefix in dask_scheduler.task_prefixes.items() if prefix.active}


@pytest.fixture(scope="module")
def watched():
    """A cluster with what of the dashboard there is without bokeh, and a function that reads its pages."""
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, host="127.0.0.1",
                                  dashboard_address="127.0.0.1:0", memory_limit="4GB") as cluster:
        with distributed.Client(cluster) as one:
            link = urllib.parse.urlsplit(one.dashboard_link)

            def page(path):
                with urllib.request.urlopen(f"http://{link.netloc}{path}", timeout=30) as answer:
                    return answer.read().decode()

            yield one, page


@pytest.mark.parametrize("kind", ["convert", "shard"])
def test_the_dashboard_shows_how_far_it_is(watched, tmp_path, kind):
    client, page = watched
    # One after another ends, when it is told to.
    go = tmp_path / "go"
    go.mkdir()
    script = tmp_path / "patient"
    script.write_text(f"""#!/bin/sh
until rmdir {go} 2>/dev/null; do sleep 0.1; done
exec {COMMAND} "$@"
""")
    script.chmod(0o755)
    shown, pages = [], []

    def look(done, total, name):
        if name == "merge":
            shown.append(client.run_on_scheduler(counts_of))
            return
        others = 6 - done
        expected = {"memory": done, "processing": min(others, 1), "waiting": max(others - 1, 0)}
        expected = {state: count for state, count in expected.items() if count}
        wait_for(lambda: client.run_on_scheduler(counts_of).get(f"bandvox-{kind}") == expected)
        shown.append(client.run_on_scheduler(counts_of))
        pages.extend(page(f"/info/worker/{urllib.parse.quote(address, safe='')}.html")
                     for address in client.scheduler_info()["workers"])
        go.mkdir()

    with distributed.get_task_stream(client=client) as stream:
        if kind == "convert":
            sequence(tmp_path, 6)
            farm.run_frames(client, "convert", tmp_path / "sim.####.obj", tmp_path / "vol.####.vdb",
                            "1-6", resolution=8, executable=str(script), progress=look)
        else:
            farm.convert_volume(client, "shape:cube", tmp_path / "cube.vdb", shards=6, resolution=8,
                                executable=str(script), progress=look)
    assert all(counts["bandvox-free-worker"] == {"no-worker": 1} for counts in shown)
    # What runs is named on the page of its worker.
    assert any(f"bandvox-{kind}-000" in text for text in pages)
    names = {re.sub("-[0-9a-f]{32}$", "", one["key"]) for one in stream.data}
    expected = {f"bandvox-{kind}-{number:04d}" for number in range(1, 7)}
    if kind == "shard":
        expected.add("bandvox-merge")
        assert shown[-1]["bandvox-merge"] == {"memory": 1}
    assert names == expected
    # Nothing is left that waits.
    wait_for(lambda: client.run_on_scheduler(counts_of) == {})


def flaky(folder, failures, status):
    """A command that fails at first, and then is bandvox."""
    script = folder / "flaky"
    script.write_text(f"""#!/bin/sh
for i in {' '.join(str(i) for i in range(failures))}; do
    if mkdir "{folder}/failed$i" 2>/dev/null; then
        echo "bandvox: error: no luck" >&2
        exit {status}
    fi
done
exec {COMMAND} "$@"
""")
    script.chmod(0o755)
    return str(script)


@pytest.mark.parametrize("status", [1, 5])
def test_what_may_go_better_is_tried_again(client, tmp_path, status):
    report = farm.convert_volume(client, "shape:cube", tmp_path / "cube.vdb", shards=2,
                                 resolution=8, executable=flaky(tmp_path, 2, status))
    assert report.tries == 5 and not report.failures  # two parts, two failures, one to join


def test_tries_come_to_an_end(client, tmp_path):
    with pytest.raises(farm.FarmError, match=r"shard ./2: no luck \(status 1\)") as caught:
        farm.convert_volume(client, "shape:cube", tmp_path / "cube.vdb", shards=2, retries=1,
                            resolution=8, executable=flaky(tmp_path, 9, 1))
    assert caught.value.report.tries == 2


def test_what_its_workers_die_of_is_given_up(client, tmp_path):
    script = tmp_path / "deadly"
    script.write_text('#!/bin/sh\ncase "$*" in *"--shard 1/2"*) kill -9 $PPID ;; esac\n'
                      'exec sleep 600\n')
    script.chmod(0o755)
    with pytest.raises(farm.FarmError, match="shard 1/2") as caught:
        farm.convert_volume(client, "shape:cube", tmp_path / "cube.vdb", shards=2, retries=1,
                            resolution=8, executable=str(script))
    assert caught.value.report.tries == 2
    assert names_in(tmp_path) == ["deadly"]
    client.wait_for_workers(2, timeout=60)


def test_a_command_that_is_not_there_is_said(client, tmp_path):
    with pytest.raises(farm.FarmError, match="shard ./2"):
        farm.convert_volume(client, "shape:cube", tmp_path / "cube.vdb", shards=2, retries=0,
                            executable="/nowhere/bandvox")
    assert names_in(tmp_path) == []


def test_an_interruption_ends_the_runs(client, tmp_path):
    pid = tmp_path / "pid"

    def interrupt(*_):
        wait_for(lambda: pid.exists() and pid.read_text().strip())
        raise KeyboardInterrupt

    # A part that would take minutes, by a process that it starts, beside one that is done at once.
    script = tmp_path / "slow"
    script.write_text(f"""#!/bin/sh
case "$*" in *--shard=1/2*|*"--shard 1/2"*) exec {COMMAND} "$@" ;; esac
sleep 600 &
echo $! > {pid}
wait
""")
    script.chmod(0o755)
    with pytest.raises(KeyboardInterrupt):
        farm.convert_volume(client, "shape:cube", tmp_path / "cube.vdb", shards=2, resolution=8,
                            executable=str(script), progress=interrupt)
    assert names_in(tmp_path) == ["pid", "slow"]
    wait_for(lambda: is_gone(pid))


def test_a_task_takes_what_it_asks_for():
    from bandvox._dispatch import Slots

    assert [Slots(None, None).of(threads, 0) for threads in (1, 8)] == [1, 1]
    assert [Slots(2, None).of(threads, 0) for threads in (1, 2, 8)] == [0, 1, 4]
    assert [Slots(1, 3).of(8, memory) for memory in (2, 3, 7, 100)] == [0, 1, 2, 8]
    assert Slots(1, 3).of(8, 0) == 8  # no limit


def test_wrong_arguments_are_refused(client, tmp_path):
    cube = ("shape:cube", tmp_path / "cube.vdb")
    frames = (client, "convert", "a.####.obj", tmp_path / "a.####.vdb")
    for call, message in [
            (lambda: farm.convert_volume(client, *cube, shards=1), "shards is 1"),
            (lambda: farm.convert_volume(client, "shape:cube", "cube.obj", shards=2), "a .vdb"),
            (lambda: farm.convert_volume(client, *cube, shards=2, retries=-1), "retries is -1"),
            (lambda: farm.convert_volume(client, *cube, shards=2, threads=64), "64 threads"),
            (lambda: farm.convert_volume(client, *cube, shards=2, memory=10**15), "no worker"),
            (lambda: farm.convert_volume(client, *cube, shards=2, shard="1/2"), "shard is not"),
            (lambda: farm.run_frames(client, "merge", "a", "b.##.vdb", "1"), "'merge'"),
            (lambda: farm.run_frames(client, "convert", "a", "b.vdb", "1"), "a place"),
            (lambda: farm.run_frames(*frames, "3-1"), "'3-1'"),
            (lambda: farm.run_frames(*frames, "all"), "'all'")]:
        with pytest.raises(ValueError, match=message):
            call()
    assert names_in(tmp_path) == []


def test_the_rest_of_bandvox_does_without_dask():
    program = "import sys; sys.modules['distributed'] = None; import bandvox; bandvox.shape_names()"
    subprocess.run([sys.executable, "-c", program], check=True)


def test_what_the_page_shows_runs(client, tmp_path, monkeypatch):
    # Its mark says that this test runs it.
    (block,) = re.findall(r"tests/python/distributed_test.py has one -->\n```python\n(.*?)^```",
                          (ROOT / "docs" / "farm.md").read_text(), re.DOTALL | re.MULTILINE)
    sequence(tmp_path, 3)
    shutil.copy(tmp_path / "sim.0001.obj", tmp_path / "scan.obj")
    monkeypatch.chdir(tmp_path)
    address = client.scheduler.address
    program = block.replace("tcp://scheduler:8786", address).replace("1-100", "1-3")
    program = program.replace("resolution=4096", "resolution=24").replace(
        "resolution=512", "resolution=8")
    path = os.path.dirname(COMMAND) + os.pathsep + os.environ["PATH"]
    client.run(os.environ.__setitem__, "PATH", path)
    subprocess.run([sys.executable, "-c", program], check=True)
    assert {"scan.vdb", "vol.0001.vdb", "vol.0003.vdb"} <= set(names_in(tmp_path))
