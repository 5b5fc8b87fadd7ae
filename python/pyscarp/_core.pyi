# SPDX-License-Identifier: MIT
# The extension module: private to the package.
from typing import Any, Callable, Optional, Sequence

import numpy as np

_Progress = Optional[Callable[[float], Optional[bool]]]
_Six = Sequence[float]
_Rows = tuple[int, int]  # first, and the one after the last, from north

__version__: str
HAS_FILES: bool
HAS_SUN: bool
HIT_BYTES: int
HIT_OFFSETS: dict[str, int]

class Error(ValueError):
    """Error of the library: one line, ``SUBJECT: what is wrong (what to do)``."""

class Interrupted(Error):
    """A progress callback returned False."""

class SceneBase:
    def __init__(self, *args: Any, **kwargs: Any) -> None: ...
    def _cast(
        self,
        origins: np.ndarray,
        directions: np.ndarray,
        hits: np.ndarray,
        positions: Any,
        normals: Any,
        t_min: Any,
        t_max: Any,
        start: Any,
    ) -> None: ...
    def _cast_plain(self, origins: Any, directions: Any, hits: np.ndarray, positions: Any, normals: Any) -> bool: ...
    def _occluded(
        self, origins: np.ndarray, directions: np.ndarray, blocked: np.ndarray, t_min: Any, t_max: Any, start: Any
    ) -> None: ...
    def _occluded_plain(self, origins: Any, directions: Any, blocked: np.ndarray) -> bool: ...
    def _heights_at(self, xs: np.ndarray, ys: np.ndarray, out: np.ndarray) -> None: ...

class Terrain(SceneBase):
    def __init__(self, *args: Any, **kwargs: Any) -> None: ...
    @property
    def _array(self) -> Optional[np.ndarray]: ...
    @property
    def _heights(self) -> np.ndarray: ...
    @property
    def _settings(self) -> tuple[float, float, float, float, float, Optional[float], str, str, bool]: ...
    @property
    def _georeference(self) -> tuple[bool, list[float], str, float]: ...
    @property
    def _range(self) -> tuple[Optional[float], Optional[float]]: ...
    def _samples_changed(self, col: int, row: int, cols: int, rows: int) -> None: ...
    def _set_samples(self, col: int, row: int, samples: np.ndarray) -> None: ...

class Voxels(SceneBase):
    def __init__(self, indices: np.ndarray, side: float, palette: Sequence[Sequence[int]]) -> None: ...
    @property
    def _size(self) -> tuple[int, int, int]: ...
    @property
    def _solid_count(self) -> int: ...
    def _indices(self) -> np.ndarray: ...
    def _fill_box(self, low: Sequence[int], high: Sequence[int], entry: int) -> None: ...
    def _fill_sphere(self, centre: Sequence[float], radius: float, entry: int) -> None: ...
    def _set(self, positions: np.ndarray, entries: np.ndarray) -> None: ...

class Scene(SceneBase):
    def __init__(self, parts: Sequence[tuple[Any, Sequence[float], float, Sequence[float]]]) -> None: ...

def set_threads(threads: int) -> None:
    """Limits the threads of all calls that start afterwards; 0: all. Raises Error below 0."""

def metres_per_vertical_unit(name: str) -> Optional[float]: ...
def all_hits(
    terrain: Terrain, origins: np.ndarray, directions: np.ndarray, t_min: Any, t_max: Any
) -> tuple[np.ndarray, np.ndarray]: ...
def cast_from_camera(
    terrain: Terrain,
    eye: Sequence[float],
    forward: Sequence[float],
    up: Sequence[float],
    columns: int,
    rows: int,
    tan_half_width: float,
    t_min: float,
    t_max: float,
    normals: bool,
) -> list[np.ndarray]: ...
def cast_from_scanner(
    terrain: Terrain,
    eye: Sequence[float],
    elevations: Sequence[float],
    columns: int,
    first_azimuth: float,
    azimuth_step: float,
    t_min: float,
    t_max: float,
    normals: bool,
) -> list[np.ndarray]: ...
def row_band(rows: int, part: int, parts: int) -> _Rows: ...
def viewshed(
    terrain: Terrain,
    observers: Sequence[Sequence[Any]],
    target_height: float,
    coefficient: float,
    diameter: float,
    min_distance: float,
    max_distance: float,
    low_pitch: float,
    high_pitch: float,
    mode: str,
    rows: _Rows,
    progress: _Progress,
) -> np.ndarray: ...
def line_of_sight(terrain: Terrain, *line: Any) -> tuple[bool, Any, float, float, float, float, float]: ...
def profile(terrain: Terrain, *line: Any) -> np.ndarray: ...
def shadow(
    terrain: Terrain, azimuth: float, altitude: float, fraction: bool, rows: _Rows, progress: _Progress
) -> np.ndarray: ...
def local_shadow(
    terrain: Terrain,
    time: Optional[str],
    refraction: bool,
    azimuth: float,
    altitude: float,
    fraction: bool,
    rows: _Rows,
    progress: _Progress,
) -> np.ndarray: ...
def horizon(
    terrain: Terrain,
    azimuths: Sequence[float],
    eye_height: float,
    max_distance: float,
    coefficient: float,
    diameter: float,
    engine: str,
    distances: bool,
    rows: _Rows,
    progress: _Progress,
) -> tuple[np.ndarray, Any]: ...
def horizon_at(
    terrain: Terrain,
    col: float,
    row: float,
    azimuths: Sequence[float],
    eye_height: float,
    max_distance: float,
    coefficient: float,
    diameter: float,
    cell_x: float,
    cell_y: float,
) -> Optional[np.ndarray]: ...
def sky_view(
    terrain: Terrain,
    measures: Sequence[str],
    azimuths: int,
    eye_height: float,
    max_distance: float,
    coefficient: float,
    diameter: float,
    engine: str,
    rows: _Rows,
    progress: _Progress,
) -> list[np.ndarray]: ...
def sun_hours(
    terrain: Terrain,
    moments: Sequence[tuple[float, float, float, float]],
    eye_height: float,
    max_distance: float,
    coefficient: float,
    diameter: float,
    engine: str,
    sky: Optional[tuple[float, float, Optional[float]]],
    rows: _Rows,
    progress: _Progress,
) -> list[np.ndarray]: ...
def sun_masks(
    terrain: Terrain,
    moments: Sequence[tuple[float, float, float, float]],
    eye_height: float,
    max_distance: float,
    coefficient: float,
    diameter: float,
    engine: str,
    rows: _Rows,
    progress: _Progress,
) -> np.ndarray: ...
def sun_positions(
    times: Sequence[str], longitude: float, latitude: float, height: float, refraction: bool
) -> list[tuple[float, float]]: ...
def render(
    scene: SceneBase,
    size: Sequence[int],
    look: str,
    aa: int,
    sun: Sequence[float],
    view: Sequence[float],
    distance: float,
    fov: float,
    top: bool,
    eye: Optional[Sequence[float]],
    target: Optional[Sequence[float]],
    shadows: bool,
    unlit: bool,
    haze: float,
    samples: int,
    ao_distance: float,
    ramp: str,
    sky: str,
    alpha: bool,
    grid_north: float,
    progress: _Progress,
) -> np.ndarray: ...
def wkt_of(text: str) -> str: ...
def ground_plane(
    map_from_node: _Six, crs: str, cols: int, rows: int, col: float, row: float, reach: float
) -> tuple[float, float, float, float]: ...
def line_plane(
    map_from_node: _Six,
    crs: str,
    cols: int,
    rows: int,
    from_node: tuple[float, float],
    to_node: tuple[float, float],
) -> tuple[float, float, float, float]: ...
def crs_of(crs: str) -> tuple[bool, float, bool, float, float]: ...
def lonlat(
    map_from_node: _Six, crs: str, cols: int, rows: int, col: float, row: float
) -> Optional[tuple[float, float]]: ...
def node_of_lonlat(
    map_from_node: _Six, crs: str, cols: int, rows: int, longitude: float, latitude: float
) -> Optional[tuple[float, float]]: ...
