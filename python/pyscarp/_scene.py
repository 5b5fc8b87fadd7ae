# SPDX-License-Identifier: MIT
"""Voxels, and scenes of several parts."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any, Optional, Sequence, Union

import numpy as np

from . import _core
from ._arguments import array_of_numbers, converted, number, numbers, shown, whole, whole_numbers
from ._core import Error
from ._rays import Rays
from ._terrain import Terrain

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class Voxels(Rays, _core.Voxels):
    """A grid of voxels. Voxel (x, y, z) is the cube from (x, y, z) * side to (x + 1, y + 1, z + 1) * side, z up.

    Args:
        indices: uint8 ``(z, y, x)``, sides from 1 to 16384: index of a colour, 0: empty. It is copied, as one bit per
            voxel and one index per solid voxel.
        side: of a voxel in metres, above 0.
        palette: ``(n, 3)``, integers from 0 to 255, sRGB: the colours of the indices. Default: one colour.

    Raises:
        TypeError: another type. Error: another shape, an index beyond the palette, a colour that is not one.

    >>> voxels = Voxels(np.ones((2, 2, 2), np.uint8), side=0.5)
    >>> hits = voxels.cast([0.2, 0.7, 9], [0, 0, -1])
    >>> hits.voxel.tolist(), hits.t.item()
    ([0, 1, 1], 8.0)
    """

    def __init__(self, indices: np.ndarray, side: float = 1.0, palette: Optional["ArrayLike"] = None) -> None:
        array = array_of_numbers(indices, "voxels")
        if array.dtype != np.uint8:
            raise TypeError(
                f"voxels: {array.dtype} is not uint8 (convert the array: (indices > 0).astype(numpy.uint8))"
            )
        colours = [] if palette is None else _colours(palette)
        super().__init__(np.ascontiguousarray(array), number(side, "side"), colours)
        self._last_index = len(colours) - 1 if colours else 255
        self._token = object()

    @property
    def shape(self) -> tuple[int, int, int]:
        """Sizes in z, y and x, as of the array."""
        x, y, z = self._size
        return z, y, x

    @property
    def solid_count(self) -> int:
        """Number of voxels that are not empty."""
        return self._solid_count

    def to_array(self) -> np.ndarray:
        """Returns a copy of the indices, uint8 ``(z, y, x)``."""
        return self._indices()

    def edit(
        self,
        *,
        box: Optional[tuple[Sequence[int], Sequence[int]]] = None,
        sphere: Optional[tuple[Sequence[float], float]] = None,
        positions: Optional["ArrayLike"] = None,
        index: Any = 0,
    ) -> None:
        """Fills a box, a sphere or single voxels with an index; 0 empties them. Waits for running queries.

        Args:
            box: the lowest (x, y, z), and the one after the highest.
            sphere: centre (x, y, z) and radius, in voxels: those whose centres are within.
            positions: ``(n, 3)``, x, y and z.
            index: one, or with positions one each.

        Positions outside the grid are ignored.

        Raises:
            Error: not exactly one of box, sphere and positions; a place or an index that is not a whole number; an
                index beyond 255 or the palette.

        >>> voxels = Voxels(np.ones((4, 4, 4), np.uint8))
        >>> voxels.edit(box=((0, 0, 2), (4, 4, 4)))
        >>> voxels.solid_count
        32
        """
        if sum(part is not None for part in (box, sphere, positions)) != 1:
            raise Error("edit: expected one of box, sphere and positions")
        if positions is None:
            entry = whole(index, "index", 0, self._last_index)
            if box is not None:
                low, high = _corners(box)
                self._fill_box(low, high, entry)
            elif sphere is not None:
                centre, radius = _sphere(sphere)
                self._fill_sphere(centre, radius, entry)
            return
        places, entries = whole_numbers(positions, "positions"), whole_numbers(index, "index").reshape(-1)
        if places.size == 0:
            places = places.reshape(-1, 3)
        wrong = (entries < 0) | (entries > self._last_index)
        if wrong.any():
            raise Error(f"edit: the index {entries[wrong][0]} is not between 0 and {self._last_index}")
        self._set(_as_int32(places), _as_int32(entries))

    def __repr__(self) -> str:
        if "_token" not in self.__dict__:
            return "<pyscarp.Voxels, not built>"
        x, y, z = self._size
        return f"<pyscarp.Voxels {x} x {y} x {z}, {self.solid_count} solid>"


def _colours(palette: Any) -> list[list[int]]:
    colours = array_of_numbers(palette, "palette")
    if colours.ndim != 2 or colours.shape[1] != 3:
        raise Error(f"palette: the array has the shape {colours.shape} (expected (n, 3): red, green and blue)")
    if colours.dtype.kind == "f":
        raise Error(
            f"palette: {colours.dtype} (expected integers from 0 to 255; from shares: numpy.rint(255 * "
            "palette).astype(numpy.uint8))"
        )
    return converted(colours, np.dtype(np.uint8), "palette").tolist()


def _as_int32(values: np.ndarray) -> np.ndarray:
    """Numbers beyond the range become its ends, which are outside of every grid."""
    ends = np.iinfo(np.int32)
    return np.clip(values, ends.min, ends.max).astype(np.int32)


def _corners(box: Any) -> list[list[int]]:
    corners = whole_numbers(box, "box")
    if corners.shape != (2, 3):
        raise Error(f"box: the array has the shape {corners.shape} (expected (2, 3): two corners x, y, z)")
    return _as_int32(corners).tolist()


def _sphere(sphere: Any) -> tuple[tuple[float, ...], float]:
    try:
        centre, radius = sphere
    except (TypeError, ValueError):
        raise TypeError(f"sphere: {shown(sphere)} (expected ((x, y, z), radius))") from None
    found = (*numbers(centre, 3, "sphere", "a centre x, y, z"), number(radius, "sphere"))
    if not all(map(math.isfinite, found)):
        raise Error(f"sphere: {shown(sphere)} is not finite (expected a centre and a radius in voxels)")
    return found[:3], found[3]


@dataclasses.dataclass
class Part:
    """A part of a scene: ``world = scale * turn @ point + origin``."""

    scene: Rays
    origin: Sequence[float] = (0.0, 0.0, 0.0)  #: metres
    scale: float = 1.0  #: above 0
    #: rotation, ``(3, 3)``, or one number: degrees about the vertical, counterclockwise from above
    turn: Union[float, "ArrayLike"] = 0.0

    def _rotation(self) -> list[float]:
        turn = array_of_numbers(self.turn, "turn").astype(float)
        if turn.ndim == 0:
            c, s = math.cos(math.radians(float(turn))), math.sin(math.radians(float(turn)))
            turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        if turn.shape != (3, 3):
            raise Error(f"turn: the array has the shape {turn.shape} (expected (3, 3), or degrees)")
        return turn.reshape(-1).tolist()


class Scene(Rays, _core.Scene):
    """Terrains, voxels and scenes under placements, with the nearest hit over all of them.

    Args:
        parts: each a `Terrain`, `Voxels` or `Scene`, or a `Part` with its placement. They are shared, not copied: edits
            of a part change the scene.

    `Hits.object` is the index of the part. Hits on terrain have cells, hits on voxels have voxels.

    Raises:
        Error: a placement that is not a rotation with a scale above 0.

    >>> ground = Terrain(np.zeros((9, 9), np.float32), cell=10)
    >>> tower = Voxels(np.ones((5, 2, 2), np.uint8))
    >>> scene = Scene([ground, Part(tower, origin=(40, 40, 0))])
    >>> scene.cast([41, 41, 100], [0, 0, -1]).position.tolist()
    [41.0, 41.0, 5.0]
    """

    def __init__(self, parts: Sequence[Union[Rays, Part]]) -> None:
        if isinstance(parts, (Rays, Part)) or not hasattr(parts, "__iter__"):
            raise TypeError(f"parts: {shown(parts)} (expected a list of parts)")
        placed = tuple(part if isinstance(part, Part) else Part(part) for part in parts)
        for part in placed:
            if not isinstance(part.scene, _core.SceneBase):
                raise TypeError(f"scene: {type(part.scene).__name__} is not a Terrain, Voxels or Scene")
        self._parts = placed
        self._token = object()
        super().__init__(
            tuple(
                (
                    part.scene,
                    numbers(part.origin, 3, "origin", "x, y and z in metres"),
                    number(part.scale, "scale"),
                    part._rotation(),
                )
                for part in placed
            )
        )

    @property
    def parts(self) -> tuple[Part, ...]:
        """The parts, in the order of `Hits.object`."""
        return self._parts

    def __repr__(self) -> str:
        return f"<pyscarp.Scene of {len(self._parts)} parts>"


def scene_of(value: Any) -> Rays:
    """Returns a scene as it is, and a terrain of anything else."""
    return value if isinstance(value, Rays) else Terrain(value)
