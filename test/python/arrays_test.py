# SPDX-License-Identifier: MIT
"""Arrays are read where they are, kept alive, and refused with a remedy."""

import gc
import weakref

import numpy as np
import pytest
from conftest import hills
from hypothesis import given, strategies as st

import pyscarp
from pyscarp import Error, Terrain


def address(array):
    return array.__array_interface__["data"][0]


@given(
    rows=st.integers(1, 9),
    cols=st.integers(1, 9),
    row_step=st.sampled_from([1, 2, 3, -1, -2]),
    margin=st.integers(0, 3),
    dtype=st.sampled_from([np.float32, np.int16, np.uint16]),
    south_up=st.booleans(),
)
def test_reads_strided_rows_without_a_copy(rows, cols, row_step, margin, dtype, south_up):
    whole = np.arange(3 * rows * (cols + 2 * margin)).reshape(3 * rows, -1).astype(dtype)
    view = whole[::row_step][:rows, margin : margin + cols]
    terrain = Terrain(view, cell=2, south_up=south_up)
    from_north = view[::-1] if south_up else view
    assert np.array_equal(terrain.heights, from_north)
    assert address(terrain.heights) == address(from_north)
    assert np.shares_memory(terrain.heights, whole)
    if rows > 1 and cols > 1:
        x, y = np.meshgrid(2 * np.arange(cols), 2 * np.arange(rows)[::-1])
        assert np.array_equal(terrain.heights_at(x, y), from_north.astype(float))


@given(
    st.sampled_from([np.float64, np.int32, np.uint8, np.bool_, np.complex64, np.dtype(">f4"), np.dtype("U3"), object])
)
def test_refuses_other_types_with_the_remedy(dtype):
    with pytest.raises(TypeError, match="copy=True"):
        Terrain(np.zeros((3, 3), dtype), cell=1)


@pytest.mark.parametrize(
    "dtype", [np.float64, np.float16, np.int32, np.uint8, np.int8, np.dtype(">f4"), np.dtype(">i2")]
)
def test_copies_other_types_when_allowed(dtype):
    heights = np.arange(12).reshape(3, 4).astype(dtype)
    terrain = Terrain(heights, cell=1, copy=True)
    assert np.array_equal(terrain.heights, np.arange(12).reshape(3, 4))
    assert not np.shares_memory(terrain.heights, heights)


def test_a_copy_is_one_in_any_case():
    heights = np.zeros((3, 4), np.float32)
    terrain = Terrain(heights, cell=1, copy=True)
    heights[:] = 7
    assert terrain.range == (0, 0) and (terrain.heights == 0).all()


def test_paths_are_opened():
    with pytest.raises(TypeError, match="Terrain.open"):
        Terrain("dem.tif")


def test_objects_that_were_not_built_can_be_shown():
    # Tracebacks of pytest and IPython show the objects whose constructors failed.
    for call in (
        lambda: Terrain(np.full((2, 2), np.inf, np.float32), cell=1),
        lambda: Terrain.open("none.tif"),
        lambda: pyscarp.Voxels(np.full((2, 2, 2), 9, np.uint8), palette=[(0, 0, 0)]),
    ):
        with pytest.raises(Error) as caught:
            call()
        shown = [
            repr(value)
            for entry in caught.traceback
            for value in entry.frame.f_locals.values()
            if isinstance(value, (Terrain, pyscarp.Voxels))
        ]
        assert shown and all("not built" in text for text in shown)


def test_holes_survive_rounding_to_float32():
    lowest = np.finfo(np.float64).min
    terrain = Terrain(np.array([[1, 2, 3], [4, lowest, 6], [7, 8, 9.0]]), cell=1, nodata=lowest, copy=True)
    assert np.isnan(terrain.heights_at(1, 1)) and terrain.range == (1, 9)


def test_masked_arrays_need_a_copy():
    masked = np.ma.masked_array(np.ones((3, 3), np.float32), np.eye(3, dtype=bool))
    with pytest.raises(TypeError, match="masked"):
        Terrain(masked, cell=1)
    assert np.array_equal(np.isnan(Terrain(masked, cell=1, copy=True).heights), np.eye(3, dtype=bool))
    whole = Terrain(np.ma.masked_array(np.ones((3, 3), np.int16), np.eye(3, dtype=bool)), cell=1, nodata=-9, copy=True)
    assert whole.heights[0].tolist() == [-9, 1, 1] and whole.range == (1, 1)


@pytest.mark.parametrize(
    "array, message",
    [
        (np.zeros(4, np.float32), "two dimensions"),
        (np.zeros((2, 2, 2), np.float32), "two dimensions"),
        (np.zeros((0, 3), np.float32), "at least one row"),
        (np.zeros((4, 6), np.float32)[:, ::2], "next to one another"),
        (np.zeros((4, 6), np.float32).T, "next to one another"),
        (np.full((2, 2), np.inf, np.float32), "inf"),
    ],
)
def test_refuses_other_shapes_and_layouts(array, message):
    with pytest.raises(Error, match=message):
        Terrain(array, cell=1)


@pytest.mark.parametrize(
    "settings, message",
    [
        ({}, "cell"),
        ({"cell": 0}, "cell"),
        ({"cell": np.nan}, "cell"),
        ({"cell": (1, 2, 3)}, "cell"),
        ({"cell": 1, "surface": "smooth"}, "bilinear, triangles"),
        ({"cell": 1, "wrap": "round"}, "periodic"),
        ({"cell": 1, "exaggeration": -1}, "exaggeration"),
        ({"cell": 1, "unit": "K"}, "unit"),
        ({"cell": 1, "transform": (1, 2, 0, 3, -1, 0)}, "rotated"),
    ],
)
def test_names_settings_out_of_range(settings, message):
    with pytest.raises(Error, match=message):
        Terrain(np.zeros((3, 3), np.float32), **settings)


def test_keeps_the_array_alive_and_frees_it():
    class Watched(np.ndarray):
        pass

    heights = hills(20, 20).view(Watched)
    watch = weakref.ref(heights)
    terrain = Terrain(heights, cell=1)
    scene = pyscarp.Scene([terrain])
    hits = terrain.cast([5, 5, 999], [0, 0, -1])
    view = terrain.heights
    del heights, terrain
    gc.collect()
    assert watch() is not None and scene.cast([5, 5, 999], [0, 0, -1]).t == hits.t
    del scene
    gc.collect()
    assert watch() is not None and view.shape == (20, 20)  # the view keeps the terrain, which keeps the array
    del view
    gc.collect()
    assert watch() is None


def test_refuses_an_array_that_was_resized():
    heights = np.zeros((30, 30), np.float32)
    terrain = Terrain(heights[5:25], cell=1)
    assert terrain.occluded([5, 5, 1], [0, 0, -1])
    heights.resize((300, 300), refcheck=False)
    for call in (
        lambda: terrain.occluded([5, 5, 1], [0, 0, -1]),
        lambda: pyscarp.viewshed(terrain, (5, 5)),
        lambda: pyscarp.Scene([terrain]),
        lambda: terrain.samples_changed(),
    ):
        with pytest.raises(Error, match="resized"):
            call()


def test_reads_read_only_and_mapped_arrays(tmp_path):
    hills(9, 9, np.int16).tofile(tmp_path / "heights.raw")
    mapped = np.memmap(tmp_path / "heights.raw", np.int16, "r", shape=(9, 9))
    terrain = Terrain(mapped, cell=1)
    assert address(terrain.heights) == address(mapped)
    with pytest.raises(Error, match="read-only"):
        terrain.edit(5)


def test_edits_are_seen_by_rays_maps_and_scenes():
    heights = np.zeros((9, 9), np.float32)
    terrain = Terrain(heights, cell=1)
    scene = pyscarp.Scene([terrain, pyscarp.Part(terrain, origin=(100, 0, 0))])
    down = lambda of: of.cast([[4, 4, 50], [104, 4, 50]], [0, 0, -1]).t.tolist()
    assert down(scene) == [50, 50]
    terrain.edit(7, rows=slice(3, 6), cols=slice(3, 6))
    assert heights[4, 4] == 7 and down(scene) == [43, 43]
    heights[4, 4] = 9
    terrain.samples_changed(slice(4, 5), slice(4, 5))
    assert down(scene) == [41, 41] and terrain.range == (0, 9)
    with pytest.raises(Error, match="inf"):
        terrain.edit(np.inf, rows=slice(0, 2))
    assert heights[0, 0] == 0 and down(scene) == [41, 41]
    with pytest.raises(Error, match="broadcast"):
        terrain.edit([1, 2])
    with pytest.raises(Error, match="selects no rows"):
        terrain.samples_changed(slice(9, 12))


@given(
    st.sampled_from([np.int16, np.uint16]),
    st.one_of(
        st.integers(-70_000, 70_000), st.floats(-70_000, 70_000), st.sampled_from([np.nan, np.inf, -np.inf, 2**40])
    ),
)
def test_edits_of_integers_are_exact(dtype, height):
    array = np.full((3, 4), 9, dtype)
    terrain = Terrain(array, cell=1)
    ends = np.iinfo(dtype)
    if ends.min <= height <= ends.max and height == int(height):
        terrain.edit(height, rows=slice(1, 2))
        assert (array[1] == height).all()
    else:
        with pytest.raises(Error, match=f"edit: .* is not a value of {np.dtype(dtype).name}"):
            terrain.edit(height, rows=slice(1, 2))
        assert (array == 9).all()


def test_edits_name_the_value_of_holes():
    terrain = Terrain(np.zeros((3, 3), np.int16), cell=1, nodata=-9999)
    with pytest.raises(Error, match="a hole is -9999"):
        terrain.edit(np.nan)
    terrain.edit(-9999, rows=slice(0, 1))
    assert np.isnan(terrain.heights_at(1, 2))


@pytest.mark.parametrize(
    "heights, message",
    [
        ("high", "not an array of numbers"),
        (1j, "not an array of numbers"),
        ([[1, 2], [3]], "rows of the same length"),
        (np.ma.masked_array([1, 2, 3], [False, True, False]), "masked"),
    ],
)
def test_edits_take_numbers_only(heights, message):
    for dtype in np.int16, np.float32:
        array = np.zeros((3, 3), dtype)
        with pytest.raises(TypeError, match=f"edit: .*{message}"):
            Terrain(array, cell=1).edit(heights)
        assert (array == 0).all()


def test_edits_count_rows_of_the_array():
    heights = np.zeros((9, 5), np.float32)
    terrain = Terrain(heights, cell=1, south_up=True)
    terrain.cast([2, 1, 5], [0, 0, -1])
    terrain.edit(7, rows=slice(1, 2), cols=slice(2, 3))
    assert terrain.cast([2, 1, 50], [0, 0, -1]).t == 43 and terrain.heights_at(2, 1) == 7


def test_rows_that_are_one_memory_are_refused():
    row = np.arange(5, dtype=np.float32)
    with pytest.raises(Error, match="all rows are the same memory"):
        Terrain(np.broadcast_to(row, (4, 5)), cell=1)
    copied = Terrain(np.broadcast_to(row, (4, 5)), cell=1, copy=True)
    assert copied.heights.tolist() == [row.tolist()] * 4


def test_masked_integers_are_holes_whatever_their_fill():
    heights = np.ma.masked_array(np.full((3, 3), 16959, np.int16), np.eye(3, dtype=bool))
    terrain = Terrain(heights, cell=1, copy=True)  # NumPy's own fill, 999999, would be 16959 in 16 bits
    assert np.isnan(np.diag(terrain.heights)).all() and terrain.range == (16959, 16959)
    with pytest.raises(Error, match="nodata: 70000 is not a value of int16"):
        Terrain(heights, cell=1, nodata=70000, copy=True)


def test_hidden_elements_are_refused():
    hidden = np.ma.array(np.ones((3, 3, 3), np.uint8), mask=True)
    with pytest.raises(TypeError, match="voxels: a masked array hides"):
        pyscarp.Voxels(hidden)
    terrain = Terrain(np.zeros((3, 3), np.float32), cell=1)
    starts = np.ma.array([0.0, 1.0], mask=[True, False])
    with pytest.raises(TypeError, match="t_min: a masked array hides"):
        terrain.cast([[1, 1, 5], [1, 1, 5]], [0, 0, -1], t_min=starts)
