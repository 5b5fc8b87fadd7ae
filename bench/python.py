# SPDX-License-Identifier: MIT
"""The Python package beside C++, NumPy and xarray-spatial: see bench/README.md.

usage: python.py PYTHON_RAYS [--csv FILE] [--repeats N] [--small]
"""

import argparse
import ctypes
import datetime
import os
import platform
import subprocess
import sys
import tempfile
import time

import numpy as np

import pyscarp

CELL = 10.0
# xarray-spatial's own benchmark of viewshed() (asv, class Viewshed, nx = 3000): NumPy on a CPU, and OptiX on a graphics
# card; the benchmark is https://github.com/xarray-contrib/xarray-spatial/pull/595. Not measured here.
XARRAY_SPATIAL = {"CPU": 7.24, "GPU": 0.170}


def ground(side, seed=1):
    """Hills of several sizes, float32, 0 to about 600 m."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[0:side, 0:side].astype(np.float32)
    heights = np.zeros((side, side), np.float32)
    for octave in range(6):
        angle, phase = random.uniform(0, 2 * np.pi, 2)
        u, v = x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)
        length = 300 / 2**octave
        heights += 300 / 2**octave * np.sin(u / length + phase) * np.cos(v / length)
    return heights - heights.min()


def camera_rays(heights, width, height):
    """Rays of a camera above the southern border, looking north and down."""
    side = len(heights)
    eye = np.array([side / 2 * CELL, 10.0, float(heights.max()) + 200])
    right, up = np.meshgrid(np.linspace(-0.7, 0.7, width), np.linspace(0.1, -0.8, height))
    directions = np.stack([right, np.ones_like(right), up], axis=-1).reshape(-1, 3)
    return np.ascontiguousarray(np.broadcast_to(eye, directions.shape)), directions


def random_rays(heights, width, height):
    """Rays from random points above all ground, in random directions downward."""
    random = np.random.default_rng(2)
    count = width * height
    origins = random.uniform(0, (len(heights) - 1) * CELL, (count, 3))
    origins[:, 2] = float(heights.max()) + 50
    directions = random.normal(size=(count, 3))
    directions[:, 2] = -0.3 * np.abs(directions[:, 2]) - 0.3
    return origins, directions


def march(heights, origins, directions, step):
    """Fixed steps on all rays at once, as such code is written: t of the first step below the nearest sample."""
    side = len(heights)
    found = np.full(len(origins), np.inf)
    index = np.arange(len(origins))
    t = np.zeros(len(origins))
    highest = heights.max()
    while len(index):
        p = origins[index] + t[:, None] * directions[index]
        col, row = np.rint(p[:, 0] / CELL).astype(int), side - 1 - np.rint(p[:, 1] / CELL).astype(int)
        inside = (col >= 0) & (col < side) & (row >= 0) & (row < side)
        inside &= (p[:, 2] <= highest) | (directions[index, 2] < 0)
        below = np.zeros(len(index), bool)
        below[inside] = p[inside, 2] <= heights[row[inside], col[inside]]
        found[index[below]] = t[below]
        on = inside & ~below
        index, t = index[on], t[on] + step
    return found


def least_seconds(repeats, work):
    """Processor time: on one thread it is the time on a machine without other work."""
    least = np.inf
    for _ in range(repeats):
        begin = time.process_time()
        work()
        least = min(least, time.process_time() - begin)
    return least


def memory_kb(name):
    with open("/proc/self/status") as file:
        return next(int(line.split()[1]) for line in file if line.startswith(name))


def peak_bytes(work):
    """Additional memory of a call."""
    ctypes.CDLL(None).malloc_trim(0)  # what earlier calls freed is not there already
    with open("/proc/self/clear_refs", "w") as file:
        file.write("5")
    before = memory_kb("VmRSS")
    result = work()
    peak = memory_kb("VmHWM")
    del result
    return 1024 * (peak - before)


def rays(program, name, make_rays, side, count, repeats):
    """Rows of batch, call and marching: (what, engine, seconds, ratio, note)."""
    heights = ground(side)
    origins, directions = make_rays(heights, count, count)
    terrain = pyscarp.Terrain(heights, cell=CELL)
    out = pyscarp.Hits(len(origins), position=False, normal=False)
    one = pyscarp.Hits(1, position=False, normal=False)
    first = origins[:1], directions[:1]
    calls = 20_000

    def many():
        cast = terrain.cast
        for _ in range(calls):
            cast(*first, out=one)

    batch, call, cxx_batch, cxx_call = [], [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for file, array in ("heights", heights), ("origins", origins), ("directions", directions):
            array.tofile(os.path.join(folder, f"{file}.raw"))
        for _ in range(3):  # in turn: the machine may have other work
            words = [program, folder, str(side), str(CELL), str(repeats)]
            printed = subprocess.run(words, check=True, capture_output=True, text=True).stdout.split()
            cxx_batch.append(float(printed[0]))
            cxx_call.append(float(printed[1]))
            batch.append(least_seconds(repeats, lambda: terrain.cast(origins, directions, out=out)))
            call.append(least_seconds(repeats, many) / calls)
    step = CELL / 2
    begin = time.process_time()
    marched = march(heights, origins, directions, step)
    numpy_seconds = time.process_time() - begin
    wrong = np.isfinite(marched) != np.isfinite(out.t)
    both = ~wrong & np.isfinite(out.t)
    wrong[both] = np.abs(marched[both] - out.t[both]) > CELL
    number = f"{len(origins)} {name} rays"
    yield f"cast, {number}", "C++", min(cxx_batch), 1.0, ""
    yield f"cast, {number}", "pyscarp, out=", min(batch), min(batch) / min(cxx_batch), "at most 1.1"
    yield f"cast, {number}", "NumPy, fixed steps", numpy_seconds, numpy_seconds / min(cxx_batch), (
        f"steps of half a cell; {100 * wrong.mean():.2g} % of rays wrong by more than a cell"
    )
    if name == "camera":
        return
    yield "cast, 1 ray", "C++", min(cxx_call), 1.0, ""
    more = min(call) - min(cxx_call)
    yield "cast, 1 ray", "pyscarp, out=", min(call), min(call) / min(cxx_call), f"{1e6 * more:.2f} us more; at most 2"


def viewsheds(side, repeats):
    heights = ground(side)
    terrain = pyscarp.Terrain(heights, cell=CELL)
    eye = (side / 2 * CELL, side / 2 * CELL)
    seconds = least_seconds(repeats, lambda: pyscarp.viewshed(terrain, eye))
    bytes_per_pixel = peak_bytes(lambda: pyscarp.viewshed(terrain, eye)) / side**2
    what = f"viewshed, {side} x {side}"
    yield what, "pyscarp", seconds, 1.0, f"at most 0.05 s; {bytes_per_pixel:.1f} bytes per pixel; at most 8"
    if side == 3000:
        for device, published in XARRAY_SPATIAL.items():
            yield what, f"xarray-spatial, {device}", published, published / seconds, "as published"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", metavar="PYTHON_RAYS", help="the program python_rays of the same build")
    parser.add_argument("--csv", help="file to write")
    parser.add_argument("--repeats", type=int, default=7, help="least time of that many (7)")
    parser.add_argument("--small", action="store_true", help="small input, to check that everything works")
    options = parser.parse_args()
    pyscarp.set_threads(1)
    side, count, wide = (129, 30, 200) if options.small else (2049, 1000, 3000)
    rows = [
        *rays(options.program, "camera", camera_rays, side, count, options.repeats),
        *rays(options.program, "random", random_rays, side, count, options.repeats),
    ]
    rows += [*viewsheds(wide, options.repeats)]
    print(f"{'':32}{'':24}{'seconds':>12}{'ratio':>8}")
    for what, engine, seconds, ratio, note in rows:
        print(f"{what:32}{engine:24}{seconds:12.4g}{ratio:8.3g}  {note}")
    if options.csv:
        with open("/proc/cpuinfo") as file:
            model = next((line.split(": ")[1].strip() for line in file if line.startswith("model name")), "unknown")
        with open(options.csv, "w") as file:
            file.write(
                f'# machine: "{model}, {os.cpu_count()} cores, Linux {platform.release()}, Python '
                f'{platform.python_version()}, NumPy {np.__version__}"\n'
                f"# command: python.py python_rays {' '.join(sys.argv[2:])}\n"
                f"# date: {datetime.datetime.now(datetime.timezone.utc):%Y-%m-%dT%H:%M:%SZ}\n"
                "what,engine,threads,seconds,ratio,note\n"
            )
            for what, engine, seconds, ratio, note in rows:
                threads = "" if "xarray" in engine else 1
                file.write(f'"{what}","{engine}",{threads},{seconds:.6g},{ratio:.4g},"{note}"\n')


if __name__ == "__main__":
    main()
