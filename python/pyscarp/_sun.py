# SPDX-License-Identifier: MIT
"""Shadows, horizons, sky views and hours of sun."""

from __future__ import annotations

import datetime
import math
from typing import Any, Optional, Sequence, Union

import numpy as np

from . import _core, _georeference as geo
from ._core import Error
from ._progress import Progress, reporting
from ._rays import number, numbers
from ._sight import curvature_of, terrain_of
from ._terrain import Terrain

_MINUTES = 1440

Time = Union[str, datetime.datetime]
Date = Union[str, datetime.date]


def _centre(terrain: Terrain) -> tuple[float, float]:
    return (terrain.shape[1] - 1) / 2, (terrain.shape[0] - 1) / 2


def _plane(terrain: Terrain) -> Terrain:
    """The terrain on the plane of its centre."""
    if terrain._body.geographic:
        terrain._ground(*_centre(terrain), math.inf)  # throws for rasters that are too large
    return terrain


def _place(terrain: Terrain, place: Optional[Sequence[float]]) -> tuple[float, float, float]:
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
    if len(place) != 2 or not (abs(place[0]) <= 360 and abs(place[1]) <= 90):
        raise Error(f"place: {tuple(place)} (expected longitude and latitude in degrees)")
    low, high = terrain.range
    return math.radians(place[0]), math.radians(place[1]), 0.0 if low is None or high is None else (low + high) / 2


def _time_text(time: Time) -> str:
    if isinstance(time, datetime.datetime):
        if time.tzinfo is None:
            raise Error(f"time: {time} has no UTC offset (give a time zone)")
        return time.isoformat()
    return str(time)


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
    ((azimuth, altitude),) = _core.sun_positions([_time_text(time)], *_place(terrain, place), refraction)
    return math.degrees(azimuth), math.degrees(altitude)


def shadow(
    terrain: Any,
    sun: Optional[Sequence[float]] = None,
    *,
    time: Optional[Time] = None,
    refraction: bool = False,
    place: Optional[Sequence[float]] = None,
    fraction: bool = False,
    progress: Progress = None,
) -> Any:
    """Maps where the sun shines, exactly: the same values as ``scarp shadow``.

    Args:
        terrain: `Terrain`, or what it accepts.
        sun: azimuth in degrees clockwise from true north, and altitude in degrees, above 0 and at most 90.
        time, refraction, place: instead of ``sun``, as for `sun_position`; one sun for the whole map.
        fraction: the lit share of the sun's disc, float32, 0 to 1, NaN without a sample; instead of codes.
        progress: see `viewshed`.

    Returns:
        uint8 ``(rows, cols)``: 0 lit, 1 self-shaded, 2 cast shadow, 255 no sample; a DataArray if the input is one.

    Raises:
        Error: a sun out of range or below the horizon; neither or both of sun and time.

    >>> wall = Terrain(np.array([[0, 0, 9, 0, 0]] * 2, np.float32), cell=10)
    >>> shadow(wall, sun=(90, 40))[0].tolist()
    [0, 1, 0, 0, 0]
    """
    terrain = _plane(terrain_of(terrain))
    if (sun is None) == (time is None):
        raise Error("shadow: expected sun=(azimuth, altitude) or time")
    if time is not None:
        sun = sun_position(terrain, time, refraction=refraction, place=place)
        if sun[1] <= 0:
            raise Error(f"time {_time_text(time)}: the sun is {-sun[1]:.2f} degrees below the horizon")
    azimuth, altitude = numbers(sun, 2, "sun", "azimuth and altitude in degrees")
    if not (math.isfinite(azimuth) and 0 < altitude <= 90):
        raise Error(
            f"sun: {azimuth}, {altitude} (expected azimuth and altitude in degrees, altitude above 0 and at most 90)"
        )
    with reporting(progress) as report:
        values = _core.shadow(
            terrain, math.radians(azimuth) - terrain._georeference[3], math.radians(altitude), fraction, report
        )
    return terrain._wrap(
        values,
        "shadow",
        "1" if fraction else "",
        "lit share of the sun" if fraction else "0 lit, 1 self-shaded, 2 cast shadow",
        None if fraction else 255,
    )


def _horizon_settings(
    terrain: Terrain, observer_height: float, max_distance: float, cc: Optional[float]
) -> tuple[float, float, float, float]:
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
        cc, coords, progress: as for `viewshed`.
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
    terrain = terrain_of(terrain)
    degrees = (
        np.arange(azimuths) * (360 / max(azimuths, 1))
        if isinstance(azimuths, (int, np.integer))
        else np.asarray(azimuths, float)
    )
    degrees = np.atleast_1d(degrees).astype(float)
    if degrees.ndim != 1 or degrees.size == 0 or not np.isfinite(degrees).all():
        raise Error("azimuths: expected at least one, in degrees")
    settings = _horizon_settings(terrain, observer_height, max_distance, cc)
    if at is not None:
        col, row = terrain._node(at[0], at[1], coords)
        ground = terrain._ground(col, row, max_distance)
        table = _core.horizon_at(terrain, col, row, (np.radians(degrees) - ground.grid_north).tolist(), *settings)
        if table is None:
            raise Error(f"place {at[0]:.10g},{at[1]:.10g}: is outside the terrain or over a hole")
        elevations = np.degrees(table[:, 0])
        return (degrees, elevations, table[:, 1]) if distance else (degrees, elevations)
    _plane(terrain)
    with reporting(progress) as report:
        angles, metres = _core.horizon(
            terrain, (np.radians(degrees) - terrain._georeference[3]).tolist(), *settings, engine, distance, report
        )
    np.multiply(angles, 180 / math.pi, out=angles, dtype=float, casting="same_kind")
    found = _stacked(terrain, angles, degrees, "horizon", "degrees", "elevation of the horizon")
    return (
        (found, _stacked(terrain, metres, degrees, "distance", "m", "distance to the horizon")) if distance else found
    )


def _stacked(terrain: Terrain, values: np.ndarray, azimuths: np.ndarray, name: str, unit: str, meaning: str) -> Any:
    if terrain._template is None:
        return terrain._wrap(values, name)
    import xarray

    maps = [terrain._wrap(one, name, unit, meaning) for one in values]
    stacked = xarray.concat(
        maps,
        xarray.DataArray(
            azimuths, dims="azimuth", name="azimuth", attrs={"units": "degrees", "long_name": "azimuth from true north"}
        ),
    )
    stacked.attrs = maps[0].attrs
    return stacked


_MEASURES = {
    "sky-fraction": ("1", "share of the sky's solid angle that is visible"),
    "sky-view-factor": ("1", "share of the radiation of a uniform sky"),
    "positive-openness": ("degrees", "positive openness"),
    "negative-openness": ("degrees", "negative openness"),
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
    progress: Progress = None,
) -> Any:
    """Maps how much sky each sample sees, from its horizons.

    Args:
        terrain: `Terrain`, or what it accepts.
        measure: ``sky-fraction`` (solid angle, 0 to 1), ``sky-view-factor`` (radiation on the sloping ground, 0 to 1),
            ``positive-openness`` or ``negative-openness`` (degrees).
        azimuths: number of directions, 1 to 3600.
        observer_height, max_distance, cc, engine, progress: as for `horizon`.

    Returns:
        float32 ``(rows, cols)``, NaN without a sample; a DataArray if the input is one.

    Raises:
        Error: a value out of range.

    >>> sky_view(Terrain(np.zeros((2, 2), np.float32), cell=1), azimuths=8).tolist()
    [[1.0, 1.0], [1.0, 1.0]]
    """
    terrain = _plane(terrain_of(terrain))
    with reporting(progress) as report:
        (values,) = _core.sky_view(
            terrain, [measure], azimuths, *_horizon_settings(terrain, observer_height, max_distance, cc), engine, report
        )
    unit, meaning = _MEASURES[measure]
    if unit == "degrees":
        values *= np.float32(180 / math.pi)
    return terrain._wrap(values, measure.replace("-", "_"), unit, meaning)


def sun_hours(
    terrain: Any,
    date: Optional[Date] = None,
    *,
    to: Optional[Date] = None,
    step: int = 30,
    utc_offset: Optional[float] = None,
    suns: Any = None,
    refraction: bool = False,
    place: Optional[Sequence[float]] = None,
    observer_height: float = 0.0,
    max_distance: float = math.inf,
    cc: Optional[float] = None,
    engine: str = "exact",
    progress: Progress = None,
) -> Any:
    """Maps the hours of direct sun.

    Args:
        terrain: `Terrain`, or what it accepts.
        date, to: first and last day, ``2026-06-21`` or a date. Default of ``to``: ``date``.
        step: minutes between positions of the sun, 1 to 1440; the sun of a step is that in its middle.
        utc_offset: hours of local time from UTC, with which days begin. Default: whole hours, from the longitude.
        suns: instead of dates, ``(n, 3)``: azimuth from true north and altitude of the sun in degrees, and hours. Suns
            below the horizon do not count.
        refraction, place: as for `sun_position`.
        observer_height, max_distance, cc, engine, progress: as for `horizon`.

    Returns:
        float32 ``(rows, cols)``, hours, NaN without a sample; a DataArray if the input is one.

    Raises:
        Error: neither or both of date and suns; no CRS and no place; a value out of range.

    >>> wall = Terrain(np.array([[0, 0, 10, 0, 0]] * 2, np.float32), cell=10)
    >>> sun_hours(wall, suns=[(90, 30, 4), (270, 30, 4)])[0].tolist()
    [8.0, 4.0, 8.0, 4.0, 8.0]
    """
    terrain = _plane(terrain_of(terrain))
    if (date is None) == (suns is None):
        raise Error("sun_hours: expected a date, or suns=[(azimuth, altitude, hours), ...]")
    if suns is not None:
        table = np.asarray(suns, float)
        if table.ndim != 2 or table.shape[1] != 3:
            raise Error(f"suns: the array has the shape {table.shape} (expected (n, 3): azimuth, altitude, hours)")
        moments = [(math.radians(a), math.radians(h), t, 1.0) for a, h, t in table.tolist()]
    else:
        assert date is not None
        moments = _moments(terrain, date, date if to is None else to, step, utc_offset, refraction, place)
    north = terrain._georeference[3]
    up = [(azimuth - north, altitude, hours, day) for azimuth, altitude, hours, day in moments if altitude > 0]
    with reporting(progress) as report:
        values = _core.sun_hours(
            terrain, up, *_horizon_settings(terrain, observer_height, max_distance, cc), engine, report
        )
    return terrain._wrap(values, "sun_hours", "h", "hours of direct sun")


def _day(date: Date) -> datetime.date:
    if isinstance(date, datetime.date):
        return date
    try:
        return datetime.date.fromisoformat(date)
    except ValueError:
        raise Error(f"date: '{date}' is not a date (expected 2026-06-21)") from None


def _moments(
    terrain: Terrain,
    date: Date,
    to: Date,
    step: int,
    utc_offset: Optional[float],
    refraction: bool,
    place: Optional[Sequence[float]],
) -> list[tuple[float, float, float, float]]:
    """The sun in the middle of each step: azimuth, altitude, hours, day of the year."""
    if not 1 <= step <= _MINUTES:
        raise Error(f"step: {step} minutes (expected 1 to {_MINUTES})")
    longitude, latitude, height = _place(terrain, place)
    offset = round(math.degrees(longitude) / 15) if utc_offset is None else utc_offset
    day, last = _day(date), _day(to)
    if last < day:
        raise Error(f"to: {last} is before {day}")
    times, spans = [], []
    while day <= last:
        midnight = datetime.datetime(day.year, day.month, day.day, tzinfo=datetime.timezone.utc)
        for minute in range(0, _MINUTES, step):
            length = min(step, _MINUTES - minute)
            middle = midnight + datetime.timedelta(minutes=minute + length / 2 - 60 * offset)
            times.append(middle.isoformat())
            spans.append((length / 60, float(day.timetuple().tm_yday)))
        day += datetime.timedelta(days=1)
    positions = _core.sun_positions(times, longitude, latitude, height, refraction)
    return [(azimuth, altitude, *span) for (azimuth, altitude), span in zip(positions, spans)]
