# SPDX-License-Identifier: MIT
"""Answers of ray queries as arrays."""

from __future__ import annotations

import enum
from typing import Any, Iterator, Tuple, Union

import numpy as np

from . import _core
from ._arguments import flag, shown, whole
from ._core import Error

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

    ``hits[index]`` has the hits of some rays, as NumPy indexes the axes of the batch: slices share memory, as NumPy's
    views. Iteration goes along the first axis. The truth value of one hit is whether the ray hits; that of several is
    an Error.

    >>> terrain = Terrain(np.full((3, 3), 5, np.float32), cell=10)
    >>> hits = terrain.cast([[7, 3, 100], [7, 300, 100], [9, 3, 50]], [0, 0, -1])
    >>> hits[hits.hit].t.tolist(), [bool(hit) for hit in hits]
    ([95.0, 45.0], [True, False, True])
    """

    __slots__ = ("_raw", "_scene", "position", "normal")

    #: float64 ``(..., 3)``: points in metres (x east, y north, z up); NaN without a hit. None if not computed.
    position: np.ndarray | None
    #: float64 ``(..., 3)``: unit normals of the surface; 0 without a hit. None if not computed.
    normal: np.ndarray | None

    def __init__(self, shape: Shape, *, position: bool = True, normal: bool = True) -> None:
        sides = shape if isinstance(shape, (tuple, list)) else (shape,)
        shape = tuple(whole(side, "shape", 0, 2**62) for side in sides)
        self._raw = np.zeros(shape, _HIT)
        self._raw["t"] = np.inf
        self._raw["cell"] = -1
        self._scene: object = None
        self.position = np.full(shape + (3,), np.nan) if flag(position, "position") else None
        self.normal = np.zeros(shape + (3,)) if flag(normal, "normal") else None

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the batch."""
        return self._raw.shape

    def __len__(self) -> int:
        return len(self._raw)

    def __getitem__(self, index: Any) -> "Hits":
        part = Hits.__new__(Hits)
        batch, vectors = _along_batch(index)
        part._raw = self._raw[batch]
        part._scene = self._scene
        part.position = None if self.position is None else self.position[vectors]
        part.normal = None if self.normal is None else self.normal[vectors]
        return part

    def __iter__(self) -> Iterator["Hits"]:
        return (self[i] for i in range(len(self)))

    def __bool__(self) -> bool:
        if self._raw.size != 1:
            raise Error(f"hits: {self._raw.size} rays have no single truth value (use .hit.any() or .hit.all())")
        return bool(self.hit.all())

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


def _along_batch(index: Any) -> tuple[Any, Any]:
    """Returns an index of the axes of a batch for arrays of the batch, and for arrays of vectors."""
    parts = index if isinstance(index, tuple) else (index,)
    for part in parts:
        if isinstance(part, slice) or part is Ellipsis or np.size(part) == 0:
            continue
        if np.asarray(part).dtype.kind not in "biu":
            raise TypeError(f"hits: {shown(index)} is no index of rays (expected integers, slices or an array of bool)")
    if not any(part is Ellipsis for part in parts):
        parts = (*parts, Ellipsis)  # one hit stays an array, of no dimensions
    return parts, (*parts, slice(None))


class AllHits(Hits):
    """All hits along rays, ordered by ray and ``t``: arrays ``(hits,)``.

    The hits of ray ``i`` (of the flattened batch) are ``of_ray(i)``, or ``slice(first[i], first[i + 1])``. Indices and
    iteration count hits. The truth value is whether any ray hits.
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

    def of_ray(self, ray: int) -> Hits:
        """Returns the hits of one ray, ordered by ``t``.

        Raises:
            Error: there is no such ray.
        """
        ray = whole(ray, "ray", 0, len(self.first) - 2)
        return self[self.first[ray] : self.first[ray + 1]]

    def __bool__(self) -> bool:
        return len(self) > 0

    def __repr__(self) -> str:
        return f"<pyscarp.AllHits of {len(self.first) - 1} rays, {len(self)} hits>"


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
