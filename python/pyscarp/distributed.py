# SPDX-License-Identifier: MIT
"""Maps of whole rasters on many machines, as tasks over parts on a cluster of Dask.

    import distributed
    import pyscarp.distributed

    client = distributed.Client("scheduler:8786")
    shade = pyscarp.distributed.shadow("/shared/dem.tif", sun=(135, 20), parts=64)     # computes nothing yet
    shade.compute()                                         # or .persist(), .to_zarr(), .rio.to_raster()
    pyscarp.distributed.run(["shadow", "/shared/dem.tif", "--sun", "135,20"], "/shared/shadow.tif", parts=64)

The parts are bands of rows, those of ``scarp --part I/N``, and have the values of one process to the last byte. A part
depends only on its inputs: if a worker dies, Dask computes its parts again on another one.

Each map takes the arguments of the function of pyscarp of the same name, except `rows` and `progress`, and `parts`. Its
terrain is a path, which all workers open, or anything that `pyscarp.Terrain` accepts, which travels with each part. The
result is an array of dask with one chunk per part, or a DataArray over such an array.
"""

from __future__ import annotations

import glob
import os
import shutil
import subprocess
import threading
import uuid
from typing import Any, Callable, Optional, Sequence, Union

import pyscarp

from . import _core
from ._core import Error
from ._maps import Compute, Divided, Map, part_of, terrain_of
from ._terrain import Terrain


class MissingModule(Error, ImportError):
    """A module that is not installed."""


try:
    import dask
    import dask.array
    import distributed as _cluster
except ImportError as error:
    raise MissingModule(
        f"pyscarp.distributed: needs the module {error.name} (install dask and distributed; Debian: python3-dask "
        "python3-distributed)"
    ) from None

__all__ = ["MissingModule", "horizon", "run", "shadow", "sky_view", "sun_hours", "viewshed"]

#: Parts by default: enough that workers end together, few enough that what each builds once does not count.
_PARTS = 16


def viewshed(terrain: Any, observers: Any, *, parts: Optional[int] = None, **settings: Any) -> Any:
    """Maps what observers see, as `pyscarp.viewshed`, in parts.

    >>> wall = Terrain(np.array([[0, 0, 9, 0, 0]] * 2, np.float32), cell=10)
    >>> pyscarp.distributed.viewshed(wall, [(0, 0), (40, 0)], mode="count", parts=2).compute()[0].tolist()
    [1, 1, 2, 1, 1]
    """
    return pyscarp.viewshed(_Parts(terrain, parts), observers, **settings)


def shadow(terrain: Any, sun: Any = None, *, parts: Optional[int] = None, **settings: Any) -> Any:
    """Maps where the sun shines, as `pyscarp.shadow`, in parts.

    >>> wall = Terrain(np.array([[0, 0, 9, 0, 0]] * 2, np.float32), cell=10)
    >>> pyscarp.distributed.shadow(wall, (90, 40), parts=2).compute()[0].tolist()
    [0, 1, 0, 0, 0]
    """
    return pyscarp.shadow(_Parts(terrain, parts), sun, **settings)


def horizon(terrain: Any, azimuths: Any = 36, *, parts: Optional[int] = None, **settings: Any) -> Any:
    """Maps the elevation of the horizon, as `pyscarp.horizon`, in parts.

    >>> wall = Terrain(np.array([[0, 0, 10, 0, 0]] * 2, np.float32), cell=10)
    >>> pyscarp.distributed.horizon(wall, [90], cc=0, parts=2).compute()[0, 0].astype(float).round(1).tolist()
    [26.6, 45.0, -26.6, 0.0, -90.0]
    """
    return pyscarp.horizon(_Parts(terrain, parts), azimuths, **settings)


def sky_view(terrain: Any, measure: str = "sky-fraction", *, parts: Optional[int] = None, **settings: Any) -> Any:
    """Maps how much sky each sample sees, as `pyscarp.sky_view`, in parts.

    >>> flat = Terrain(np.zeros((2, 2), np.float32), cell=1)
    >>> pyscarp.distributed.sky_view(flat, azimuths=8, parts=2).compute().tolist()
    [[1.0, 1.0], [1.0, 1.0]]
    """
    return pyscarp.sky_view(_Parts(terrain, parts), measure, **settings)


def sun_hours(terrain: Any, date: Any = None, *, parts: Optional[int] = None, **settings: Any) -> Any:
    """Maps the hours of direct sun, as `pyscarp.sun_hours`, in parts.

    >>> wall = Terrain(np.array([[0, 0, 10, 0, 0]] * 2, np.float32), cell=10)
    >>> pyscarp.distributed.sun_hours(wall, suns=[(90, 30, 4)], parts=2).compute()[0].tolist()
    [4.0, 0.0, 4.0, 4.0, 4.0]
    """
    return pyscarp.sun_hours(_Parts(terrain, parts), date, **settings)


class _Parts(Divided):
    """Computes maps as tasks of dask. A task holds all that it needs: tasks that share the result of another one may
    wait forever when its worker dies (distributed 2022.12)."""

    def __init__(self, terrain: Any, parts: Optional[int]) -> None:
        if isinstance(terrain, (str, os.PathLike)):
            self._source: Any = _File(os.path.abspath(terrain))
            self.terrain = self._source.terrain()
        else:
            self.terrain = terrain_of(terrain)
            self._source = _Array(self.terrain)
        rows = self.terrain.shape[0]
        if parts is not None and (isinstance(parts, bool) or parts != int(parts) or not 1 <= parts <= rows):
            raise Error(f"parts: {parts} (expected 1 to {rows}, the rows of the terrain)")
        self._count = min(_PARTS, rows) if parts is None else int(parts)
        if self._source.sent_bytes * self._count > _MOST_SENT:
            raise Error(
                f"terrain: {self._count} parts with an array of {self._source.sent_bytes} bytes each are too much for "
                "the scheduler (save it as a file that all workers reach, and pass the path)"
            )

    def arrays(self, found: Map) -> list[Any]:
        rows, cols = self.terrain.shape
        compute_part = dask.delayed(_part, pure=False)
        chunks: list[list[Any]] = [[] for _ in found.layers]
        for part in range(1, self._count + 1):
            first, last = _core.row_band(rows, part, self._count)
            arrays = compute_part(self._source, found.compute, found.arguments, first, last)
            for number, layer in enumerate(found.layers):
                shape = layer.shape(last - first, cols)
                chunks[number].append(dask.array.from_delayed(arrays[number], shape, layer.dtype))
        return [dask.array.concatenate(of_layer, axis=-2) for of_layer in chunks]


#: Bytes of arrays in the tasks of one map, which the scheduler keeps.
_MOST_SENT = 2**30


class _File:
    """A terrain that each process opens."""

    sent_bytes = 0

    def __init__(self, path: str) -> None:
        self._path = path
        try:
            found = os.stat(path)
            self._key = (path, found.st_size, found.st_mtime_ns)  # a changed file is opened again
        except OSError:
            self._key = (path, 0, 0)  # opening reports it

    def terrain(self) -> Terrain:
        return _kept(self._key, lambda: Terrain.open(self._path))


class _Array:
    """A terrain whose array travels with each task."""

    def __init__(self, terrain: Terrain) -> None:
        # Workers do not need the DataArray.
        self._build, (self._arguments, _, *self._settings) = terrain.__reduce__()
        self._key = uuid.uuid4().hex
        self.sent_bytes = terrain.heights.nbytes

    def terrain(self) -> Terrain:
        return _kept(self._key, lambda: self._build(self._arguments, None, *self._settings))


_keeping = threading.Lock()
_last_terrain: dict[Any, Terrain] = {}


def _kept(key: Any, make: Callable[[], Terrain]) -> Terrain:
    """A process keeps its last terrain: it computes many parts of one map."""
    with _keeping:
        if key not in _last_terrain:
            terrain = make()
            _last_terrain.clear()
            _last_terrain[key] = terrain
        return _last_terrain[key]


def _part(source: Any, compute: Compute, arguments: tuple[Any, ...], first: int, last: int) -> list[Any]:
    return part_of(source.terrain(), compute, arguments, first, last)


def run(
    command: Sequence[Any],
    output: Union[str, "os.PathLike[str]"],
    *,
    parts: int = _PARTS,
    client: Any = None,
    program: str = "scarp",
) -> str:
    """Runs a map of the command line in parts on a cluster, and merges them into one file.

    For rasters larger than memory, and for all options: each part reads only the rows that it needs, and is written
    beside the output, which all workers must reach by the same path. Waits for the end.

    Args:
        command: subcommand, input and options, without ``-o``: ``["viewshed", "dem.tif", "--observer", "500,700"]``.
        output: raster to write.
        parts: number of parts.
        client: of the cluster. Default: the current one.
        program: the command line on the workers.

    Returns:
        The path of the output.

    Raises:
        Error: what the command line reports; no cluster.
    """
    if parts != int(parts) or parts < 1:
        raise Error(f"parts: {parts} (expected a number of parts, at least 1)")
    if client is None:
        try:
            client = _cluster.get_client()
        except ValueError:
            raise Error("run: no cluster (make a client first: distributed.Client())") from None
    words = [os.fspath(word) if isinstance(word, os.PathLike) else str(word) for word in command]
    path = os.path.abspath(output)
    # The name of its own keeps runs apart that write the same output.
    stem = f"{path}.part-{uuid.uuid4().hex[:8]}"
    folder = os.getcwd()
    try:
        files = [
            client.submit(_run_part, program, words, f"{stem}-{i}", f"{i}/{parts}", folder, pure=False)
            for i in range(1, parts + 1)
        ]
        return client.submit(_merge, program, files, path, folder, pure=False).result()
    finally:
        for left in glob.glob(f"{glob.escape(stem)}-*"):
            os.remove(left)


def _run_part(program: str, words: list[str], stem: str, part: str, folder: str) -> str:
    # A worker that was lost may still be writing: each try has a file of its own.
    file = f"{stem}-{uuid.uuid4().hex[:8]}.tif"
    _call(program, [*words, "--part", part, "-o", file], folder)
    return file


def _merge(program: str, files: list[str], output: str, folder: str) -> str:
    _call(program, ["merge", *files, "-o", output], folder)
    return output


def _call(program: str, words: list[str], folder: str) -> None:
    if shutil.which(program) is None:
        raise Error(f"{program}: the command line is not installed on the worker (install the package scarp)")
    done = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or [f"ended with the code {done.returncode}"]
        raise Error(lines[-1].removeprefix("scarp: error: "))
