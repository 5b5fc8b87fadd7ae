# SPDX-License-Identifier: MIT
"""Answers of ray queries as arrays."""

from __future__ import annotations

import enum
from typing import Any, Tuple, Union

import numpy as np

from . import _core

_FORMATS = {
    "status": "u1",
    "wall": "?",
    "face": "u1",
    "object": "u4",
    "t": "f8",
    "cell": ("i4", (2,)),
    "u": "f8",
    "v": "f8",
    "height": "f8",
    "voxel": ("i4", (3,)),
    "part": "u4",
}
_HIT = np.dtype(
    {
        "names": list(_FORMATS),
        "formats": list(_FORMATS.values()),
        "offsets": [_core.HIT_OFFSETS[name] for name in _FORMATS],
        "itemsize": _core.HIT_BYTES,
    }
)

Shape = Union[int, Tuple[int, ...]]


class Status(enum.IntEnum):
    """Result of a ray."""

    MISS = 0
    HIT = 1
    #: The ray starts below the surface, or enters below it through the border, and hits nothing.
    BELOW = 2
    #: The march reached its step limit: unknown beyond ``t``.
    EXHAUSTED = 3


class Hits:
    """Closest hits of a batch of rays, one per ray. Arrays have the shape of the batch, ``(...)``.

    ``Hits(shape)`` makes room for a batch, for ``cast(..., out=hits)``: no memory is allocated in such a call. With
    ``normal=False`` it has no normals, with ``position=False`` no positions, and they are not computed.

    >>> Hits((2, 3)).t.shape
    (2, 3)
    """

    __slots__ = ("_raw", "_scene", "position", "normal")

    #: float64 ``(..., 3)``: points in metres (x east, y north, z up); NaN without a hit. None if not computed.
    position: np.ndarray | None
    #: float64 ``(..., 3)``: unit normals of the surface; 0 without a hit. None if not computed.
    normal: np.ndarray | None

    def __init__(self, shape: Shape, *, position: bool = True, normal: bool = True) -> None:
        shape = (shape,) if isinstance(shape, int) else tuple(shape)
        self._raw = np.zeros(shape, _HIT)
        self._raw["t"] = np.inf
        self._raw["cell"] = -1
        self._scene: object = None
        self.position = np.full(shape + (3,), np.nan) if position else None
        self.normal = np.zeros(shape + (3,)) if normal else None

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the batch."""
        return self._raw.shape

    def __len__(self) -> int:
        return len(self._raw)

    def _field(self, name: str) -> np.ndarray:
        view = self._raw[name]
        view.flags.writeable = False  # later rays may start on these hits
        return view

    @property
    def status(self) -> np.ndarray:
        """uint8 ``(...)``: a `Status` each."""
        return self._field("status")

    @property
    def hit(self) -> np.ndarray:
        """bool ``(...)``: whether the ray hits anything."""
        return self._raw["status"] == Status.HIT

    @property
    def t(self) -> np.ndarray:
        """float64 ``(...)``: distance in lengths of the ray's direction; infinity without a hit."""
        return self._field("t")

    @property
    def cell(self) -> np.ndarray:
        """int32 ``(..., 2)``: column and row of the cell of a terrain, rows from north; -1 without a hit."""
        return self._field("cell")

    @property
    def uv(self) -> np.ndarray:
        """float64 ``(..., 2)``: position in the cell towards the next column and row, 0 to 1."""
        return np.stack([self._raw["u"], self._raw["v"]], axis=-1)

    @property
    def object(self) -> np.ndarray:
        """uint32 ``(...)``: index of the part of the scene."""
        return self._field("object")

    @property
    def voxel(self) -> np.ndarray:
        """int32 ``(..., 3)``: x, y and z of the voxel; -1 for other hits."""
        return self._field("voxel")

    @property
    def face(self) -> np.ndarray:
        """uint8 ``(...)``: face of the voxel: low x, high x, low y, high y, low z, high z; 6: the ray starts in it."""
        return self._field("face")

    def __repr__(self) -> str:
        return f"<pyscarp.Hits of {self._raw.size} rays, {int(self.hit.sum())} hits>"


class AllHits(Hits):
    """All hits along rays, ordered by ray and ``t``.

    The hits of ray ``i`` (of the flattened batch) are ``slice(first[i], first[i + 1])``.
    """

    __slots__ = ("first",)

    #: int64 ``(rays + 1,)``
    first: np.ndarray

    def __init__(self, raw: np.ndarray, first: np.ndarray, origins: np.ndarray, directions: np.ndarray) -> None:
        self._raw = raw.view(_HIT)
        self._scene = None
        self.first = first
        ray = self.ray
        self.position = origins[ray] + self._raw["t"][:, None] * directions[ray]
        self.normal = None

    @property
    def ray(self) -> np.ndarray:
        """int64 ``(hits,)``: index of the ray of each hit."""
        return np.repeat(np.arange(len(self.first) - 1), np.diff(self.first))


class FanHits:
    """Answers to all rays of a `Camera` or `Scanner`. Arrays have the shape ``(rows, columns)``."""

    __slots__ = ("t", "status", "cell", "uv", "normal", "_instrument")

    #: float32: distance in lengths of the ray's direction (camera: depth, scanner: range, in metres); infinity: no hit.
    t: np.ndarray
    #: uint8: a `Status` each.
    status: np.ndarray
    #: int32 ``(rows, columns, 2)``: column and row of the cell, rows from north; -1 without a hit.
    cell: np.ndarray
    #: float32 ``(rows, columns, 2)``: position in the cell, 0 to 1.
    uv: np.ndarray
    #: float32 ``(rows, columns, 3)``: unit normals, 0 without a hit; None unless requested.
    normal: np.ndarray | None

    def __init__(self, arrays: list[np.ndarray], instrument: Any) -> None:
        self.t, self.status = arrays[0], arrays[1]
        self.cell = np.stack(arrays[2:4], axis=-1)
        self.uv = np.stack(arrays[4:6], axis=-1)
        self.normal = np.stack(arrays[6:9], axis=-1) if len(arrays) > 6 else None
        self._instrument = instrument

    @property
    def shape(self) -> tuple[int, ...]:
        """(rows, columns)"""
        return self.t.shape

    @property
    def hit(self) -> np.ndarray:
        """bool: whether the ray hits anything."""
        return self.status == Status.HIT

    @property
    def position(self) -> np.ndarray:
        """float64 ``(rows, columns, 3)``: points in metres, NaN without a hit. Computed by each access."""
        instrument = self._instrument
        t = np.where(self.hit, self.t.astype(float), np.nan)
        return np.asarray(instrument.eye, float) + t[..., None] * instrument.directions()

    def __repr__(self) -> str:
        return f"<pyscarp.FanHits {self.shape[0]} x {self.shape[1]}, {int(self.hit.sum())} hits>"
