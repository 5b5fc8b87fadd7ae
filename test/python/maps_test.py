# SPDX-License-Identifier: MIT
"""Maps: against a judge in rational numbers, against one another, and their errors."""

import copy
import pickle
from fractions import Fraction

import numpy as np
import pytest
import sight_judge
from conftest import hills
from hypothesis import given, settings, strategies as st

import pyscarp
from pyscarp import Error, Terrain

small = st.integers(0, 2**32 - 1)


def rough(seed, rows=7, cols=9, holes=2):
    random = np.random.default_rng(seed)
    heights = random.integers(0, 20, (rows, cols)).astype(np.float32)
    for _ in range(holes):
        heights[random.integers(rows), random.integers(cols)] = np.nan
    return heights


@settings(max_examples=12)
@given(small, st.sampled_from([0, 1.5]), st.booleans())
def test_viewsheds_are_exact(seed, target, south_up):
    heights = rough(seed)
    observer = (4, 3)
    heights[3, 4] = 12
    array = heights[::-1].copy() if south_up else heights
    seen = pyscarp.viewshed(
        Terrain(array, cell=5, south_up=south_up), (5 * 4, 5 * 3), observer_height=2, target_height=target, cc=0
    )
    seen = seen[::-1] if south_up else seen
    for row in range(7):
        for col in range(9):
            if np.isnan(heights[row, col]):
                assert seen[row, col] == 255
            elif (col, row) != observer:
                assert seen[row, col] == sight_judge.sees(heights, observer, (col, row), 2, target), (col, row)


@settings(max_examples=8)
@given(small)
def test_shadows_are_exact(seed):
    heights = rough(seed)
    # A sun in the east-south-east: exactly two columns per row, with cells of 1 m.
    for step, azimuth, altitude in (((1, 0), 90, 45), ((-1, 0), 270, 60), ((1, 1), 135, 40)):
        length = np.hypot(*step)
        rise = Fraction(float(np.tan(np.radians(altitude)) * length))
        codes = pyscarp.shadow(Terrain(heights, cell=1), (azimuth, altitude))
        for row in range(7):
            for col in range(9):
                block = (
                    None if np.isnan(heights[row, col]) else sight_judge.first_block(heights, (col, row), step, rise)
                )
                wanted = 255 if np.isnan(heights[row, col]) else 0 if block is None else 1 if block == 0 else 2
                if codes[row, col] != wanted and wanted != 255:
                    # tan is rounded: only ground within rounding of the ray may differ.
                    lifted = [
                        sight_judge.first_block(heights, (col, row), step, rise * (1 + e))
                        for e in (Fraction(1, 10**6), Fraction(-1, 10**6))
                    ]
                    assert lifted[0] != lifted[1], (col, row)
                else:
                    assert codes[row, col] == wanted


@settings(max_examples=10)
@given(small)
def test_lines_of_sight_agree_with_the_viewshed(seed):
    heights = rough(seed, holes=0)
    terrain = Terrain(heights, cell=10)
    seen = pyscarp.viewshed(terrain, (40, 30))
    for row in range(7):
        for col in range(9):
            if (col, row) != (4, 3):
                line = pyscarp.line_of_sight(terrain, (40, 30), (10 * col, 10 * (6 - row)))
                assert bool(line) == line.visible == bool(seen[row, col])
                assert (line.obstruction is None) == line.visible and (line.clearance < 0) == (not line.visible)


def test_many_observers():
    terrain = Terrain(hills(40, 50), cell=10)
    places = [(100, 100), (300, 250), (400, 60, 20)]
    alone = np.stack([pyscarp.viewshed(terrain, place) for place in places])
    assert np.array_equal(pyscarp.viewshed(terrain, places[:2]), alone[:2].max(0))
    three = [(100, 100, 2), (300, 250, 2), (400, 60, 20)]
    assert np.array_equal(pyscarp.viewshed(terrain, three), alone.max(0))
    count = pyscarp.viewshed(terrain, three, mode="count")
    assert count.dtype == np.uint16 and np.array_equal(count, alone.sum(0))
    above = pyscarp.viewshed(terrain, three, mode="ground")
    assert above.dtype == np.float32 and np.array_equal(above == 0, alone.max(0) == 1)
    assert np.allclose(pyscarp.viewshed(terrain, three, mode="dem") - above, terrain.heights, atol=1e-3)
    angle = pyscarp.viewshed(terrain, three, mode="angle")
    assert np.array_equal(np.isnan(angle), alone.max(0) == 0)


def test_limits_of_viewsheds():
    terrain = Terrain(np.zeros((21, 21), np.float32), cell=10)
    seen = pyscarp.viewshed(terrain, (100, 100), max_distance=50, cc=0)
    y, x = np.mgrid[-10:11, -10:11]
    assert np.array_equal(seen == 1, np.hypot(x, y) <= 5)
    east = pyscarp.viewshed(terrain, (100, 100), azimuth=(45, 135), cc=0)
    off_diagonal = np.abs(x) != np.abs(y)  # on diagonals the angle of 45 degrees is rounded
    assert np.array_equal((east == 1)[off_diagonal], (np.abs(y) < x)[off_diagonal])
    turned = pyscarp.viewshed(
        Terrain(np.zeros((21, 21), np.float32), cell=10, grid_north=90), (100, 100), azimuth=(135, 225), cc=0
    )
    assert np.array_equal(turned[off_diagonal], east[off_diagonal])


def test_profiles_are_the_ground_at_crossings():
    heights = hills(30, 30)
    line = pyscarp.profile(Terrain(heights, cell=10), (0, 145), (290, 145), cc=0)
    # Along a row line between rows 14 and 15: the crossings are the columns.
    few = 4 * np.finfo(float).eps  # a quotient and a product, each rounded
    assert np.allclose(line.x, np.arange(30) * 10.0, rtol=few) and np.allclose(line.distance, line.x, rtol=few)
    assert np.allclose(line.ground, (heights[14].astype(float) + heights[15]) / 2, rtol=1e-15)
    assert line.visible[:2].all() and not line.visible.all()


def test_horizons_are_the_steepest_crossings():
    heights = hills(30, 30)
    angles = pyscarp.horizon(Terrain(heights, cell=10), [90, 0], cc=0)
    assert angles.shape == (2, 30, 30) and angles.dtype == np.float32
    rise = np.array(
        [
            [max((float(heights[r, k]) - heights[r, c]) / (10 * (k - c)) for k in range(c + 1, 30)) for c in range(29)]
            for r in range(30)
        ]
    )
    # One rounding to float of each of: two heights' difference, slope, arc tangent, degrees.
    assert (
        np.abs(np.tan(np.radians(angles[0, :, :-1].astype(float))) - rise).max()
        <= 8 * 2**-24 * (1 + np.abs(rise).max()) ** 2 * 90
    )
    assert (angles[0, :, -1] == -90).all() and (angles[1, 0] == -90).all()
    _, metres = pyscarp.horizon(Terrain(heights, cell=10), 4, cc=0, distance=True)
    assert metres.shape == (4, 30, 30) and (metres[1, :, :-1] % 10 == 0).all()


def test_horizons_at_a_place_suit_pvlib():
    terrain = Terrain(hills(30, 30), cell=10)
    azimuths, elevations = pyscarp.horizon(terrain, 8, at=(120, 130))
    maps = pyscarp.horizon(terrain, 8)
    assert azimuths.tolist() == [45 * i for i in range(8)]
    # The map is in float, the place in double.
    assert np.allclose(elevations, maps[:, 29 - 13, 12], atol=1e-4)
    *_, metres = pyscarp.horizon(terrain, 8, at=(120, 130), distance=True)
    assert metres.shape == (8,)
    with pytest.raises(Error, match="outside"):
        pyscarp.horizon(terrain, 8, at=(999, 0))


def test_sky_views_are_means_over_horizons():
    terrain = Terrain(hills(20, 20), cell=10)
    horizons = np.radians(pyscarp.horizon(terrain, 16).astype(float))
    fraction = pyscarp.sky_view(terrain, azimuths=16)
    assert np.allclose(fraction, (1 - np.sin(np.maximum(horizons, 0))).mean(0), atol=1e-6)
    opened = pyscarp.sky_view(terrain, "positive-openness", azimuths=16)
    level = np.where(horizons == -np.pi / 2, 0, horizons)  # a direction without ground is level
    assert np.allclose(opened, 90 - np.degrees(level).mean(0), atol=1e-4)
    with pytest.raises(Error, match="sky-view-factor"):
        pyscarp.sky_view(terrain, "svf")


def test_hours_of_sun_are_the_suns_above_the_horizon():
    terrain = Terrain(hills(20, 20), cell=10)
    suns = [(100, 15, 1), (180, 35, 2), (250, 10, 0.5), (300, -5, 9)]
    horizons = pyscarp.horizon(terrain, [100, 180, 250]).astype(float)
    wanted = sum(hours * (altitude >= horizons[i]) for i, (_, altitude, hours) in enumerate(suns[:3]))
    assert np.array_equal(pyscarp.sun_hours(terrain, suns=suns), wanted)


def test_days_have_the_suns_of_their_steps():
    if not pyscarp._core.HAS_SUN:
        pytest.skip("this build does not compute the sun's position")
    flat = Terrain(np.zeros((3, 3), np.float32), cell=10)
    hours = pyscarp.sun_hours(flat, "2026-03-20", place=(0, 45), step=10)
    assert np.ptp(hours) == 0 and abs(hours[0, 0] - 12) < 0.5
    assert pyscarp.sun_hours(flat, "2026-03-20", to="2026-03-21", place=(0, 45))[0, 0] > 23
    azimuth, altitude = pyscarp.sun_position(flat, "2026-03-20T12:07Z", place=(0, 45))
    assert abs(azimuth - 180) < 1 and abs(altitude - 45) < 0.5
    shade = pyscarp.shadow(flat, time="2026-03-20T12:00Z", place=(0, 45))
    assert (shade == 0).all()


def all_maps():
    """Maps of each kind as functions of a terrain."""
    observers = [(100, 100), (300, 250), (400, 60)]
    suns = [(100, 15, 1), (180, 35, 2)]
    yield from (
        (lambda t, mode=mode, **k: pyscarp.viewshed(t, observers, mode=mode, max_distance=260, **k))
        for mode in ("visible", "count", "dem", "ground", "angle")
    )
    yield lambda t, **k: pyscarp.viewshed(t, observers[0], **k)
    yield lambda t, **k: pyscarp.shadow(t, (135, 10), **k)
    yield lambda t, **k: pyscarp.shadow(t, (200, 10), fraction=True, **k)
    yield lambda t, **k: pyscarp.horizon(t, 5, **k)
    yield lambda t, **k: pyscarp.sky_view(t, "positive-openness", azimuths=6, **k)
    yield lambda t, **k: pyscarp.sun_hours(t, suns=suns, **k)


@pytest.mark.parametrize("south_up", [False, True])
def test_rows_are_those_of_the_whole_map(south_up):
    terrain = Terrain(rough(3, 41, 50, holes=5), cell=10, south_up=south_up)
    for index, compute in enumerate(all_maps()):
        whole = compute(terrain)
        for rows in slice(0, 1), slice(7, 30), slice(-3, None):
            part = compute(terrain, rows=rows)
            assert part.dtype == whole.dtype and np.array_equal(part, whole[..., rows, :], equal_nan=True), index
    for rows in slice(5, 5), slice(0, 9, 2), slice(60, 70):
        with pytest.raises(Error, match="rows"):
            pyscarp.shadow(terrain, (135, 10), rows=rows)
    with pytest.raises(TypeError, match="rows"):
        pyscarp.shadow(terrain, (135, 10), rows=3)


def test_terrains_can_be_copied_and_pickled():
    heights = rough(3, 12, 9)
    whole = Terrain(
        heights, crs="EPSG:32610", transform=(10, 0, 0, 0, -10, 120), cell=10, south_up=False, nodata=3, exaggeration=2
    )
    again = pickle.loads(pickle.dumps(whole))
    assert np.array_equal(again.heights, heights, equal_nan=True) and not np.shares_memory(again.heights, heights)
    for name in "shape", "cell", "range", "transform", "crs", "grid_north":
        assert getattr(again, name) == getattr(whole, name), name
    assert np.array_equal(pyscarp.shadow(again, (99, 9)), pyscarp.shadow(whole, (99, 9)))
    assert np.shares_memory(copy.copy(whole).heights, heights)
    south = Terrain(heights, cell=1, south_up=True)
    assert np.array_equal(pickle.loads(pickle.dumps(south)).heights, south.heights, equal_nan=True)


FLAT = np.zeros((5, 5), np.float32)


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda t: pyscarp.viewshed(t, (99, 0)), "outside the terrain"),
        (lambda t: pyscarp.viewshed(t, (np.nan, 0)), "not finite"),
        (lambda t: pyscarp.viewshed(t, [1, 2, 3, 4]), "expected"),
        (lambda t: pyscarp.viewshed(t, np.empty((0, 2))), "expected"),
        (lambda t: pyscarp.viewshed(t, (0, 0), mode="all"), "visible, count, dem, ground, angle"),
        (lambda t: pyscarp.viewshed(t, (0, 0), observer_height=-1), "height"),
        (lambda t: pyscarp.viewshed(t, (0, 0), cc=11), "coefficient"),
        (lambda t: pyscarp.viewshed(t, (0, 0), azimuth=(0, 999)), "azimuth"),
        (lambda t: pyscarp.viewshed(t, (0, 0), max_distance=np.nan), "distance"),
        (lambda t: pyscarp.viewshed(t, (0, 0), coords="lonlat"), "need a CRS"),
        (lambda t: pyscarp.viewshed(t, (0, 0), coords="utm"), "map, local, lonlat"),
        (lambda t: pyscarp.viewshed(t, (0, 0), coords="map"), "no map coordinates"),
        (lambda t: pyscarp.line_of_sight(t, (0, 0), (99, 0)), "end 99,0: is outside"),
        (lambda t: pyscarp.profile(t, (0,), (4, 4)), "start"),
        (lambda t: pyscarp.shadow(t), "sun"),
        (lambda t: pyscarp.shadow(t, (90, 0)), "altitude"),
        (lambda t: pyscarp.shadow(t, (90, 91)), "altitude"),
        (lambda t: pyscarp.shadow(t, time="2026-06-21T12:00Z"), "place"),
        (lambda t: pyscarp.shadow(t, time="noon", place=(0, 0)), "noon"),
        (lambda t: pyscarp.shadow(t, time="2026-06-21T00:00Z", place=(0, 45)), "below the horizon"),
        (lambda t: pyscarp.horizon(t, []), "azimuths"),
        (lambda t: pyscarp.horizon(t, [np.inf]), "azimuths"),
        (lambda t: pyscarp.horizon(t, engine="fast"), "exact, sweep"),
        (lambda t: pyscarp.horizon(t, max_distance=0), "distance"),
        (lambda t: pyscarp.sky_view(t, azimuths=0), "azimuths"),
        (lambda t: pyscarp.sun_hours(t), "date"),
        (lambda t: pyscarp.sun_hours(t, "yesterday", place=(0, 0)), "2026-06-21"),
        (lambda t: pyscarp.sun_hours(t, suns=[(90, 30)]), "azimuth, altitude, hours"),
        (lambda t: pyscarp.sun_hours(t, "2026-06-21", place=(0, 99)), "place"),
        (lambda t: pyscarp.sun_hours(t, suns=[(90, 30, 1)], energy=True), "date"),
        (lambda t: pyscarp.sun_hours(t, "2026-06-21", to="2026-06-22", first_last=True, place=(0, 9)), "single day"),
        (lambda t: pyscarp.sun_hours(t, "2026-06-21", energy=True, linke=9, place=(0, 9)), "linke: 9 .* 1 to 8"),
        (lambda t: pyscarp.sun_hours(t, "2026-06-21", energy=True, albedo=np.nan, place=(0, 9)), "albedo"),
        (lambda t: pyscarp.sun_masks(t, "2026-12-21", place=(0, 80)), "does not rise"),
    ],
)
def test_bad_input_has_one_line(call, message):
    with pytest.raises(Error, match=message) as caught:
        call(Terrain(FLAT, cell=1))
    assert "\n" not in str(caught.value)


DAY = dict(date="2026-06-21", place=(0, 45))


@pytest.mark.parametrize(
    "call, names",
    [
        (lambda t: pyscarp.viewshed(t, (0, 0), heights="sea"), "heights"),
        (lambda t: pyscarp.viewshed(t, [(0, 0, 9), (1, 1, 9)], observer_height=5), "observer_height"),
        (lambda t: pyscarp.viewshed(t, (0, 0), mode="dem", target_height=5), "target_height"),
        (lambda t: pyscarp.viewshed(t, (0, 0), mode="ground", target_height=5), "target_height"),
        (lambda t: pyscarp.line_of_sight(t, (0, 0, 9), (1, 1), observer_height=5), "observer_height"),
        (lambda t: pyscarp.line_of_sight(t, (0, 0), (1, 1, 9), target_height=5), "target_height"),
        (lambda t: pyscarp.profile(t, (0, 0), (1, 1), heights="sea"), "heights"),
        (lambda t: pyscarp.shadow(t, (90, 9), refraction=True, place=(0, 0)), "refraction, place"),
        (lambda t: pyscarp.horizon(t, coords="local"), "coords"),
        (
            lambda t: pyscarp.horizon(t, at=(1, 1), engine="sweep", rows=slice(0, 1), progress=print),
            "engine, rows, progress",
        ),
        (
            lambda t: pyscarp.sun_hours(t, suns=[(90, 30, 1)], step=60, utc_offset=1, refraction=True, place=(0, 0)),
            "step, utc_offset, refraction, place",
        ),
        (lambda t: pyscarp.sun_hours(t, suns=[(90, 30, 1)], to="2026-06-21"), "to"),
        (lambda t: pyscarp.sun_hours(t, **DAY, linke=4, albedo=0.4, transmittance=0.6), "linke, albedo, transmittance"),
        (lambda t: pyscarp.sun_hours(t, **DAY, energy=True, linke=4, transmittance=0.6), "linke"),
        (lambda t: pyscarp.render(t, top=True, view=(1, 2), fov=40, eye=(0, 0, 9)), "view, fov, eye"),
        (lambda t: pyscarp.render(t, eye=(0, 0, 9), distance=2), "distance"),
        (lambda t: pyscarp.render(t, target=(0, 0, 9)), "target"),
        (lambda t: pyscarp.render(t, unlit=True, shadows=False, samples=4), "shadows, samples"),
        (lambda t: pyscarp.render(t, unlit=True, sun=(90, 9)), "sun"),
        (lambda t: pyscarp.render(t, ao_distance=9), "ao_distance"),
        (lambda t: pyscarp.render(t, look="hillshade", shadows=False, haze=0.5), "shadows, haze"),
        (lambda t: Terrain(FLAT, cell=1, plane_error=2), "plane_error"),
    ],
)
def test_arguments_without_effect_are_named(call, names):
    with pytest.raises(Error, match=f"^{names}: no effect ") as caught:
        call(Terrain(FLAT, cell=1))
    assert "\n" not in str(caught.value)


def test_arguments_at_their_defaults_are_not_refused():
    terrain = Terrain(FLAT, cell=1, plane_error=0.5)
    pyscarp.viewshed(terrain, (0, 0, 2), observer_height=2, mode="dem", target_height=0)
    pyscarp.shadow(terrain, (90, 9), refraction=False, place=None)
    assert pyscarp.render(terrain, (8, 8), top=True, view=[190, 35], fov=30).shape == (8, 8, 3)


def test_observers_on_holes():
    heights = FLAT.copy()
    heights[2, 2] = np.nan
    terrain = Terrain(heights, cell=1)
    with pytest.raises(Error, match="nodata"):
        pyscarp.viewshed(terrain, (2, 2))
    assert pyscarp.viewshed(terrain, (2, 2, 5), heights="sea")[0, 0] == 1


def test_terrains_without_cells_and_samples():
    for shape in (1, 1), (1, 5), (5, 1):
        terrain = Terrain(np.zeros(shape, np.float32), cell=1)
        assert (pyscarp.viewshed(terrain, (0, 0)) == 1).all()
        assert not terrain.cast([0, 0, 5], [0, 0, -1]).hit
    empty = Terrain(np.full((3, 3), np.nan, np.float32), cell=1)
    assert empty.range == (None, None) and (pyscarp.shadow(empty, (90, 45)) == 255).all()
    with pytest.raises(Error, match="nodata|visible"):
        pyscarp.render(empty)
