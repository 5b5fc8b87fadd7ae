# SPDX-License-Identifier: MIT
"""Rays: answers against NumPy, shapes, room for answers, and errors."""

import tracemalloc

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


def allocated(call):
    """Most bytes that NumPy and Python held during a call."""
    tracemalloc.start()
    try:
        call()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_fills_room_without_allocating(ground):
    origins, directions = random_rays(1000)
    out = Hits(1000, normal=False)
    position = out.position
    assert ground.cast(origins, directions, out=out) is out and out.position is position and out.normal is None
    # One byte per ray would be 1000.
    assert allocated(lambda: ground.cast(origins, directions, out=out)) < 1000
    assert allocated(lambda: ground.cast(origins, directions)) > 1000 * 8
    fresh = ground.cast(origins, directions)
    assert np.array_equal(out._raw, fresh._raw) and np.array_equal(position, fresh.position, equal_nan=True)
    turned = ground.cast(origins[:, ::-1], directions, out=out)  # other strides, the same room
    assert np.array_equal(turned.t, ground.cast(origins[:, ::-1].copy(), directions).t)
    assert not np.array_equal(turned.t, fresh.t)
    blocked = np.zeros(1000, bool)
    assert ground.occluded(origins, directions, out=blocked) is blocked and np.array_equal(blocked, fresh.hit)
    heights = np.empty(1000)
    ground.heights_at(origins[:, 0], origins[:, 1], out=heights)
    # A dozen roundings, of positions below 80 cells on slopes below 300 m per cell.
    wanted = bilinear(ground.heights, 10, origins[:, 0], origins[:, 1])
    assert np.abs(heights - wanted).max() <= 12 * 2.0**-53 * 80 * 300
    for wrong in (Hits(999), Hits((1000, 1))):
        with pytest.raises(Error, match="room"):
            ground.cast(origins, directions, out=wrong)
    with pytest.raises(Error, match="bool"):
        ground.occluded(origins, directions, out=np.zeros(1000))
    with pytest.raises(Error, match="position, normal: no effect with out"):
        ground.cast(origins, directions, out=out, position=False, normal=False)


def test_hits_are_indexed_as_their_arrays(ground):
    origins, directions = random_rays(60)
    hits = ground.cast(origins.reshape(6, 10, 3), directions.reshape(6, 10, 3))
    mask = hits.hit
    for index in 2, -1, (2, 3), slice(1, 4), (slice(None), 4), (..., 2), mask, [3, 1], (mask.any(1), 0), []:
        part = hits[index]
        assert type(part) is Hits and part.shape == hits.t[index].shape
        for name in "t", "status", "hit", "cell", "uv", "position", "normal", "face", "object", "voxel":
            whole = getattr(hits, name)
            vectors = whole.ndim > hits.t.ndim
            axes = index if isinstance(index, tuple) else (index,)
            wanted = whole[(*axes, slice(None))] if vectors else whole[index]
            assert np.array_equal(getattr(part, name), wanted, equal_nan=True), (index, name)
    assert np.shares_memory(hits[1:].t, hits.t) and np.shares_memory(hits[2].position, hits.position)
    assert [row.shape for row in hits] == [(10,)] * 6
    assert [float(ray.t) for row in hits for ray in row] == hits.t.reshape(-1).tolist()
    bare = ground.cast(origins, directions, position=False, normal=False)[:5]
    assert bare.position is None and bare.normal is None and bare.t.tolist() == hits.t[0, :5].tolist()
    for index in "t", None, 1.5, (0, "t"):
        with pytest.raises(TypeError, match="no index of rays"):
            hits[index]
    with pytest.raises(IndexError):
        hits[6]


def test_parts_of_hits_start_rays(ground):
    origins, directions = random_rays(200)
    hits = ground.cast(origins, directions)
    sun = np.array([1.0, 0.5, 0.4])
    points = np.where(hits.hit[:, None], hits.position, 500.0)
    shadow = ground.occluded(points, sun, start=hits)
    assert np.array_equal(ground.occluded(points[::3], sun, start=hits[::3]), shadow[::3])
    with pytest.raises(Error, match="another scene"):
        Terrain(np.zeros((5, 5), np.float32), cell=1).occluded(points[:3], sun, start=hits[:3])
    with pytest.raises(TypeError, match="start: "):
        ground.occluded(points, sun, start=points)


def test_truth_values_are_clear(ground):
    hits = ground.cast([[400, 300, 900], [400, 300, 900]], [[0, 0, -1], [0, 0, 1]])
    assert bool(hits[0]) and not hits[1] and bool(hits[:1]) and [bool(h) for h in hits] == [True, False]
    for several in hits, hits[:0]:
        with pytest.raises(Error, match=r"no single truth value \(use .hit.any\(\)"):
            bool(several)
    above, along = ([400, 300, 900], [0, 0, 1]), ([-50, 20, 150], [1, 0.05, 0])
    assert not ground.all_hits(*above) and bool(ground.all_hits(*along))
    assert repr(ground.all_hits(*above)) == "<pyscarp.AllHits of 1 rays, 0 hits>"


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


def test_batches_of_cameras_are_those_of_their_rays(ground):
    # More rays than a piece of a batch; rows do not divide its size.
    camera = pyscarp.Camera((400, -200, 600), forward=(0.1, 1, -0.6), columns=700, rows=201, fov=70)
    directions = camera.directions().reshape(-1, 3)
    origins = np.ascontiguousarray(np.broadcast_to(camera.eye, directions.shape).astype(float))
    hits = ground.cast(origins, directions)
    order = np.random.default_rng(5).permutation(len(directions))
    shuffled = ground.cast(origins[order], directions[order])
    assert np.array_equal(shuffled._raw, hits._raw[order]) and 0.2 < hits.hit.mean() < 1
    assert np.array_equal(shuffled.position, hits.position[order], equal_nan=True)
    assert np.array_equal(ground.occluded(origins, directions), hits.hit)


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
    for i in 0, 40, len(origins) - 1:
        of_ray = every.of_ray(i)
        assert np.array_equal(of_ray.t, every.t[every.ray == i]) and len(of_ray) == count[i]
    assert len(every) == count.sum() and float(every[-1].t) == every.t[-1]
    for wrong in -1, len(origins), 0.5:
        with pytest.raises(Error, match="ray: "):
            every.of_ray(wrong)
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
