"""Volumes by Bandvox, without anything of Blender: by its Python package where there is one, else by its command."""

import contextlib
import dataclasses
import json
import os
import shutil
import subprocess
import tempfile
import warnings

from . import ply

# What the package reads as a solid; of everything else the command knows what it is.
PACKAGE_READS = (".obj", ".ply", ".stl", ".gltf", ".glb", ".off", ".dae", ".3ds", ".fbx")


class EngineError(Exception):
    """What Bandvox refused, with what was found and what was expected."""


@dataclasses.dataclass
class Lattice:
    """The voxels of a new volume, and how sharp it is on them."""

    resolution: int = 128      # voxels along the longest side, at least 1
    voxel_size: float = 0.0    # world units; instead of the resolution where it is above 0
    cutoff: float = 0.16       # cycles per voxel, 0.01 to 0.5
    order: float = 2.0         # 1 to 64; above 2 the density overshoots at flat faces

    def keywords(self):
        size = {"voxel_size": self.voxel_size} if self.voxel_size > 0 else {"resolution": self.resolution}
        return {**size, "cutoff": self.cutoff, "order": self.order}

    def words(self):
        return [word for name, value in self.keywords().items()
                for word in ("--" + name.replace("_", "-"), repr(value))]


@dataclasses.dataclass
class GridFacts:
    """What a file says of one of its grids."""

    name: str
    is_level_set: bool
    voxel_size: tuple  # world units, along x, y and z
    iso: float         # the value that is the surface
    volume: float      # of the solid, cubic world units; 0 where the file does not say


class Engine:
    """Makes files of volumes.

    command: the `bandvox` program; empty looks for it on PATH. use_package: take `import bandvox` where it can.
    progress: called with a fraction, 0 to 1. `warnings` collects what Bandvox warned of.
    Raises EngineError if there is neither package nor command.
    """

    def __init__(self, command="", use_package=True, progress=None):
        self.package = _package() if use_package else None
        self.command = shutil.which(command or "bandvox")
        self.progress = progress or (lambda fraction: None)
        self.warnings = []
        if command and not self.command:
            raise EngineError(f"cannot run '{command}'; expected the path of the command bandvox, "
                              "or nothing in the add-on's preferences")
        if not self.package and not self.command:
            raise EngineError("found neither the Python package bandvox nor the command; expected the command on "
                              "PATH or in the add-on's preferences")

    def convert_file(self, source, target, lattice, kind=""):
        """A mesh, points, a scan or a volume to a .vdb file.

        kind: `density`, `values`, ... as of `bandvox convert --as`; empty takes what suits the file.
        """
        if not kind and self.package and _is_for_package(source):
            with self._package_at_work() as bandvox:
                bandvox.bandlimit(source, **lattice.keywords(), progress=self._told).write(target)
            return
        self._run(["convert", source, "--output", target, *lattice.words(), *(["--as", kind] if kind else [])])

    def convert_mesh(self, points, triangles, target, lattice):
        """Points (n, 3) and triangles (m, 3) to a .vdb file of the solid inside."""
        if self.package:
            with self._package_at_work() as bandvox:
                grid = bandvox.bandlimit((points, triangles), **lattice.keywords(), progress=self._told)
                grid.write(target)
            return
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mesh.ply")
            ply.write(path, points, triangles)
            self.convert_file(path, target, lattice)

    def facts(self, path):
        """GridFacts of each grid of numbers in a .vdb file."""
        if self.package:
            with self._package_at_work() as bandvox:
                return [_facts_of(grid.name, grid.metadata.get("class", ""), grid.voxel_size,
                                  lambda name, grid=grid: grid.metadata.get("bandvox_" + name))
                        for grid in bandvox.read_vdb(path) if isinstance(grid, bandvox.Grid)]
        grids = json.loads(self._run(["info", path, "--json"]))["grids"]
        return [_facts_of(grid["name"], grid["class"], grid["voxel_size"], grid.get("bandvox", {}).get)
                for grid in grids if grid["value_type"] == "float"]

    def iso_of_volume(self, path, grid):
        """The value of a density whose surface encloses as much as the solid that the density was made of."""
        if self.package:
            with self._package_at_work() as bandvox:
                density = self._grid(path, grid)
                volume = density.metadata.get("bandvox_source_volume")
                if volume is None:
                    raise EngineError(f"'{path}' does not say what volume its source has; expected a density by Bandvox")
                return bandvox.iso_of_volume(density, volume, progress=self._told)[0]
        with tempfile.TemporaryDirectory() as folder:
            target = os.path.join(folder, "same.vdb")
            self._run(["convert", path, "--grid", grid, "--iso", "volume", "--output", target])
            return self.facts(target)[0].iso

    def surface(self, path, grid, iso):
        """Points (n, 3) and triangles (m, 3) of the surface where a grid of a .vdb file has the value iso."""
        if self.package:
            with self._package_at_work() as bandvox:
                mesh = bandvox.to_mesh(self._grid(path, grid), iso=iso, progress=self._told)
                return mesh.points, mesh.triangles
        with tempfile.TemporaryDirectory() as folder:
            target = os.path.join(folder, "surface.ply")
            self._run(["convert", path, "--grid", grid, "--iso", repr(iso), "--output", target])
            try:
                return ply.read(target)
            except ValueError as error:
                raise EngineError(str(error)) from error

    def _grid(self, path, name):
        found = [grid for grid in self.package.read_vdb(path) if grid.name == name]
        if not found:
            raise EngineError(f"'{path}' has no grid '{name}'; expected one that it has")
        return found[0]

    def _told(self, stage, fraction):
        if fraction is not None:
            self.progress(fraction)

    @contextlib.contextmanager
    def _package_at_work(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", self.package.BandvoxWarning)
            try:
                yield self.package
            except self.package.Error as error:
                raise EngineError(str(error)) from error
        self.warnings += [str(one.message) for one in caught
                          if issubclass(one.category, self.package.BandvoxWarning)]

    def _run(self, words):
        """Runs the command; what it prints."""
        if not self.command:
            raise EngineError(f"'{words[1]}' needs the command bandvox; expected it on PATH or in the add-on's preferences")
        # A file for the output, so that a full pipe never stops the command while its progress is read.
        with tempfile.TemporaryFile("w+", encoding="utf-8") as printed:
            with subprocess.Popen([self.command, *words, "--progress", "always"], stdin=subprocess.DEVNULL, text=True,
                                  stdout=printed, stderr=subprocess.PIPE, encoding="utf-8", errors="replace") as process:
                try:
                    errors = self._listen(process.stderr)
                except BaseException:  # Ctrl-C too: nobody waits for the result any more
                    process.terminate()
                    raise
            if process.returncode != 0:
                raise EngineError(errors or f"bandvox {words[0]} has ended with status {process.returncode}")
            printed.seek(0)
            return printed.read()

    def _listen(self, stream):
        """Takes the progress and the warnings out of what the command says; returns its errors."""
        errors = []
        for line in stream:
            line = line.strip()
            if line.startswith("Progress: "):
                self.progress(float(line[len("Progress: "):-1]) / 100)
            elif line.startswith("bandvox: warning: "):
                self.warnings.append(line[len("bandvox: warning: "):])
            elif line.startswith("bandvox: error: "):
                errors.append(line[len("bandvox: error: "):])
        return "; ".join(errors)


def _package():
    """The package, or None where this Python has none, or one that does not fit it."""
    try:
        import bandvox
    except ImportError:
        return None
    return bandvox


def _is_for_package(source):
    return source.startswith("shape:") or source.lower().endswith(PACKAGE_READS) and not _is_points(source)


def _is_points(source):
    """Is it a .ply file of points without faces? Only its head tells."""
    if not source.lower().endswith(".ply"):
        return False
    with contextlib.suppress(OSError), open(source, "rb") as stream:
        return b"element face" not in stream.read(10000)
    return False


def _facts_of(name, kind, voxel_size, metadata):
    is_level_set = kind == "level set"
    iso = metadata("iso")
    if iso is None:
        iso = 0.0 if is_level_set else 0.5
    return GridFacts(name, is_level_set, tuple(voxel_size), iso, metadata("grid_volume") or 0.0)
