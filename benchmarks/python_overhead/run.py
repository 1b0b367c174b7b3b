#!/usr/bin/python3
"""What calling bandvox.bandlimit from Python costs, over the same calls in C++.

run.py BUILD [--mesh FILE] [--resolution N] [--calls N] [--runs N]

BUILD is a build tree with the benchmarks and the Python package. Each run is a process of Python and
one of C++, by turns, with so many calls; the first call of each is left away. The mesh is that of a
built-in shape if there is no file.
"""

import argparse
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

PROGRAM = """
import sys, time, bandvox
for _ in range(int(sys.argv[3])):
    start = time.perf_counter()
    grid = bandvox.bandlimit(sys.argv[1], resolution=int(sys.argv[2]))
    print(time.perf_counter() - start)
    del grid
"""


def seconds(command, environment):
    found = subprocess.run(command, env=environment, text=True, stdout=subprocess.PIPE, check=True).stdout
    return [float(line) for line in found.split()][1:]


def make_mesh(build, environment, path):
    program = ("import bandvox, sys; "
               "bandvox.to_mesh(bandvox.bandlimit('shape:torus', resolution=40)).write(sys.argv[1])")
    subprocess.run([sys.executable, "-c", program, path], env=environment, check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--mesh")
    parser.add_argument("--resolution", type=int, default=64)
    parser.add_argument("--calls", type=int, default=20)
    parser.add_argument("--runs", type=int, default=7)
    options = parser.parse_args()
    environment = {**os.environ, "PYTHONPATH": str(options.build / "python")}
    with tempfile.TemporaryDirectory() as folder:
        mesh = options.mesh or os.path.join(folder, "torus.ply")
        if not options.mesh:
            make_mesh(options.build, environment, mesh)
        words = [mesh, str(options.resolution), str(options.calls)]
        ours, theirs = [], []
        for _ in range(options.runs):
            theirs += seconds([str(options.build / "benchmarks" / "mesh_seconds"), *words], environment)
            ours += seconds([sys.executable, "-c", PROGRAM, *words], environment)
    python, cpp = statistics.median(ours), statistics.median(theirs)
    print(f"{len(ours)} calls each, medians: C++ {1e3 * cpp:.2f} ms, Python {1e3 * python:.2f} ms, "
          f"{100 * (python / cpp - 1):+.1f} %")
    print(f"the fastest: C++ {1e3 * min(theirs):.2f} ms, Python {1e3 * min(ours):.2f} ms, "
          f"{100 * (min(ours) / min(theirs) - 1):+.1f} %")


if __name__ == "__main__":
    main()
