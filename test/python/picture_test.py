# SPDX-License-Identifier: MIT
"""Pictures: the pixels of the command line, PNG, errors."""

import struct
import subprocess
import zlib

import numpy as np
import pytest
from conftest import hills

import pyscarp
from pyscarp import Error


def decoded(data):
    """Pixels of a PNG without filters."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    chunks, at = {}, 8
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        assert struct.unpack(">I", data[at + 8 + length : at + 12 + length])[0] == zlib.crc32(name + body)
        chunks[name] = body
        at += 12 + length
    width, height, bits, colour = struct.unpack(">IIBB", chunks[b"IHDR"][:10])
    channels = {0: 1, 2: 3, 6: 4}[colour]
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(height, 1 + width * channels)
    assert bits == 8 and (rows[:, 0] == 0).all()
    return rows[:, 1:].reshape(height, width, channels)


@pytest.mark.parametrize("channels", [None, 3, 4])
def test_png_holds_the_pixels(channels):
    shape = (5, 7) if channels is None else (5, 7, channels)
    picture = np.random.default_rng(1).integers(0, 256, shape).astype(np.uint8)
    assert np.array_equal(decoded(pyscarp.png(picture)).reshape(shape), picture)


def test_pictures_are_those_of_the_command_line(ground, tmp_path, scarp_program):
    rasterio = pytest.importorskip("rasterio")
    np.save(tmp_path / "dem.npy", ground.heights)
    ten_metres = pyscarp.Terrain(ground.heights, cell=1)  # a file without georeference has cells of 1 m
    for settings, options in (
        ({}, []),
        (
            {"view": (40, 60), "sun": (120, 20), "haze": 0.3, "ramp": "viridis"},
            ["--view", "40,60", "--sun", "120,20", "--haze", "0.3", "--ramp", "viridis"],
        ),
        ({"look": "hillshade", "top": True}, ["--look", "hillshade", "--top"]),
    ):
        done = subprocess.run(
            [scarp_program, "render", tmp_path / "dem.npy", "--size", "160x90", "-o", tmp_path / "dem.png", *options],
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr
        with rasterio.open(tmp_path / "dem.png") as file:
            wanted = file.read()[:3].transpose(1, 2, 0)
        assert np.array_equal(pyscarp.render(ten_metres, (160, 90), **settings), wanted), settings


def test_notebooks_show_what_there_is_to_see(ground):
    voxels = pyscarp.Voxels(np.ones((4, 4, 4), np.uint8), palette=[(0, 0, 0), (255, 0, 0)])
    for scene, colours in (ground, 100), (voxels, 2), (pyscarp.Scene([ground, voxels]), 100):
        picture = decoded(scene._repr_png_())
        assert picture.shape == (360, 640, 3) and len(np.unique(picture.reshape(-1, 3), axis=0)) > colours
    for heights in np.full((5, 5), np.nan, np.float32), np.zeros((1, 5), np.float32):
        assert pyscarp.Terrain(heights, cell=1)._repr_png_() is None
    assert pyscarp.Voxels(np.zeros((2, 2, 2), np.uint8))._repr_png_() is None


def test_renders_scenes_and_alpha(ground):
    voxels = pyscarp.Voxels(np.ones((4, 4, 4), np.uint8), palette=[(0, 0, 0), (255, 0, 0)])
    red = pyscarp.render(voxels, (64, 64))
    assert red[32, 32, 0] > 50 and red[32, 32, 1:].max() == 0
    assert pyscarp.render(pyscarp.Scene([ground, voxels]), (40, 30)).shape == (30, 40, 3)
    opacity = pyscarp.render(ground, (64, 36), alpha=True)
    assert opacity.shape == (36, 64, 4) and opacity[0, 0, 3] == 0 and opacity[18, 32, 3] == 255
    near = pyscarp.render(ground, (64, 36), eye=(400, 300, 2000), target=(400, 301, 0), fov=10, alpha=True)
    assert (near[..., 3] == 255).all()


@pytest.mark.parametrize(
    "settings, message",
    [
        ({"size": (0, 9)}, "width"),
        ({"look": "pretty"}, "shaded"),
        ({"sun": (0, 99)}, "sun"),
        ({"fov": 0}, "view|fov|angle"),
        ({"haze": 2}, "haze"),
        ({"aa": 99}, "aa"),
        ({"ramp": "rainbow"}, "viridis"),
        ({"sky": "blue"}, "scattering"),
        ({"eye": (0, 0, 0), "target": (0, 0, 0)}, "eye"),
        ({"view": (0, 120)}, "elevation|view"),
    ],
)
def test_names_settings_out_of_range(ground, settings, message):
    with pytest.raises(Error, match=message):
        pyscarp.render(ground, **{"size": (16, 9), **settings})


def test_refuses_other_arrays_as_png(tmp_path):
    for array in np.zeros((2, 2)), np.zeros((2, 2, 2), np.uint8), np.zeros((0, 2, 3), np.uint8):
        with pytest.raises(Error, match="png"):
            pyscarp.png(array)
    with pytest.raises(OSError):
        pyscarp.write_png(tmp_path / "none" / "a.png", np.zeros((2, 2, 3), np.uint8))
