# SPDX-License-Identifier: MIT
"""Voxels and scenes of several parts."""

import gc

import numpy as np
import pytest

import pyscarp
from pyscarp import Error, Part, Scene, Terrain, Voxels


def ball(side=12, radius=5):
    z, y, x = np.mgrid[:side, :side, :side] + 0.5 - side / 2
    return (x * x + y * y + z * z <= radius * radius).astype(np.uint8)


def first_solid(solid, origin, direction):
    """The first solid voxel of a ray, by all its crossings with planes, in order."""
    t = np.concatenate([(np.arange(n + 1) - o) / d for n, o, d in zip(solid.shape[::-1], origin, direction)])
    t = np.sort(np.append(t[t >= 0], 0))
    middles = origin + ((t[1:] + t[:-1]) / 2)[:, None] * direction
    for at in np.floor(middles).astype(int):
        if (at >= 0).all() and (at < solid.shape[::-1]).all() and solid[tuple(at[::-1])]:
            return at.tolist()
    return [-1, -1, -1]


def test_hits_are_the_first_solid_voxels():
    solid = ball()
    voxels = Voxels(solid)
    random = np.random.default_rng(5)
    origins = random.random((400, 3)) * 40 - 14
    directions = 6 + random.standard_normal((400, 3)) * 3 - origins
    hits = voxels.cast(origins, directions)
    assert 50 < hits.hit.sum() < 350
    assert hits.voxel.tolist() == [first_solid(solid, o, d) for o, d in zip(origins, directions)]
    assert np.array_equal(voxels.occluded(origins, directions), hits.hit)
    sun = np.array([0.3, 0.2, 1])
    shadow = voxels.occluded(np.nan_to_num(hits.position), sun, start=hits)
    assert shadow[hits.hit].any() and not shadow[hits.hit].all()


def test_arrays_come_back_after_edits():
    solid = ball()
    solid[3] *= 2
    voxels = Voxels(solid, side=0.5, palette=[(0, 0, 0), (255, 0, 0), (0, 0, 255)])
    assert np.array_equal(voxels.to_array(), solid) and voxels.solid_count == (solid > 0).sum()
    voxels.edit(box=((0, 0, 3), (12, 12, 4)))
    voxels.edit(sphere=((6, 6, 9), 2.0), index=2)
    voxels.edit(positions=[[0, 0, 0], [11, 1, 2], [99, 0, 0]], index=[1, 2, 1])
    solid[3] = 0
    z, y, x = np.mgrid[:12, :12, :12] + 0.5
    solid[(x - 6) ** 2 + (y - 6) ** 2 + (z - 9) ** 2 <= 4] = 2
    solid[0, 0, 0], solid[2, 1, 11] = 1, 2
    assert np.array_equal(voxels.to_array(), solid)
    for wrong in (
        {},
        {"box": ((0, 0, 0), (1, 1, 1)), "positions": [[0, 0, 0]]},
        {"positions": [[0, 0]]},
        {"positions": [[0, 0, 0]], "index": -1},
        {"box": ((0, 0, 0), (1, 1, 1)), "index": 300},
    ):
        with pytest.raises(Error, match="edit|index"):
            voxels.edit(**wrong)


def test_edits_of_voxels_are_exact():
    voxels = Voxels(np.ones((2, 2, 2), np.uint8), palette=[(0, 0, 0), (9, 9, 9)])
    whole = np.ones((2, 2, 2), np.uint8)
    # Indices that would be inside if they wrapped are outside.
    for outside in [[2**32, 0, 0]], [[0, -(2**40), 0]], np.array([[2**64 - 2, 1, 1]], np.uint64), [[1e300, 0, 0]]:
        voxels.edit(positions=outside)
        assert np.array_equal(voxels.to_array(), whole)
    voxels.edit(positions=[])
    voxels.edit(positions=[[1.0, 0.0, 1.0]], index=np.uint8(0))
    voxels.edit(box=((-(2**40), 1, 0), (2**40, 2, 1)))
    whole[1, 0, 1] = whole[0, 1] = 0
    assert np.array_equal(voxels.to_array(), whole)


@pytest.mark.parametrize(
    "edit, message",
    [
        ({"positions": [[0.5, 0, 0]]}, "positions: 0.5 is not a whole number"),
        ({"positions": [[0, np.nan, 0]]}, "positions: nan is not a whole number"),
        ({"positions": [[0, 0, 0]], "index": 0.5}, "index: 0.5 is not a whole number"),
        ({"positions": [[0, 0, 0]], "index": 256}, "index 256"),
        ({"positions": [[0, 0, 0]], "index": 2**32}, "index 4294967296"),
        ({"positions": [[0, 0, 0]], "index": 2}, "index 2 is not between 0 and 1"),
        ({"positions": [["a", "b", "c"]]}, "positions: .* not an array of numbers"),
        ({"box": ((0, 0, 0.5), (1, 1, 1))}, "box: 0.5 is not a whole number"),
        ({"box": ((0, 0), (1, 1))}, r"box: .*\(2, 3\)"),
        ({"box": ((0, 0, 0), (1, 1, 1)), "index": 1.5}, "index: 1.5"),
        ({"box": ((0, 0, 0), (1, 1, 1)), "index": 2}, "index: 2 .* 0 to 1"),
        ({"sphere": 5}, "sphere: 5"),
        ({"sphere": ((0, 0, np.nan), 1)}, "sphere: .* is not finite"),
    ],
)
def test_refuses_places_and_indices_that_are_none(edit, message):
    voxels = Voxels(np.ones((2, 2, 2), np.uint8), palette=[(0, 0, 0), (9, 9, 9)])
    with pytest.raises((Error, TypeError), match=message) as caught:
        voxels.edit(**edit)
    assert "\n" not in str(caught.value) and (voxels.to_array() == 1).all()


@pytest.mark.parametrize("dtype", [np.uint8, np.int64, np.uint16])
def test_palettes_are_of_any_integers(dtype):
    palette = np.array([[0, 0, 0], [255, 0, 0], [0, 255, 0]]).astype(dtype)
    picture = pyscarp.render(Voxels(np.ones((2, 2, 2), np.uint8), palette=palette), (32, 32), unlit=True)
    assert picture[16, 16].tolist() == [255, 0, 0]


@pytest.mark.parametrize(
    "palette, message",
    [
        ([(0, 0, 0), (256, 0, 0)], "256"),
        ([(0, 0, 0), (-1, 0, 0)], "-1"),
        ([(0.0, 0, 0), (1.0, 0.5, 0)], "integers from 0 to 255"),
        ([0, 0, 0, 255, 0, 0], r"\(n, 3\)"),
        (np.zeros((3, 2), np.uint8), r"\(n, 3\)"),
        (np.zeros((3, 4), np.uint8), r"\(n, 3\)"),
        ([0x000000, 0xFF0000], r"\(n, 3\)"),
        ("red", "palette: 'red' is not an array of numbers"),
    ],
)
def test_refuses_other_palettes(palette, message):
    with pytest.raises((Error, TypeError), match=f"palette: .*{message}|{message}"):
        Voxels(np.ones((2, 2, 2), np.uint8), palette=palette)


@pytest.mark.parametrize(
    "array, error",
    [
        (np.zeros((2, 2), np.uint8), Error),
        (np.zeros((2, 0, 2), np.uint8), Error),
        (np.zeros((2, 2, 2), np.int32), TypeError),
        (np.full((2, 2, 2), 9, np.uint8), Error),
    ],
)
def test_refuses_other_arrays(array, error):
    with pytest.raises(error, match="voxels|palette"):
        Voxels(array, palette=[(0, 0, 0), (255, 255, 255)])


def test_the_nearest_part_counts():
    ground = Terrain(np.zeros((9, 9), np.float32), cell=10)
    tower = Voxels(np.ones((4, 2, 2), np.uint8), side=1)
    scene = Scene([ground, Part(tower, origin=(40, 40, 0), scale=2), Part(tower, origin=(20, 20, 0), turn=45)])
    hits = scene.cast([[41, 43, 50], [60, 60, 50], [20, 21.5, 50], [21.7, 21.7, 50]], [0, 0, -1])
    assert hits.object.tolist() == [1, 0, 2, 0] and hits.t.tolist() == [42, 50, 46, 50]
    assert scene.heights_at(41, 43) == 0  # voxels are no ground
    nested = Scene([Part(scene, origin=(1000, 0, 0)), ground])
    assert nested.cast([1041, 43, 50], [0, 0, -1]).t == 42


def test_edits_of_parts_change_the_scene():
    tower = Voxels(np.ones((4, 2, 2), np.uint8))
    scene = Scene([tower, Part(tower, origin=(10, 0, 0))])
    nested = Scene([scene])
    tower.edit(box=((0, 0, 2), (2, 2, 4)))
    for of in scene, nested:
        assert of.cast([[1, 0.5, 9], [10.5, 0.5, 9]], [0, 0, -1]).t.tolist() == [7, 7]


def test_scenes_keep_their_parts():
    scene = Scene([Terrain(np.zeros((9, 9), np.float32), cell=10)])
    gc.collect()
    np.ones((9, 9), np.float32)
    assert scene.cast([40, 40, 9], [0, 0, -1]).t == 9


@pytest.mark.parametrize("part, error", [(Part(None, scale=1), TypeError), ("scene", TypeError)])
def test_refuses_other_parts(part, error):
    with pytest.raises(error, match="not a Terrain"):
        Scene([part])


@pytest.mark.parametrize(
    "placement", [{"scale": 0}, {"origin": (np.nan, 0, 0)}, {"turn": np.ones((3, 3))}, {"turn": np.ones(3)}]
)
def test_refuses_other_placements(placement):
    with pytest.raises(Error):
        Scene([Part(Voxels(np.ones((2, 2, 2), np.uint8)), **placement)])


def test_scenes_without_parts():
    assert not Scene([]).cast([0, 0, 0], [0, 0, 1]).hit
