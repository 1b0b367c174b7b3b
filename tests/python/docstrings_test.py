"""What docstrings say of numbers is what the C++ comments say: defaults, ranges and units of an option are
read from the header that declares it, and held against the docstring of the argument that sets it."""

import functools
import inspect
import pathlib
import re

import pytest

import bandvox

HEADERS = pathlib.Path(__file__).resolve().parents[2] / "lib" / "include" / "bandvox"

# Which member an argument sets.
OPTIONS = {
    "bandlimit": {
        "resolution": "DensityOptions.resolution", "voxel_size": "DensityOptions.voxelSize",
        "order": "ExponentialFilter.order", "cutoff": "ExponentialFilter.cutoff",
        "tolerance": "DensityOptions.tolerance", "tile": "DensityOptions.tile",
        "clamp": "DensityOptions.clamp", "iso": "DensityOptions.iso",
        "oversample": "FieldDensityOptions.oversample",
    },
    "resample": {
        "order": "ExponentialFilter.order", "cutoff": "ExponentialFilter.cutoff",
        "tolerance": "ResampleOptions.tolerance",
    },
    "to_mesh": {
        "adaptivity": "MeshOptions.adaptivity", "tolerance": "MeshOptions.tolerance",
    },
    "to_level_set": {
        "band": "LevelSetOptions.halfWidth",
    },
    "voxelize": {
        "resolution": "VoxelOptions.resolution", "voxel_size": "VoxelOptions.voxelSize",
        "threshold": "VoxelOptions.threshold", "fraction": "VoxelOptions.fraction",
    },
    "fit": {
        "tolerance": "FitSurfaceOptions.tolerance", "smooth": "FitSurfaceOptions.noise",
        "max_level": "FitSurfaceOptions.maxLevel", "tension": "FitSurfaceOptions.tension",
    },
    "fit_volume": {
        "tolerance": "FitVolumeOptions.tolerance", "smooth": "FitVolumeOptions.noise",
        "max_level": "FitVolumeOptions.maxLevel", "reach": "FitVolumeOptions.reach",
        "tension": "FitVolumeOptions.tension",
    },
    "merge": {"clamp": "MergeOptions.clamp"},
    "compare": {"cuts": "GridToSurfaceOptions.cuts"},
    "outline": {
        "tolerance": "OutlineOptions.tolerance", "crease_angle": "OutlineOptions.creaseAngle",
        "hidden": "OutlineOptions.hidden", "isophotes": "OutlineOptions.isophotes",
        "suggestive": "OutlineOptions.suggestive", "tones": "OutlineOptions.tones",
        "light": "OutlineOptions.light", "resolution": "DensityOptions.resolution",
        "cutoff": "ExponentialFilter.cutoff", "order": "ExponentialFilter.order", "stroke": "StrokeOptions.width",
        "stroke_color": "StrokeOptions.color", "hidden_stroke": "StrokeOptions.hiddenWidth",
        "hidden_color": "StrokeOptions.hiddenColor", "dash": "StrokeOptions.dash",
        "fill_colors": "StrokeOptions.fillColors", "shade": "StrokeOptions.shade",
    },
    "render": {
        "samples": "PictureOptions.samples", "seed": "PictureOptions.seed",
        "read_error": "PictureOptions.tolerance", "shadows": "TransportOptions.shadows",
        "gather": "TransportOptions.gather", "gather_distance": "TransportOptions.gatherDistance",
        "bounces": "TransportOptions.bounces", "depth": "TransportOptions.depth",
        "step": "VolumeOptions.step",
    },
    "Reconstruction.__init__": {
        "tolerance": "BrickReconstructionOptions.tolerance",
        "cache_bytes": "BrickReconstructionOptions.cacheBytes",
    },
}
CASES = [(function, argument, member) for function, arguments in OPTIONS.items()
         for argument, member in arguments.items()]
UNITS = ("cycles per voxel", "world units", "voxels", "degrees", "pixels", "mm")


@functools.lru_cache
def members():
    """Default and comment of each member of the structs of options, both as text."""
    found = {}
    for header in HEADERS.rglob("*.h"):
        for struct, body in re.findall(r"^struct (\w+)[^;{]*\{\n(.*?)^\};", header.read_text(),
                                       re.DOTALL | re.MULTILINE):
            # A comment before a member, or behind it and on the lines after it.
            for before, name, default, listed, after in re.findall(
                    r"((?:^ +/// .*\n)*)^ {4}[\w:<>,* ]+? (\w+)(?: = ([^;]*?)|\{([^;]*?)\})?;"
                    r"((?: +///< .*\n)*)", body, re.MULTILINE):
                default = default or listed
                comment = re.sub(r"\s*///<?\s*", " ", before + after).strip()
                found[f"{struct}.{name}"] = default, comment
    return found


def function_of(path):
    return functools.reduce(getattr, path.split("."), bandvox)


def docstring_of(path):
    # That of a constructor is its class's.
    return inspect.getdoc(function_of(path.partition(".__init__")[0]))


def arguments_of(path):
    """Defaults of the arguments, as Python has them."""
    function = function_of(path)
    try:
        return {name: one.default for name, one in inspect.signature(function).parameters.items()}
    except ValueError:
        line = function.__doc__.splitlines()[0]
        return {name: eval(default) for name, default in  # of literals alone
                re.findall(r"(\w+): [^=:]+? = ('[^']*'|\[[^]]*\]|[^,)]+)", line)}


def said_of(path, argument):
    """What the docstring says from the argument's name to that of another one that is told of, and what
    others say to which it refers."""
    text = " ".join(docstring_of(path).split("\n\n", 1)[-1].split())
    names = "|".join(arguments_of(path))
    parts = re.split(rf"\b({names})(?=:| \(|(?:,| and|, and) (?:{names})\b)", text)
    told, together = {}, []
    for name, said in zip(parts[1::2], parts[2::2]):
        together.append(name)
        if said in (", ", " and ", ", and "):
            continue  # They have in common what follows.
        for one in together:
            told[one] = told.get(one, "") + said
        together = []
    said = told.get(argument) or "".join(re.findall(r"The others are as of \w+", text))
    for other in re.findall(r"\bas of (\w+)", said):
        if argument in arguments_of(other):
            said += said_of(other, argument)
    return said


def number_of(text):
    """A number as C++ or a comment has it."""
    text = text.strip().rstrip("uULfF").replace("'", "")
    if "<<" in text:
        low, shift = re.sub(r"std::size_t\(|\)|u", "", text).split("<<")
        return float(int(low) << int(shift))
    return float(text)


def ranges_in(text):
    """The pairs 'a to b' of a text."""
    number = r"(-?\d+(?:\.\d+)?(?:e-?\d+)?(?:(?:\^|\*\*)\d+)?)"
    value = lambda one: float(eval(one.replace("^", "**")))  # of numbers alone
    return {(value(a), value(b)) for a, b in re.findall(rf"{number} to {number}(?![\w.]*\w)", text)}


@pytest.mark.parametrize("function, argument, member", CASES)
def test_defaults_are_those_of_the_library(function, argument, member):
    declared, _ = members()[member]
    default = arguments_of(function)[argument]
    if declared == "":
        return  # It is found out, and the docstring says how.
    if default is None:
        said = said_of(function, argument)
        values = re.findall(r"#\w+|-?\d[\d.]*", declared)
        assert values and all(value in said for value in values), (declared, said)
    elif isinstance(default, bool):
        assert declared == str(default).lower()
    elif isinstance(default, str):
        assert declared.strip('"') == default
    else:
        assert number_of(declared) == default


@pytest.mark.parametrize("function, argument, member", CASES)
def test_ranges_and_units_are_those_of_the_library(function, argument, member):
    _, comment = members()[member]
    said = said_of(function, argument)
    assert said, f"the docstring of {function} says nothing of {argument}"
    assert ranges_in(comment) <= ranges_in(said), (comment, said)
    for unit in UNITS:
        if re.search(rf"\b{unit}\b", comment) and unit != "voxels":
            assert unit in said, (comment, said)


def test_comments_are_read():
    default, comment = members()["DensityOptions.tile"]
    assert default == "0" and comment.endswith("even, up to 512; 0 chooses")
    assert members()["MeshOptions.adaptivity"][1].startswith("How much of the points")
    assert ranges_in("1 to 2^20, 1e-6 to 0.05, 2**3 to 9") == {(1, 2**20), (1e-6, 0.05), (8, 9)}
