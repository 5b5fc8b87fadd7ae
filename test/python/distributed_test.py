# SPDX-License-Identifier: MIT
"""Maps in parts on clusters of one and four processes, of which some die."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from conftest import hills

import pyscarp
from pyscarp import Error, Terrain


def test_missing_modules_have_one_line():
    for module in "dask", "distributed":
        done = subprocess.run(
            [
                sys.executable,
                "-c",
                f"import sys; sys.modules[{module!r}] = None\nimport pyscarp\n"
                "try:\n    import pyscarp.distributed\nexcept ImportError as error:\n"
                "    assert isinstance(error, pyscarp.Error); print(error)",
            ],
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0 and done.stdout.count("\n") == 1, done.stderr
        assert f"needs the module {module}" in done.stdout and "python3-distributed" in done.stdout


@pytest.fixture(scope="module", params=[1, 4])
def client(request):
    distributed = pytest.importorskip("distributed", reason="Dask is not installed (python3-distributed)")
    with distributed.LocalCluster(
        n_workers=request.param, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster, distributed.Client(cluster) as client:
        yield client


@pytest.fixture
def parted(client):
    import pyscarp.distributed

    return pyscarp.distributed


OBSERVERS = [(100, 100), (300, 250), (400, 60)]
SUNS = [(100, 15, 1), (180, 35, 2)]
MAPS = {
    "viewshed": lambda of, t, **k: of.viewshed(t, OBSERVERS, **k),
    "count": lambda of, t, **k: of.viewshed(t, OBSERVERS, mode="count", max_distance=300, **k),
    "ground": lambda of, t, **k: of.viewshed(t, OBSERVERS, mode="ground", **k),
    "shadow": lambda of, t, **k: of.shadow(t, (135, 10), **k),
    "horizon": lambda of, t, **k: of.horizon(t, 4, **k),
    "sky_view": lambda of, t, **k: of.sky_view(t, "negative-openness", azimuths=6, **k),
    "sun_hours": lambda of, t, **k: of.sun_hours(t, suns=SUNS, **k),
}


def field():
    heights = hills(61, 50)
    heights[20, 30] = np.nan
    return heights


@pytest.mark.parametrize("name", MAPS)
def test_maps_are_those_of_one_process(parted, name):
    terrain = Terrain(field(), cell=10, south_up=name == "shadow")
    whole = MAPS[name](pyscarp, terrain)
    lazy = MAPS[name](parted, terrain, parts=7)
    assert lazy.shape == whole.shape and lazy.dtype == whole.dtype
    assert lazy.chunks[-2] == (8, 9, 9, 8, 9, 9, 9)  # as --part I/7
    assert lazy.compute().tobytes() == whole.tobytes()


def test_several_maps_and_data_arrays(parted):
    xarray = pytest.importorskip("xarray")
    data = xarray.DataArray(
        field(), dims=("y", "x"), coords={"y": 10.0 * np.arange(61)[::-1], "x": 10.0 * np.arange(50)}
    )
    terrain = Terrain(data, cell=10)
    angles, metres = parted.horizon(terrain, [90, 135], distance=True, parts=3)
    whole = pyscarp.horizon(terrain, [90, 135], distance=True)
    assert angles.identical(angles) and angles.compute().identical(whole[0]) and metres.compute().identical(whole[1])
    day = dict(date="2026-06-21", place=(7, 46), step=120, energy=True, first_last=True)
    if pyscarp._core.HAS_SUN:
        lazy, found = parted.sun_hours(terrain, parts=2, **day), pyscarp.sun_hours(terrain, **day)
        for name in "hours", "first", "energy", "reflected":
            assert getattr(lazy, name).compute().identical(getattr(found, name)), name


def kill_worker(client, has_work):
    """Kills a worker with work, as soon as there is one."""
    deadline = time.monotonic() + 30
    while not (busy := [worker for worker, keys in has_work().items() if keys]):
        assert time.monotonic() < deadline
        time.sleep(0.01)
    os.kill(client.run(os.getpid, workers=[busy[0]])[busy[0]], signal.SIGKILL)


def test_parts_of_dead_workers_are_computed_again(client, parted, tmp_path):
    import distributed

    terrain = given = Terrain(hills(300, 300), cell=10)
    if pyscarp._core.HAS_FILES and len(client.scheduler_info()["workers"]) > 1:
        np.save(tmp_path / "dem.npy", hills(300, 300))
        given, terrain = tmp_path / "dem.npy", Terrain.open(tmp_path / "dem.npy")
    lazy = parted.horizon(given, 40, parts=12).persist()
    kill_worker(client, client.processing)  # at work
    distributed.wait(lazy, timeout=60)
    kill_worker(client, client.has_what)  # with results
    assert lazy.compute().tobytes() == pyscarp.horizon(terrain, 40).tobytes()


def test_writes_zarr(parted, tmp_path):
    zarr = pytest.importorskip("zarr")
    terrain = Terrain(field(), cell=10)
    parted.shadow(terrain, (135, 10), parts=4).rechunk((16, 50)).to_zarr(str(tmp_path / "shade.zarr"))
    assert np.array_equal(zarr.open(str(tmp_path / "shade.zarr"))[:], pyscarp.shadow(terrain, (135, 10)))


@pytest.fixture
def dem(tmp_path):
    path = tmp_path / "dem.npy"
    np.save(path, field())
    return path


@pytest.mark.skipif(not pyscarp._core.HAS_FILES, reason="this build reads no files")
def test_workers_open_files(parted, dem):
    whole = pyscarp.shadow(Terrain.open(dem), (135, 10))
    assert parted.shadow(dem, (135, 10), parts=5).compute().tobytes() == whole.tobytes()
    with pytest.raises(Error, match="none.tif"):
        parted.shadow(dem.with_name("none.tif"), (135, 10))


def read(path):
    rasterio = pytest.importorskip("rasterio")
    with rasterio.open(path) as file:
        return file.read(), {k: v for k, v in file.tags().items()}


def test_the_command_line_in_parts(parted, dem, tmp_path, scarp_program):
    """The second part kills its worker at the first try."""
    whole, out, marker = tmp_path / "whole.tif", tmp_path / "shade.tif", tmp_path / "killed"
    words = ["shadow", str(dem), "--sun", "135,10"]
    subprocess.run([scarp_program, *words, "-o", whole], check=True, capture_output=True)
    murderous = tmp_path / "program"
    murderous.write_text(
        f'#!/bin/sh\ncase "$*" in *2/4*) [ -e {marker} ] || {{ touch {marker}; kill -9 $PPID; }} ;; esac\n'
        f'exec {scarp_program} "$@"\n'
    )
    murderous.chmod(0o755)
    assert parted.run(words, out, parts=4, program=str(murderous)) == str(out)
    assert marker.exists()
    (pixels, tags), (expected, expected_tags) = read(out), read(whole)
    assert pixels.tobytes() == expected.tobytes() and tags == expected_tags
    left = sorted(path.name for path in tmp_path.iterdir())
    assert left == ["dem.npy", "killed", "program", "shade.tif", "whole.tif"]


def test_errors_have_one_line(parted, dem, tmp_path, scarp_program):
    terrain = Terrain(field(), cell=10)
    hole = (300, 10 * (60 - 20))
    for call, message in (
        (lambda: parted.viewshed(terrain, (9999, 0)), "outside the terrain"),
        (lambda: parted.viewshed(terrain, hole, parts=2).compute(), "nodata"),
        (lambda: parted.shadow(terrain, (135, 10), parts=0), "1 to 61"),
        (lambda: parted.shadow(terrain, (135, 10), parts=62), "1 to 61"),
        (lambda: parted.shadow(terrain, (135, 10), rows=slice(0, 5)), "rows"),
        (lambda: parted.run(["shadow", dem], tmp_path / "o.tif", parts=2, program=scarp_program), "no sun"),
        (lambda: parted.run(["shadow", dem], tmp_path / "o.tif", parts=0), "parts"),
        (lambda: parted.run(["shadow"], tmp_path / "o.tif", program="/none/scarp"), "not installed"),
    ):
        with pytest.raises(Error, match=message) as caught:
            call()
        assert "\n" not in str(caught.value)
    assert not (tmp_path / "o.tif").exists()
