# SPDX-License-Identifier: MIT
"""Pictures of scenes as arrays and PNG."""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING, Optional, Sequence, Union

import numpy as np

from . import _core
from ._arguments import flag, number, numbers, refuse_unused, text, whole
from ._core import Error
from ._progress import Progress, reporting
from ._scene import scene_of

if TYPE_CHECKING:
    import os

    from ._rays import Rays


def render(
    scene: "Rays",
    size: Sequence[int] = (1280, 720),
    *,
    look: str = "shaded",
    view: Sequence[float] = (190, 35),
    distance: float = 1.0,
    fov: float = 30.0,
    top: bool = False,
    eye: Optional[Sequence[float]] = None,
    target: Optional[Sequence[float]] = None,
    sun: Sequence[float] = (315, 45),
    shadows: bool = True,
    unlit: bool = False,
    haze: Optional[float] = None,
    aa: int = 2,
    samples: int = 0,
    ao_distance: float = float("inf"),
    ramp: str = "",
    sky: str = "plain",
    alpha: bool = False,
    progress: Progress = None,
) -> np.ndarray:
    """Renders a picture, uint8 ``(height, width, 3)``, sRGB; the same pixels as ``scarp render``.

    Args:
        scene: `Terrain`, `Voxels`, `Scene`, or what `Terrain` accepts.
        size: width and height in pixels, 1 to 65536.
        look: ``shaded``, ``hillshade``, ``height``, ``steps``, ``cost``, ``error`` or ``comanche``.
        view: compass azimuth and elevation of the eye in degrees, as seen from the scene; it shows the whole scene.
        distance: factor of the distance at which all fits into the picture.
        fov: vertical angle of view in degrees, 1 to 150.
        top: look straight down, north at the top, as on a map.
        eye, target: position and aim of the camera in metres, as rays have them, instead of ``view``.
        sun: compass azimuth and altitude of the sun in degrees.
        shadows, unlit: whether surfaces block the sun; colours without light.
        haze: share of haze over the diagonal of the scene, 0 to 0.95. Default: 0.1 for a terrain, else 0.
        aa: aa x aa samples per pixel, 1 to 16.
        samples: rays to sun and sky per sample, for soft shadows and ambient occlusion, 0 to 4096.
        ao_distance: maximum distance of ambient occlusion in metres.
        ramp: colours by height: viridis, magma, inferno, plasma, grey or hypsometric.
        sky: ``plain`` or ``scattering``.
        alpha: add a fourth channel, the share of each pixel that shows ground.
        progress: see `viewshed`.

    Raises:
        Error: a setting out of range, nothing to see. Interrupted.

    >>> render(Terrain(np.eye(4, dtype=np.float32), cell=1), (32, 18)).shape
    (18, 32, 3)
    """
    scene = scene_of(scene)
    width, height = (whole(v, "size") for v in numbers(size, 2, "size", "width and height in pixels"))
    unlit, top = flag(unlit, "unlit"), flag(top, "top")
    look, sky, samples = text(look, "look"), text(sky, "sky"), whole(samples, "samples")
    if top:
        refuse_unused(render, "with top", view=view, distance=distance, fov=fov, eye=eye, target=target)
    elif eye is not None:
        refuse_unused(render, "with eye", view=view, distance=distance)
    else:
        refuse_unused(render, "without eye", target=target)
    if unlit:
        refuse_unused(render, "with unlit", shadows=shadows, samples=samples)
    if unlit and sky == "plain":
        refuse_unused(render, "with unlit", sun=sun)
    if samples == 0:
        refuse_unused(render, "without samples", ao_distance=ao_distance)
    if look != "shaded":
        refuse_unused(render, f"on the look {look}", shadows=shadows, haze=haze)
    with reporting(progress) as report:
        return _core.render(
            scene,
            (width, height),
            look,
            whole(aa, "aa"),
            numbers(sun, 2, "sun", "azimuth and altitude in degrees"),
            numbers(view, 2, "view", "azimuth and elevation in degrees"),
            number(distance, "distance"),
            number(fov, "fov"),
            top,
            _point(eye, "eye"),
            _point(target, "target"),
            flag(shadows, "shadows"),
            unlit,
            (0.1 if isinstance(scene, _core.Terrain) else 0.0) if haze is None else number(haze, "haze"),
            samples,
            number(ao_distance, "ao_distance"),
            text(ramp, "ramp"),
            sky,
            flag(alpha, "alpha"),
            scene._georeference[3] if isinstance(scene, _core.Terrain) else 0.0,
            report,
        )


def _point(place: Optional[Sequence[float]], name: str) -> Optional[tuple[float, ...]]:
    return None if place is None else numbers(place, 3, name, "x, y and z in metres")


def png(picture: np.ndarray) -> bytes:
    """Returns a picture as PNG.

    Args:
        picture: uint8, ``(height, width)`` grey, ``(height, width, 3)`` RGB or ``(height, width, 4)`` RGBA.

    Raises:
        Error: another type or shape.

    >>> png(np.zeros((2, 2, 3), np.uint8))[1:4]
    b'PNG'
    """
    picture = np.asarray(picture)
    if (
        picture.dtype != np.uint8
        or picture.ndim not in (2, 3)
        or picture.shape[2:] not in ((), (3,), (4,))
        or picture.size == 0
    ):
        raise Error(
            f"png: {picture.dtype} of the shape {picture.shape} (expected uint8, (height, width) or "
            "(height, width, 3 or 4))"
        )
    height, width = picture.shape[:2]
    colour = {(): 0, (3,): 2, (4,): 6}[picture.shape[2:]]
    rows = np.zeros((height, 1 + picture[0].size), np.uint8)  # filter 0
    rows[:, 1:] = picture.reshape(height, -1)

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, colour, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6))
        + chunk(b"IEND", b"")
    )


def write_png(path: Union[str, "os.PathLike[str]"], picture: np.ndarray) -> None:
    """Writes a picture as a PNG file. Arguments and errors as in `png`; OSError if the file cannot be written."""
    data = png(picture)
    with open(path, "wb") as file:
        file.write(data)
