# SPDX-License-Identifier: MIT
"""Maps of a terrain: functions that compute some of their rows, in one process or in parts, and their meaning."""

from __future__ import annotations

import abc
import dataclasses
from typing import Any, Callable, Optional, Sequence

import numpy as np

from ._arguments import shown
from ._core import Error
from ._progress import Progress, reporting
from ._terrain import Terrain

#: Computes rows [first, last), from north, of the arrays of a map: (terrain, *arguments, (first, last), progress). A
#: function of a module with plain arguments, so that other processes can call it.
Compute = Callable[..., Sequence[np.ndarray]]


@dataclasses.dataclass(frozen=True)
class Layer:
    """The meaning of one array of a map, ``(rows, cols)``, or of one per value of a coordinate."""

    name: str
    dtype: type
    unit: str = ""
    meaning: str = ""
    nodata: Any = None
    #: name, values and attributes of the first of three dimensions
    coordinate: Optional[tuple[str, np.ndarray, dict[str, str]]] = None

    def shape(self, rows: int, cols: int) -> tuple[int, ...]:
        """Shape of so many rows."""
        return (rows, cols) if self.coordinate is None else (len(self.coordinate[1]), rows, cols)


@dataclasses.dataclass(frozen=True)
class Map:
    """A map, before it is computed."""

    compute: Compute
    arguments: tuple[Any, ...]
    layers: tuple[Layer, ...]
    #: makes the result of one array per layer
    assemble: Callable[[list[Any]], Any] = lambda arrays: arrays[0]


class Divided(abc.ABC):
    """In place of a terrain: computes maps in another way."""

    terrain: Terrain

    @abc.abstractmethod
    def arrays(self, found: Map) -> list[Any]:
        """Returns an array of each layer, all rows in the order of the input."""


def terrain_of(value: Any) -> Terrain:
    """Returns a terrain as it is, and one over anything else."""
    if isinstance(value, Divided):
        return value.terrain
    return value if isinstance(value, Terrain) else Terrain(value)


def computed(given: Any, terrain: Terrain, found: Map, rows: Optional[slice], progress: Progress) -> Any:
    """Returns the result of a map. ``given``: what the caller passed as the terrain."""
    if isinstance(given, Divided):
        if rows is not None or progress is not None:
            raise Error("rows, progress: not with parts, which are computed later (leave them out)")
        first, last = 0, terrain.shape[0]
        arrays = given.arrays(found)
    else:
        first, last = _bounds(rows, terrain.shape[0])
        with reporting(progress) as report:
            arrays = list(part_of(terrain, found.compute, found.arguments, first, last, report))
    return found.assemble([wrapped(terrain, a, layer, first, last) for a, layer in zip(arrays, found.layers)])


def _bounds(rows: Optional[slice], count: int) -> tuple[int, int]:
    if rows is None:
        return 0, count
    if not isinstance(rows, slice):
        raise TypeError(f"rows: {shown(rows)} is not a slice (expected slice(first, last))")
    first, last, step = rows.indices(count)
    if step != 1 or last <= first:
        raise Error(f"rows: {rows} selects none of {count} rows, or not neighbouring ones")
    return first, last


def part_of(
    terrain: Terrain, compute: Compute, arguments: tuple[Any, ...], first: int, last: int, report: Any = None
) -> list[np.ndarray]:
    """Computes rows of a map, in the order of the input."""
    count = terrain.shape[0]
    south_up = terrain._south_up
    north = (count - last, count - first) if south_up else (first, last)
    arrays = compute(terrain, *arguments, north, report)
    return [a[..., ::-1, :] if south_up else a for a in arrays]


def wrapped(terrain: Terrain, values: Any, layer: Layer, first: int, last: int) -> Any:
    """Returns rows of a map as the input has them: a DataArray if it is one."""
    template = terrain._template
    if template is None:
        return values
    import xarray

    coords: dict[Any, Any] = {k: v for k, v in template.coords.items() if set(v.dims) <= set(template.dims)}
    if last - first < template.shape[0]:
        band = template.isel({template.dims[0]: slice(first, last)})
        coords = {k: band.coords[k] for k in coords}
    attrs: dict[str, Any] = {"long_name": layer.meaning or layer.name}
    if layer.unit:
        attrs["units"] = layer.unit
    if layer.nodata is not None:
        attrs["_FillValue"] = layer.nodata
    if "grid_mapping" in template.attrs:
        attrs["grid_mapping"] = template.attrs["grid_mapping"]
    dims = template.dims
    if layer.coordinate is not None:
        name, at, about = layer.coordinate
        coords = {name: xarray.DataArray(at, dims=name, name=name, attrs=about), **coords}
        dims = (name, *dims)
    result = xarray.DataArray(values, coords=coords, dims=dims, name=layer.name, attrs=attrs)
    if "grid_mapping" in template.encoding:
        result.encoding["grid_mapping"] = template.encoding["grid_mapping"]
    return result
