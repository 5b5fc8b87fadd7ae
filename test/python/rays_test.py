# SPDX-License-Identifier: MIT
"""Rays: answers against NumPy, shapes, room for answers, and errors."""

import numpy as np
import pytest
from conftest import hills
from hypothesis import given, strategies as st

import pyscarp
from pyscarp import Error, Hits, Status, Terrain


def bilinear(heights, cell, x, y):
    """Height of the surface, by the definition."""
    col, row = x / cell, heights.shape[0] - 1 - y / cell
    c = np.clip(np.floor(col).astype(int), 0, heights.shape[1] - 2)
    r = np.clip(np.floor(row).astype(int), 0, heights.shape[0] - 2)
    u, v, h = col - c, row - r, heights.astype(float)
    return (1 - u) * (1 - v) * h[r, c] + u * (1 - v) * h[r, c + 1] + (1 - u) * v * h[r + 1, c] + u * v * h[r + 1, c + 1]


def random_rays(count):
    random = np.random.default_rng(3)
    origins = random.random((count, 3)) * (790, 590, 100) + (0, 0, 320)
    directions = random.standard_normal((count, 3)) * (1, 1, 0.5) - (0, 0, 0.3)
    return origins, directions


@pytest.mark.parametrize("dtype", [np.float32, np.int16, np.uint16])
def test_hits_are_the_first_points_of_the_surface(dtype):
    heights = hills(60, 80, dtype)
    terrain = Terrain(heights, cell=10)
    origins, directions = random_rays(3000)
    hits = terrain.cast(origins, directions)
    found = hits.hit
    assert 500 < found.sum() < 2900
    x, y, z = hits.position[found].T
    # The documented accuracy: a thousandth of a cell.
    assert np.abs(bilinear(heights, 10, x, y) - z).max() <= 1e-3 * 10
    # No point before the hit, and none within the field of a miss, is below the ground.
    share = np.linspace(0, 1, 400)[:, None]
    reach = np.where(found, hits.t, 2000.0)
    points = origins + (share * reach)[..., None] * directions
    inside = ((points[..., :2] >= 0) & (points[..., :2] <= (790, 590))).all(-1)
    ground = bilinear(heights, 10, *np.clip(points[..., :2], 0, (790, 590)).transpose(2, 0, 1))
    assert (points[..., 2] - ground)[inside].min() >= -1e-3 * 10
    assert np.array_equal(terrain.occluded(origins, directions), found)
    assert np.isnan(hits.position[~found]).all() and np.isinf(hits.t[~found]).all() and (hits.cell[~found] == -1).all()


def test_normals_are_those_of_the_surface(ground):
    origins, directions = random_rays(500)
    hits = ground.cast(origins, directions)
    normal, found, step = hits.normal, hits.hit, 1e-3
    assert np.allclose(np.linalg.norm(normal[found], axis=1), 1) and (normal[~found] == 0).all()
    x, y = hits.position[found, 0], hits.position[found, 1]
    col, row = hits.cell[found].T
    west, south = col * 10.0, (60 - 2 - row) * 10.0
    x, y = np.clip(x, west + step, west + 10 - step), np.clip(y, south + step, south + 10 - step)
    slope_x = (bilinear(ground.heights, 10, x + step, y) - bilinear(ground.heights, 10, x - step, y)) / (2 * step)
    # A bilinear patch is linear along x, so that this difference is its slope at y; y was moved by at most `step`.
    twist = np.abs(np.diff(np.diff(ground.heights.astype(float), axis=0), axis=1)).max() / 100
    assert np.abs(-normal[found, 0] / normal[found, 2] - slope_x).max() <= twist * step + 1e-6


@given(
    st.lists(st.integers(1, 4), max_size=3),
    st.lists(st.integers(1, 4), max_size=3),
    st.sampled_from([np.float64, np.float32, np.int64]),
)
def test_rays_broadcast_as_in_numpy(first, second, dtype):
    terrain = Terrain(np.zeros((9, 9), np.float32), cell=1)
    origins = (np.arange(3 * np.prod(first, dtype=int)).reshape(*first, 3) % 7).astype(dtype) + np.array(
        [0, 0, 1], dtype
    )
    directions = np.full((*second, 3), -1, dtype)
    try:
        shape = np.broadcast_shapes(tuple(first), tuple(second))
    except ValueError:
        with pytest.raises(Error, match="broadcast"):
            terrain.cast(origins, directions)
        return
    hits = terrain.cast(origins, directions)
    assert hits.shape == shape and hits.position.shape == shape + (3,)
    t = np.broadcast_to(origins[..., 2], shape).astype(float)
    at = np.broadcast_to(origins, shape + (3,))[..., :2] - t[..., None]
    inside = ((at >= 0) & (at <= 8)).all(-1)
    assert np.array_equal(hits.t, np.where(inside, t, np.inf))
    assert np.array_equal(terrain.occluded(origins, directions), inside)


def test_fills_room_without_allocating(ground):
    origins, directions = random_rays(1000)
    out = Hits(1000, normal=False)
    position = out.position
    assert ground.cast(origins, directions, out=out) is out and out.position is position and out.normal is None
    fresh = ground.cast(origins, directions)
    assert np.array_equal(out._raw, fresh._raw) and np.array_equal(position, fresh.position, equal_nan=True)
    ground.cast(origins[:, ::-1], directions, out=out)  # other strides, the same room
    blocked = np.zeros(1000, bool)
    assert ground.occluded(origins, directions, out=blocked) is blocked and np.array_equal(blocked, fresh.hit)
    heights = np.empty(1000)
    ground.heights_at(origins[:, 0], origins[:, 1], out=heights)
    assert np.array_equal(heights, bilinear(ground.heights, 10, origins[:, 0], origins[:, 1])) or np.allclose(
        heights, bilinear(ground.heights, 10, origins[:, 0], origins[:, 1]), rtol=1e-12
    )
    for wrong in (Hits(999), Hits((1000, 1))):
        with pytest.raises(Error, match="room"):
            ground.cast(origins, directions, out=wrong)
    with pytest.raises(Error, match="bool"):
        ground.occluded(origins, directions, out=np.zeros(1000))


def test_rays_start_on_hits(ground):
    origins, directions = random_rays(1000)
    hits = ground.cast(origins, directions)
    points = np.where(hits.hit[:, None], hits.position, 500.0)
    sun = np.array([1.0, 0.5, 0.4])
    shadow = ground.occluded(points, sun, start=hits)
    lifted = ground.occluded(points + (0, 0, 1e-6), sun, start=None)
    assert shadow.any() and not shadow.all() and (shadow == lifted).mean() > 0.9
    flat = Terrain(np.zeros((5, 5), np.float32), cell=1)
    on = flat.cast([2, 2, 5], [0, 0, -1])
    assert not flat.occluded([2, 2, 0], [1, 0, 0], start=on)
    with pytest.raises(Error, match="another scene"):
        ground.occluded([2, 2, 0], [1, 0, 0], start=on)


def test_ranges_are_one_number_or_one_per_ray(ground):
    down = np.tile([0.0, 0, -1], (3, 1))
    origins = np.tile([400.0, 300, 1000], (3, 1))
    t = ground.cast(origins, down).t
    assert ground.cast(origins, down, t_max=1).hit.tolist() == [False] * 3
    assert ground.cast(origins, down, t_max=[1, t[1], np.inf]).hit.tolist() == [False, True, True]
    with pytest.raises(Error, match="t_max"):
        ground.cast(origins, down, t_max=[1, 2])


@pytest.mark.parametrize(
    "origins, directions, message",
    [
        ([[0, 0, 9], [0, np.nan, 9]], [0, 0, -1], "ray 1 of 2: its origin is not finite"),
        ([0, 0, 9], [0, 0, 0], "zero"),
        ([0, 0, 9], [0, np.inf, 0], "direction is not finite"),
        ([0, 0], [0, 0, -1], "expected"),
        ([0, 0, 9], [[0, 0]], "expected"),
        (5, [0, 0, 1], "expected"),
    ],
)
def test_names_bad_rays(ground, origins, directions, message):
    for call in ground.cast, ground.occluded, ground.all_hits:
        with pytest.raises(Error, match=message):
            call(origins, directions)


def test_names_bad_rays_of_large_batches(ground):
    origins = np.tile([400.0, 300, 1000], (200_000, 1))
    origins[150_000, 1] = np.inf
    with pytest.raises(Error, match="ray 150000 of 200000"):
        ground.cast(origins, np.array([0, 0, -1.0]))


def test_texts_are_no_rays(ground):
    with pytest.raises(TypeError, match="numbers"):
        ground.cast([["a", "b", "c"]], [0, 0, 1])


def test_empty_batches(ground):
    assert ground.cast(np.empty((0, 3)), np.empty((0, 3))).t.shape == (0,)
    assert ground.occluded(np.empty((2, 0, 3)), [0, 0, 1]).shape == (2, 0)


def test_statuses():
    terrain = Terrain(np.zeros((3, 3), np.float32), cell=1)
    hits = terrain.cast([[1, 1, 1], [9, 9, 1], [1, 1, -1]], [0, 0, -1])
    assert [Status(s) for s in hits.status] == [Status.HIT, Status.MISS, Status.BELOW]


def test_all_hits_begin_with_the_closest(ground):
    origins = np.array([[-50.0, y, z] for y in range(20, 580, 20) for z in (150, 200, 250)])
    directions = np.array([[1.0, 0.05, 0]])
    every, first = ground.all_hits(origins, directions), ground.cast(origins, directions)
    count = np.diff(every.first)
    assert count.max() > 1 and np.array_equal(count > 0, first.hit)
    assert np.array_equal(every.t[every.first[:-1][count > 0]], first.t[first.hit])
    same_ray = np.diff(every.ray) == 0
    assert (np.diff(every.t)[same_ray] > 0).all()


def test_fans_are_casts_of_their_directions(ground):
    camera = pyscarp.Camera((400, -200, 600), forward=(0.1, 1, -0.6), columns=60, rows=40, fov=70)
    scanner = pyscarp.Scanner((400, 300, 330), elevations=np.linspace(-40, 5, 30), columns=48, first_azimuth=10)
    for instrument in camera, scanner:
        fan = ground.cast_from(instrument, normal=True)
        rays = ground.cast(instrument.eye, instrument.directions())
        assert 0.2 < rays.hit.mean() < 1 or instrument is scanner
        # Directions of fans are floats: rays along a silhouette may differ.
        same = (fan.hit == rays.hit) & (fan.cell == rays.cell).all(-1)
        assert same.mean() > 0.95
        both = same & fan.hit
        assert np.allclose(fan.t[both], rays.t[both], rtol=1e-4) and np.allclose(
            fan.position[both], rays.position[both], atol=0.1
        )
    with pytest.raises(Error, match="eye"):
        ground.cast_from(pyscarp.Scanner((0, np.nan, 0)))
    with pytest.raises(Error, match="tan_half_width"):
        ground.cast_from(pyscarp.Camera((0, 0, 900), fov=180))
