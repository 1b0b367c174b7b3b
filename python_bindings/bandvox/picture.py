"""Pictures of densities."""

from __future__ import annotations

import pathlib
import tempfile
from typing import Dict, NamedTuple, Optional

import numpy.typing as npt

from . import _bandvox
from .types import Floats, Path, Progress


class Picture(NamedTuple):
    """A picture, and what was seen at each of its pixels. Rows from the top.

    image: (height, width, 4) float32, linear R G B times coverage, and the coverage. channels:
    'depth' (height, width), world units along the view, inf where nothing is seen; 'normal' and
    'position' (height, width, 3), world, 0 where nothing is seen.
    """

    image: Floats
    channels: Dict[str, Floats]

    def write(self, path: Path) -> None:
        """Write a .png (sRGB) or an .exr with all channels."""
        _bandvox.write_image(path, self.image, self.channels)

    def _repr_png_(self) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "picture.png")
            _bandvox.write_image(path, self.image)
            return path.read_bytes()


def render(
    grid: _bandvox.Grid,
    *,
    width: int = 512,
    height: int = 512,
    samples: int = 1,
    eye: Optional[npt.ArrayLike] = None,
    lookat: Optional[npt.ArrayLike] = None,
    up: Optional[npt.ArrayLike] = None,
    from_: Optional[npt.ArrayLike] = None,
    camera: str = "perspective",
    focal: float = 50.0,
    aperture: float = 41.2136,
    frame: float = 0.0,
    iso: Optional[float] = None,
    shading: str = "spectral",
    light: npt.ArrayLike = (-0.4, 0.7, 0.8),
    color: npt.ArrayLike = (0.8, 0.8, 0.8),
    ambient: float = 0.1,
    background: Optional[npt.ArrayLike] = None,
    shadows: bool = False,
    allow_empty: bool = False,
    tolerance: float = 5e-4,
    seed: int = 0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Picture:
    """Draw the surface {density = iso} of a grid; returns a Picture.

    samples: lines of sight per pixel. eye, lookat, up: world, chosen so that the object fits if they
    are None; camera: 'perspective' or 'orthographic'; from_: direction from the object to a chosen eye. focal, aperture: mm. frame: width of
    an orthographic view, 0 fits. light: towards it, along the camera's right, up and back. color,
    background: linear; without a background it is transparent. shading: 'spectral', or an older
    method. Raises ResultError if nothing is seen, unless allow_empty.
    """
    image, channels = _bandvox._render(
        grid, width, height, samples, eye, lookat, up, from_, camera, focal, aperture, frame,
        iso, shading, light, color, ambient, background, shadows, allow_empty, tolerance, seed,
        threads, progress)
    return Picture(image, channels)
