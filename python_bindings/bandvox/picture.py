"""Pictures of densities, and of scenes of them."""

from __future__ import annotations

import pathlib
import tempfile
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy.typing as npt

from . import _bandvox
from .scene import Environment, Light, SceneObject
from .types import Floats, Path, Progress

# Towards the lamp that there is if nothing is said of one, along the camera's right, up and back.
_LAMP = (-0.4, 0.7, 0.8)
_AMBIENT = 0.1
_CHANNELS = ("color", "depth", "normal", "position")

# What is drawn: a grid, an object, or several of these.
Seen = Union[_bandvox.Grid, SceneObject, Sequence[Union[_bandvox.Grid, SceneObject]]]


class _Arrays(NamedTuple):
    image: Floats
    channels: Dict[str, Floats]


class Picture(_Arrays):
    """A picture, and what was seen at each of its pixels. Rows from the top.

    image: (height, width, 4) float32, linear R G B times coverage, and the coverage. channels:
    'depth' (height, width), world units along the view, inf where nothing is seen; 'normal' and
    'position' (height, width, 3), world, 0 where nothing is seen. metadata: how it was made, by the names
    that an .exr has for it. window: left, top, width and height, of the larger picture of which it is a
    part, pixels; None if it is none.
    """

    metadata: Dict[str, Any]
    window: Optional[Tuple[int, int, int, int]]

    def __new__(cls, image: Floats, channels: Dict[str, Floats],
                metadata: Optional[Dict[str, Any]] = None,
                window: Optional[Tuple[int, int, int, int]] = None) -> Picture:
        picture = super().__new__(cls, image, channels)
        picture.metadata = metadata or {}
        picture.window = window
        return picture

    def write(self, path: Path, *, channels: Sequence[str] = _CHANNELS) -> None:
        """Write a .png (sRGB), or an .exr with all channels, or some of 'color', 'depth', 'normal' and
        'position'."""
        for name in channels:
            if name not in _CHANNELS:
                raise _bandvox.UsageError(
                    f"channels: found '{name}'; expected some of {', '.join(_CHANNELS)}")
        kept = {name: self.channels[name] for name in channels if name in self.channels}
        _bandvox.write_image(path, self.image, kept, color="color" in channels,
                             metadata=self.metadata, window=self.window)

    def _repr_png_(self) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "picture.png")
            _bandvox.write_image(path, self.image)
            return path.read_bytes()


def render(
    source: Seen,
    *,
    width: int = 512,
    height: int = 512,
    samples: int = 1,
    filter: str = "box",
    crop: Optional[Sequence[int]] = None,
    eye: Optional[npt.ArrayLike] = None,
    lookat: Optional[npt.ArrayLike] = None,
    up: Optional[npt.ArrayLike] = None,
    from_: Optional[npt.ArrayLike] = None,
    camera: Optional[str] = None,
    camera_file: Optional[Path] = None,
    focal: Optional[float] = None,
    aperture: Optional[float] = None,
    fov: Optional[float] = None,
    frame: Optional[float] = None,
    iso: Optional[float] = None,
    color: Optional[npt.ArrayLike] = None,
    light: Optional[npt.ArrayLike] = None,
    light_at: Optional[npt.ArrayLike] = None,
    light_color: Optional[npt.ArrayLike] = None,
    light_size: float = 0.0,
    ambient: Optional[float] = None,
    lights: Optional[Sequence[Light]] = None,
    environment: Union[Path, Environment, None] = None,
    background: Optional[npt.ArrayLike] = None,
    shadows: bool = False,
    gather: int = 0,
    gather_distance: float = 0.0,
    bounces: int = 0,
    depth: int = 8,
    volume_method: str = "steps",
    step: float = 1.0,
    shading: str = "spectral",
    allow_empty: bool = False,
    read_error: float = 5e-4,
    cache_size: int = 0,
    seed: int = 0,
    preview: Optional[Callable[[Floats], object]] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Picture:
    """Draw grids, or a scene of them; returns a Picture.

    source: a Grid, whose surface {density = iso} of this color is drawn, a SceneObject, or several of
    both. samples: lines of sight per pixel; filter: how they count, 'box', 'triangle', 'gaussian' or
    'blackman-harris'. crop: left, top, right, bottom, of a part of the picture, pixels.

    eye, lookat, up: world, chosen so that the objects fit if they are None; camera: 'perspective' or
    'orthographic'; from_: direction from the objects to a chosen eye. focal, aperture: mm, 50 and
    41.2136; fov: degrees from left to right, instead of focal. frame: width of an orthographic view,
    0 fits. camera_file: a .gltf or .glb file with a camera, FILE:NAME takes the one of that name; the
    others change it.

    light: towards the lamp, along the camera's right, up and back; light_at: its place, world, instead;
    light_color: what ambient leaves of white; light_size: degrees across, or the radius, world units.
    lights: all lamps, instead. ambient: light from around, 0 to 1, 0.1 by default. environment: an image
    of all that is around, or an Environment; then there is no lamp unless one is asked for. background,
    colours: linear; without a background it is transparent.

    shadows: objects stop the light of lamps. gather: directions in which a matt surface looks for light
    from around; gather_distance: how far at most, world units, 0: any; bounces: how often it goes on from
    surface to surface. depth: how often a line of sight is mirrored and refracted. volume_method: 'steps'
    or 'tracking'; step: voxels from place to place, 0.05 to 16. shading: 'spectral', or an older method.

    read_error: of what is read between the nodes, 1e-6 to 0.1; cache_size: memory for it, MB, 0 chooses.
    seed: of all that is random. preview: called now and then with the picture as far as it is, (height,
    width, 4). Raises ResultError if nothing is seen, unless allow_empty.
    """
    picture = _picture(locals())
    scene = _scene(source, iso, color, light, light_at, light_color, light_size, ambient, lights,
                   environment)
    return Picture(*_bandvox._render(scene, picture, threads, progress))


def turntable(source: Seen, pictures: int, **options: Any) -> List[Dict[str, Any]]:
    """Cameras that go once around, in even steps: for view in turntable(grid, 36): render(grid, **view).

    options: of render, as far as they say what is seen, from where and how large the pictures are; those
    of the first camera. All see what they look at from as far away that all of it fits.
    """
    standard = dict(render.__kwdefaults__ or {})
    unknown = sorted(set(options) - set(standard))
    if unknown:
        raise TypeError(f"turntable() got an unexpected keyword argument '{unknown[0]}'")
    chosen = {**standard, **options}
    scene = _scene(source, *(chosen[name] for name in (
        "iso", "color", "light", "light_at", "light_color", "light_size", "ambient", "lights",
        "environment")))
    return _bandvox._turntable(scene, _picture(chosen), pictures, chosen["threads"],
                               chosen["progress"])


def _picture(arguments: Dict[str, Any]) -> Dict[str, Any]:
    """What of render's arguments says how the picture is drawn."""
    of_scene = ("source", "iso", "color", "light", "light_at", "light_color", "light_size", "ambient",
                "lights", "environment", "threads", "progress")
    return {name: value for name, value in arguments.items() if name not in of_scene}


def _scene(
    source: Seen,
    iso: Optional[float],
    color: Optional[npt.ArrayLike],
    light: Optional[npt.ArrayLike],
    light_at: Optional[npt.ArrayLike],
    light_color: Optional[npt.ArrayLike],
    light_size: float,
    ambient: Optional[float],
    lights: Optional[Sequence[Light]],
    environment: Union[Path, Environment, None],
) -> Dict[str, Any]:
    around = environment if isinstance(environment, Environment) else Environment(file=environment)
    has_map = around.file is not None
    if ambient is not None and around.color is not None:
        raise _bandvox.UsageError("ambient and the color of the environment exclude each other")
    if ambient is None:
        ambient = 1.0 if has_map else _AMBIENT
    if around.color is None:
        around = around._replace(color=(ambient, ambient, ambient))
    if lights is None:
        lights = _lamp(light, light_at, light_color, light_size, 1.0 if has_map else 1.0 - ambient,
                       has_map)
    elif not (light is None and light_at is None and light_color is None):
        raise _bandvox.UsageError("lights are all lamps that there are; expected no light, light_at or "
                                  "light_color with them")
    objects = _objects(source, iso, color)
    return {"objects": [one._asdict() for one in objects],
            "lights": [one._asdict() for one in lights], "environment": around._asdict()}


def _lamp(light: Optional[npt.ArrayLike], light_at: Optional[npt.ArrayLike],
          light_color: Optional[npt.ArrayLike], light_size: float, rest: float,
          has_map: bool) -> List[Light]:
    # An environment has lamps of its own.
    if has_map and light is None and light_at is None and light_color is None:
        return []
    if light is not None and light_at is not None:
        raise _bandvox.UsageError("light and light_at exclude each other")
    color = (rest, rest, rest) if light_color is None else light_color
    if light_at is not None:
        return [Light(position=light_at, color=color, size=light_size)]
    return [Light(_LAMP if light is None else light, space="camera", color=color, size=light_size)]


def _objects(source: Seen, iso: Optional[float],
             color: Optional[npt.ArrayLike]) -> List[SceneObject]:
    objects = []
    # A SceneObject is a tuple, too.
    several = isinstance(source, (list, tuple)) and not isinstance(source, SceneObject)
    sources: Any = source if several else (source,)
    for one in sources:
        if isinstance(one, SceneObject):
            if iso is not None or color is not None:
                raise _bandvox.UsageError("iso and color are for grids alone; a SceneObject has its own")
            objects.append(one)
        else:
            objects.append(SceneObject(one, iso=iso, color=color))
    return objects
