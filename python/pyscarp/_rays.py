# SPDX-License-Identifier: MIT
"""Ray queries that every scene answers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from ._arguments import array_of_numbers, refuse_unused
from ._core import Error
from ._hits import Hits

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._core import SceneBase
else:
    SceneBase = object


def vectors(values: "ArrayLike", name: str) -> np.ndarray:
    """Returns an array of floats (..., 3), the same object if it is one."""
    if type(values) is np.ndarray and values.dtype.char in "df":
        return values
    array = array_of_numbers(values, name)
    return array if array.dtype.char in "df" else array.astype(float)


def batch(origins: "ArrayLike", directions: "ArrayLike") -> tuple[np.ndarray, np.ndarray, tuple[int, ...]]:
    """Returns both as arrays (n, 3), and the shape of the batch. Broadcasting repeats no memory."""
    a, b = vectors(origins, "origins"), vectors(directions, "directions")
    if a.ndim == 2 and a.shape == b.shape:
        return a, b, a.shape[:1]
    for name, array in ("origins", a), ("directions", b):
        if array.ndim < 1 or array.shape[-1] != 3:
            raise Error(f"{name}: the array has the shape {array.shape} (expected (..., 3): x, y and z)")
    try:
        shape = np.broadcast_shapes(a.shape[:-1], b.shape[:-1])
    except ValueError:
        raise Error(f"rays: origins of the shape {a.shape} and directions of {b.shape} do not broadcast") from None
    a, b = np.broadcast_to(a, shape + (3,)), np.broadcast_to(b, shape + (3,))
    if len(shape) != 1:
        a, b = a.reshape(-1, 3), b.reshape(-1, 3)  # copies only arrays of more dimensions that are not contiguous
    return a, b, shape


def limit(value: Any, shape: tuple[int, ...], name: str) -> Any:
    """Returns None, one number, or one number per ray."""
    if value is None or isinstance(value, (int, float)):
        return value
    values = array_of_numbers(value, name).astype(float, copy=False)
    try:
        return np.ascontiguousarray(np.broadcast_to(values, shape))
    except ValueError:
        raise Error(f"{name}: values of the shape {np.shape(value)} do not broadcast to {shape} rays") from None


class Rays(SceneBase):
    """Queries of `Terrain`, `Voxels` and `Scene`.

    Rays are points ``origin + t * direction`` for t in [t_min, t_max], in metres: x east and y north from the
    south-west sample of a terrain, z up. Directions have any length except 0; t counts in this length. Origins and
    directions have the shapes ``(..., 3)`` and broadcast; float64 and float32 arrays are read where they are. Queries
    run on all threads, without the interpreter's lock.
    """

    _token: object  # of the scene, to which hits belong

    def cast(
        self,
        origins: "ArrayLike",
        directions: "ArrayLike",
        *,
        t_min: Any = None,
        t_max: Any = None,
        start: Optional[Hits] = None,
        out: Optional[Hits] = None,
        position: bool = True,
        normal: bool = True,
    ) -> Hits:
        """Finds the closest hit of each ray.

        Args:
            origins: ``(..., 3)``, metres.
            directions: ``(..., 3)``, any length except 0.
            t_min, t_max: number, or one per ray; 0 and infinity.
            start: hits of this scene, as many as rays: the rays start on the surface at these hits, without an offset.
                Rays whose entry is no hit start anywhere.
            out: room for the answers, ``Hits(shape)``; it is returned.
            position, normal: whether a new `Hits` has them; without them the call is faster.

        Raises:
            Error: the index of the first ray that is not finite, has a direction of 0 or an empty range; shapes that
                do not broadcast; an array that was resized.
            TypeError: arrays that are not numbers.

        >>> terrain = Terrain(np.full((3, 3), 5, np.float32), cell=10)
        >>> hits = terrain.cast([[7, 3, 100], [7, 300, 100]], [0, 0, -1])
        >>> hits.t.tolist(), hits.position[0].tolist(), hits.cell.tolist()
        ([95.0, inf], [7.0, 3.0, 5.0], [[0, 1], [-1, -1]])
        """
        if out is not None and not isinstance(out, Hits):
            raise TypeError(f"out: {type(out).__name__} is not a Hits (make room with pyscarp.Hits(shape))")
        starts = out is not None and out._scene is not None and start is out
        if out is not None and not starts:
            out._scene = None  # until all answers are there, no rays may start from them
        if (
            out is not None
            and t_min is None
            and t_max is None
            and start is None
            and position
            and normal
            and self._cast_plain(origins, directions, out._raw, out.position, out.normal)
        ):
            out._scene = self._token
            return out
        a, b, shape = batch(origins, directions)
        if out is None:
            out = Hits(shape, position=position, normal=normal)
        elif out._raw.shape != shape:
            raise Error(f"out: room for the shape {out._raw.shape}, but rays of the shape {shape}")
        else:
            refuse_unused(Rays.cast, "with out, which has them or not", position=position, normal=normal)
        self._cast(
            a,
            b,
            out._raw,
            out.position,
            out.normal,
            limit(t_min, shape, "t_min"),
            limit(t_max, shape, "t_max"),
            None if start is None else self._starts(start, shape),
        )
        out._scene = self._token
        return out

    def occluded(
        self,
        origins: "ArrayLike",
        directions: "ArrayLike",
        *,
        t_min: Any = None,
        t_max: Any = None,
        start: Optional[Hits] = None,
        out: Optional[np.ndarray] = None,
    ) -> np.ndarray:
        """Returns whether anything blocks each ray, bool ``(...)``; faster than `cast`.

        For the segment from a to b, use ``directions = b - a`` and ``t_max=1``. Arguments and errors as in `cast`;
        ``out`` is a bool array of the shape of the batch.

        >>> terrain = Terrain(np.full((3, 3), 5, np.float32), cell=10)
        >>> terrain.occluded([7, 3, 6], [[0, 0, -1], [0, 0, 1]]).tolist()
        [True, False]
        """
        if out is not None and not isinstance(out, np.ndarray):
            raise TypeError(f"out: {type(out).__name__} is not an array (expected bool)")
        if out is not None and t_min is None and t_max is None and start is None:
            if out.dtype.char == "?" and self._occluded_plain(origins, directions, out):
                return out
        a, b, shape = batch(origins, directions)
        if out is None:
            out = np.empty(shape, bool)
        elif out.shape != shape or out.dtype != bool:
            raise Error(f"out: {out.dtype} of the shape {out.shape} (expected bool of the shape {shape})")
        self._occluded(
            a,
            b,
            out,
            limit(t_min, shape, "t_min"),
            limit(t_max, shape, "t_max"),
            None if start is None else self._starts(start, shape),
        )
        return out

    def heights_at(self, x: "ArrayLike", y: "ArrayLike", *, out: Optional[np.ndarray] = None) -> np.ndarray:
        """Returns the height of the highest ground at points, float64, metres; NaN outside and over holes.

        ``x`` and ``y`` are in metres, as in rays, and broadcast.

        >>> terrain = Terrain(np.array([[0, 10], [0, 10]], np.float32), cell=10)
        >>> terrain.heights_at([2.5, 5, 99], 5).tolist()
        [2.5, 5.0, nan]
        """
        try:
            xs, ys = np.broadcast_arrays(
                array_of_numbers(x, "x").astype(float, copy=False), array_of_numbers(y, "y").astype(float, copy=False)
            )
        except ValueError as error:
            raise Error(f"heights_at: x of the shape {np.shape(x)}, y of {np.shape(y)}: {error}") from None
        if out is None:
            out = np.empty(xs.shape)
        elif not isinstance(out, np.ndarray) or out.dtype != float or out.shape != xs.shape:
            raise Error(f"out: expected an array of float64 of the shape {xs.shape}")
        self._heights_at(np.ascontiguousarray(xs), np.ascontiguousarray(ys), out)
        return out

    def _repr_png_(self) -> Optional[bytes]:
        """Returns the picture that notebooks show; None if there is nothing to see."""
        from ._picture import png, render

        try:
            return png(render(self, (640, 360)))
        except Error:
            return None

    def _starts(self, start: Hits, shape: tuple[int, ...]) -> np.ndarray:
        if not isinstance(start, Hits):
            raise TypeError(f"start: {type(start).__name__} is not a Hits (pass the result of cast)")
        if start._raw.shape != shape:
            raise Error(f"start: hits of the shape {start._raw.shape} for rays of the shape {shape}")
        if start._scene is not self._token:
            raise Error("start: the hits are of another scene (cast rays against this one)")
        return np.ascontiguousarray(start._raw)  # parts of hits may have gaps
