"""What arguments and results of the package are to type checkers."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Callable, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ._bandvox import Mesh, Patches

__all__ = ["Doubles", "Field", "Floats", "Iso", "Path", "Progress", "Source", "Voxel"]

Path = Union[str, "os.PathLike[str]"]
Floats = npt.NDArray[np.float32]
Doubles = npt.NDArray[np.float64]
# The index of a voxel.
Voxel = Tuple[int, int, int]
# Is called with the stage, and how far it is, from 0 to 1, where that is known.
Progress = Callable[[str, Optional[float]], object]
# The values at places x, y, z.
Field = Callable[[Doubles, Doubles, Doubles], npt.ArrayLike]
# A file, 'shape:NAME', a mesh, patches, (points, triangles) or a function.
Source = Union[Path, "Mesh", "Patches", Sequence[npt.ArrayLike], Field]
# The value that is a surface; 'volume': the one that encloses the volume of the source.
Iso = Union[float, str]
