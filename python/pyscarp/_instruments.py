# SPDX-License-Identifier: MIT
"""Cameras and scanners: rays of one eye, traced in one call by `Terrain.cast_from`."""

from __future__ import annotations

import dataclasses
import math
from typing import Sequence

import numpy as np


@dataclasses.dataclass
class Camera:
    """A perspective camera with square pixels. Directions have length 1 along ``forward``: t is the depth in metres.

    >>> Camera((0, 0, 100), forward=(0, 1, 0), columns=4, rows=2).directions().shape
    (2, 4, 3)
    """

    eye: Sequence[float]  #: metres: x east, y north, z up
    forward: Sequence[float] = (0.0, 1.0, 0.0)  #: of any length
    up: Sequence[float] = (0.0, 0.0, 1.0)  #: not along ``forward``
    columns: int = 640  #: pixels
    rows: int = 480  #: pixels
    fov: float = 60.0  #: horizontal angle of view, degrees, above 0 and below 180
    t_min: float = 0.0  #: metres
    t_max: float = math.inf  #: metres

    def directions(self) -> np.ndarray:
        """Directions of all pixels, float64 ``(rows, columns, 3)``."""
        forward = np.asarray(self.forward, float) / np.linalg.norm(self.forward)
        right = np.cross(forward, np.asarray(self.up, float))
        right /= np.linalg.norm(right)
        up = np.cross(right, forward)
        half = math.tan(math.radians(self.fov) / 2)
        pixel = 2 * half / self.columns
        x = (np.arange(self.columns) + 0.5) * pixel - half
        y = (self.rows / 2 - (np.arange(self.rows) + 0.5)) * pixel
        return forward + x[None, :, None] * right + y[:, None, None] * up


@dataclasses.dataclass
class Scanner:
    """A scanner that turns about the vertical. Directions have length 1: t is the range in metres.

    >>> Scanner((0, 0, 2), elevations=[-5, 0, 5], columns=360).directions().shape
    (3, 360, 3)
    """

    eye: Sequence[float]  #: metres: x east, y north, z up
    elevations: Sequence[float] = (0.0,)  #: of the rows, degrees above the horizon; faster if they rise or fall
    columns: int = 360  #: azimuths
    first_azimuth: float = 0.0  #: degrees from north (y), clockwise
    #: degrees between columns; None: 360 / columns
    azimuth_step: float | None = None
    t_min: float = 0.0  #: metres
    t_max: float = math.inf  #: metres

    @property
    def step(self) -> float:
        """Degrees between columns."""
        return 360 / self.columns if self.azimuth_step is None else self.azimuth_step

    def directions(self) -> np.ndarray:
        """Directions of all rays, float64 ``(rows, columns, 3)``."""
        azimuth = np.radians(self.first_azimuth + self.step * np.arange(self.columns))[None, :]
        elevation = np.radians(np.asarray(self.elevations, float))[:, None]
        level = np.cos(elevation)
        return np.stack(
            [level * np.sin(azimuth), level * np.cos(azimuth), np.sin(elevation) + np.zeros_like(azimuth)], axis=-1
        )
