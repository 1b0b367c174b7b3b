"""Pictures of densities."""

import pathlib
import tempfile
from typing import NamedTuple

from . import _bandvox


class Picture(NamedTuple):
    """A picture, and what was seen at each of its pixels. Rows from the top.

    image: (height, width, 4) float32, linear R G B times coverage, and the coverage. channels:
    'depth' (height, width), world units along the view, inf where nothing is seen; 'normal' and
    'position' (height, width, 3), world, 0 where nothing is seen.
    """

    image: "object"
    channels: "dict[str, object]"

    def write(self, path):
        """Write a .png (sRGB) or an .exr with all channels."""
        _bandvox.write_image(path, self.image, self.channels)

    def _repr_png_(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "picture.png")
            _bandvox.write_image(path, self.image)
            return path.read_bytes()


def render(
    grid,
    *,
    width=512,
    height=512,
    samples=1,
    eye=None,
    lookat=None,
    up=None,
    from_=None,
    projection="perspective",
    focal=50.0,
    aperture=41.2136,
    frame=0.0,
    iso=None,
    shading="spectral",
    light=(-0.4, 0.7, 0.8),
    color=(0.8, 0.8, 0.8),
    ambient=0.1,
    background=None,
    shadows=False,
    allow_empty=False,
    tolerance=5e-4,
    seed=0,
    threads=0,
    progress=None,
):
    """Draw the surface {density = iso} of a grid; returns a Picture.

    samples: lines of sight per pixel. eye, lookat, up: world, chosen so that the object fits if they
    are None; from_: direction from the object to a chosen eye. focal, aperture: mm. frame: width of
    an orthographic view, 0 fits. light: towards it, along the camera's right, up and back. color,
    background: linear; without a background it is transparent. shading: 'spectral', or an older
    method. Raises ResultError if nothing is seen, unless allow_empty.
    """
    image, channels = _bandvox._render(
        grid, width, height, samples, eye, lookat, up, from_, projection, focal, aperture, frame,
        iso, shading, light, color, ambient, background, shadows, allow_empty, tolerance, seed,
        threads, progress)
    return Picture(image, channels)
