# SPDX-License-Identifier: MIT
"""DataArrays and files: coordinates, CRS, units, holes; and the same bytes as the command line's."""

import subprocess
import sys

import numpy as np
import pytest
from conftest import hills

import pyscarp
from pyscarp import Error, Terrain

xarray = pytest.importorskip("xarray")

HAS_FILES = pyscarp._core.HAS_FILES
needs_files = pytest.mark.skipif(not HAS_FILES, reason="this build reads no files")


def data_array(heights, x0=500_000.0, y0=5_200_000.0, step=30.0, crs="EPSG:32632", dims=("y", "x"), **attrs):
    """Rows from north, with the coordinates of pixel centres, as rioxarray has them."""
    rows, cols = heights.shape
    array = xarray.DataArray(
        heights,
        dims=dims,
        attrs=attrs,
        coords={dims[0]: y0 - step * np.arange(rows), dims[1]: x0 + step * np.arange(cols)},
    )
    if crs:
        array = array.assign_coords(spatial_ref=xarray.DataArray(0, attrs={"crs_wkt": pyscarp._core.wkt_of(crs)}))
    return array


@needs_files
def test_reads_a_data_array_without_a_copy():
    heights = hills(20, 30)
    terrain = Terrain(data_array(heights, _FillValue=-9999.0))
    assert np.shares_memory(terrain.heights, heights) and np.array_equal(terrain.heights, heights)
    assert terrain.transform == (30, 0, 499_985, 0, -30, 5_200_015)
    # UTM at its central meridian: the scale is 0.9996, and grid north is true north.
    assert np.allclose(terrain.cell, 30 / 0.9996, rtol=1e-6) and abs(terrain.grid_north) < 0.01
    assert "UTM zone 32N" in terrain.crs
    x, y = terrain.to_local(500_030, 5_200_000 - 19 * 30)
    assert np.allclose([x, y], [terrain.cell[0], 0], atol=1e-6)
    assert np.allclose(terrain.to_map(x, y), [500_030, 5_200_000 - 19 * 30])


@needs_files
def test_maps_have_the_coordinates_of_the_input():
    data = data_array(hills(20, 30))
    seen = pyscarp.viewshed(data, (500_300, 5_199_700))
    assert seen.dims == data.dims and seen.attrs["_FillValue"] == 255
    xarray.testing.assert_equal(seen.coords.to_dataset(), data.coords.to_dataset())
    angles = pyscarp.horizon(data, 4)
    assert angles.dims == ("azimuth", "y", "x") and angles.azimuth.values.tolist() == [0, 90, 180, 270]
    assert angles.attrs["units"] == "degrees" and "spatial_ref" in angles.coords
    for result in (
        pyscarp.shadow(data, (135, 20)),
        pyscarp.sky_view(data, azimuths=8),
        pyscarp.sun_hours(data, "2026-06-21", step=240),
    ):
        assert result.shape == data.shape and "spatial_ref" in result.coords


@needs_files
def test_rows_from_south_give_the_same_maps():
    north = data_array(hills(20, 30))
    south = north[::-1].copy()
    for call in (
        lambda d: pyscarp.viewshed(d, (500_300, 5_199_700)),
        lambda d: pyscarp.shadow(d, (135, 20)),
        lambda d: pyscarp.horizon(d, 4),
    ):
        xarray.testing.assert_identical(call(north), call(south).sortby("y", ascending=False))


@needs_files
def test_degrees_are_measured_at_the_observer():
    tall = data_array(np.zeros((200, 5), np.float32), x0=10.0, y0=50.0, step=0.002, crs=None, dims=("lat", "lon"))
    terrain = Terrain(tall)
    assert "WGS 84" in terrain.crs
    seen = [pyscarp.viewshed(terrain, (10.004, y), max_distance=1000, cc=0) for y in (49.99, 49.62)]
    metres_east = 111_320 * np.cos(np.radians(49.99)) * 0.002
    # Two columns away on both sides, and rows of 222.4 m.
    assert terrain.cell[0] > metres_east and [int((s == 1).sum()) for s in seen] == [5 * 9, 5 * 9]
    with pytest.raises(Error, match="metric plane"):
        pyscarp.shadow(
            data_array(np.zeros((200, 200), np.float32), x0=10.0, y0=50.0, step=0.05, crs="EPSG:4326"), (90, 30)
        )


def test_builds_without_gdal_use_pyproj_or_given_cells(monkeypatch):
    monkeypatch.setattr(pyscarp._core, "HAS_FILES", False)
    heights = hills(20, 30)
    transform = (30, 0, 500_000, 0, -30, 5_200_000)
    if pytest.importorskip("pyproj"):
        terrain = Terrain(heights, crs="EPSG:32632", transform=transform)
        assert np.allclose(terrain.cell, 30 / 0.9996, rtol=1e-6)
        x, y = terrain.to_map(300, 300)
        lonlat = sys.modules["pyproj"].Transformer.from_crs("EPSG:32632", "EPSG:4326", always_xy=True).transform(x, y)
        seen = pyscarp.viewshed(terrain, (x, y))
        assert np.array_equal(pyscarp.viewshed(terrain, lonlat, coords="lonlat"), seen)
        assert not np.array_equal(pyscarp.viewshed(terrain, (9.0, 46.95), coords="lonlat"), seen)
        with pytest.raises(Error, match="EPSG:99999"):
            Terrain(heights, crs="EPSG:99999", transform=transform)
    monkeypatch.setitem(sys.modules, "pyproj", None)
    with pytest.raises(Error, match="pyproj"):
        Terrain(heights, crs="EPSG:32632", transform=transform)
    given = Terrain(heights, crs="EPSG:32632", transform=transform, cell=30)
    assert given.cell == (30, 30) and pyscarp.viewshed(given, (500_300, 5_199_700)).shape == (20, 30)
    with pytest.raises(Error, match="pyproj"):
        pyscarp.viewshed(given, (9, 46.9), coords="lonlat")
    with pytest.raises(Error, match="reads no files"):
        Terrain.open("dem.tif")


@needs_files
def test_given_cells_hold_for_degrees():
    degrees = dict(crs="EPSG:4326", transform=(0.1, 0, 10, 0, -0.1, 50))
    given = Terrain(np.zeros((50, 50), np.float32), cell=20, **degrees)
    assert given.cell == (20, 20) and (pyscarp.viewshed(given, (12, 47), max_distance=20, cc=0) == 1).sum() == 5


@needs_files
def test_places_in_degrees():
    terrain = Terrain(data_array(hills(20, 30)))
    pyproj = pytest.importorskip("pyproj")
    to_lonlat = pyproj.Transformer.from_crs("EPSG:32632", "EPSG:4326", always_xy=True).transform
    start, end = (500_100, 5_199_900), (500_700, 5_199_600)
    line = pyscarp.profile(terrain, start, end)
    degrees = pyscarp.profile(terrain, to_lonlat(*start), to_lonlat(*end), coords="lonlat")
    assert np.array_equal(degrees.ground, line.ground)
    # A cell is 1 / 1024 of 30 m; a degree has about 111 km.
    assert np.allclose([degrees.x, degrees.y], to_lonlat(line.x, line.y), atol=30 / 1024 / 111e3)
    local = pyscarp.profile(terrain, *zip(*terrain.to_local(*zip(start, end))), coords="local")
    assert np.array_equal(local.ground, line.ground)
    assert np.allclose(terrain.to_map(local.x, local.y), [line.x, line.y], rtol=1e-12)
    seen = pyscarp.viewshed(terrain, to_lonlat(*start), coords="lonlat")
    xarray.testing.assert_equal(seen, pyscarp.viewshed(terrain, start))


@needs_files
def test_lengths_agree_with_pyproj():
    pytest.importorskip("pyproj")
    from pyscarp import _georeference as geo

    for crs, m in (
        ("EPSG:32632", (300_000.0, 30.0, 0.0, 5_200_000.0, 0.0, -30.0)),
        ("EPSG:3857", (1_200_000.0, 30.0, 0.0, 6_000_000.0, 0.0, -30.0)),
        ("EPSG:4326", (10.0, 0.0003, 0.0, 50.0, 0.0, -0.0003)),
    ):
        wkt = pyscarp._core.wkt_of(crs)
        own, other = geo.ground_at(m, wkt, (9, 9), 4, 4), geo._ground_by_pyproj(m, wkt, 4, 4)
        assert np.allclose(own.cell, other.cell, rtol=1e-6)
        assert abs(own.grid_north - other.grid_north) < 1e-5


@needs_files
def test_units_scales_and_holes_come_from_the_attributes():
    heights = np.array([[1000, 2000], [-1, 3000]], np.int16)
    feet = Terrain(data_array(heights, units="ft", _FillValue=-1, scale_factor=0.1, add_offset=10.0))
    assert np.allclose(feet.range, [110 * 0.3048, 310 * 0.3048]) and np.isnan(feet.heights_at(0, 0))
    assert Terrain(data_array(heights), unit="m", nodata=-1).range == (1000, 3000)
    with pytest.raises(Error, match="'K' is not a unit"):
        Terrain(data_array(heights, units="K"))


@needs_files
@pytest.mark.parametrize(
    "change, message",
    [
        (lambda d: d.transpose(), "rows first"),
        (lambda d: d[:, ::-1], "decreases"),
        (lambda d: d.assign_coords(x=d.x + (d.x > 500_100)), "evenly spaced"),
        (lambda d: d.expand_dims(band=2), "two"),
    ],
)
def test_refuses_other_data_arrays_with_the_remedy(change, message):
    with pytest.raises(Error, match=message):
        Terrain(change(data_array(hills(9, 9))))


def test_lazy_data_arrays_are_loaded_by_the_caller():
    dask = pytest.importorskip("dask.array")
    data = xarray.DataArray(dask.zeros((9, 9), dtype=np.float32), dims=("y", "x"))
    with pytest.raises(TypeError, match="load"):
        Terrain(data, cell=1)
    assert Terrain(data, cell=1, copy=True).shape == (9, 9)


@needs_files
def test_unknown_coordinate_systems():
    with pytest.raises(Error, match="EPSG:99999"):
        Terrain(hills(9, 9), crs="EPSG:99999", transform=(1, 0, 0, 0, -1, 0))
    with pytest.raises(TypeError, match="CRS"):
        Terrain(hills(9, 9), crs=3.5, transform=(1, 0, 0, 0, -1, 0))


@pytest.fixture
def dem(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    path = tmp_path / "dem.tif"
    heights = hills(60, 70).astype(np.int16)
    heights[30, 40] = -9999
    with rasterio.open(
        path,
        "w",
        driver="GTiff",
        width=70,
        height=60,
        count=1,
        dtype="int16",
        crs="EPSG:32633",
        transform=rasterio.Affine(30, 0, 300_000, 0, -30, 5_100_000),
        nodata=-9999,
    ) as file:
        file.write(heights, 1)
    return path


def command(program, *arguments):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@needs_files
def test_opens_files(dem, tmp_path):
    terrain = Terrain.open(dem)
    import rasterio

    with rasterio.open(dem) as file:
        heights, transform = file.read(1), file.transform
    assert np.array_equal(terrain.heights, heights) and not terrain.heights.flags.writeable
    assert terrain.transform == tuple(transform)[:6]
    over = Terrain(heights, crs="EPSG:32633", transform=transform, nodata=-9999)
    assert np.allclose(over.cell, terrain.cell, rtol=1e-12) and np.isclose(over.grid_north, terrain.grid_north)
    assert np.array_equal(pyscarp.viewshed(over, (301_000, 5_099_000)), pyscarp.viewshed(terrain, (301_000, 5_099_000)))
    terrain.edit(500, rows=slice(3, 5), cols=slice(3, 5))
    assert terrain.heights[3, 3] == 500 and terrain.range[1] == 500
    assert Terrain.open(dem, window=(5, 6, 7, 8)).shape == (8, 7)
    with pytest.raises(Error, match="none.tif"):
        Terrain.open(tmp_path / "none.tif")


@needs_files
def test_maps_equal_those_of_the_command_line(dem, tmp_path, scarp_program):
    import rasterio

    def written(*arguments):
        command(scarp_program, *arguments, "-o", tmp_path / "map.tif")
        with rasterio.open(tmp_path / "map.tif") as file:
            return file.read()

    rioxarray = pytest.importorskip("rioxarray")
    data = rioxarray.open_rasterio(dem)
    place = ("--observer", "301000,5099000,5")
    for terrain in Terrain.open(dem), data:
        as_array = lambda result: np.asarray(result)
        assert np.array_equal(
            as_array(pyscarp.viewshed(terrain, (301_000, 5_099_000, 5))), written("viewshed", dem, *place)[0]
        )
        angle = as_array(pyscarp.viewshed(terrain, (301_000, 5_099_000, 5), mode="angle"))
        assert np.array_equal(np.nan_to_num(angle, nan=-9999), written("viewshed", dem, *place, "--mode", "angle")[0])
        assert np.array_equal(
            as_array(pyscarp.shadow(terrain, (135, 20))), written("shadow", dem, "--sun", "135,20")[0]
        )
        assert np.array_equal(
            np.nan_to_num(as_array(pyscarp.horizon(terrain, 4)), nan=-9999), written("horizon", dem, "--azimuths", 4)
        )
        assert np.array_equal(
            np.nan_to_num(as_array(pyscarp.sky_view(terrain, azimuths=8)), nan=-9999),
            written("skyview", dem, "--azimuths", 8)[0],
        )
        hours = as_array(pyscarp.sun_hours(terrain, "2026-06-21", step=60))
        assert np.array_equal(
            np.nan_to_num(hours, nan=-9999), written("sunhours", dem, "--date", "2026-06-21", "--step", 60)[0]
        )


@needs_files
def test_suns_equal_those_of_the_command_line(dem, tmp_path, scarp_program):
    rasterio = pytest.importorskip("rasterio")

    def written(*arguments):
        command(scarp_program, *arguments, "-o", tmp_path / "map.tif")
        with rasterio.open(tmp_path / "map.tif") as file:
            return file.read()

    terrain = Terrain.open(dem)
    date = ("sunhours", dem, "--date", "2026-03-21", "--step", 60)
    maps = pyscarp.sun_hours(terrain, "2026-03-21", step=60, first_last=True, energy=True, linke=5, albedo=0.4)
    bands = np.nan_to_num(
        [maps.hours, maps.energy, maps.beam, maps.diffuse, maps.reflected, maps.first, maps.last], nan=-9999
    )
    assert np.array_equal(bands, written(*date, "--first-last", "--energy", "--linke", 5, "--albedo", 0.4))
    assert maps.energy.dtype == maps.first.dtype == np.float32 and np.nanmin(maps.first) < np.nanmax(maps.first)
    clear = pyscarp.sun_hours(terrain, "2026-03-21", step=60, energy=True, transmittance=0.65)
    assert clear.first is None
    assert np.array_equal(
        np.nan_to_num(clear.energy, nan=-9999), written(*date, "--energy", "--transmittance", 0.65)[1]
    )
    times, masks = pyscarp.sun_masks(terrain, "2026-03-21", step=60)
    assert np.array_equal(masks, written(*date, "--masks")) and times.dtype.kind == "M" and len(times) == len(masks)

    per_cell = ("shadow", dem, "--sun-per-cell")
    noon = "2026-12-21T09:00Z"
    assert np.array_equal(pyscarp.shadow(terrain, time=noon, sun_per_cell=True), written(*per_cell, "--time", noon)[0])
    shares = pyscarp.shadow(terrain, (135, 20), sun_per_cell=True, fraction=True)
    assert np.array_equal(np.nan_to_num(shares, nan=-1), written(*per_cell, "--sun", "135,20", "--fraction")[0])
    with pytest.raises(Error, match="below the horizon"):
        pyscarp.shadow(terrain, time="2026-12-21T00:00Z", sun_per_cell=True)
    with pytest.raises(Error, match="needs a CRS"):
        pyscarp.shadow(Terrain(hills(9, 9), cell=1), (135, 20), sun_per_cell=True)


def test_coordinates_in_float32_are_even_enough():
    # A second of arc at 10 degrees east.
    x, y = (np.float32(10) + np.arange(60) / 3600).astype(np.float32), (45 - np.arange(50) / 3600).astype(np.float32)
    data = xarray.DataArray(hills(50, 60), dims=("lat", "lon"), coords={"lat": y, "lon": x})
    assert np.allclose(Terrain(data).cell, (21.9, 30.9), rtol=0.01) if HAS_FILES else Terrain(data, cell=30)


def test_units_of_coordinates_count():
    def of(units, step):
        data = data_array(hills(20, 30), 10, 45, step, crs=None)
        for name in ("x", "y"):
            data.coords[name].attrs["units"] = units
        return data

    if HAS_FILES:
        assert np.allclose(Terrain(of("degrees_east", 1 / 3600)).cell, (21.9, 30.9), rtol=0.01)
    assert Terrain(of("m", 30)).cell == (30, 30)
    with pytest.raises(Error, match="coordinates in km"):
        Terrain(of("km", 0.03))
    assert Terrain(of("km", 0.03), cell=30).cell == (30, 30)


FEET = "EPSG:2227"  # NAD83 / California zone 3 (ftUS)
US_FOOT = 1200 / 3937


def with_units(data, units):
    for name in data.dims:
        data.coords[name].attrs["units"] = units
    return data


@pytest.mark.parametrize("has_files", [True, False])
@pytest.mark.parametrize(
    "crs, step, unit, metres, other",
    [
        (FEET, 100, "US_survey_foot", 100 * US_FOOT, "metre"),
        (FEET, 100, "ft", 100 * US_FOOT, "km"),
        ("+proj=utm +zone=32 +units=km +type=crs", 0.03, "km", 30, "m"),
        ("EPSG:32632", 30, "m", 30, "km"),
        ("EPSG:32632", 30, "metre", 30, "degrees_east"),
        ("EPSG:32632", 30, "meters", 30, "pixel"),
    ],
)
def test_coordinates_are_in_the_unit_of_the_crs(crs, step, unit, metres, other, has_files, monkeypatch):
    if not has_files:
        pytest.importorskip("pyproj")
        monkeypatch.setattr(pyscarp._core, "HAS_FILES", False)
    elif not HAS_FILES:
        pytest.skip("this build reads no files")
    x0, y0 = (6_000_000, 2_100_000) if crs == FEET else (500, 5_200) if "km" in crs else (500_000, 5_200_000)
    data = data_array(hills(20, 30), x0, y0, step, crs=None)
    plain = Terrain(data, crs=crs)
    # The scale of both projections is within 0.05 % of 1 there.
    assert np.allclose(plain.cell, metres, rtol=5e-4)
    assert Terrain(with_units(data, unit), crs=crs).cell == plain.cell
    with pytest.raises(Error, match=f"coordinates in {other}, but their CRS has "):
        Terrain(with_units(data, other), crs=crs)
    with pytest.raises(Error, match="coordinates in m, but their CRS has degrees"):
        Terrain(with_units(data_array(hills(9, 9), 9, 45, 0.001, crs=None), "m"), crs="EPSG:4326")


@pytest.mark.parametrize("has_files", [True, False])
def test_heights_are_in_the_unit_of_the_vertical_crs(has_files, monkeypatch):
    if not has_files:
        pytest.importorskip("pyproj")
        monkeypatch.setattr(pyscarp._core, "HAS_FILES", False)
    elif not HAS_FILES:
        pytest.skip("this build reads no files")
    heights, place = np.full((3, 3), 1000, np.int16), dict(transform=(100, 0, 6_000_000, 0, -100, 2_100_000))
    top = lambda crs, **settings: Terrain(heights, crs=crs, **place, **settings).range[1]
    # NAVD88 in US survey feet, in metres, and no vertical CRS.
    assert np.isclose(top(f"{FEET}+6360"), 1000 * US_FOOT, rtol=1e-12)
    assert top(f"{FEET}+5703") == 1000 and top(FEET) == 1000
    assert top(f"{FEET}+6360", unit="m") == 1000
    data = data_array(heights, 6_000_000, 2_100_000, 100, crs=None, units="m")
    assert Terrain(data, crs=f"{FEET}+6360").range[1] == 1000
    del data.attrs["units"]
    assert np.isclose(Terrain(data, crs=f"{FEET}+6360").range[1], 1000 * US_FOOT, rtol=1e-12)


@needs_files
def test_vertical_units_are_those_of_the_command_line(tmp_path, scarp_program):
    rasterio = pytest.importorskip("rasterio")
    with rasterio.open(
        tmp_path / "feet.tif", "w", driver="GTiff", width=3, height=3, count=1, dtype="int16", crs=f"{FEET}+6360",
        transform=rasterio.Affine(100, 0, 6_000_000, 0, -100, 2_100_000),
    ) as file:
        file.write(np.full((3, 3), 1000, np.int16), 1)
        transform, crs = file.transform, file.crs
    opened = Terrain.open(tmp_path / "feet.tif")
    array = Terrain(np.full((3, 3), 1000, np.int16), crs=crs, transform=transform)
    # WKT has 15 digits.
    assert np.allclose([opened.range[1], array.range[1]], 1000 * US_FOOT, rtol=1e-14)


def test_units_of_heights_are_those_of_the_command_line():
    for unit in "m", "ft", "us-ft", "US survey foot", "km", "dm", "cm", "mm", "yd", "fathom", "Metre":
        low, high = Terrain(np.array([[0, 1], [2, 3]], np.float32), cell=1, unit=unit).range
        assert low == 0 and high > 0
    assert Terrain(np.array([[0, 1], [2, 3]], np.float32), cell=1, unit="fathom").range[1] == 3 * 6 * 0.3048
    for unit in "K", "m2", "1/3 ft":
        with pytest.raises(Error, match="is not a unit of heights"):
            Terrain(np.zeros((2, 2), np.float32), cell=1, unit=unit)


def test_lengths_need_a_unit():
    heights, transform = hills(9, 9), (30, 0, 500_000, 0, -30, 5_200_000)
    with pytest.raises(Error, match=r"cell: the unit of the transform .* without a CRS \(give crs, or cell=30"):
        Terrain(heights, transform=transform)
    with pytest.raises(Error, match="without a CRS"):
        Terrain(data_array(heights, crs=None))
    with pytest.raises(Error, match=r"cell: .*: a CRS does not say it \(give transform, or cell=30"):
        Terrain(heights, crs="EPSG:32632")
    assert Terrain(heights, transform=transform, cell=30).to_local(500_015, 5_199_985 - 240)[0] == 0
    if HAS_FILES:
        assert "UTM" in Terrain(heights, crs="EPSG:32632", cell=30).crs


@needs_files
def test_transforms_from_south_give_the_same_maps():
    heights = hills(20, 30)
    north = Terrain(heights, crs="EPSG:32632", transform=(30, 0, 500_000, 0, -30, 5_200_000))
    south = Terrain(heights[::-1].copy(), crs="EPSG:32632", transform=(30, 0, 500_000, 0, 30, 5_200_000 - 20 * 30))
    assert south.transform == north.transform and south.cell == north.cell
    assert np.array_equal(south.heights, heights)
    place = (500_315, 5_199_585)
    assert np.array_equal(south.to_local(*place), north.to_local(*place))
    for call in (
        lambda t: pyscarp.viewshed(t, place),
        lambda t: pyscarp.shadow(t, (135, 20)),
        lambda t: pyscarp.horizon(t, 4),
    ):
        assert np.array_equal(call(south)[..., ::-1, :], call(north)) and not np.array_equal(call(south), call(north))
    south.edit(900, rows=slice(0, 1))
    assert (south.heights[-1] == 900).all()
    with pytest.raises(Error, match="south_up: False contradicts"):
        Terrain(heights, cell=30, south_up=False, transform=(30, 0, 0, 0, 30, 0))


@needs_files
def test_horizons_at_a_place_have_its_cells_and_north(tmp_path):
    # 8 degrees of latitude: cells at the north are far narrower than at the centre.
    heights = np.zeros((81, 81), np.float32)
    heights[:, 45] = 3000
    terrain = Terrain(
        xarray.DataArray(
            heights, dims=("lat", "lon"), coords={"lat": 60 - 0.1 * np.arange(81), "lon": 10 + 0.1 * np.arange(81)}
        )
    )
    for row in (5, 75):
        lat = 60 - 0.1 * row
        _, elevation = pyscarp.horizon(terrain, [90], at=(14.3, lat), coords="lonlat", max_distance=30_000, cc=0)
        # Two columns away, on the ellipsoid's parallel.
        a, f = 6378137, 1 / 298.257223563
        e2 = f * (2 - f)
        radius = a * np.cos(np.radians(lat)) / np.sqrt(1 - e2 * np.sin(np.radians(lat)) ** 2)
        assert np.isclose(elevation[0], np.degrees(np.arctan(3000 / (radius * np.radians(0.2)))), rtol=1e-4)


@needs_files
def test_lines_read_only_the_samples_beside_them():
    # Each line has its own lengths of cells. A pass over all samples would find the infinite one.
    heights = hills(60, 70)
    terrain = Terrain(data_array(heights, x0=300_000))
    ends = (300_030, 5_199_900), (300_900, 5_199_700)
    before, profile = pyscarp.line_of_sight(terrain, *ends), pyscarp.profile(terrain, *ends)
    horizon = pyscarp.horizon(terrain, [270], at=ends[0])[1]
    heights[59, 69] = np.inf
    assert np.array_equal(pyscarp.horizon(terrain, [270], at=ends[0])[1], horizon)
    assert pyscarp.line_of_sight(terrain, *ends) == before
    assert np.array_equal(pyscarp.profile(terrain, *ends).distance, profile.distance)
    # The lengths are those of the line, not of the terrain's centre: 2 km north, the scale differs.
    assert abs(profile.distance[-1] / np.hypot(870, 200) - terrain.cell[0] / 30) > 1e-9


@needs_files
def test_a_given_north_counts_everywhere():
    data = data_array(hills(60, 60), x0=300_000)
    terrain = Terrain(data, grid_north=30)
    place = terrain.to_map(*terrain.to_local(300_900, 5_199_100))
    at = pyscarp.horizon(terrain, [75], at=place)[1][0]
    plain = Terrain(np.asarray(data.values), cell=terrain.cell, grid_north=30)
    assert np.isclose(at, pyscarp.horizon(plain, [75], at=terrain.to_local(*place), coords="local")[1][0], rtol=1e-4)


@needs_files
def test_border_samples_are_inside():
    rng = np.random.default_rng(1)
    for _ in range(40):
        x0, y0, step = rng.uniform(3e5, 7e5), rng.uniform(4e6, 6e6), rng.uniform(1, 90)
        terrain = Terrain(data_array(hills(20, 30), x0, y0, step))
        corners = [terrain.to_map(c * terrain.cell[0], r * terrain.cell[1]) for c in (0, 29) for r in (0, 19)]
        for corner in corners:
            other = corners[0] if corner != corners[0] else corners[1]
            assert pyscarp.line_of_sight(terrain, corner, other) is not None


def test_horizons_outside_are_refused_before_their_plane():
    transform = (10, 0, 500000, 0, -10, 5000000)
    terrain = Terrain(hills(30, 40), crs="EPSG:32633", transform=transform)
    for at in [(0, 0), (499990, 4999900), (500100, 5000020)]:
        with pytest.raises(Error, match="is outside the terrain or over a hole"):
            pyscarp.horizon(terrain, 4, at=at)
