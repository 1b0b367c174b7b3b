"""What pictures show: objects, lights, what is around them, and files that tell of all that."""

from __future__ import annotations

import json
import pathlib
import re
from typing import Any, Dict, List, NamedTuple, NoReturn, Optional, Sequence, Tuple

import numpy.typing as npt

from . import _bandvox
from .types import Path


class SceneObject(NamedTuple):
    """A grid that is seen.

    mode: 'surface', where the grid is iso, or 'volume': fog, clouds and fire. iso: by default as
    stored, else 0.5, or 0 of a level set. color: linear, of a surface's matt ground or its glass; of
    a volume what it scatters, 0 to 1. colors: a grid of colours instead, where it is active.
    reflectance: of a coat over the matt ground, seen straight on, 0 to 1; roughness: of coat or
    glass, 0 (a mirror) to 1. transparency: part of the surface that is glass, 0 to 1; refraction:
    its index, 1 to 4; tint_length: world units of glass after which light has taken on the colour, 0:
    clear. extinction: part of light that a volume of density 1 stops per world unit, 0 chooses;
    anisotropy: whether it scatters light back, -1, or onward, 1; emission: linear colour in which it
    shines where nothing passes it; temperature: a grid of kelvin at which it glows; glow: how bright at
    2000 K. scale, about the world's origin; then rotate, degrees about x, y and z; then translate, world
    units.
    """

    grid: _bandvox.Grid
    mode: str = "surface"
    iso: Optional[float] = None
    color: Optional[npt.ArrayLike] = None
    colors: Optional[_bandvox.VectorGrid] = None
    reflectance: float = 0.0
    roughness: float = 0.3
    transparency: float = 0.0
    refraction: float = 1.5
    tint_length: float = 0.0
    extinction: float = 0.0
    anisotropy: float = 0.0
    emission: npt.ArrayLike = (0.0, 0.0, 0.0)
    temperature: Optional[_bandvox.Grid] = None
    glow: float = 1.0
    scale: float = 1.0
    rotate: npt.ArrayLike = (0.0, 0.0, 0.0)
    translate: npt.ArrayLike = (0.0, 0.0, 0.0)


class Light(NamedTuple):
    """A lamp: either a direction towards it or a position.

    space: 'world', or 'camera': along the camera's right, up and back. color: linear, what a white matt
    surface that faces it looks like; with a position, one world unit from it. size: degrees across, or
    with a position its radius, world units; shadows are as soft as it is large.
    """

    direction: Optional[npt.ArrayLike] = None
    position: Optional[npt.ArrayLike] = None
    space: str = "world"
    color: npt.ArrayLike = (0.9, 0.9, 0.9)
    size: float = 0.0


class Environment(NamedTuple):
    """Light from around.

    color: linear; by default 0.1, and 1 with a file. file: an image of all that is around, latitude and
    longitude; turn: degrees to turn it about y; visible: it is seen behind the objects.
    """

    color: Optional[npt.ArrayLike] = None
    file: Optional[Path] = None
    turn: float = 0.0
    visible: bool = False


# Settings of scene files whose values are words.
_WORDS = ("grid", "mode", "colors", "temperature", "file", "space", "filter", "camera", "camera-file",
          "volume-method")
_FLAGS = ("shadows", "allow-empty", "visible")
_OBJECT = ("file", "grid", "mode", "iso", "color", "colors", "roughness", "reflectance", "transparency",
           "refraction", "tint-length", "extinction", "anisotropy", "emission", "temperature", "glow",
           "scale", "rotate", "translate")
_LIGHT = ("direction", "position", "space", "color", "size")
_ENVIRONMENT = ("color", "file", "turn", "visible")
_PICTURE = ("res", "samples", "filter", "crop", "background", "seed", "allow-empty", "cache-size",
            "read-error", "camera", "camera-file", "eye", "lookat", "up", "from", "focal", "aperture",
            "fov", "frame", "shadows", "gather", "gather-distance", "bounces", "depth", "volume-method",
            "step")
# What is about files that render does not write.
_OF_FILES = ("channels", "preview")
_GROUPS = ("objects", "lights", "environment", "picture", "camera")


def read_scene(path: Path) -> Dict[str, Any]:
    """The scene file of `bandvox render`, JSON, as arguments of render: render(**read_scene(path)).

    Grids are read. Settings of what is written, channels and preview, are left out. Raises InputError.
    """
    return _SceneFile(path).arguments()


class _SceneFile:
    def __init__(self, path: Path) -> None:
        self.path = pathlib.Path(path)
        try:
            with open(self.path, encoding="utf-8") as stream:
                self.json = json.load(stream, object_pairs_hook=self.once)
        except OSError as error:
            self.fail(f"it cannot be opened for reading ({error.strerror})")
        except ValueError as error:
            if isinstance(error, _bandvox.Error):
                raise
            self.fail(f"it is no JSON ({error})")
        if not isinstance(self.json, dict):
            self.fail('it holds no scene; expected { "objects": [ ... ] }')
        for name in self.json:
            if name not in _GROUPS:
                self.fail(f"there is '{name}'; expected {', '.join(_GROUPS)}")
        self.files: Dict[pathlib.Path, List[Any]] = {}

    def arguments(self) -> Dict[str, Any]:
        found: Dict[str, Any] = {
            "source": [self.scene_object(*each) for each in self.listed("objects", _OBJECT)]}
        if not found["source"]:
            self.fail("it has no objects; expected a list of them")
        around = self.group("environment", _ENVIRONMENT)
        if around:
            if "file" in around:
                around["file"] = self.beside(around["file"])
            found["environment"] = Environment(**around)
        # An environment has lamps of its own.
        if "lights" in self.json or "file" in around:
            found["lights"] = [Light(**lamp) for _, lamp in self.listed("lights", _LIGHT)]
        for name in ("picture", "camera"):
            for key, value in self.group(name, _PICTURE + _OF_FILES).items():
                self.take(key, value, found)
        return found

    def take(self, key: str, value: Any, found: Dict[str, Any]) -> None:
        """Of two settings of one name that of the picture counts, as on the command line."""
        if key in _OF_FILES:
            return
        if key == "res":
            found.setdefault("width", value[0])
            found.setdefault("height", value[1])
        elif key == "camera_file":
            found.setdefault(key, self.beside(value))
        else:
            found.setdefault("from_" if key == "from" else key, value)

    def scene_object(self, where: str, settings: Dict[str, Any]) -> SceneObject:
        if "file" not in settings:
            self.fail(f"{where}.file is missing")
        file = self.beside(settings.pop("file"))
        if file not in self.files:
            self.files[file] = _bandvox.read_vdb(file)
        settings["grid"] = self.chosen(file, settings.get("grid"), "density")
        colors = settings.pop("colors", None)
        if colors != "none":
            settings["colors"] = self.named(file, colors, "Cd", _bandvox.VectorGrid)
        heat = settings.pop("temperature", None)
        if heat != "none" and settings.get("mode") == "volume":
            settings["temperature"] = self.named(file, heat, "temperature", _bandvox.Grid)
        return SceneObject(**settings)

    def chosen(self, file: pathlib.Path, name: Optional[str], standard: str) -> Any:
        found = self.named(file, name, standard, _bandvox.Grid)
        if found is not None:
            return found
        numbers = [grid for grid in self.files[file] if isinstance(grid, _bandvox.Grid)]
        if len(numbers) != 1:
            self.fail(f"'{file}' has {len(numbers)} grids of numbers, and none is '{standard}'; expected "
                      "the grid to be named")
        return numbers[0]

    def named(self, file: pathlib.Path, name: Optional[str], standard: str, kind: type) -> Any:
        """NAME[1] is the second one of that name; none is an error if it was asked for."""
        wanted = name or standard
        numbered = re.fullmatch(r"(.*)\[(\d+)\]", wanted)
        grids = self.files[file]
        found = [grid for grid in grids if grid.name == wanted and isinstance(grid, kind)]
        if not found and numbered:
            alike = [grid for grid in grids if grid.name == numbered[1]]
            found = [grid for grid in alike[int(numbered[2]):][:1] if isinstance(grid, kind)]
        if len(found) == 1:
            return found[0]
        if name or len(found) > 1:
            names = ", ".join(f"'{grid.name}'" for grid in grids)
            self.fail(f"'{file}' has the grids {names}; expected one {kind.__name__} '{wanted}'")
        return None

    def listed(self, name: str, names: Sequence[str]) -> List[Tuple[str, Dict[str, Any]]]:
        groups = self.json.get(name, [])
        if not isinstance(groups, list):
            self.fail(f"{name} is no list; expected [ {{ ... }}, ... ]")
        return [(f"{name}[{i}]", self.settings(one, f"{name}[{i}]", names))
                for i, one in enumerate(groups)]

    def group(self, name: str, names: Sequence[str]) -> Dict[str, Any]:
        return self.settings(self.json.get(name, {}), name, names)

    def settings(self, group: Any, where: str, names: Sequence[str]) -> Dict[str, Any]:
        if not isinstance(group, dict):
            self.fail(f"{where} holds no settings; expected {{ ... }}")
        found = {}
        for name, value in group.items():
            if name not in names:
                self.fail(f"{where} has '{name}'; expected {', '.join(names)}")
            found[name.replace("-", "_")] = self.value(f"{where}.{name}", name, value)
        return found

    def value(self, where: str, name: str, value: Any) -> Any:
        if name in _OF_FILES:
            return value
        if (name in _FLAGS) != isinstance(value, bool):
            self.fail(f"{where} is neither true nor false" if name in _FLAGS else
                      f"{where} is true or false; expected a value")
        if name in _FLAGS:
            return value
        if name in _WORDS:
            if not isinstance(value, str):
                self.fail(f"{where} is no text")
            return value
        if isinstance(value, str):
            value = self.numbers(where, value)
        numbers = value if isinstance(value, list) else [value]
        if not numbers or not all(type(one) in (int, float) for one in numbers):
            self.fail(f"{where} is neither text, a number nor a list of numbers")
        if name == "res" and len(numbers) != 2:
            self.fail(f"{where} has {len(numbers)} numbers; expected a width and a height")
        return value

    def numbers(self, where: str, text: str) -> Any:
        """What an option would be on the command line."""
        try:
            found = [float(word) if re.search(r"[.eEn]", word) else int(word)
                     for word in re.split(r"[,x]", text)]
        except ValueError:
            self.fail(f"{where} is '{text}'; expected numbers")
        return found if len(found) > 1 else found[0]

    def once(self, pairs: List[Tuple[str, Any]]) -> Dict[str, Any]:
        found: Dict[str, Any] = {}
        for name, value in pairs:
            if name in found:
                self.fail(f"there is '{name}' twice in one object; expected it once")
            found[name] = value
        return found

    def beside(self, file: str) -> pathlib.Path:
        return self.path.parent / file

    def fail(self, why: str) -> NoReturn:
        raise _bandvox.InputError(f"'{self.path}': {why}")
