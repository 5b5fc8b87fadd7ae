# SPDX-License-Identifier: MIT
"""Voxels, and scenes of several parts."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any, Optional, Sequence, Union

import numpy as np

from . import _core
from ._core import Error
from ._rays import Rays, number
from ._terrain import Terrain

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class Voxels(Rays, _core.Voxels):
    """A grid of voxels. Voxel (x, y, z) is the cube from (x, y, z) * side to (x + 1, y + 1, z + 1) * side, z up.

    Args:
        indices: uint8 ``(z, y, x)``, sides from 1 to 16384: index of a colour, 0: empty. It is copied, as one bit per
            voxel and one index per solid voxel.
        side: of a voxel in metres, above 0.
        palette: uint8 ``(n, 3)``, sRGB: the colours of the indices. Default: one colour.

    Raises:
        TypeError: another type. Error: another shape, an index beyond the palette.

    >>> voxels = Voxels(np.ones((2, 2, 2), np.uint8), side=0.5)
    >>> hits = voxels.cast([0.2, 0.7, 9], [0, 0, -1])
    >>> hits.voxel.tolist(), hits.t.item()
    ([0, 1, 1], 8.0)
    """

    def __init__(self, indices: np.ndarray, side: float = 1.0, palette: Optional["ArrayLike"] = None) -> None:
        array = np.asarray(indices)
        if array.dtype != np.uint8:
            raise TypeError(
                f"voxels: {array.dtype} is not uint8 (convert the array: (indices > 0).astype(numpy.uint8))"
            )
        colours = [] if palette is None else np.asarray(palette, np.uint8).reshape(-1, 3).tolist()
        super().__init__(np.ascontiguousarray(array), number(side, "side"), colours)
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
            Error: not exactly one of box, sphere and positions; an index that does not fit.

        >>> voxels = Voxels(np.ones((4, 4, 4), np.uint8))
        >>> voxels.edit(box=((0, 0, 2), (4, 4, 4)))
        >>> voxels.solid_count
        32
        """
        if sum(part is not None for part in (box, sphere, positions)) != 1:
            raise Error("edit: expected one of box, sphere and positions")
        if positions is not None:
            self._set(np.asarray(positions), np.asarray(index).reshape(-1))
            return
        if not 0 <= int(index) <= 255:
            raise Error(f"edit: the index {index} is not between 0 and 255")
        if box is not None:
            self._fill_box(tuple(map(int, box[0])), tuple(map(int, box[1])), int(index))
        elif sphere is not None:
            self._fill_sphere(tuple(map(float, sphere[0])), float(sphere[1]), int(index))

    def __repr__(self) -> str:
        if "_token" not in self.__dict__:
            return "<pyscarp.Voxels, not built>"
        x, y, z = self._size
        return f"<pyscarp.Voxels {x} x {y} x {z}, {self.solid_count} solid>"


@dataclasses.dataclass
class Part:
    """A part of a scene: ``world = scale * turn @ point + origin``."""

    scene: Rays
    origin: Sequence[float] = (0.0, 0.0, 0.0)  #: metres
    scale: float = 1.0  #: above 0
    #: rotation, ``(3, 3)``, or one number: degrees about the vertical, counterclockwise from above
    turn: Union[float, "ArrayLike"] = 0.0

    def _rotation(self) -> list[float]:
        turn = np.asarray(self.turn, float)
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
        if isinstance(parts, (Rays, Part)):
            raise TypeError("scene: expected a list of parts")
        placed = tuple(part if isinstance(part, Part) else Part(part) for part in parts)
        for part in placed:
            if not isinstance(part.scene, _core.SceneBase):
                raise TypeError(f"scene: {type(part.scene).__name__} is not a Terrain, Voxels or Scene")
        self._parts = placed
        self._token = object()
        super().__init__(
            tuple((part.scene, tuple(map(float, part.origin)), float(part.scale), part._rotation()) for part in placed)
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
