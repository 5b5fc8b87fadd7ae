# SPDX-License-Identifier: MIT
"""Every kind of call, and wrong ones, a few times: leak_test.py looks for what is left. ``keep``: leaks a map."""

import ctypes
import gc
import sys

import numpy as np

import pyscarp

Y, X = np.mgrid[0:60, 0:80]


def new_terrain():
    return pyscarp.Terrain((140 + 60 * np.sin(X / 9) + 60 * np.cos(Y / 7)).astype(np.float32), cell=10)


def rays():
    terrain = new_terrain()
    hits = terrain.cast([[5, 5, 900.0]] * 100, [0, 0, -1])
    terrain.occluded([[5, 5, 900.0]] * 100, [0, 0, 1], start=hits)
    terrain.all_hits([0, 5, 100], [1, 0, 0])
    terrain.heights_at([1, 2], [3, 4])
    terrain.cast_from(pyscarp.Scanner((10, 10, 400), elevations=[-45, 45], columns=8))
    terrain.edit(5, rows=slice(0, 2))
    voxels = pyscarp.Voxels(np.ones((4, 4, 4), np.uint8), side=2)
    scene = pyscarp.Scene([terrain, pyscarp.Part(voxels, origin=(1, 2, 500))])
    scene.cast((2, 3, 900), (0, 0, -1))
    voxels.edit(sphere=((1, 1, 1), 1))
    pyscarp.png(pyscarp.render(scene, (16, 9)))


def maps():
    terrain = new_terrain()
    for mode in "visible", "count", "ground", "angle":
        pyscarp.viewshed(terrain, [(100, 100), (200, 200)], mode=mode, rows=slice(3, 40))
    pyscarp.line_of_sight(terrain, (0, 0), (300, 300))
    pyscarp.profile(terrain, (0, 0), (300, 300))
    pyscarp.shadow(terrain, (135, 20))
    pyscarp.shadow(terrain, (135, 20), fraction=True)
    pyscarp.horizon(terrain, 4, distance=True)
    pyscarp.horizon(terrain, 4, at=(100, 100))
    pyscarp.sky_view(terrain, azimuths=4)
    if pyscarp._core.HAS_SUN:
        pyscarp.sun_hours(terrain, "2026-06-21", place=(7, 46), step=240, energy=True)
        pyscarp.sun_masks(terrain, "2026-06-21", place=(7, 46), step=240)


def errors():
    terrain = new_terrain()
    for wrong in (
        lambda: terrain.cast([np.nan, 0, 0], [0, 0, 1]),
        lambda: terrain.heights_at([1, 2], [1, 2, 3]),
        lambda: terrain.edit(np.inf),
        lambda: pyscarp.viewshed(terrain, (99999, 0)),
        lambda: pyscarp.Terrain(np.zeros((2, 2)), cell=1),
        lambda: pyscarp.horizon(terrain, 3000, progress=lambda fraction: False),
    ):
        try:
            wrong()
        except (pyscarp.Error, TypeError):
            continue
        raise AssertionError


if __name__ == "__main__":
    if "keep" in sys.argv:
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(pyscarp.shadow(new_terrain(), (135, 20))))
    else:
        for _ in range(3):
            rays()
            maps()
            errors()
            gc.collect()
    print("done")
