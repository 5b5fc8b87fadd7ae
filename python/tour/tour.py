# SPDX-License-Identifier: MIT
# %% [markdown]
# # A tour of pyscarp
#
# One elevation model, and the questions that people ask of terrain: what it looks like, what is visible from a tower,
# where the sun shines, what a scanner measures. Each answer is exact, and an array.
#
# The model is that of Debian's package `python-matplotlib-data`: the Jacksboro fault in Tennessee, 344 x 403 samples in
# degrees. The tour needs `pyscarp` and NumPy, and takes a few seconds.

# %%
import numpy as np
import pyscarp

path = "/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz"
elevation = np.load(path)["elevation"]  # int16, metres
west, south, east, north = -84.41375, 36.44625, -84.0779166667, 36.7329166667
rows, cols = elevation.shape
transform = ((east - west) / cols, 0, west, 0, -(north - south) / rows, north)

terrain = pyscarp.Terrain(elevation, crs="EPSG:4326", transform=transform, plane_error=1)
terrain

# %% [markdown]
# A terrain shows itself. Its heights are those of the array, not a copy. Degrees become metres on a plane, on which
# `plane_error` allows samples to be off by at most one cell.

# %%
np.shares_memory(terrain.heights, elevation)

# %% [markdown]
# ## Pictures
#
# `render` returns an array of colours. A small class shows arrays in a notebook.


# %%
class Picture:
    """Shows an array of uint8."""

    def __init__(self, array):
        self.array = np.ascontiguousarray(array)

    def _repr_png_(self):
        return pyscarp.png(self.array)


Picture(pyscarp.render(terrain, (800, 450), view=(195, 30), sun=(120, 12), samples=16))

# %% [markdown]
# ## The visible sky
#
# The share of the sky that each sample sees: dark in valleys. It serves as relief below the maps that follow.

# %%
sky = pyscarp.sky_view(terrain, azimuths=32)
low, high = np.quantile(sky, [0.01, 0.99])
relief = np.repeat((255 * np.clip((sky - low) / (high - low), 0, 1)).astype(np.uint8)[..., None], 3, axis=2)


def over_relief(mask, colour, share=0.6):
    """Colours the relief where the mask is true."""
    mixed = relief * (1 - share) + np.array(colour) * share
    return np.where(mask[..., None], mixed, relief).astype(np.uint8)


Picture(relief)

# %% [markdown]
# ## What a tower sees
#
# A tower of 30 m on a ridge, and all ground within 12 km of it. 1 is visible, 0 hidden, 255 out of range.

# %%
tower = (-84.275, 36.5667, 30)
visible = pyscarp.viewshed(terrain, tower, max_distance=12_000)
print(f"{(visible == 1).sum()} of {(visible != 255).sum()} samples are visible")
Picture(over_relief(visible == 1, (40, 200, 60)))

# %% [markdown]
# Three towers: the number of them that see each sample.

# %%
towers = [tower, (-84.2308, 36.485, 30), (-84.2042, 36.7233, 30)]
count = pyscarp.viewshed(terrain, towers, mode="count")
colours = np.array([(0, 0, 0), (70, 60, 160), (60, 170, 150), (250, 230, 60)])
Picture(np.where((count > 0)[..., None], relief * 0.4 + colours[count] * 0.6, relief).astype(np.uint8))

# %% [markdown]
# One line of sight: whether the target is visible, else by how much the ground is in the way.

# %%
seen = pyscarp.line_of_sight(terrain, tower, (-84.35, 36.65))
print("visible" if seen else f"hidden: {-seen.clearance:.0f} m are missing", f"over {seen.distance:.0f} m")

# %% [markdown]
# ## Shadows
#
# The sun of 9 o'clock on the shortest day. 0 is lit, 1 turned away from the sun, 2 in the shadow of other ground.

# %%
shade = pyscarp.shadow(terrain, time="2026-12-21T09:00-05:00", refraction=True)
print(f"{(shade == 0).mean():.0%} lit")
Picture(over_relief(shade > 0, (30, 40, 110)))

# %% [markdown]
# Hours of sun on that day, from violet (few) to yellow (most).

# %%
hours = pyscarp.sun_hours(terrain, "2026-12-21", step=30)
print(f"{hours.min():.1f} to {hours.max():.1f} hours")
ramp = np.array([(68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37)])
share = (hours - hours.min()) / (hours.max() - hours.min()) * (len(ramp) - 1)
mixed = np.stack([np.interp(share, range(len(ramp)), ramp[:, i]) for i in range(3)], axis=-1)
Picture(mixed.astype(np.uint8))

# %% [markdown]
# ## The skyline of a place
#
# Elevation of the horizon per azimuth, as pvlib takes it. North is in the middle of the picture below.

# %%
azimuths, elevations = pyscarp.horizon(terrain, 720, at=(-84.28, 36.62))
skyline = np.roll(elevations, 360)
level = np.linspace(30, -2, 160)[:, None]  # degrees, from top to bottom
Picture(np.where((level < skyline)[..., None], (70, 80, 60), (190, 215, 240)).astype(np.uint8))

# %% [markdown]
# ## Rays
#
# Rays and points are in metres: x east, y north, z up. A million rays from one point take a fraction of a second. Here, a
# scanner turns on a mast of 40 m, and its points are seen from above.

# %%
x, y = terrain.to_local(tower[0], tower[1])
mast = (x, y, float(terrain.heights_at(x, y)) + 40)
scan = terrain.cast_from(pyscarp.Scanner(mast, elevations=np.linspace(-40, 5, 256), columns=2048))
cloud = scan.position[scan.hit]
print(f"{len(cloud)} points")
near = cloud[np.hypot(cloud[:, 0] - x, cloud[:, 1] - y) < 3000]
dots = np.zeros((400, 400), np.uint8)
dots[(200 - (near[:, 1] - y) / 15).astype(int), (200 + (near[:, 0] - x) / 15).astype(int)] = 255
Picture(dots)

# %% [markdown]
# A camera measures depth. Near is bright, the sky black.

# %%
camera = pyscarp.Camera(mast, forward=(1, 0.3, -0.15), columns=640, rows=360, fov=50)
depth = terrain.cast_from(camera).t
Picture(np.where(np.isfinite(depth), 255 / (1 + depth / 2500), 0).astype(np.uint8))

# %% [markdown]
# ## Edits, voxels, scenes
#
# A quarry is dug, and a building of voxels stands on its rim. `Scene` combines both.

# %%
mine = pyscarp.Terrain(elevation.astype(np.float32), cell=90)
centre, radius = np.array([170, 200]), 14
distance = np.hypot(*(np.mgrid[0:rows, 0:cols] - centre[:, None, None]))
pit = np.where(distance < radius, mine.heights - 30 * (radius - distance), mine.heights)
mine.edit(pit)

tower_block = np.zeros((40, 12, 12), np.uint8)  # z, y, x
tower_block[:, 1:-1, 1:-1] = 1
tower_block[::4] = 2
block = pyscarp.Voxels(tower_block, side=20, palette=[(0, 0, 0), (200, 60, 40), (240, 230, 210)])
at = 90.0 * np.array([centre[1] + radius, rows - 1 - centre[0]])
scene = pyscarp.Scene([mine, pyscarp.Part(block, origin=(*at, float(mine.heights_at(*at))))])
eye, target = (at[0] + 1500, at[1] - 4500, 3000), (at[0] - 900, at[1], 300)
Picture(pyscarp.render(scene, (800, 450), eye=eye, target=target, sun=(80, 30)))

# %% [markdown]
# ## Where to go on
#
# - The guide, `doc/user/python.md`: all of this on DataArrays of xarray with their coordinates, threads, progress, errors.
# - `help(pyscarp.viewshed)`: shapes, units and an example of each function.
# - The same maps on the command line (`scarp viewshed --help`), and in QGIS (`doc/user/qgis.md`).
