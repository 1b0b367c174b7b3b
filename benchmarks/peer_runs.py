"""Whole processes, timed by turns."""

import json
import os
import pathlib
import shutil
import statistics
import sys
import time

SOURCE_FOLDER = pathlib.Path(__file__).resolve().parent.parent
BUILT_BANDVOX = str(SOURCE_FOLDER / "build" / "release" / "apps" / "bandvox" / "bandvox")


def fail(message):
    sys.exit(f"{os.path.basename(sys.argv[0])}: {message}")


def require_programs(programs):
    for program in programs:
        if not shutil.which(program):
            fail(f"there is no program '{program}'; scripts/test builds bandvox, and the package "
                 "libopenvdb-tools holds vdb_tool, vdb_render and vdb_lod")


def scale_obj(source, target):
    """Copies an obj file with its points moved and scaled so that they fill [-1, 1]."""
    with open(source, encoding="utf-8", errors="replace") as file:
        lines = file.readlines()
    points = [[float(word) for word in line.split()[1:4]] for line in lines
              if line.startswith("v ")]
    if not points:
        fail(f"{source} has no points")
    low = [min(axis) for axis in zip(*points)]
    high = [max(axis) for axis in zip(*points)]
    half = max(h - l for l, h in zip(low, high)) / 2
    if half == 0:
        fail(f"all points of {source} are the same")
    middle = [(l + h) / 2 for l, h in zip(low, high)]
    remaining = iter(points)
    with open(target, "w", encoding="utf-8") as file:
        for line in lines:
            if line.startswith("v "):
                point = next(remaining)
                scaled = [(x - m) / half for x, m in zip(point, middle)]
                line = "v " + " ".join(f"{x:.9g}" for x in scaled) + "\n"
            file.write(line)


def run_once(command):
    """Runs a program to its end: seconds, and the most memory it held, in megabytes."""
    start = time.perf_counter()
    child = os.fork()
    if child == 0:
        nowhere = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(nowhere, stream)
        try:
            os.execvp(command[0], [str(word) for word in command])
        finally:
            os._exit(127)
    _, status, usage = os.wait4(child, 0)
    seconds = time.perf_counter() - start
    if os.waitstatus_to_exitcode(status) != 0:
        fail(f"this failed with status {os.waitstatus_to_exitcode(status)}: "
             f"{' '.join(map(str, command))}")
    return {"seconds": seconds, "megabytes": usage.ru_maxrss * 1024 / 1e6}


def medians(runs):
    return {key: statistics.median(run[key] for run in runs) for key in runs[0]}


def alternate(commands, runs, after=None):
    """The medians of each of some named commands, which run one after another, again and again, so
    that whatever else the machine does troubles all alike. `after(name, run)` may add to a run."""
    found = {name: [] for name in commands}
    for _ in range(runs):
        for name, command in commands.items():
            run = run_once(command)
            if after:
                after(name, run)
            found[name].append(run)
    return {name: medians(list_of_runs) for name, list_of_runs in found.items()}


def stage_seconds(path):
    """What the stages of a command took, of the file that its --stats wrote."""
    with open(path, encoding="utf-8") as file:
        stages = json.load(file)["stages"]
    seconds = {}
    for stage in stages:
        seconds[stage["name"]] = seconds.get(stage["name"], 0) + stage["seconds"]
    return seconds
