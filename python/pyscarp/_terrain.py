# SPDX-License-Identifier: MIT
"""Terrain: heights of an array or a file, ready for rays and maps."""

from __future__ import annotations

import dataclasses
import math
import os
from typing import TYPE_CHECKING, Any, Optional, Sequence, Union

import numpy as np

from . import _core, _georeference as geo
from ._arguments import array_of_numbers, converted, flag, number, numbers, optional, refuse_unused, shown, text, whole
from ._core import Error
from ._hits import AllHits, FanHits
from ._instruments import Camera, Scanner
from ._rays import Rays, batch, limit

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class Terrain(Rays, _core.Terrain):
    """A height field over an array, without a copy.

    Args:
        heights: float32, int16 or uint16, ``(rows, cols)``: a NumPy array or an xarray DataArray. Rows may be strided;
            the samples of a row are next to one another. The terrain keeps the array alive, and reads it: after a
            change of its values call `samples_changed`. NaN is a hole.
        cell: metres between samples: one number, or east and north. Default: from coordinates and CRS; without a CRS,
            coordinates that say that they are in metres.
        crs: text such as ``EPSG:32610``, WKT, or an object of rasterio or pyproj. Default: the DataArray's.
        nodata: value of holes. Default: the DataArray's ``_FillValue``.
        transform: ``(a, b, c, d, e, f)``, from pixel corners to the map, as rasterio's ``Affine``. Default: from the
            DataArray's coordinates.
        scale, offset: metres = (value * scale + offset) in ``unit``. Default: the DataArray's, else 1 and 0.
        unit: of heights: ``m`` or ``ft``, ``us-ft``, ``km``, ``cm``, ... Default: the DataArray's ``units``, else that
            of the vertical CRS, else metres.
        exaggeration: factor of all heights, above 0.
        surface: ``bilinear`` between samples, or ``triangles``.
        wrap: ``none``, ``periodic`` or ``shared_border``: the field repeats.
        solid: whether borders and rims of holes have walls.
        south_up: whether the first row is the southernmost. Default: from coordinates, else False.
        grid_north: azimuth of decreasing rows in degrees from true north. Default: from the CRS, else 0.
        plane_error: maps are computed on planes in metres: the most cells by which they may misplace samples.
        copy: read a copy instead of the array itself: arrays of other types (float64 becomes float32) and layouts.

    Raises:
        TypeError: another type of samples, with the remedy.
        Error: another shape or layout; coordinates that are not evenly spaced, or in another unit than their CRS; no
            ``cell`` and no transform with a CRS; an infinite sample.

    >>> terrain = Terrain(np.array([[0, 1], [2, 3]], np.float32), cell=30)
    >>> terrain.shape, terrain.cell, terrain.range
    ((2, 2), (30.0, 30.0), (0.0, 3.0))
    """

    def __init__(
        self,
        heights: Any,
        cell: Union[None, float, Sequence[float]] = None,
        crs: Any = None,
        nodata: Optional[float] = None,
        *,
        transform: Optional[Sequence[float]] = None,
        scale: Optional[float] = None,
        offset: Optional[float] = None,
        unit: Optional[str] = None,
        exaggeration: float = 1.0,
        surface: str = "bilinear",
        wrap: str = "none",
        solid: bool = False,
        south_up: Optional[bool] = None,
        grid_north: Optional[float] = None,
        plane_error: float = 0.5,
        copy: bool = False,
    ) -> None:
        source = geo.source_of(heights)
        nodata = source.nodata if nodata is None else number(nodata, "nodata")
        array, hole = _samples(source.heights, nodata, flag(copy, "copy"))
        if transform is not None:
            source.map_from_node, source.south_up = geo.rows_from_north(geo.node_transform(transform), array.shape[0])
            source.coordinate_units = ()
        if crs is not None:
            source.crs = geo.crs_text(crs)
        if south_up is not None:
            if source.map_from_node is not None and flag(south_up, "south_up") != source.south_up:
                raise Error(f"south_up: {south_up} contradicts the coordinates (leave it out)")
            source.south_up = flag(south_up, "south_up")
        body = geo.body_of(source.crs)
        if cell is not None or not source.crs:
            refuse_unused(Terrain.__init__, "on cells of given lengths", plane_error=plane_error)
        else:
            geo.require_units(source, body)
        size, north = _cells(source, array.shape, cell)
        self._template = source.template
        self._known_body = body
        self._south_up = source.south_up
        self._plane_error = number(plane_error, "plane_error")
        self._cell_given = cell is not None
        self._north_given = grid_north is not None
        factor = _metres_per_sample_unit(source, body, unit)
        super().__init__(
            array,
            source.south_up,
            size[0],
            size[1],
            factor * (source.scale if scale is None else number(scale, "scale")),
            factor * (source.offset if offset is None else number(offset, "offset")),
            number(exaggeration, "exaggeration"),
            hole,
            text(surface, "surface"),
            text(wrap, "wrap"),
            flag(solid, "solid"),
            source.map_from_node,
            source.crs,
            north if grid_north is None else math.radians(number(grid_north, "grid_north")),
        )
        self._token = object()  # last: __repr__() of an object that was not built must not read it

    @classmethod
    def open(
        cls,
        path: Union[str, "os.PathLike[str]"],
        *,
        band: int = 0,
        nodata: Optional[float] = None,
        crs: Any = "",
        unit: str = "",
        window: Optional[tuple[int, int, int, int]] = None,
        exaggeration: float = 1.0,
        surface: str = "bilinear",
        wrap: str = "none",
        solid: bool = False,
        plane_error: float = 0.5,
    ) -> "Terrain":
        """Reads an elevation model in any format of the command line (GeoTIFF, .hgt, .npy, a folder of tiles, ...).

        Args:
            band: counts from 1; 0: the only one.
            window: column, row, columns and rows to read.
            nodata, crs, unit: replace those of the file; others as for `Terrain`.

        Raises:
            Error: naming the file, if it is missing, damaged, rotated or not a raster; or a build without GDAL.
        """
        if not isinstance(path, (str, os.PathLike)):
            raise TypeError(f"path: {shown(path)} is not a path (pass arrays to Terrain itself)")
        if not _core.HAS_FILES:
            raise Error(
                f"{os.fspath(path)}: this build of pyscarp reads no files (open it with rasterio or rioxarray, and "
                "pass the array to Terrain)"
            )
        self = cls.__new__(cls)
        self._template = None
        self._south_up = False
        self._plane_error = number(plane_error, "plane_error")
        self._cell_given = self._north_given = False
        _core.Terrain.__init__(
            self,
            os.fsdecode(path),
            whole(band, "band"),
            optional(number, nodata, "nodata"),
            geo.crs_text(crs),
            text(unit, "unit"),
            None if window is None else [whole(v, "window") for v in numbers(window, 4, "window", _WINDOW)],
            number(exaggeration, "exaggeration"),
            text(surface, "surface"),
            text(wrap, "wrap"),
            flag(solid, "solid"),
        )
        self._token = object()
        return self

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of samples."""
        rows, cols = self._heights.shape
        return rows, cols

    @property
    def cell(self) -> tuple[float, float]:
        """Metres between columns and between rows."""
        return self._settings[:2]

    @property
    def heights(self) -> np.ndarray:
        """The samples, rows from north: a read-only view of the array, without a copy."""
        return self._heights

    @property
    def range(self) -> tuple[Optional[float], Optional[float]]:
        """Lowest and highest height in metres; None if all samples are holes."""
        return self._range

    @property
    def transform(self) -> Optional[tuple[float, ...]]:
        """``(a, b, c, d, e, f)`` of pixel corners, rows from north, as rasterio's ``Affine``; None if unknown."""
        present, (x0, dx, _, y0, _, dy), _, _ = self._georeference
        return (dx, 0.0, x0 - dx / 2, 0.0, dy, y0 - dy / 2) if present else None

    @property
    def crs(self) -> str:
        """The CRS as WKT, or as it was given; empty if unknown."""
        return self._georeference[2]

    @property
    def grid_north(self) -> float:
        """Azimuth of decreasing rows at the centre, degrees clockwise from true north."""
        return math.degrees(self._georeference[3])

    # Positions.

    def to_local(self, x: "ArrayLike", y: "ArrayLike") -> tuple[np.ndarray, np.ndarray]:
        """Converts map coordinates to metres east and north of the south-west sample, as rays have them.

        Raises:
            Error: the terrain has no coordinates.

        >>> terrain = Terrain(np.zeros((2, 2), np.float32), cell=10, transform=(10, 0, 500, 0, -10, 820))
        >>> [float(v) for v in terrain.to_local(505, 805)]
        [0.0, 0.0]
        """
        x0, dx, y0, dy = self._map()
        col, row = (np.asarray(x, float) - x0) / dx, (np.asarray(y, float) - y0) / dy
        return col * self.cell[0], (self.shape[0] - 1 - row) * self.cell[1]

    def to_map(self, x: "ArrayLike", y: "ArrayLike") -> tuple[np.ndarray, np.ndarray]:
        """Converts metres east and north of the south-west sample to map coordinates; the reverse of `to_local`."""
        x0, dx, y0, dy = self._map()
        col, row = np.asarray(x, float) / self.cell[0], self.shape[0] - 1 - np.asarray(y, float) / self.cell[1]
        return x0 + col * dx, y0 + row * dy

    def _map(self) -> tuple[float, float, float, float]:
        present, (x0, dx, _, y0, _, dy), _, _ = self._georeference
        if not present:
            raise Error(
                "coordinates: the terrain has no map coordinates (give transform, or use metres: coords='local')"
            )
        return x0, dx, y0, dy

    def _coords(self, coords: Optional[str]) -> str:
        """The kind of coordinates of places: ``map``, ``local`` or ``lonlat``."""
        if coords is not None and text(coords, "coords") not in ("map", "local", "lonlat"):
            raise Error(f"coords: unknown name '{coords}' (expected one of: map, local, lonlat)")
        if coords == "lonlat" and not self.crs:
            raise Error("coords: longitude and latitude need a CRS (give crs, or use coords='local')")
        return coords or ("map" if self._georeference[0] else "local")

    def _node(self, x: float, y: float, coords: Optional[str]) -> tuple[float, float]:
        """Column and row of a place."""
        kind = self._coords(coords)
        x, y = float(x), float(y)
        if not (math.isfinite(x) and math.isfinite(y)):
            raise Error(f"place {x}, {y}: is not finite")
        if kind == "local":
            return x / self.cell[0], self.shape[0] - 1 - y / self.cell[1]
        x0, dx, y0, dy = self._map()
        if kind == "map":
            return (x - x0) / dx, (y - y0) / dy
        node = geo.node_of_lonlat(self._georeference[1], self.crs, self.shape, x, y)
        if node is None:
            raise Error(f"place {x}, {y}: is outside the domain of the CRS (expected longitude, latitude in degrees)")
        return node

    def _place(self, col: np.ndarray, row: np.ndarray, coords: Optional[str]) -> tuple[np.ndarray, np.ndarray]:
        """The reverse of `_node`."""
        kind = self._coords(coords)
        if kind == "local":
            return col * self.cell[0], (self.shape[0] - 1 - row) * self.cell[1]
        x0, dx, y0, dy = self._map()
        if kind == "map":
            return x0 + col * dx, y0 + row * dy
        m, crs = self._georeference[1:3]
        places = [geo.lonlat_of(m, crs, self.shape, c, r) or (math.nan, math.nan) for c, r in zip(col, row)]
        return np.array([p[0] for p in places]), np.array([p[1] for p in places])

    def _ground(self, col: float, row: float, reach: float) -> geo.Ground:
        """The plane for maps around a sample, with scale and north there."""
        present, map_from_node, crs, north = self._georeference
        if self._cell_given or not (present and crs):
            return geo.Ground(self.cell, north)
        return self._checked(geo.ground_at(map_from_node, crs, self.shape, col, row, reach))

    def _ground_along(self, start: tuple[float, float], end: tuple[float, float]) -> geo.Ground:
        """The plane for a line between two samples."""
        present, map_from_node, crs, north = self._georeference
        if self._cell_given or not (present and crs):
            return geo.Ground(self.cell, north)
        return self._checked(geo.ground_along(map_from_node, crs, self.shape, start, end))

    def _checked(self, ground: geo.Ground) -> geo.Ground:
        if self._north_given:
            ground = dataclasses.replace(ground, grid_north=self._georeference[3])
        if ground.error_cells > self._plane_error:
            raise Error(
                f"samples are up to {ground.error_cells:.2g} cells off the metric plane, limit {self._plane_error} "
                "(first: reproject, for example with rio.reproject; or set max_distance; or raise plane_error of "
                "Terrain)"
            )
        return ground

    @property
    def _body(self) -> geo.Body:
        if "_known_body" not in self.__dict__:
            self.__dict__["_known_body"] = geo.body_of(self.crs)
        return self.__dict__["_known_body"]

    # Queries.

    def all_hits(
        self, origins: "ArrayLike", directions: "ArrayLike", *, t_min: Any = None, t_max: Any = None
    ) -> AllHits:
        """Finds all hits along each ray: where it passes from above to on or below the surface.

        Arguments and errors as in `cast`. Returns the hits of all rays in one array, ``(hits,)``.

        >>> ridges = Terrain(np.tile(np.array([0, 9, 0, 9, 0], np.float32), (2, 1)), cell=10)
        >>> hits = ridges.all_hits([0, 5, 4], [1, 0, 0])
        >>> hits.first.tolist(), hits.position[:, 0].round(3).tolist()
        ([0, 2], [4.444, 24.444])
        """
        a, b, shape = batch(origins, directions)
        raw, first = _core.all_hits(self, a, b, limit(t_min, shape, "t_min"), limit(t_max, shape, "t_max"))
        return AllHits(raw, first, a, b)

    def cast_from(self, instrument: Union[Camera, Scanner], *, normal: bool = False) -> FanHits:
        """Traces all rays of a camera or a scanner; faster than `cast`, because rays of one eye share their way.

        ``t`` is a float32. Rays hit the same cells as in `cast`.

        Raises:
            Error: an eye or a setting that is not finite or out of range.

        >>> terrain = Terrain(np.zeros((3, 3), np.float32), cell=10)
        >>> scan = terrain.cast_from(Scanner((10, 10, 1), elevations=[-45, 45], columns=4))
        >>> scan.hit.tolist(), round(float(scan.t[0, 0]), 3)
        ([[True, True, True, True], [False, False, False, False]], 1.414)
        """
        i = instrument
        if not isinstance(i, (Camera, Scanner)):
            raise TypeError(f"cast_from: {type(i).__name__} is not a Camera or Scanner")
        vector = "x, y and z"
        eye, columns = numbers(i.eye, 3, "eye", vector), whole(i.columns, "columns", 1)
        t_min, t_max, normal = number(i.t_min, "t_min"), number(i.t_max, "t_max"), flag(normal, "normal")
        if isinstance(i, Camera):
            fov = number(i.fov, "fov")
            tan = math.tan(math.radians(fov) / 2) if 0 < fov < 180 else math.nan
            forward, up = numbers(i.forward, 3, "forward", vector), numbers(i.up, 3, "up", vector)
            rows = whole(i.rows, "rows", 1)
            arrays = _core.cast_from_camera(self, eye, forward, up, columns, rows, tan, t_min, t_max, normal)
        else:
            optional(number, i.azimuth_step, "azimuth_step")
            elevations = np.radians(array_of_numbers(i.elevations, "elevations").astype(float).reshape(-1)).tolist()
            first, step = math.radians(number(i.first_azimuth, "first_azimuth")), math.radians(i.step)
            arrays = _core.cast_from_scanner(self, eye, elevations, columns, first, step, t_min, t_max, normal)
        return FanHits(arrays, i)

    # Edits.

    def samples_changed(self, rows: slice = slice(None), cols: slice = slice(None)) -> None:
        """Reports that the caller changed values of the array, in these rows and columns of it; updates what is built.

        Waits for running queries. Scenes with this terrain see the change.

        Raises:
            Error: an infinite sample; the terrain must not be used until another call succeeds. No rows or columns.

        >>> heights = np.zeros((3, 3), np.float32)
        >>> terrain = Terrain(heights, cell=1)
        >>> heights[1, 1] = 7
        >>> terrain.samples_changed(slice(1, 2), slice(1, 2))
        >>> terrain.heights_at(1, 1).item()
        7.0
        """
        col, row, width, height = self._rect(rows, cols)
        self._samples_changed(col, row, width, height)

    def edit(self, heights: "ArrayLike", rows: slice = slice(None), cols: slice = slice(None)) -> None:
        """Overwrites samples, in the array or of an opened file in memory, and updates what is built.

        ``heights`` broadcasts to the rows and columns, in units of the samples. Waits for running queries.

        Raises:
            Error: an infinite sample, or one that the type of the array does not have (fractions, NaN and large
                numbers in integers); a read-only array; no rows or columns. Nothing is changed then.

        >>> terrain = Terrain(np.zeros((3, 3), np.float32), cell=1)
        >>> terrain.edit(7, rows=slice(1, 2), cols=slice(1, 2))
        >>> terrain.heights_at(1, 1).item()
        7.0
        """
        col, row, width, height = self._rect(rows, cols)
        if self._array is not None and not self._array.flags.writeable:
            raise Error("edit: the array is read-only (pass a writable one to Terrain)")
        nodata = self._settings[5]
        hole = "" if nodata is None else f"; a hole is {nodata:g}"
        values = converted(heights, self.heights.dtype, "edit", hole)
        try:
            new = np.broadcast_to(values, (height, width))
        except ValueError:
            raise Error(f"edit: heights of the shape {values.shape} do not broadcast to {(height, width)}") from None
        self._set_samples(col, row, np.ascontiguousarray(new[::-1] if self._south_up else new))

    def _rect(self, rows: slice, cols: slice) -> tuple[int, int, int, int]:
        """Column, row from north, columns and rows of slices of the array."""
        (first, last), (left, right) = (
            _bounds(part, count, name) for part, count, name in zip((rows, cols), self.shape, ("rows", "cols"))
        )
        return left, self.shape[0] - last if self._south_up else first, right - left, last - first

    # Output.

    def __reduce__(self) -> Any:
        # The coordinates of a DataArray are kept, its values are those of the array.
        array = self.heights if self._array is None else self._array
        present, map_from_node, crs, north = self._georeference
        settings = self._settings
        arguments = (array, self._south_up, *settings, tuple(map_from_node) if present else None, crs, north)
        return _rebuilt, (
            arguments,
            self._template,
            self._south_up,
            self._plane_error,
            self._cell_given,
            self._north_given,
        )

    def __repr__(self) -> str:
        if "_token" not in self.__dict__:
            return "<pyscarp.Terrain, not built>"
        rows, cols = self.shape
        low, high = self.range
        between = "all nodata" if low is None else f"{low:.6g} to {high:.6g} m"
        return (
            f"<pyscarp.Terrain {cols} x {rows} {self.heights.dtype}, cells {self.cell[0]:.6g} x {self.cell[1]:.6g} m, "
            f"{between}>"
        )


def _rebuilt(
    arguments: tuple[Any, ...], template: Any, south_up: bool, plane_error: float, cell_given: bool, north_given: bool
) -> Terrain:
    """Returns the terrain of a pickle or a copy; a copy is over the same array."""
    terrain = Terrain.__new__(Terrain)
    terrain._template = template
    terrain._south_up = south_up
    terrain._plane_error = plane_error
    terrain._cell_given = cell_given
    terrain._north_given = north_given
    array, *others = arguments
    # Arrays that came over a network may lie at any address.
    _core.Terrain.__init__(terrain, np.require(array, requirements="A"), *others)
    terrain._token = object()
    return terrain


_WINDOW = "column, row, columns and rows"


def _metres_per_sample_unit(source: geo.Source, body: geo.Body, unit: Optional[str]) -> float:
    """The unit that was given, that of the DataArray, that of the vertical CRS, or the metre."""
    name = source.unit if unit is None else text(unit, "unit")
    return geo.metres_per_unit(name) if name or not body.vertical_unit else body.vertical_unit


def _bounds(part: slice, count: int, name: str) -> tuple[int, int]:
    if not isinstance(part, slice):
        raise TypeError(f"{name}: {shown(part)} is not a slice (expected slice(first, last))")
    first, last, step = part.indices(count)
    if step != 1 or last <= first:
        raise Error(f"{name}: {part} selects no rows or columns, or not neighbouring ones")
    return first, last


def _samples(heights: Any, nodata: Optional[float], copy: bool) -> tuple[np.ndarray, Optional[float]]:
    """Returns the array that the terrain reads, and its nodata."""
    if isinstance(heights, (str, os.PathLike)):
        raise TypeError(f"heights: {os.fspath(heights)!r} is a path (use Terrain.open)")
    if not isinstance(heights, np.ndarray):
        if not copy:
            raise TypeError(
                f"heights: {type(heights).__name__} is not a NumPy array (load it first, or pass copy=True)"
            )
        heights = np.asarray(heights)
    if nodata is not None and math.isnan(nodata):
        nodata = None  # NaN is a hole anyway
    if isinstance(heights, np.ma.MaskedArray):
        if np.ma.is_masked(heights):
            if not copy:
                raise TypeError(
                    "heights: a masked array keeps its holes apart (pass copy=True, or heights.filled(value) "
                    "and nodata=value)"
                )
            if heights.dtype.kind == "f" or nodata is None:
                # Integers have no value that is certainly none of theirs.
                heights = np.ma.filled(heights.astype(np.result_type(heights.dtype, np.float32)), np.nan)
            else:
                if not (nodata == int(nodata) and np.can_cast(np.min_scalar_type(int(nodata)), heights.dtype)):
                    raise Error(f"nodata: {nodata:g} is not a value of {heights.dtype} (choose another one)")
                heights = heights.filled(int(nodata))
        heights = np.asarray(heights.data if isinstance(heights, np.ma.MaskedArray) else heights)
    return (_converted(heights, nodata) if copy else heights), nodata


_SAMPLE_TYPES = {
    "int8": "int16",
    "uint8": "uint16",
    "int16": "int16",
    "uint16": "uint16",
    "float32": "float32",
    "float16": "float32",
    "float64": "float32",
    "int32": "float32",
    "uint32": "float32",
    "int64": "float32",
    "uint64": "float32",
}


def _converted(heights: np.ndarray, nodata: Optional[float]) -> np.ndarray:
    """Returns a copy of a type that the library reads."""
    target = _SAMPLE_TYPES.get(heights.dtype.newbyteorder("=").name)
    if target is None:
        raise TypeError(f"heights: {heights.dtype} is not a type of numbers that heights have (expected float32)")
    if target == "float32" and nodata is not None:
        # Rounding must not make other values equal to nodata, nor nodata infinite.
        return np.where(heights == nodata, np.nan, heights).astype(np.float32)
    return np.array(heights, target, order="C")


def _cells(
    source: geo.Source, shape: tuple[int, ...], cell: Union[None, float, Sequence[float]]
) -> tuple[tuple[float, float], float]:
    """Returns the lengths of cells in metres, and the azimuth of grid north in radians."""
    if len(shape) != 2:
        return (1.0, 1.0), 0.0  # the class of the module reports the shape
    ground = None
    if cell is None:
        geo.require_lengths(source)
    if source.map_from_node is not None and (cell is None or _core.HAS_FILES):
        ground = geo.ground_at(
            source.map_from_node, source.crs, (shape[0], shape[1]), (shape[1] - 1) / 2, (shape[0] - 1) / 2
        )
    if cell is None:
        assert ground is not None
        return ground.cell, ground.grid_north
    sizes = array_of_numbers(cell, "cell").astype(float).reshape(-1)
    if sizes.size not in (1, 2):
        raise Error(f"cell: {sizes.size} numbers (expected one, or east and north, in metres)")
    return (float(sizes[0]), float(sizes[-1])), ground.grid_north if ground else 0.0
