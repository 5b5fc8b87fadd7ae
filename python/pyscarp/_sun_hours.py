# SPDX-License-Identifier: MIT
"""Hours of sun, their energy, and masks of single moments."""

from __future__ import annotations

import dataclasses
import datetime
import math
from typing import Any, Optional, Sequence, Union

import numpy as np

from . import _core
from ._arguments import array_of_numbers, flag, number, refuse_unused, shown, text, whole
from ._core import Error
from ._maps import Layer, Map, computed, terrain_of
from ._progress import Progress
from ._sun import horizon_settings, place_of_sun, require_plane
from ._terrain import Terrain

_MINUTES = 1440

Date = Union[str, datetime.date]


@dataclasses.dataclass(frozen=True)
class SunMaps:
    """Results of `sun_hours` with ``first_last`` or ``energy``: maps ``(rows, cols)`` as the terrain's, float32, NaN
    without a sample; None if not asked for."""

    hours: Any  #: of direct sun
    first: Any = None  #: time of day of the first step with sun, hours of local time; NaN also without sun
    last: Any = None  #: of the last
    energy: Any = None  #: kWh per square metre of the sloping ground under a clear sky: the sum of the next three
    beam: Any = None  #: from the sun
    diffuse: Any = None  #: from the sky
    reflected: Any = None  #: from the ground around


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
    first_last: bool = False,
    energy: bool = False,
    linke: float = 3.0,
    albedo: float = 0.2,
    transmittance: Optional[float] = None,
    observer_height: float = 0.0,
    max_distance: float = math.inf,
    cc: Optional[float] = None,
    engine: str = "exact",
    rows: Optional[slice] = None,
    progress: Progress = None,
) -> Any:
    """Maps the hours of direct sun, and the energy of a clear sky: the same values as ``scarp sunhours``, where north
    turns by at most 0.05 degrees over the raster; beyond that, that of the centre counts.

    Args:
        terrain: `Terrain`, or what it accepts.
        date, to: first and last day, ``2026-06-21`` or a date. Default of ``to``: ``date``.
        step: minutes between positions of the sun, 1 to 1440; the sun of a step is that in its middle.
        utc_offset: hours of local time from UTC, with which days begin. Default: whole hours, from the longitude.
        suns: instead of dates, ``(n, 3)``: azimuth from true north and altitude of the sun in degrees, and hours. Suns
            below the horizon do not count.
        refraction, place: as for `sun_position`.
        first_last: also map the times of the first and the last sun of the day.
        energy: also map the energy, by the model of the European Solar Radiation Atlas (Rigollier 2000).
        linke: turbidity of the sky: 2 clean, 3 rural, 5 urban, 1 to 8.
        albedo: share of light that the ground reflects, 0 to 1; snow 0.8.
        transmittance: share of the sun's beam that comes down to the sea from the zenith, 0.1 to 1, instead of
            ``linke``.
        observer_height, max_distance, cc, engine, rows, progress: as for `horizon`.

    Returns:
        float32 ``(rows, cols)``, hours, NaN without a sample; a DataArray if the input is one. With ``first_last`` or
        ``energy``: `SunMaps`.

    Raises:
        Error: neither or both of date and suns; no CRS and no place; a value out of range.

    >>> wall = Terrain(np.array([[0, 0, 10, 0, 0]] * 2, np.float32), cell=10)
    >>> sun_hours(wall, suns=[(90, 30, 4), (270, 30, 4)])[0].tolist()
    [8.0, 4.0, 8.0, 4.0, 8.0]
    """
    given, terrain = terrain, require_plane(terrain_of(terrain))
    first_last, energy = flag(first_last, "first_last"), flag(energy, "energy")
    if (date is None) == (suns is None):
        raise Error("sun_hours: expected a date, or suns=[(azimuth, altitude, hours), ...]")
    if date is None and (first_last or energy):
        raise Error("sun_hours: first_last and energy need a date (leave suns out)")
    if first_last and to is not None and _day(to) != _day(date):  # type: ignore[arg-type]
        raise Error("first_last: expected a single day (leave 'to' out)")
    if not energy:
        refuse_unused(sun_hours, "without energy", linke=linke, albedo=albedo, transmittance=transmittance)
    elif transmittance is not None:
        refuse_unused(sun_hours, "with transmittance", linke=linke)
    if suns is not None:
        refuse_unused(
            sun_hours, "with suns", to=to, step=step, utc_offset=utc_offset, refraction=refraction, place=place
        )
        table = array_of_numbers(suns, "suns").astype(float)
        if table.ndim != 2 or table.shape[1] != 3:
            raise Error(f"suns: the array has the shape {table.shape} (expected (n, 3): azimuth, altitude, hours)")
        steps = [_Step(math.radians(a), math.radians(h), t, 1.0) for a, h, t in table.tolist()]
    else:
        steps = _steps(terrain, date, date if to is None else to, step, utc_offset, refraction, place)
    up = [s for s in steps if s.altitude > 0]
    sky = _sky(linke, albedo, transmittance) if energy else None
    times = [s.minute / 60 for s in up] if first_last else None
    settings = horizon_settings(terrain, observer_height, max_distance, cc)
    names = ["hours"] + ["first", "last"] * first_last + ["energy", "beam", "diffuse", "reflected"] * energy
    arguments = (times, _moments(up, terrain), *settings, text(engine, "engine"), sky)
    found = Map(
        _hours_rows,
        arguments,
        tuple(_LAYERS[name] for name in names),
        lambda arrays: arrays[0] if len(names) == 1 else SunMaps(**dict(zip(names, arrays))),
    )
    return computed(given, terrain, found, rows, progress)


_LAYERS = {
    "hours": Layer("sun_hours", np.float32, "h", "hours of direct sun"),
    "first": Layer("first_sun", np.float32, "h", "local time of the first sun"),
    "last": Layer("last_sun", np.float32, "h", "local time of the last sun"),
    **{
        name: Layer(name, np.float32, "kWh/m2", meaning)
        for name, meaning in (
            ("energy", "energy under a clear sky"),
            ("beam", "energy from the sun"),
            ("diffuse", "energy from the sky"),
            ("reflected", "energy reflected by the ground"),
        )
    },
}


def _hours_rows(terrain: Terrain, times: Optional[list[float]], *arguments: Any) -> list[np.ndarray]:
    hours, first, last, *parts = _core.sun_hours(terrain, *arguments)
    arrays = [hours]
    if times is not None:
        of_moment = np.array([*times, math.nan], np.float32)  # the index -1 is that of no moment
        arrays += [of_moment[first], of_moment[last]]
    if parts:
        beam, diffuse, reflected = parts
        arrays += [beam + diffuse + reflected, beam, diffuse, reflected]
    return arrays


def _sky(linke: float, albedo: float, transmittance: Optional[float]) -> tuple[float, float, Optional[float]]:
    for name, value, low, high in (
        ("linke", linke, 1, 8),
        ("albedo", albedo, 0, 1),
        ("transmittance", transmittance, 0.1, 1),
    ):
        if value is not None and not low <= number(value, name) <= high:
            raise Error(f"{name}: {value} (expected {low} to {high})")
    return float(linke), float(albedo), None if transmittance is None else float(transmittance)


def sun_masks(
    terrain: Any,
    date: Date,
    *,
    step: int = 30,
    utc_offset: Optional[float] = None,
    refraction: bool = False,
    place: Optional[Sequence[float]] = None,
    observer_height: float = 0.0,
    max_distance: float = math.inf,
    cc: Optional[float] = None,
    engine: str = "exact",
    rows: Optional[slice] = None,
    progress: Progress = None,
) -> tuple[np.ndarray, Any]:
    """Maps where the sun shines at each step of a day with the sun up: the same values as ``scarp sunhours --masks``,
    as far as for `sun_hours`.

    Args:
        terrain: `Terrain`, or what it accepts.
        date, step, utc_offset, refraction, place: as for `sun_hours`.
        observer_height, max_distance, cc, engine, rows, progress: as for `horizon`.

    Returns:
        A pair: local times in the middle of the steps, datetime64 ``(steps,)``, and uint8 ``(steps, rows, cols)``: 1 in
        the sun, 0 in the shade, 255 without a sample; a DataArray with the dimension ``time`` if the input is one.

    Raises:
        Error: as `sun_hours`; the sun does not rise on that day.

    >>> wall = Terrain(np.array([[0, 0, 30, 0, 0]] * 2, np.float32), cell=10)
    >>> times, masks = sun_masks(wall, "2026-06-21", step=240, place=(0, 45))
    >>> str(times[1]), masks[1, 0].tolist()
    ('2026-06-21T10:00:00', [1, 0, 1, 1, 1])
    """
    given, terrain = terrain, require_plane(terrain_of(terrain))
    up = [s for s in _steps(terrain, date, date, step, utc_offset, refraction, place) if s.altitude > 0]
    if not up:
        raise Error(f"date: the sun does not rise on {_day(date)}")
    times = np.array([np.datetime64(_day(date)) + np.timedelta64(round(60 * s.minute), "s") for s in up])
    settings = horizon_settings(terrain, observer_height, max_distance, cc)
    layer = Layer(
        "sun", np.uint8, "", "1 in the sun, 0 in the shade", 255, ("time", times, {"long_name": "local time"})
    )
    found = Map(_mask_rows, (_moments(up, terrain), *settings, text(engine, "engine")), (layer,))
    return times, computed(given, terrain, found, rows, progress)


def _mask_rows(terrain: Terrain, *arguments: Any) -> list[np.ndarray]:
    return [_core.sun_masks(terrain, *arguments)]


@dataclasses.dataclass(frozen=True)
class _Step:
    """A span of time, with the sun in its middle: radians from true north."""

    azimuth: float
    altitude: float
    hours: float
    day_of_year: float
    minute: float = 0.0  # of the local day, in the middle


def _moments(steps: list[_Step], terrain: Terrain) -> list[tuple[float, float, float, float]]:
    north = terrain._georeference[3]
    return [(s.azimuth - north, s.altitude, s.hours, s.day_of_year) for s in steps]


def _day(date: Date) -> datetime.date:
    if isinstance(date, datetime.date):
        return date
    try:
        return datetime.date.fromisoformat(date)
    except (TypeError, ValueError):
        raise Error(f"date: {shown(date)} is not a date (expected 2026-06-21)") from None


def _steps(
    terrain: Terrain,
    date: Any,
    to: Any,
    step: int,
    utc_offset: Optional[float],
    refraction: bool,
    place: Optional[Sequence[float]],
) -> list[_Step]:
    step, refraction = whole(step, "step", 1, _MINUTES), flag(refraction, "refraction")
    longitude, latitude, height = place_of_sun(terrain, place)
    offset = round(math.degrees(longitude) / 15) if utc_offset is None else number(utc_offset, "utc_offset")
    if not abs(offset) <= 24:
        raise Error(f"utc_offset: {offset} (expected hours from -24 to 24)")
    day, last = _day(date), _day(to)
    if last < day:
        raise Error(f"to: {last} is before {day}")
    times, spans = [], []
    while day <= last:
        midnight = datetime.datetime(day.year, day.month, day.day, tzinfo=datetime.timezone.utc)
        for minute in range(0, _MINUTES, step):
            length = min(step, _MINUTES - minute)
            middle = minute + length / 2
            times.append((midnight + datetime.timedelta(minutes=middle - 60 * offset)).isoformat())
            spans.append((length / 60, float(day.timetuple().tm_yday), middle))
        day += datetime.timedelta(days=1)
    positions = _core.sun_positions(times, longitude, latitude, height, refraction)
    return [_Step(azimuth, altitude, *span) for (azimuth, altitude), span in zip(positions, spans)]
