# SPDX-License-Identifier: MIT
"""Where a raster is: coordinates, CRS, units and holes of arrays and of xarray's DataArray."""

from __future__ import annotations

import dataclasses
import math
from typing import Any, Optional, Sequence

import numpy as np

from . import _core
from ._arguments import shown
from ._core import Error

_X_NAMES = {"x", "lon", "longitude", "easting", "eastings", "projection_x_coordinate"}
_Y_NAMES = {"y", "lat", "latitude", "northing", "northings", "projection_y_coordinate"}
_DEGREES = {"lon", "longitude", "lat", "latitude"}
# Units of coordinates, as the CF conventions have them.
_DEGREE_UNITS = {
    f"degree{several}{axis}" for several in ("", "s") for axis in ("", "_east", "_e", "e", "_north", "_n", "n")
}
#: Relative difference of lengths of one unit: that of the two US feet is 2e-6, other units differ by far more.
_SAME_UNIT = 1e-5
#: Coordinates may be off their even spacing by this share of a step: the accuracy of hits is the same.
_UNEVEN = 1e-3


@dataclasses.dataclass
class Source:
    """An array of heights and what is known of it."""

    heights: Any
    map_from_node: Optional[tuple[float, ...]] = None  # rows from north
    south_up: bool = False
    crs: str = ""
    nodata: Optional[float] = None
    scale: float = 1.0
    offset: float = 0.0
    unit: str = ""
    coordinate_units: tuple[str, ...] = ()  # lower case
    template: Any = None  # the DataArray


def crs_text(crs: Any) -> str:
    """Returns WKT, or the text itself in a build without GDAL."""
    if crs is None:
        return ""
    if isinstance(crs, int):
        crs = f"EPSG:{crs}"
    for method in ("to_wkt", "ExportToWkt"):
        if hasattr(crs, method):
            crs = getattr(crs, method)()
    if not isinstance(crs, str):
        raise TypeError(
            f"crs: {type(crs).__name__} is not a CRS (expected text such as EPSG:32610, or an object of "
            "rasterio or pyproj)"
        )
    if not (crs and _core.HAS_FILES):
        return crs
    try:
        return _core.wkt_of(crs)
    except Error:
        raise Error(f"crs: {shown(crs)} is unknown (expected EPSG:32610, WKT or PROJ text)") from None


def node_transform(transform: Any) -> tuple[float, ...]:
    """Returns x0, dx, 0, y0, 0, dy of the first sample from an affine transform of pixel corners, as rasterio's."""
    try:
        a, b, c, d, e, f = (float(v) for v in tuple(transform)[:6])
    except (TypeError, ValueError):
        raise TypeError(
            "transform: expected six numbers (a, b, c, d, e, f) of pixel corners, as rasterio's Affine"
        ) from None
    if b != 0 or d != 0:
        raise Error("transform: the raster is rotated (first: gdalwarp, or rio.reproject)")
    if not (a > 0 and e != 0 and all(map(math.isfinite, (a, c, e, f)))):
        raise Error(f"transform: expected a step east above 0 and a step along rows, found {a} and {e}")
    return (c + a / 2, a, 0.0, f + e / 2, 0.0, e)


def rows_from_north(map_from_node: Sequence[float], rows: int) -> tuple[tuple[float, ...], bool]:
    """Returns the transform with rows from north, and whether the rows were from south."""
    x0, dx, _, y0, _, dy = map_from_node
    return ((x0, dx, 0.0, y0, 0.0, dy), False) if dy < 0 else ((x0, dx, 0.0, y0 + (rows - 1) * dy, 0.0, -dy), True)


def metres_per_unit(unit: str) -> float:
    """Returns the length of a vertical unit; metres are the default."""
    metres = _core.metres_per_vertical_unit(unit) if unit else 1.0
    if metres is None:
        raise Error(f"unit: {shown(unit)} is not a unit of heights (give unit='m' or 'ft')")
    return metres


def require_units(source: Source, body: Body) -> None:
    """Throws Error unless the coordinates are in the unit of the CRS, as far as they say."""
    for unit in source.coordinate_units:
        metres = None if unit in _DEGREE_UNITS else _core.metres_per_vertical_unit(unit)
        if body.geographic:
            same = unit in _DEGREE_UNITS
        else:
            same = metres is not None and abs(metres - body.map_unit) <= _SAME_UNIT * body.map_unit
        if not same:
            metric = "metres" if body.map_unit == 1 else f"units of {body.map_unit:.10g} m"
            has = "degrees" if body.geographic else metric
            raise Error(
                f"heights: coordinates in {unit}, but their CRS has {has} (convert the coordinates, or correct their "
                "units or the CRS)"
            )


def require_lengths(source: Source) -> None:
    """Throws Error if nothing says how far apart samples are."""
    if source.map_from_node is None:
        said = "a CRS does not say it (give transform, or" if source.crs else "(give"
        raise Error(
            f"cell: the distance between samples is unknown{': ' if source.crs else ' '}{said} cell=30 in metres"
            f"{')' if source.crs else ', or transform and crs)'}"
        )
    if source.crs:
        return
    for unit in source.coordinate_units:
        if unit in _DEGREE_UNITS or _core.metres_per_vertical_unit(unit) != 1:
            raise Error(f"heights: coordinates in {unit} without a CRS (give crs, or convert them to metres)")
    if not source.coordinate_units:
        raise Error(
            "cell: the unit of the transform or coordinates is unknown without a CRS (give crs, or cell=30 in metres)"
        )


def is_dataarray(value: Any) -> bool:
    """Whether a value is a DataArray, without importing xarray."""
    return (
        type(value).__module__.partition(".")[0] == "xarray" and hasattr(value, "dims") and hasattr(value, "variable")
    )


def source_of(value: Any) -> Source:
    """Reads what an array says of itself."""
    return _of_dataarray(value) if is_dataarray(value) else Source(value)


def _of_dataarray(data: Any) -> Source:
    while data.ndim > 2 and data.shape[0] == 1:
        data = data[0]
    if data.ndim != 2:
        raise Error(f"heights: the DataArray has the dimensions {data.dims} (expected two; select one band)")
    y, x = data.dims
    if str(y).lower() in _X_NAMES or str(x).lower() in _Y_NAMES:
        raise Error(f"heights: the dimensions are {data.dims}, rows first (use .transpose('{x}', '{y}').copy())")
    source = Source(data.data, template=data)
    attrs = data.attrs
    source.map_from_node = _map_from_coordinates(data, x, y)
    if source.map_from_node:
        source.map_from_node, source.south_up = rows_from_north(source.map_from_node, data.shape[0])
    source.crs = crs_text(_crs_of(data))
    units = {str(data.coords[c].attrs.get("units", "")).lower() for c in (x, y) if c in data.coords} - {""}
    source.coordinate_units = tuple(sorted(units))
    if not source.crs and ({str(x).lower(), str(y).lower()} <= _DEGREES or (units and units <= _DEGREE_UNITS)):
        source.crs = crs_text("EPSG:4326")
    for name in ("_FillValue", "missing_value", "nodata"):
        if attrs.get(name) is not None:
            source.nodata = float(np.asarray(attrs[name]).reshape(-1)[0])
            break
    source.scale = float(attrs.get("scale_factor", 1))
    source.offset = float(attrs.get("add_offset", 0))
    source.unit = str(attrs.get("units", "") or "")
    return source


def _map_from_coordinates(data: Any, x: Any, y: Any) -> Optional[tuple[float, ...]]:
    mapping = _grid_mapping(data)
    transform = mapping.get("GeoTransform") if mapping else None
    if isinstance(transform, str):
        c, a, b, f, d, e = (float(v) for v in transform.split())
        stored = node_transform((a, b, c, d, e, f))
    else:
        stored = None
    steps: list[tuple[float, float]] = []
    for name, fallback in ((x, stored[1] if stored else None), (y, stored[5] if stored else None)):
        if name not in data.coords or data.coords[name].ndim != 1:
            return stored
        values = np.asarray(data.coords[name].values, float)
        if len(values) == 1:
            if fallback is None:
                return None
            steps.append((values[0], fallback))
            continue
        step = (values[-1] - values[0]) / (len(values) - 1)
        even = values[0] + step * np.arange(len(values))
        # Coordinates in float32 are rounded.
        kind = data.coords[name].dtype
        rounding = np.finfo(kind).eps * np.abs(values).max() if kind.kind == "f" else 0
        if not (math.isfinite(step) and step != 0 and np.abs(values - even).max() <= _UNEVEN * abs(step) + rounding):
            raise Error(f"heights: the coordinates of '{name}' are not evenly spaced (interpolate the DataArray first)")
        steps.append((values[0], step))
    if steps[0][1] < 0:
        raise Error(f"heights: '{x}' decreases (use .sortby('{x}').copy())")
    return (steps[0][0], steps[0][1], 0.0, steps[1][0], 0.0, steps[1][1])


def _grid_mapping(data: Any) -> Optional[dict[str, Any]]:
    name = data.encoding.get("grid_mapping") or data.attrs.get("grid_mapping") or "spatial_ref"
    return dict(data.coords[name].attrs) if name in data.coords else None


def _crs_of(data: Any) -> Any:
    mapping = _grid_mapping(data) or {}
    for text in (mapping.get("crs_wkt"), mapping.get("spatial_ref"), data.attrs.get("crs")):
        if text is not None and text != "":
            return text
    return None


@dataclasses.dataclass
class Ground:
    """Lengths on the ground of the steps between samples, around one of them."""

    cell: tuple[float, float]  # metres east and north
    grid_north: float = 0.0  # azimuth of decreasing rows, radians
    error_cells: float = 0.0


@dataclasses.dataclass
class Body:
    """The body that a CRS refers to."""

    geographic: bool = False
    diameter: float = 2 * 6378137.0
    earth: bool = True
    map_unit: float = 1.0  # metres; of a CRS that is not geographic
    vertical_unit: float = 0.0  # metres; 0: no vertical CRS


def body_of(crs: str) -> Body:
    """Returns the body of a CRS; the Earth without one."""
    if not crs:
        return Body()
    if _core.HAS_FILES:
        return Body(*_core.crs_of(crs))
    try:
        found = _pyproj_crs(crs)
    except ImportError:
        return Body()  # cells were given
    ellipsoid = found.ellipsoid
    axis = ellipsoid.semi_major_metre if ellipsoid else 6378137.0
    parts = found.sub_crs_list if found.is_compound else [found]
    map_unit = 1.0 if found.is_geographic else _unit_of(parts[0])
    vertical = next((_unit_of(part) for part in parts if part.is_vertical), 0.0)
    return Body(found.is_geographic, 2 * axis, abs(axis / 6378137.0 - 1) <= 0.05, map_unit, vertical)


def _unit_of(crs: Any) -> float:
    """Metres per unit of the first axis."""
    return float(crs.axis_info[0].unit_conversion_factor) if crs.axis_info else 1.0


def ground_at(
    map_from_node: Sequence[float], crs: str, shape: tuple[int, int], col: float, row: float, reach: float = 0.0
) -> Ground:
    """Returns the lengths around a sample. `reach`: metres within which `error_cells` counts."""
    if not crs:
        return Ground((map_from_node[1], -map_from_node[5]))
    rows, cols = shape
    if _core.HAS_FILES:
        cell_x, cell_y, north, error = _core.ground_plane(tuple(map_from_node), crs, cols, rows, col, row, reach)
        return Ground((cell_x, cell_y), north, error)
    return _ground_by_pyproj(map_from_node, crs, col, row)


def ground_along(
    map_from_node: Sequence[float],
    crs: str,
    shape: tuple[int, int],
    from_node: tuple[float, float],
    to_node: tuple[float, float],
) -> Ground:
    """Returns the lengths along a line: with them it has its geodesic length, as far as this build has PROJ."""
    if crs and _core.HAS_FILES:
        cell_x, cell_y, north, error = _core.line_plane(
            tuple(map_from_node), crs, shape[1], shape[0], from_node, to_node
        )
        return Ground((cell_x, cell_y), north, error)
    col, row = (from_node[0] + to_node[0]) / 2, (from_node[1] + to_node[1]) / 2
    return ground_at(map_from_node, crs, shape, col, row)


def lonlat_of(
    map_from_node: Sequence[float], crs: str, shape: tuple[int, int], col: float, row: float
) -> Optional[tuple[float, float]]:
    """Returns longitude and latitude of a sample in degrees, WGS 84."""
    if _core.HAS_FILES:
        return _core.lonlat(tuple(map_from_node), crs, shape[1], shape[0], col, row)
    transform = _transformer(crs, "EPSG:4326")
    return transform.transform(*_map_position(map_from_node, col, row))


def node_of_lonlat(
    map_from_node: Sequence[float], crs: str, shape: tuple[int, int], longitude: float, latitude: float
) -> Optional[tuple[float, float]]:
    """Returns column and row of a place in degrees, WGS 84."""
    if _core.HAS_FILES:
        return _core.node_of_lonlat(tuple(map_from_node), crs, shape[1], shape[0], longitude, latitude)
    transform = _transformer("EPSG:4326", crs)
    x, y = transform.transform(longitude, latitude)
    col, row = (x - map_from_node[0]) / map_from_node[1], (y - map_from_node[3]) / map_from_node[5]
    return (col, row) if math.isfinite(col) and math.isfinite(row) else None


def _map_position(m: Sequence[float], col: float, row: float) -> tuple[float, float]:
    return m[0] + col * m[1], m[3] + row * m[5]


class _NoPyproj(Error, ImportError):
    """pyproj is not installed, and this build has no PROJ."""


def _pyproj_crs(crs: str) -> Any:
    try:
        import pyproj
    except ImportError:
        raise _NoPyproj(
            "crs: this build needs pyproj for coordinate systems (install it; or give cell=(east, north) in metres, "
            "and no places or times that depend on the CRS)"
        ) from None
    try:
        return pyproj.CRS.from_user_input(crs)
    except pyproj.exceptions.CRSError as error:
        raise Error(f"crs: {str(error).splitlines()[0]} (expected EPSG:32610, WKT or PROJ text)") from None


def _transformer(source: str, target: str) -> Any:
    ends = _pyproj_crs(source), _pyproj_crs(target)
    import pyproj

    return pyproj.Transformer.from_crs(*ends, always_xy=True)


def _ground_by_pyproj(m: Sequence[float], crs: str, col: float, row: float) -> Ground:
    """Central differences of geodesic distances, one cell wide."""
    found = _pyproj_crs(crs)
    transform = _transformer(crs, found.geodetic_crs.to_wkt())
    geod = found.get_geod()

    def step(cols: float, rows: float) -> tuple[float, float]:
        ends = [
            transform.transform(*_map_position(m, col + sign * cols / 2, row + sign * rows / 2)) for sign in (-1, 1)
        ]
        azimuth, _, distance = geod.inv(*ends[0], *ends[1])
        if not math.isfinite(distance) or distance <= 0:
            raise Error("crs: the raster is outside the domain of its CRS (check crs and coordinates)")
        return distance, math.radians(azimuth)

    north, azimuth = step(0, -1)
    return Ground((step(1, 0)[0], north), azimuth)
