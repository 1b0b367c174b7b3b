"""The job arrays of docs/farm.md, by a Slurm of one machine that the test starts for itself."""

import contextlib
import os
import pathlib
import re
import shutil
import socket
import subprocess
import time

import numpy as np
import pytest

import bandvox

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMANDS = pathlib.Path(os.environ["BANDVOX_BUILD_DIR"], "apps", "bandvox")
CUBE = """v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"""
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch")
# Where Debian has what only root runs.
PATH = os.environ["PATH"] + ":/usr/sbin"


def why_not():
    missing = [name for name in PROGRAMS if not shutil.which(name, path=PATH)]
    if missing:
        return f"Slurm is not installed: no {', '.join(missing)}"
    return "" if os.geteuid() == 0 else "Slurm's daemons need root"


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def configuration(folder):
    host = socket.gethostname().partition(".")[0]
    return f"""ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,batch_sched_delay=0
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
"""


@contextlib.contextmanager
def daemon(words, environment, log):
    with open(log, "wb") as said:
        process = subprocess.Popen(words, env=environment, stdin=subprocess.DEVNULL, stdout=said,
                                   stderr=said)
    try:
        yield
    finally:
        process.terminate()
        try:
            process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


@pytest.fixture(scope="module")
def slurm(tmp_path_factory):
    """The environment in which Slurm's commands find it."""
    if why_not():
        pytest.skip(why_not())
    folder = tmp_path_factory.mktemp("slurm")
    for name in ("state", "spool"):
        (folder / name).mkdir()
    key = folder / "munge.key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o400)
    (folder / "slurm.conf").write_text(configuration(folder))
    environment = dict(os.environ, PATH=f"{COMMANDS}:{PATH}",
                       SLURM_CONF=str(folder / "slurm.conf"))
    munged = ["munged", "--foreground", "--force", f"--key-file={key}",
              f"--socket={folder}/munge.socket", f"--pid-file={folder}/munged.pid",
              f"--log-file={folder}/munged.log", f"--seed-file={folder}/munge.seed"]
    with contextlib.ExitStack() as stack:
        for words in (munged, ["slurmctld", "-D"], ["slurmd", "-D"]):
            stack.enter_context(daemon(words, environment, folder / f"{words[0]}.said"))
        deadline = time.monotonic() + 60
        state = ""
        while "idle" not in state and time.monotonic() < deadline:
            time.sleep(0.3)
            state = subprocess.run(["sinfo", "-h", "-o", "%t"], env=environment, text=True,
                                   capture_output=True).stdout
        assert "idle" in state, (folder / "slurmctld.said").read_text()
        yield environment


def page_blocks():
    """What the page shows of Slurm, with less to do."""
    text = (ROOT / "docs" / "farm.md").read_text()
    blocks = re.findall(r"^```sh slurm\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    for found, less in [("--resolution 4096", "--resolution 48"),
                        ("--resolution 512", "--resolution 8"), ("--array=1-100", "--array=1-4"),
                        ("--cpus-per-task=16 --mem=32G", "--cpus-per-task=1 --mem=100M"),
                        ("--cpus-per-task=4 --mem=8G", "--cpus-per-task=1 --mem=100M"),
                        ("--mem=64G", "--mem=100M")]:
        assert any(found in block for block in blocks), found
        blocks = [block.replace(found, less) for block in blocks]
    return blocks


def run(block, folder, environment):
    done = subprocess.run(["sh", "-e", "-c", block], cwd=folder, env=environment, text=True,
                          capture_output=True)
    assert done.returncode == 0, done.stderr
    deadline = time.monotonic() + 120
    waiting = "?"
    while waiting.strip():
        assert time.monotonic() < deadline, waiting
        time.sleep(0.3)
        waiting = subprocess.run(["squeue", "-h"], env=environment, text=True, check=True,
                                 capture_output=True).stdout
    return "".join(path.read_text() for path in sorted(folder.glob("slurm-*.out")))


def test_an_array_of_parts_makes_what_one_machine_makes(slurm, tmp_path):
    (tmp_path / "scan.obj").write_text(CUBE)
    said = run(page_blocks()[0], tmp_path, slurm)
    assert (tmp_path / "scan.vdb").exists(), said
    subprocess.run([COMMANDS / "bandvox", "convert", "scan.obj", "-o", "one.vdb", "--resolution",
                    "48", "--quiet"], cwd=tmp_path, check=True)
    (ours,), (theirs,) = (bandvox.read_vdb(tmp_path / name) for name in ("scan.vdb", "one.vdb"))
    assert np.array_equal(ours.to_array()[0], theirs.to_array()[0])
    assert len(list(tmp_path.glob("part.*.vdb"))) == 8


def test_an_array_of_frames_leaves_out_a_broken_one(slurm, tmp_path):
    for number in range(1, 5):
        text = "v 0 0 nonsense\n" if number == 3 else CUBE
        (tmp_path / f"sim.{number:04d}.obj").write_text(text)
    said = run(page_blocks()[1], tmp_path, slurm)
    assert sorted(path.name for path in tmp_path.glob("vol.*")) == [
        "vol.0001.vdb", "vol.0002.vdb", "vol.0004.vdb"], said
    assert "sim.0003.obj" in said
