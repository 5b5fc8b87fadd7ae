# SPDX-License-Identifier: MIT
"""Shadows, horizons and sky views."""

from __future__ import annotations

import datetime
import math
from typing import Any, Optional, Sequence, Union

import numpy as np

from . import _core, _georeference as geo
from ._arguments import array_of_numbers, flag, number, numbers, refuse_unused, text, whole
from ._core import Error
from ._maps import Layer, Map, computed, terrain_of
from ._progress import Progress
from ._sight import curvature_of
from ._terrain import Terrain

Time = Union[str, datetime.datetime]


def _centre(terrain: Terrain) -> tuple[float, float]:
    return (terrain.shape[1] - 1) / 2, (terrain.shape[0] - 1) / 2


def require_plane(terrain: Terrain) -> Terrain:
    """The terrain on the plane of its centre."""
    if terrain._body.geographic:
        terrain._ground(*_centre(terrain), math.inf)  # throws for rasters that are too large
    return terrain


def place_of_sun(terrain: Terrain, place: Optional[Sequence[float]]) -> tuple[float, float, float]:
    """Longitude, latitude in radians and height in metres of the centre."""
    if not _core.HAS_SUN:
        raise Error("time: this build does not compute the sun's position (give sun=(azimuth, altitude))")
    col, row = _centre(terrain)
    if place is None:
        present, map_from_node, crs, _ = terrain._georeference
        if not (present and crs):
            raise Error(
                "time: the sun's position needs a CRS and coordinates (give place=(longitude, latitude), or sun)"
            )
        place = geo.lonlat_of(map_from_node, crs, terrain.shape, col, row)
        if place is None:
            raise Error("time: the centre of the terrain has no longitude and latitude")
    place = numbers(place, 2, "place", "longitude and latitude in degrees")
    if not (abs(place[0]) <= 360 and abs(place[1]) <= 90):
        raise Error(f"place: {place} (expected longitude and latitude in degrees)")
    return math.radians(place[0]), math.radians(place[1]), _height_at_centre(terrain)


def _height_at_centre(terrain: Terrain) -> float:
    """Metres; 0 over a hole. As the command line has it."""
    value = float(terrain.heights[terrain.shape[0] // 2, terrain.shape[1] // 2])
    _, _, scale, offset, _, nodata, *_ = terrain._settings
    return 0.0 if math.isnan(value) or value == nodata else value * scale + offset


def _time_text(time: Time) -> str:
    if isinstance(time, datetime.datetime):
        if time.tzinfo is None:
            raise Error(f"time: {time} has no UTC offset (give a time zone)")
        return time.isoformat()
    return text(time, "time")


def sun_position(
    terrain: Any, time: Time, *, refraction: bool = False, place: Optional[Sequence[float]] = None
) -> tuple[float, float]:
    """Returns azimuth (degrees from true north) and altitude of the sun over the centre of a terrain.

    Args:
        time: text with a UTC offset, ``2026-06-21T09:00+02:00``, or a datetime with a time zone.
        refraction: raise the sun by the refraction of a standard atmosphere.
        place: longitude and latitude in degrees. Default: from the CRS.

    Raises:
        Error: no CRS and no place; a time without an offset; a build without ERFA.

    >>> terrain = Terrain(np.zeros((2, 2), np.float32), cell=10)
    >>> azimuth, altitude = sun_position(terrain, "2026-06-21T12:00Z", place=(0, 51.5))
    >>> round(azimuth), round(altitude)
    (179, 62)
    """
    terrain = terrain_of(terrain)
    refraction = flag(refraction, "refraction")
    ((azimuth, altitude),) = _core.sun_positions([_time_text(time)], *place_of_sun(terrain, place), refraction)
    return math.degrees(azimuth), math.degrees(altitude)


def shadow(
    terrain: Any,
    sun: Optional[Sequence[float]] = None,
    *,
    time: Optional[Time] = None,
    refraction: bool = False,
    place: Optional[Sequence[float]] = None,
    sun_per_cell: bool = False,
    fraction: bool = False,
    rows: Optional[slice] = None,
    progress: Progress = None,
) -> Any:
    """Maps where the sun shines, exactly: the same values as ``scarp shadow``, where north turns by at most 0.05
    degrees over the raster; beyond that, that of the centre counts.

    Args:
        terrain: `Terrain`, or what it accepts.
        sun: azimuth in degrees clockwise from true north, and altitude in degrees, above 0 and at most 90.
        time, refraction, place: instead of ``sun``, as for `sun_position`; one sun for the whole map.
        sun_per_cell: take sun, north and scale at each sample instead of at the centre; needs a CRS, and GDAL.
        fraction: the lit share of the sun's disc, float32, 0 to 1, NaN without a sample; instead of codes.
        rows, progress: see `viewshed`.

    Returns:
        uint8 ``(rows, cols)``: 0 lit, 1 self-shaded, 2 cast shadow, 255 no sample; a DataArray if the input is one.

    Raises:
        Error: a sun out of range or below the horizon; neither or both of sun and time.

    >>> wall = Terrain(np.array([[0, 0, 9, 0, 0]] * 2, np.float32), cell=10)
    >>> shadow(wall, sun=(90, 40))[0].tolist()
    [0, 1, 0, 0, 0]
    """
    given, terrain = terrain, terrain_of(terrain)
    if (sun is None) == (time is None):
        raise Error("shadow: expected sun=(azimuth, altitude) or time")
    if time is None:
        refuse_unused(shadow, "with sun", refraction=refraction, place=place)
    else:
        sun = sun_position(terrain, time, refraction=refraction, place=place)
        if sun[1] <= 0 and not sun_per_cell:
            raise Error(f"time {_time_text(time)}: the sun is {-sun[1]:.2f} degrees below the horizon")
    azimuth, altitude = numbers(sun, 2, "sun", "azimuth and altitude in degrees")
    if not (math.isfinite(azimuth) and (0 < altitude or time is not None) and altitude <= 90):
        raise Error(
            f"sun: {azimuth}, {altitude} (expected azimuth and altitude in degrees, altitude above 0 and at most 90)"
        )
    refraction, fraction = flag(refraction, "refraction"), flag(fraction, "fraction")
    layer = _LIT_SHARES if fraction else _SHADES
    direction = math.radians(azimuth), math.radians(altitude)
    if flag(sun_per_cell, "sun_per_cell"):
        moment = None if time is None else _time_text(time)
        _require_suns(terrain, moment, refraction, place, direction[1])
        found = Map(_local_shadow_rows, (moment, refraction, *direction, fraction), (layer,))
    else:
        require_plane(terrain)
        found = Map(_shadow_rows, (direction[0] - terrain._georeference[3], direction[1], fraction), (layer,))
    return computed(given, terrain, found, rows, progress)


_SHADES = Layer("shadow", np.uint8, "", "0 lit, 1 self-shaded, 2 cast shadow", 255)
_LIT_SHARES = Layer("shadow", np.float32, "1", "lit share of the sun")


def _shadow_rows(terrain: Terrain, *arguments: Any) -> list[np.ndarray]:
    return [_core.shadow(terrain, *arguments)]


def _local_shadow_rows(terrain: Terrain, *arguments: Any) -> list[np.ndarray]:
    return [_core.local_shadow(terrain, *arguments)]


def _require_suns(
    terrain: Terrain, time: Optional[str], refraction: bool, place: Optional[Sequence[float]], altitude: float
) -> None:
    """Throws unless each sample can have its own sun; `altitude` is that at the centre."""
    if not (_core.HAS_FILES and _core.HAS_SUN):
        raise Error("sun_per_cell: this build has no GDAL or no ERFA (leave it out, or use scarp shadow)")
    present, map_from_node, crs, _ = terrain._georeference
    if place is not None or not (present and crs):
        raise Error("sun_per_cell: needs a CRS and coordinates, and no place")
    altitudes = [altitude]
    if time is not None:
        height = _height_at_centre(terrain)
        last_row, last_col = terrain.shape[0] - 1, terrain.shape[1] - 1
        for col in (0, last_col):
            for row in (0, last_row):
                corner = geo.lonlat_of(map_from_node, crs, terrain.shape, col, row)
                if corner is None:
                    raise Error("sun_per_cell: a corner of the terrain has no longitude and latitude")
                lonlat = math.radians(corner[0]), math.radians(corner[1])
                altitudes.append(_core.sun_positions([time], *lonlat, height, refraction)[0][1])
        if max(altitudes) <= 0:
            raise Error(f"time {time}: the sun is {-math.degrees(max(altitudes)):.2f} degrees below the horizon")
    low, high = terrain.range
    lowest = min(altitudes)
    # Rays need a plane only as far as a shadow reaches.
    reach = (high - low) / math.tan(lowest) if lowest > 0 and low is not None and high is not None else math.inf
    if terrain._body.geographic:
        terrain._ground(*_centre(terrain), reach)


def horizon_settings(
    terrain: Terrain, observer_height: float, max_distance: float, cc: Optional[float]
) -> tuple[float, float, float, float]:
    """Returns eye height and distance in metres, and the curvature."""
    return (
        number(observer_height, "observer_height"),
        number(max_distance, "max_distance"),
        *curvature_of(terrain, cc),
    )


def horizon(
    terrain: Any,
    azimuths: Any = 36,
    *,
    at: Optional[Sequence[float]] = None,
    observer_height: float = 0.0,
    max_distance: float = math.inf,
    cc: Optional[float] = None,
    engine: str = "exact",
    distance: bool = False,
    coords: Optional[str] = None,
    rows: Optional[slice] = None,
    progress: Progress = None,
) -> Any:
    """Maps the elevation of the horizon in degrees, for all samples, or at one place.

    Args:
        terrain: `Terrain`, or what it accepts.
        azimuths: degrees clockwise from true north, or their number, equally spaced from north.
        at: (x, y) of one place: the result is then a pair (azimuths, elevations), each float64 ``(n,)`` in degrees, as
            pvlib's functions take them.
        observer_height: of the eye, metres above ground.
        max_distance: metres; ground farther away does not count.
        cc, coords, rows, progress: as for `viewshed`.
        engine: ``exact``, or ``sweep``: approximate, faster.
        distance: also return the metres to the ground that is the horizon, as a second array.

    Returns:
        float32 ``(azimuths, rows, cols)``, degrees above the horizontal, also below 0; -90: no ground in that
        direction, NaN: no sample. A DataArray with the dimension ``azimuth`` if the input is one.

    Raises:
        Error: a value out of range; a place outside the terrain or over a hole.

    >>> wall = Terrain(np.array([[0, 0, 10, 0, 0]] * 2, np.float32), cell=10)
    >>> horizon(wall, [90], cc=0)[0, 0].astype(float).round(1).tolist()
    [26.6, 45.0, -26.6, 0.0, -90.0]
    >>> azimuths, elevations = horizon(wall, [90, 270], at=(0, 0))
    >>> elevations.round(1).tolist()
    [26.6, -90.0]
    """
    given, terrain = terrain, terrain_of(terrain)
    degrees = array_of_numbers(azimuths, "azimuths").astype(float)
    if degrees.ndim == 0:
        if not isinstance(azimuths, (int, np.integer)):
            raise Error(f"azimuths: {azimuths} (expected their number, or an array of degrees)")
        count = whole(azimuths, "azimuths")
        degrees = np.arange(count) * (360 / max(count, 1))
    if degrees.ndim != 1 or degrees.size == 0 or not np.isfinite(degrees).all():
        raise Error("azimuths: expected at least one, in degrees")
    settings = horizon_settings(terrain, observer_height, max_distance, cc)
    if at is None:
        refuse_unused(horizon, "without at", coords=coords)
    else:
        refuse_unused(horizon, "with at", engine=engine, rows=rows, progress=progress)
        at = numbers(at, 2, "at", "x and y")
        distance = flag(distance, "distance")
        col, row = terrain._node(at[0], at[1], coords)
        outside = Error(f"place {at[0]:.10g},{at[1]:.10g}: is outside the terrain or over a hole")
        if not (0 <= col <= terrain.shape[1] - 1 and 0 <= row <= terrain.shape[0] - 1):
            raise outside
        ground = terrain._ground(col, row, max_distance)
        from_north = (np.radians(degrees) - ground.grid_north).tolist()
        table = _core.horizon_at(terrain, col, row, from_north, *settings, *ground.cell)
        if table is None:
            raise outside
        elevations = np.degrees(table[:, 0])
        return (degrees, elevations, table[:, 1]) if distance else (degrees, elevations)
    require_plane(terrain)
    north = terrain._georeference[3]
    about = {"units": "degrees", "long_name": "azimuth from true north"}
    layers = [
        Layer(name, np.float32, unit, meaning, coordinate=("azimuth", degrees, about))
        for name, unit, meaning in (
            ("horizon", "degrees", "elevation of the horizon"),
            ("distance", "m", "distance to the horizon"),
        )
    ]
    arguments = ((np.radians(degrees) - north).tolist(), *settings, text(engine, "engine"), flag(distance, "distance"))
    if distance:
        found = Map(_horizon_rows, arguments, tuple(layers), tuple)
    else:
        found = Map(_horizon_rows, arguments, tuple(layers[:1]))
    return computed(given, terrain, found, rows, progress)


def _horizon_rows(terrain: Terrain, *arguments: Any) -> list[np.ndarray]:
    angles, metres = _core.horizon(terrain, *arguments)
    np.multiply(angles, 180 / math.pi, out=angles, dtype=float, casting="same_kind")
    return [angles] if metres is None else [angles, metres]


_MEASURES = {
    "sky-fraction": Layer("sky_fraction", np.float32, "1", "share of the sky's solid angle that is visible"),
    "sky-view-factor": Layer("sky_view_factor", np.float32, "1", "share of the radiation of a uniform sky"),
    "positive-openness": Layer("positive_openness", np.float32, "degrees", "positive openness"),
    "negative-openness": Layer("negative_openness", np.float32, "degrees", "negative openness"),
}


def sky_view(
    terrain: Any,
    measure: str = "sky-fraction",
    *,
    azimuths: int = 64,
    observer_height: float = 0.0,
    max_distance: float = math.inf,
    cc: Optional[float] = None,
    engine: str = "exact",
    rows: Optional[slice] = None,
    progress: Progress = None,
) -> Any:
    """Maps how much sky each sample sees, from its horizons.

    Args:
        terrain: `Terrain`, or what it accepts.
        measure: ``sky-fraction`` (solid angle, 0 to 1), ``sky-view-factor`` (radiation on the sloping ground, 0 to 1),
            ``positive-openness`` or ``negative-openness`` (degrees).
        azimuths: number of directions, 1 to 3600.
        observer_height, max_distance, cc, engine, rows, progress: as for `horizon`.

    Returns:
        float32 ``(rows, cols)``, NaN without a sample; a DataArray if the input is one.

    Raises:
        Error: a value out of range.

    >>> sky_view(Terrain(np.zeros((2, 2), np.float32), cell=1), azimuths=8).tolist()
    [[1.0, 1.0], [1.0, 1.0]]
    """
    given, terrain = terrain, require_plane(terrain_of(terrain))
    if text(measure, "measure") not in _MEASURES:
        raise Error(f"measure: unknown name '{measure}' (expected one of: {', '.join(_MEASURES)})")
    settings = horizon_settings(terrain, observer_height, max_distance, cc)
    arguments = (measure, whole(azimuths, "azimuths"), *settings, text(engine, "engine"))
    return computed(given, terrain, Map(_sky_rows, arguments, (_MEASURES[measure],)), rows, progress)


def _sky_rows(terrain: Terrain, measure: str, *arguments: Any) -> list[np.ndarray]:
    (values,) = _core.sky_view(terrain, [measure], *arguments)
    if _MEASURES[measure].unit == "degrees":
        values *= np.float32(180 / math.pi)
    return [values]
