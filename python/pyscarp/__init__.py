# SPDX-License-Identifier: MIT
"""Ray queries and maps on elevation models and voxels, exact and without copies of arrays.

    import numpy as np
    import pyscarp

    terrain = pyscarp.Terrain(heights, cell=30)         # float32, int16 or uint16, or a DataArray
    hits = terrain.cast(origins, directions)            # hits.t, .position, .cell, .normal, .status
    seen = pyscarp.viewshed(terrain, (500, 700))        # a map, as an array or a DataArray
    picture = pyscarp.render(terrain)

Space is in metres: x east and y north from the south-west sample, z up. Angles are in degrees, azimuths clockwise from
true north.
"""

from ._core import Error, Interrupted, __version__
from ._hits import AllHits, FanHits, Hits, Status
from ._instruments import Camera, Scanner
from ._picture import png, render, write_png
from ._scene import Part, Scene, Voxels
from ._sight import LineOfSight, Profile, line_of_sight, profile, viewshed
from ._sun import horizon, shadow, sky_view, sun_position
from ._sun_hours import SunMaps, sun_hours, sun_masks
from ._terrain import Terrain
from ._threads import set_threads

__all__ = [
    "AllHits",
    "Camera",
    "Error",
    "FanHits",
    "Hits",
    "Interrupted",
    "LineOfSight",
    "Part",
    "Profile",
    "Scanner",
    "Scene",
    "Status",
    "SunMaps",
    "Terrain",
    "Voxels",
    "__version__",
    "horizon",
    "line_of_sight",
    "png",
    "profile",
    "render",
    "set_threads",
    "shadow",
    "sky_view",
    "sun_hours",
    "sun_masks",
    "sun_position",
    "viewshed",
    "write_png",
]
