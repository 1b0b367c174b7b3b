"""What the command line does, functions do: each option of each command is an argument, or is told why not."""

import inspect
import os
import pathlib
import re
import subprocess

import pytest

import bandvox

BANDVOX = pathlib.Path(os.environ.get("BANDVOX_BUILD_DIR", ""), "apps", "bandvox", "bandvox")

# Of all commands.
EVERYWHERE = {
    "threads": "threads= of each function",
    "progress": "progress= of each function",
    "quiet": "nothing is said",
    "verbose": "nothing is said",
    "stats": "what was measured is in the grid's metadata, and time is the caller's to take",
    "strict": "warnings.simplefilter('error', bandvox.BandvoxWarning)",
    "config": "a dictionary of arguments",
    "help": "help()",
    "version": "bandvox.__version__",
    "output": "what is returned has write or save",
}
FRAMES = "a loop, or bandvox.distributed.run_frames"
# A tuple is of arguments that are there, text says why there is none.
CONVERT = {
    "resolution": ("bandlimit.resolution", "bandlimit_points.resolution", "bandlimit_grid.resolution",
                   "resample.resolution"),
    "voxel-size": ("bandlimit.voxel_size", "resample.voxel_size"),
    "cutoff": ("bandlimit.cutoff", "resample.cutoff", "detail_levels.cutoff", "colors.cutoff"),
    "order": ("bandlimit.order", "resample.order", "detail_levels.order", "colors.order"),
    "tolerance": ("bandlimit.tolerance", "resample.tolerance", "detail_levels.tolerance"),
    "tile": ("bandlimit.tile", "colors.tile"),
    "route": ("bandlimit.route",),
    "oversample": ("bandlimit.oversample",),
    "overlap": ("bandlimit.overlap",),
    "base": ("bandlimit.base",),
    "clamp": ("bandlimit.clamp",),
    "iso": ("bandlimit.iso", "to_mesh.iso", "to_level_set.iso", "to_fog.iso"),
    "color": ("colors.source", "to_mesh.colors"),
    "memory-limit": "a grid is returned in memory; one that does not fit is the command's, or surfaceToVdb's of C++",
    "shard": ("bandlimit.shard", "bandlimit_points.shard", "bandlimit_grid.shard"),
    "half": ("Grid.write.half", "write_vdb.half"),
    "compression": ("Grid.write.compression", "write_vdb.compression", "write_array.compression"),
    "adaptivity": ("to_mesh.adaptivity",),
    "grid": "the grids of a file are a list",
    "background": ("read_array.background",),
    "factor": ("resample.factor", "bandlimit_grid.factor"),
    "onto": ("resample.onto", "bandlimit_grid.onto"),
    "no-filter": ("resample.filter",),
    "lod": ("detail_levels.levels",),
    "threshold": ("bandlimit_grid.threshold",),
    "points": ("bandlimit_points.points",),
    "radius": ("bandlimit_points.radius",),
    "spacing": ("read_array.spacing",),
    "origin": ("read_array.origin",),
    "space": ("read_array.space",),
    "channel": ("read_array.channel",),
    "series": ("read_array.series",),
    "as": ("to_level_set.grid", "to_fog.grid"),
    "band": ("to_level_set.band", "to_fog.band"),
    "type": ("write_array.type",),
    "range": ("write_array.range",),
    "box": ("write_array.box",),
    "frames": FRAMES,
    "keep-going": FRAMES,
    "skip-existing": FRAMES,
    "like": "a dictionary of arguments",
}
OF_CAMERA = {
    "eye": ("render.eye", "outline.eye"),
    "lookat": ("render.lookat", "outline.lookat"),
    "up": ("render.up", "outline.up"),
    "from": ("render.from_", "outline.from_"),
    "camera": ("render.camera", "outline.camera"),
    "camera-file": ("render.camera_file", "outline.camera_file"),
    "focal": ("render.focal", "outline.focal"),
    "aperture": ("render.aperture", "outline.aperture"),
    "fov": ("render.fov", "outline.fov"),
    "frame": ("render.frame", "outline.frame"),
}


def of(function, *options):
    return {option: (f"{function}.{option.replace('-', '_')}",) for option in options}


RENDER = {
    **OF_CAMERA,
    **of("SceneObject", "grid", "mode", "iso", "color", "colors", "reflectance", "roughness", "transparency",
         "refraction", "tint-length", "extinction", "anisotropy", "emission", "temperature", "glow",
         "scale", "rotate", "translate"),
    **of("render", "samples", "filter", "crop", "background", "seed", "allow-empty", "preview",
         "cache-size", "read-error", "shadows", "gather", "gather-distance", "bounces", "depth",
         "volume-method", "step", "light", "light-at", "light-color", "light-size", "ambient", "environment",
         "shading"),
    "res": ("render.width", "render.height"),
    "channels": ("Picture.write.channels",),
    "environment-turn": ("Environment.turn",),
    "environment-visible": ("Environment.visible",),
    "turntable": ("turntable.pictures",),
    "frames": FRAMES,
}
OUTLINE = {
    **OF_CAMERA,
    **of("outline", "page", "margin", "tolerance", "crease-angle", "kinds", "isophotes", "suggestive", "fill",
         "tones", "fill-colors", "shade", "light", "stroke", "stroke-color", "hidden-stroke",
         "hidden-color", "dash", "iso"),
    **of("outline", "grid", "resolution", "voxel-size", "cutoff", "order"),
    "no-hidden": ("outline.hidden",),
}
FIT = {
    **{option: (f"fit.{option.replace('-', '_')}", f"fit_volume.{option.replace('-', '_')}")
       for option in ("columns", "tolerance", "smooth", "max-level", "tension")},
    **of("fit", "rectangle", "levels"),
    "volume": ("fit_volume.places",),
    "reach": ("fit_volume.reach",),
    "samples": ("Surface.save.samples", "Surface.sample.samples", "Surface.mesh.samples"),
    "quantities": ("Surface.save.quantities", "Surface.sample.quantities", "Volume.grid.quantity"),
    "resolution": ("Surface.density.resolution", "Volume.grids.resolution"),
    "voxel-size": ("Surface.density.voxel_size", "Volume.grids.voxel_size"),
    **of("Surface.density", "base", "cutoff", "order"),
    **of("Grid.write", "half", "compression"),
}
VOXELIZE = {
    **of("voxelize", "resolution", "voxel-size", "threshold", "fraction", "axis", "backend", "gpu-method"),
    "as": ("voxelize.as_",),
    **of("MaskGrid.write", "compression"),
}
COMPARE = {
    **of("compare", "iso", "only", "distance-tolerance", "cuts"),
    "grid": "the grids of a file are a list",
    "fail-above": "an assertion about what is returned",
    "metric": "an assertion about what is returned",
    "json": ("compare.a",),
}
MERGE = {
    **of("merge", "operation", "weights", "clamp", "resample"),
    **of("Grid.write", "half", "compression"),
    "grid": "the grids of a file are a list",
}
COMMANDS = {
    "convert": CONVERT, "render": RENDER, "outline": OUTLINE, "fit": FIT, "voxelize": VOXELIZE,
    "compare": COMPARE, "merge": MERGE, "info": {"json": ("info.source",)},
    "view": {**of("view", "title", "iso", "size"), "grid": ("view.grid",)},
}


def options_of(command):
    """By the option's own help, which has a line for each."""
    text = subprocess.run([BANDVOX, command, "--help"], text=True, capture_output=True, check=True).stdout
    found = re.findall(r"^ +(?:-\w(?:, | \[ ))?--([a-z][a-z-]*)", text, re.MULTILINE)
    assert len(found) > 8, text
    return set(found)


def arguments_of(path):
    """Names of the arguments of a function, a method or a tuple of the package."""
    value = bandvox
    for name in path.split("."):
        value = getattr(value, name)
    if hasattr(value, "_fields"):
        return set(value._fields)
    try:
        return set(inspect.signature(value).parameters)
    except ValueError:
        return set(re.findall(r"(\w+):", value.__doc__.splitlines()[0]))


@pytest.mark.skipif(not BANDVOX.exists(), reason="needs the command")
@pytest.mark.parametrize("command", sorted(COMMANDS))
def test_every_option_is_an_argument_or_is_told_why_not(command):
    known = {**EVERYWHERE, **COMMANDS[command]}
    assert options_of(command) - set(known) == set()


@pytest.mark.parametrize("command", sorted(COMMANDS))
def test_arguments_are_there(command):
    for option, places in COMMANDS[command].items():
        for place in places if isinstance(places, tuple) else ():
            function, _, argument = place.rpartition(".")
            assert argument in arguments_of(function), f"--{option}: {place}"


@pytest.mark.skipif(not BANDVOX.exists(), reason="needs the command")
def test_there_is_no_other_command():
    text = subprocess.run([BANDVOX, "--help"], text=True, capture_output=True, check=True).stdout
    commands = re.findall(r"^  ([a-z]+)  ", text, re.MULTILINE)
    assert set(commands) == set(COMMANDS)
