"""Shapes to band-limited OpenVDB volumes, and pictures of them.

>>> import bandvox
>>> density = bandvox.bandlimit("shape:torus", resolution=64)
>>> picture = bandvox.render(density, width=256, height=256)
"""

from ._bandvox import (
    BandvoxWarning,
    Error,
    Grid,
    InputError,
    Mesh,
    OutOfMemoryError,
    Reconstruction,
    ResultError,
    UsageError,
    VectorGrid,
    __version__,
    bandlimit,
    compare,
    detail_levels,
    iso_of_volume,
    merge,
    read_vdb,
    resample,
    shape_names,
    thread_count,
    to_level_set,
    to_mesh,
    write_image,
    write_vdb,
)
from .picture import Picture, render

__all__ = [
    "BandvoxWarning",
    "Error",
    "Grid",
    "InputError",
    "Mesh",
    "OutOfMemoryError",
    "Picture",
    "Reconstruction",
    "ResultError",
    "UsageError",
    "VectorGrid",
    "__version__",
    "bandlimit",
    "compare",
    "detail_levels",
    "iso_of_volume",
    "merge",
    "read_vdb",
    "render",
    "resample",
    "shape_names",
    "thread_count",
    "to_level_set",
    "to_mesh",
    "write_image",
    "write_vdb",
]
