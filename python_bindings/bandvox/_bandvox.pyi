"""What the compiled module is to type checkers; stubs_test.py holds it against the module."""

from typing import Any, Dict, Iterable, Iterator, List, Optional, Sequence, Tuple, TypeVar, Union

import numpy as np
import numpy.typing as npt

from .types import Doubles, Field, Floats, Iso, Path, Progress, Source, Voxel

__version__: str

class Error(Exception): ...
class UsageError(Error, ValueError): ...
class InputError(Error, ValueError): ...
class ResultError(Error, ArithmeticError): ...
class OutOfMemoryError(Error, MemoryError): ...
class BandvoxWarning(UserWarning): ...

class Grid:
    name: str
    @staticmethod
    def from_array(
        array: npt.ArrayLike,
        *,
        origin: Optional[npt.ArrayLike] = None,
        voxel_size: Optional[npt.ArrayLike] = None,
        transform: Optional[npt.ArrayLike] = None,
        background: float = 0.0,
        tolerance: float = 0.0,
        name: str = "density",
    ) -> Grid: ...
    @property
    def transform(self) -> Doubles: ...
    @property
    def voxel_size(self) -> Tuple[float, float, float]: ...
    @property
    def metadata(self) -> Dict[str, Any]: ...
    @property
    def bounds(self) -> Optional[Tuple[Voxel, Voxel]]: ...
    @property
    def grid_class(self) -> str: ...
    @property
    def active_voxel_count(self) -> int: ...
    @property
    def memory_bytes(self) -> int: ...
    def to_array(self, bounds: Optional[Sequence[npt.ArrayLike]] = None) -> Tuple[Floats, Voxel]: ...
    def blocks(self) -> Iterator[Tuple[Voxel, Floats]]: ...
    def copy(self) -> Grid: ...
    def write(
        self,
        path: Path,
        *,
        half: bool = False,
        compression: str = "blosc",
        threads: int = 0,
        progress: Optional[Progress] = None,
    ) -> None: ...

class VectorGrid:
    name: str
    @staticmethod
    def from_array(
        array: npt.ArrayLike,
        *,
        origin: Optional[npt.ArrayLike] = None,
        voxel_size: Optional[npt.ArrayLike] = None,
        transform: Optional[npt.ArrayLike] = None,
        background: float = 0.0,
        tolerance: float = 0.0,
        name: str = "density",
    ) -> VectorGrid: ...
    @property
    def transform(self) -> Doubles: ...
    @property
    def voxel_size(self) -> Tuple[float, float, float]: ...
    @property
    def metadata(self) -> Dict[str, Any]: ...
    @property
    def bounds(self) -> Optional[Tuple[Voxel, Voxel]]: ...
    @property
    def grid_class(self) -> str: ...
    @property
    def active_voxel_count(self) -> int: ...
    @property
    def memory_bytes(self) -> int: ...
    def to_array(self, bounds: Optional[Sequence[npt.ArrayLike]] = None) -> Tuple[Floats, Voxel]: ...
    def blocks(self) -> Iterator[Tuple[Voxel, Floats]]: ...
    def copy(self) -> VectorGrid: ...
    def write(
        self,
        path: Path,
        *,
        half: bool = False,
        compression: str = "blosc",
        threads: int = 0,
        progress: Optional[Progress] = None,
    ) -> None: ...

class MaskGrid:
    name: str
    @staticmethod
    def from_array(
        array: npt.ArrayLike,
        *,
        origin: Optional[npt.ArrayLike] = None,
        voxel_size: Optional[npt.ArrayLike] = None,
        transform: Optional[npt.ArrayLike] = None,
        background: float = 0.0,
        tolerance: float = 0.0,
        name: str = "density",
    ) -> MaskGrid: ...
    @property
    def transform(self) -> Doubles: ...
    @property
    def voxel_size(self) -> Tuple[float, float, float]: ...
    @property
    def metadata(self) -> Dict[str, Any]: ...
    @property
    def bounds(self) -> Optional[Tuple[Voxel, Voxel]]: ...
    @property
    def grid_class(self) -> str: ...
    @property
    def active_voxel_count(self) -> int: ...
    @property
    def memory_bytes(self) -> int: ...
    def to_array(self, bounds: Optional[Sequence[npt.ArrayLike]] = None) -> Tuple[npt.NDArray[np.bool_], Voxel]: ...
    def blocks(self) -> Iterator[Tuple[Voxel, npt.NDArray[np.bool_]]]: ...
    def copy(self) -> MaskGrid: ...
    def write(
        self,
        path: Path,
        *,
        half: bool = False,
        compression: str = "blosc",
        threads: int = 0,
        progress: Optional[Progress] = None,
    ) -> None: ...

class Mesh:
    def __init__(
        self,
        points: npt.ArrayLike,
        triangles: npt.ArrayLike,
        colors: Optional[npt.ArrayLike] = None,
    ) -> None: ...
    @staticmethod
    def read(path: Path) -> Mesh: ...
    @property
    def points(self) -> Doubles: ...
    @property
    def triangles(self) -> npt.NDArray[np.uint32]: ...
    @property
    def normals(self) -> Optional[Floats]: ...
    @property
    def colors(self) -> Optional[Floats]: ...
    @property
    def name(self) -> str: ...
    def write(self, path: Path) -> None: ...

class Reconstruction:
    def __init__(
        self, grid: Grid, *, tolerance: float = 1.5e-05, cache_bytes: int = 536870912
    ) -> None: ...
    def value(self, points: npt.ArrayLike) -> Doubles: ...
    def gradient(self, points: npt.ArrayLike) -> Doubles: ...
    def hessian(self, points: npt.ArrayLike) -> Doubles: ...

AnyGrid = TypeVar("AnyGrid", Grid, VectorGrid)

class Patches:
    def __init__(
        self, nets: Iterable[npt.ArrayLike], objects: Optional[Sequence[str]] = None
    ) -> None: ...
    @staticmethod
    def from_bspline(
        control: npt.ArrayLike, knots_u: Sequence[float], knots_v: Sequence[float]
    ) -> Patches: ...
    @staticmethod
    def read(path: Path) -> Patches: ...
    @property
    def nets(self) -> List[Doubles]: ...
    @property
    def objects(self) -> List[str]: ...
    @property
    def name(self) -> str: ...
    def position(self, patch: int, uv: npt.ArrayLike) -> Doubles: ...
    def normal(self, patch: int, uv: npt.ArrayLike) -> Doubles: ...
    def __len__(self) -> int: ...

class DrawnPath:
    @property
    def kind(self) -> str: ...
    @property
    def object(self) -> str: ...
    @property
    def hidden(self) -> int: ...
    @property
    def closed(self) -> bool: ...
    @property
    def points(self) -> Doubles: ...

class DrawnRegion:
    @property
    def object(self) -> str: ...
    @property
    def tone(self) -> int: ...
    @property
    def loops(self) -> List[Doubles]: ...

class Drawing:
    @property
    def page(self) -> Tuple[float, float]: ...
    @property
    def paths(self) -> List[DrawnPath]: ...
    @property
    def regions(self) -> List[DrawnRegion]: ...
    def svg(self) -> str: ...
    def save(self, path: Path) -> None: ...
    def _repr_svg_(self) -> str: ...

class Surface:
    def __call__(self, x: npt.ArrayLike, y: npt.ArrayLike, *, column: int = 0) -> Any: ...
    def gradient(self, x: npt.ArrayLike, y: npt.ArrayLike, *, column: int = 0) -> Doubles: ...
    def normals(self, x: npt.ArrayLike, y: npt.ArrayLike, *, column: int = 0) -> Doubles: ...
    def curvature(self, x: npt.ArrayLike, y: npt.ArrayLike, *, column: int = 0) -> Doubles: ...
    def sample(
        self, samples: int = 257, *, quantities: Sequence[str] = ["value"]
    ) -> Doubles: ...
    def patches(self) -> Patches: ...
    def mesh(self, samples: int = 257) -> Mesh: ...
    def save(
        self, path: Path, *, samples: int = 257, quantities: Sequence[str] = []
    ) -> None: ...
    def density(
        self,
        *,
        resolution: int = 256,
        voxel_size: float = 0.0,
        base: Optional[float] = None,
        cutoff: float = 0.16,
        order: float = 2.0,
        tolerance: float = 0.0001,
        threads: int = 0,
        progress: Optional[Progress] = None,
    ) -> Grid: ...
    def part(self, first: int, last: int) -> Surface: ...
    @property
    def levels(self) -> List[Dict[str, Any]]: ...
    @property
    def rectangle(self) -> Tuple[float, float, float, float]: ...
    @property
    def columns(self) -> int: ...
    @property
    def column_names(self) -> List[str]: ...
    @property
    def tension(self) -> float: ...

class Volume:
    def __call__(self, points: npt.ArrayLike, *, column: int = 0) -> Doubles: ...
    def covers(self, points: npt.ArrayLike) -> npt.NDArray[np.bool_]: ...
    def grid(
        self,
        *,
        name: str = "density",
        column: int = 0,
        columns: int = 1,
        quantity: str = "value",
        resolution: int = 256,
        voxel_size: float = 0.0,
        threads: int = 0,
        progress: Optional[Progress] = None,
    ) -> Any: ...
    def grids(
        self,
        *,
        resolution: int = 256,
        voxel_size: float = 0.0,
        threads: int = 0,
        progress: Optional[Progress] = None,
    ) -> List[Any]: ...
    @property
    def bounds(self) -> Tuple[Tuple[float, float, float], Tuple[float, float, float]]: ...
    @property
    def reach(self) -> float: ...
    @property
    def columns(self) -> int: ...
    @property
    def column_names(self) -> List[str]: ...
    @property
    def largest(self) -> float: ...

def bandlimit(
    source: Source,
    *,
    resolution: int = 256,
    voxel_size: float = 0.0,
    cutoff: float = 0.16,
    order: float = 2.0,
    tolerance: Optional[float] = None,
    tile: int = 0,
    clamp: bool = False,
    iso: Iso = 0.5,
    route: str = "auto",
    overlap: str = "union",
    oversample: Optional[int] = None,
    base: Optional[float] = None,
    bounds: Optional[npt.ArrayLike] = None,
    shard: Optional[Sequence[int]] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Grid: ...
def bandlimit_grid(
    grid: Union[Grid, MaskGrid],
    *,
    threshold: Union[float, Sequence[float], None] = None,
    resolution: int = 0,
    voxel_size: float = 0.0,
    factor: float = 0.0,
    onto: Union[Grid, VectorGrid, MaskGrid, None] = None,
    cutoff: float = 0.16,
    order: float = 2.0,
    tolerance: Optional[float] = None,
    tile: int = 0,
    clamp: bool = False,
    iso: Iso = 0.5,
    shard: Optional[Sequence[int]] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Grid: ...
def bandlimit_points(
    source: Union[Path, npt.ArrayLike],
    *,
    radius: Optional[npt.ArrayLike] = None,
    normals: Optional[npt.ArrayLike] = None,
    points: str = "auto",
    resolution: int = 256,
    voxel_size: float = 0.0,
    cutoff: float = 0.16,
    order: float = 2.0,
    tolerance: Optional[float] = None,
    tile: int = 0,
    clamp: bool = False,
    iso: Iso = 0.5,
    shard: Optional[Sequence[int]] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Grid: ...
def colors(
    source: Union[Path, Mesh, Surface],
    density: Grid,
    *,
    cutoff: float = 0.16,
    order: float = 2.0,
    tile: int = 0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> VectorGrid: ...
def compare(
    a: Union[Grid, Mesh, Path],
    b: Union[Grid, Mesh, Path],
    *,
    only: Optional[str] = None,
    iso: Optional[Iso] = None,
    distance_tolerance: float = 0.1,
    cuts: int = 1,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Dict[str, Any]: ...
def detail_levels(
    grid: AnyGrid,
    levels: int,
    *,
    cutoff: float = 0.16,
    order: float = 2.0,
    tolerance: float = 0.0001,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> List[AnyGrid]: ...
def fit(
    places: Union[Path, npt.ArrayLike],
    values: Optional[npt.ArrayLike] = None,
    *,
    columns: Sequence[str] = [],
    rectangle: Optional[Sequence[float]] = None,
    tolerance: Optional[float] = None,
    smooth: float = 0.0,
    max_level: Optional[int] = None,
    levels: Optional[Sequence[int]] = None,
    tension: Optional[float] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Surface: ...
def fit_volume(
    places: Union[Path, npt.ArrayLike],
    values: Optional[npt.ArrayLike] = None,
    *,
    columns: Sequence[str] = [],
    tolerance: Optional[float] = None,
    smooth: float = 0.0,
    max_level: Optional[int] = None,
    reach: Optional[float] = None,
    tension: float = 2.0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Volume: ...
def info(
    source: Union[Path, Grid, VectorGrid, MaskGrid, Mesh, Patches],
    *,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Dict[str, Any]: ...
def iso_of_volume(
    grid: Grid, volume: float, *, progress: Optional[Progress] = None
) -> Tuple[float, float]: ...
def join_shards(
    grids: Iterable[AnyGrid], *, threads: int = 0, progress: Optional[Progress] = None
) -> AnyGrid: ...
def merge(
    grids: Iterable[Union[Grid, MaskGrid]],
    *,
    operation: str = "union",
    weights: Sequence[float] = [],
    clamp: bool = False,
    resample: bool = False,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Grid: ...
def outline(
    source: Union[Path, Patches, Grid, MaskGrid, Sequence[Union[Path, Patches, Grid, MaskGrid]]],
    *,
    page: Union[Sequence[float], str] = [200.0, 150.0],
    margin: Optional[float] = None,
    tolerance: float = 0.01,
    crease_angle: Optional[float] = None,
    kinds: Sequence[str] = ["contour", "boundary", "crease", "intersection", "isophote", "suggestive"],
    hidden: bool = True,
    stroke: float = 0.35,
    stroke_color: str = "#000000",
    hidden_stroke: Optional[float] = None,
    hidden_color: Optional[str] = None,
    dash: Optional[str] = None,
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
    grid: Optional[str] = None,
    iso: Optional[Iso] = None,
    resolution: Optional[int] = None,
    voxel_size: Optional[float] = None,
    cutoff: Optional[float] = None,
    order: Optional[float] = None,
    isophotes: Sequence[float] = [],
    suggestive: Optional[float] = None,
    light: Optional[Sequence[float]] = None,
    fill: str = "none",
    tones: Optional[Sequence[float]] = None,
    fill_colors: Optional[Sequence[str]] = None,
    shade: Optional[float] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Drawing: ...
def read_array(
    path: Path,
    *,
    channel: str = "",
    series: str = "",
    spacing: Optional[npt.ArrayLike] = None,
    origin: Optional[npt.ArrayLike] = None,
    space: Optional[str] = None,
    background: float = 0.0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Grid: ...
def read_vdb(
    path: Path, *, threads: int = 0, progress: Optional[Progress] = None
) -> List[Any]: ...
def resample(
    grid: AnyGrid,
    *,
    resolution: int = 0,
    factor: float = 0.0,
    voxel_size: float = 0.0,
    onto: Union[Grid, VectorGrid, MaskGrid, None] = None,
    filter: bool = True,
    cutoff: float = 0.16,
    order: float = 2.0,
    tolerance: float = 0.0001,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> AnyGrid: ...
def shape_names() -> List[str]: ...
def thread_count() -> int: ...
def to_fog(
    grid: Grid,
    *,
    iso: Optional[Iso] = None,
    band: float = 3.0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Grid: ...
def to_level_set(
    grid: Grid,
    *,
    iso: Optional[Iso] = None,
    band: float = 3.0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Grid: ...
def to_mesh(
    grid: Grid,
    *,
    iso: Optional[Iso] = None,
    adaptivity: float = 0.0,
    tolerance: float = 0.001,
    colors: Optional[VectorGrid] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Mesh: ...
def view(
    path: Path,
    grid: Grid,
    *,
    title: Optional[str] = None,
    iso: Optional[float] = None,
    size: int = 160,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> None: ...
def voxelize(
    source: Union[Path, Mesh, Sequence[npt.ArrayLike], Field],
    *,
    resolution: int = 256,
    voxel_size: float = 0.0,
    threshold: int = 0,
    fraction: bool = False,
    axis: str = "x",
    backend: str = "auto",
    gpu_method: str = "bits",
    as_: str = "density",
    bounds: Optional[npt.ArrayLike] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Any: ...
def write_array(
    path: Path,
    grid: Union[Grid, MaskGrid],
    *,
    type: Optional[str] = None,
    range: Optional[Sequence[float]] = None,
    box: Optional[npt.ArrayLike] = None,
    compression: Optional[str] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> None: ...
def write_image(
    path: Path,
    image: npt.ArrayLike,
    channels: Optional[Dict[str, Floats]] = None,
    *,
    color: bool = True,
    metadata: Optional[Dict[str, Any]] = None,
    window: Optional[Sequence[int]] = None,
) -> None: ...
def write_vdb(
    path: Path,
    grids: Iterable[Union[Grid, VectorGrid, MaskGrid]],
    *,
    half: bool = False,
    compression: str = "blosc",
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> None: ...
def _render(
    scene: Dict[str, Any],
    picture: Dict[str, Any],
    threads: int,
    progress: Optional[Progress],
) -> Tuple[Floats, Dict[str, Floats], Dict[str, Any], Optional[Tuple[int, int, int, int]]]: ...
def _turntable(
    scene: Dict[str, Any],
    picture: Dict[str, Any],
    pictures: int,
    threads: int,
    progress: Optional[Progress],
) -> List[Dict[str, Any]]: ...
