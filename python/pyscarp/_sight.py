# SPDX-License-Identifier: MIT
"""Viewsheds, lines of sight and profiles."""

from __future__ import annotations

import dataclasses
import math
from typing import Any, Optional, Sequence

import numpy as np

from . import _core
from ._arguments import array_of_numbers, number, numbers, refuse_unused, shown, text
from ._core import Error
from ._maps import Layer, Map, computed, terrain_of
from ._progress import Progress
from ._terrain import Terrain

_VISIBLE_LIGHT = 6 / 7


def curvature_of(terrain: Terrain, cc: Optional[float]) -> tuple[float, float]:
    """Returns the curvature coefficient and the diameter of the body in metres."""
    body = terrain._body
    return (_VISIBLE_LIGHT if body.earth else 1.0) if cc is None else number(cc, "cc"), body.diameter


def _require_datum(heights: str) -> None:
    if text(heights, "heights") not in ("ground", "sea"):
        raise Error(f"heights: unknown name '{heights}' (expected one of: ground, sea)")


def viewshed(
    terrain: Any,
    observers: Any,
    *,
    observer_height: float = 2.0,
    target_height: float = 0.0,
    heights: str = "ground",
    min_distance: float = 0.0,
    max_distance: float = math.inf,
    azimuth: Optional[tuple[float, float]] = None,
    pitch: Optional[tuple[float, float]] = None,
    mode: str = "visible",
    cc: Optional[float] = None,
    coords: Optional[str] = None,
    rows: Optional[slice] = None,
    progress: Progress = None,
) -> Any:
    """Maps what one or many observers see, exactly: the same values as ``scarp viewshed``.

    Args:
        terrain: `Terrain`, or what it accepts.
        observers: (x, y) or (x, y, height), or many of them, ``(n, 2)`` or ``(n, 3)``; the nearest sample is taken.
        observer_height: of observers without their own, metres above ground.
        target_height: metres above ground.
        heights: reference of the observers' own heights, ``ground`` or ``sea``.
        min_distance, max_distance: of targets, metres.
        azimuth: field of view (from, to), degrees clockwise from true north.
        pitch: field of view (low, high), degrees above the horizontal.
        mode: what the map contains:

            ======== ======= ==========================================================================
            visible  uint8   1 where an observer sees the target, 0 where none does, 255 out of range
                             or no sample
            count    uint16  number of observers that see the target; 65535 out of range or no sample
            dem      float32 least height above sea at which a target is visible, metres; else NaN
            ground   float32 the same above ground
            angle    float32 degrees above the horizontal at which an observer sees the target; else NaN
            ======== ======= ==========================================================================
        cc: curvature coefficient, 1 - refraction coefficient, 0 (flat) to 1. Default: 6/7 on Earth.
        coords: of observers: ``map`` (those of the DataArray or file), ``local`` (metres, as in rays) or ``lonlat``
            (degrees, WGS 84). Default: map if there are any, else local.
        rows: compute only these rows of the map, ``slice(first, last)``: the same values, in less time.
        progress: None, True (a bar; tqdm where it is installed), or a function of the fraction done; if it returns
            False, the call raises Interrupted. Ctrl-C raises KeyboardInterrupt.

    Returns:
        An array ``(rows, cols)``, rows as in the input; a DataArray with its coordinates if the input is one.

    Raises:
        Error: an observer outside the terrain, on a hole or below ground; a value out of range.

    >>> wall = Terrain(np.array([[0, 0, 9, 0, 0]] * 2, np.float32), cell=10)
    >>> viewshed(wall, (0, 0))[0].tolist()
    [1, 1, 1, 0, 0]
    """
    given, terrain = terrain, terrain_of(terrain)
    places = np.atleast_2d(array_of_numbers(observers, "observers").astype(float))
    if places.ndim != 2 or places.shape[1] not in (2, 3) or len(places) == 0:
        raise Error(f"observers: the array has the shape {places.shape} (expected (n, 2) or (n, 3): x, y, height)")
    _require_datum(heights)
    if text(mode, "mode") not in _MODES:
        raise Error(f"mode: unknown name '{mode}' (expected one of: {', '.join(_MODES)})")
    low, high = (-90.0, 90.0) if pitch is None else numbers(pitch, 2, "pitch", "low and high in degrees")
    if azimuth is not None:
        azimuth = numbers(azimuth, 2, "azimuth", "from and to in degrees")  # type: ignore[assignment]
    owned = places.shape[1] == 3 and not np.isnan(places[:, 2]).all()
    if not owned:
        refuse_unused(viewshed, "for observers without their own heights", heights=heights)
    elif not np.isnan(places[:, 2]).any():
        refuse_unused(viewshed, "for observers with their own heights", observer_height=observer_height)
    if mode in ("dem", "ground"):
        refuse_unused(viewshed, f"on the mode {mode}", target_height=target_height)
    eyes = []
    for place in places.tolist():
        col, row = (math.floor(v + 0.5) for v in terrain._node(place[0], place[1], coords))
        if not (0 <= col < terrain.shape[1] and 0 <= row < terrain.shape[0]):
            raise Error(f"observer {place[0]:.10g},{place[1]:.10g}: is outside the terrain")
        ground = terrain._ground(col, row, max_distance)
        own = len(place) > 2 and not math.isnan(place[2])
        eyes.append(
            (
                col,
                row,
                place[2] if own else number(observer_height, "observer_height"),
                own and heights == "sea",
                *_field_of_view(azimuth, ground.grid_north),
                *ground.cell,
            )
        )
    coefficient, diameter = curvature_of(terrain, cc)
    arguments = (
        eyes,
        number(target_height, "target_height"),
        coefficient,
        diameter,
        number(min_distance, "min_distance"),
        number(max_distance, "max_distance"),
        math.radians(low),
        math.radians(high),
        mode,
    )
    return computed(given, terrain, Map(_viewshed_rows, arguments, (_MODES[mode],)), rows, progress)


_MODES = {
    "visible": Layer("viewshed", np.uint8, "", "visible", 255),
    "count": Layer("viewshed", np.uint16, "", "observers that see the pixel", 65535),
    "dem": Layer("viewshed", np.float32, "m", "least visible height above sea"),
    "ground": Layer("viewshed", np.float32, "m", "least visible height above ground"),
    "angle": Layer("viewshed", np.float32, "degrees", "angle above horizontal"),
}


def _viewshed_rows(terrain: Terrain, *arguments: Any) -> list[np.ndarray]:
    return [_core.viewshed(terrain, *arguments)]


def _field_of_view(azimuth: Optional[tuple[float, float]], grid_north: float) -> tuple[float, float]:
    """Radians from grid north."""
    if azimuth is None:
        return 0.0, 2 * math.pi
    for degrees in azimuth:
        if not -360 <= degrees <= 360:
            raise Error(f"azimuth: {degrees} (expected degrees clockwise from north, -360 to 360)")
    if azimuth[1] - azimuth[0] >= 360:
        return 0.0, 2 * math.pi
    first, last = ((math.remainder(math.radians(degrees) - grid_north, 2 * math.pi)) for degrees in azimuth)
    return (first + 2 * math.pi if first < 0 else first), (last + 2 * math.pi if last < 0 else last)


@dataclasses.dataclass(frozen=True)
class LineOfSight:
    """Result of `line_of_sight`. Its truth value is ``visible``."""

    visible: bool
    #: the first point that blocks: fraction of the way, x, y (in the coordinates of the ends) and height of the ground
    #: in metres; None if visible
    obstruction: Optional[tuple[float, float, float, float]]
    distance: float  #: metres, horizontal
    eye: float  #: metres above sea
    target: float  #: metres above sea
    clearance: float  #: least height of the line above the ground, metres; negative if blocked
    clearance_along: float  #: position of the least clearance, 0 to 1

    def __bool__(self) -> bool:
        return self.visible


def _line(
    terrain: Terrain,
    start: Sequence[float],
    end: Sequence[float],
    observer_height: float,
    target_height: float,
    heights: str,
    cc: Optional[float],
    coords: Optional[str],
) -> tuple[Any, ...]:
    _require_datum(heights)
    ends: list[Any] = []
    places = []
    owners = [np.ndim(place) == 1 and len(place) == 3 for place in (start, end)]
    given = {"observer_height": observer_height, "target_height": target_height}
    for own, (argument, value) in zip(owners, given.items()):
        number(value, argument)
        if own:
            refuse_unused(line_of_sight, "on an end with its own height", **{argument: value})
    if not any(owners):
        refuse_unused(line_of_sight, "on ends without their own heights", heights=heights)
    for name, place, height in (("start", start, observer_height), ("end", end, target_height)):
        if np.ndim(place) != 1 or len(place) not in (2, 3):
            raise Error(f"{name}: {shown(place)} (expected x, y or x, y, height)")
        place = numbers(place, len(place), name, "x, y or x, y, height")
        col, row = terrain._node(place[0], place[1], coords)
        if not (-0.5 <= col <= terrain.shape[1] - 0.5 and -0.5 <= row <= terrain.shape[0] - 0.5):
            raise Error(f"{name} {place[0]:.10g},{place[1]:.10g}: is outside the terrain")
        # Places in the outer half of a border's cell are at the border, as for the command line.
        col, row = min(max(col, 0), terrain.shape[1] - 1), min(max(row, 0), terrain.shape[0] - 1)
        own = len(place) == 3
        ends += [col, row, number(place[2] if own else height, name), own and heights == "sea"]
        places.append((round(col * 1024) / 1024, round(row * 1024) / 1024))  # as lines of sight round their ends
    ground = terrain._ground_along(*places)
    return (*ends, *curvature_of(terrain, cc), *ground.cell)


def line_of_sight(
    terrain: Any,
    start: Sequence[float],
    end: Sequence[float],
    *,
    observer_height: float = 2.0,
    target_height: float = 0.0,
    heights: str = "ground",
    cc: Optional[float] = None,
    coords: Optional[str] = None,
) -> LineOfSight:
    """Returns whether ``end`` is visible from ``start``, exactly, and what blocks it.

    Args:
        terrain: `Terrain`, or what it accepts.
        start, end: (x, y) or (x, y, height), anywhere in the terrain.
        observer_height, target_height, heights, cc, coords: as for `viewshed`.

    Raises:
        Error: an end outside the terrain, on a hole or below ground.

    >>> wall = Terrain(np.array([[0, 0, 9, 0, 0]] * 2, np.float32), cell=10)
    >>> line = line_of_sight(wall, (0, 5), (40, 5), cc=0)
    >>> line.visible, line.obstruction
    (False, (0.5, 20.0, 5.0, 9.0))
    """
    terrain = terrain_of(terrain)
    line = _line(terrain, start, end, observer_height, target_height, heights, cc, coords)
    visible, obstruction, *rest = _core.line_of_sight(terrain, *line)
    if obstruction is not None:
        (x,), (y,) = terrain._place(np.array([obstruction[1]]), np.array([obstruction[2]]), coords)
        obstruction = (obstruction[0], float(x), float(y), obstruction[3])
    return LineOfSight(visible, obstruction, *rest)


@dataclasses.dataclass(frozen=True)
class Profile:
    """Heights along a line: its ends and all crossings with grid lines. All arrays are ``(points,)``."""

    along: np.ndarray  #: float64: 0 at the start, 1 at the end
    distance: np.ndarray  #: float64: metres from the start
    x: np.ndarray  #: float64, in the coordinates of the ends
    y: np.ndarray  #: float64
    ground: np.ndarray  #: float64: metres above sea; NaN at an end on a hole
    drop: np.ndarray  #: float64: metres by which curvature lowers it
    sight: np.ndarray  #: float64: height of the line of sight, metres above sea
    visible: np.ndarray  #: bool: whether the eye sees the ground there
    after_hole: np.ndarray  #: bool: whether a hole lies between the previous point and this one


def profile(
    terrain: Any,
    start: Sequence[float],
    end: Sequence[float],
    *,
    observer_height: float = 2.0,
    target_height: float = 0.0,
    heights: str = "ground",
    cc: Optional[float] = None,
    coords: Optional[str] = None,
) -> Profile:
    """Returns the ground along a line, and which of it the start sees. Arguments and errors as for `line_of_sight`.

    >>> wall = Terrain(np.array([[0, 0, 9, 0, 0]] * 2, np.float32), cell=10)
    >>> line = profile(wall, (0, 5), (40, 5), cc=0)
    >>> line.distance.tolist(), line.ground.tolist(), line.visible.tolist()
    ([0.0, 10.0, 20.0, 30.0, 40.0], [0.0, 0.0, 9.0, 0.0, 0.0], [True, True, True, False, False])
    """
    terrain = terrain_of(terrain)
    table = _core.profile(terrain, *_line(terrain, start, end, observer_height, target_height, heights, cc, coords))
    x, y = terrain._place(table[:, 2], table[:, 3], coords)
    return Profile(
        table[:, 0], table[:, 1], x, y, table[:, 4], table[:, 5], table[:, 6], table[:, 7] != 0, table[:, 8] != 0
    )
