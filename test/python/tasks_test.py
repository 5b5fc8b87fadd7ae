# SPDX-License-Identifier: MIT
"""Long tasks: other threads run meanwhile, progress, Ctrl-C, and edits that wait."""

import os
import signal
import sys
import threading
import time

import numpy as np
import pytest
from conftest import hills

import pyscarp
from pyscarp import Error, Terrain


@pytest.fixture(scope="module")
def large():
    return Terrain(hills(700, 700), cell=10)


def long_task(terrain, progress=None):
    """Takes minutes to its end."""
    return pyscarp.horizon(terrain, 3000, progress=progress)


def test_other_threads_run_during_queries(large):
    origins = np.random.default_rng(1).random((400_000, 3)) * (6990, 6990, 0) + (0, 0, 400)
    directions = np.array([1.0, 0.5, -0.05])
    span = []

    def query():
        batch = np.ascontiguousarray(np.broadcast_to(directions, origins.shape))
        out = pyscarp.Hits(len(origins))
        large.cast(origins[:2], batch[:2])
        span.append(time.perf_counter())
        large.cast(origins, batch, out=out)
        span.append(time.perf_counter())

    thread = threading.Thread(target=query)
    seen = []
    thread.start()
    while thread.is_alive():
        seen.append(time.perf_counter())
    thread.join()
    begin, end = span
    third = (end - begin) / 3
    # With the interpreter's lock held, this thread would stand still between the two.
    assert sum(begin + third < moment < end - third for moment in seen) > 100


def test_threads_share_a_terrain(large):
    origins = np.random.default_rng(2).random((20_000, 3)) * (6990, 6990, 0) + (0, 0, 400)
    directions = np.broadcast_to(np.array([1.0, 0.5, -0.2]), origins.shape)
    wanted = large.cast(origins, directions).t
    found = [None] * 6

    def query(i):
        found[i] = large.cast(origins, directions).t

    threads = [threading.Thread(target=query, args=(i,)) for i in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(t, wanted) for t in found)


def test_edits_wait_for_queries():
    terrain = Terrain(np.zeros((200, 200), np.float32), cell=1)
    origins = np.random.default_rng(3).random((20_000, 3)) * (198, 198, 0) + (0, 0, 500)
    directions = np.broadcast_to(np.array([0, 0, -1.0]), origins.shape)
    stop, uniform = threading.Event(), []

    def query():
        while not stop.is_set():
            # A query sees the ground before or after an edit, never a mixture.
            uniform.append(np.ptp(terrain.cast(origins, directions, normal=False).t) == 0)

    threads = [threading.Thread(target=query) for _ in range(2)]
    for thread in threads:
        thread.start()
    height = 0
    while len(uniform) < 40 and all(uniform):
        height += 1
        terrain.edit(height % 100)
    stop.set()
    for thread in threads:
        thread.join()
    # Queries cannot keep an edit waiting, nor edits queries.
    assert all(uniform) and height > 10


def test_ranges_are_those_before_or_after_an_edit():
    heights = np.zeros((3000, 3000), np.float32)
    terrain = Terrain(heights, cell=1)
    for height in 7.0, 9.0, 11.0:
        thread = threading.Thread(target=terrain.edit, args=(height,))
        thread.start()
        while heights[0, 0] != height:
            pass
        # The edit has begun: the range is that after it.
        assert terrain.range == (height, height)
        thread.join()


def test_reports_progress_to_the_end(large):
    seen = []
    pyscarp.horizon(large, 6, progress=seen.append)
    assert seen[-1] == 1 and seen == sorted(seen) and all(0 <= f <= 1 for f in seen)
    pyscarp.viewshed(large, (500, 500), progress=seen.append)
    assert seen[-1] == 1


def test_progress_stops_a_task(large):
    begin = time.perf_counter()
    with pytest.raises(pyscarp.Interrupted):
        long_task(large, lambda fraction: False)
    assert time.perf_counter() - begin < 5


def test_errors_of_the_callback_are_raised(large):
    def fail(fraction):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        long_task(large, fail)
    with pytest.raises(TypeError, match="progress"):
        long_task(large, 5)


def test_callbacks_cannot_edit(large):
    with pytest.raises(Error, match="callback"):
        long_task(large, lambda fraction: large.edit(5, rows=slice(0, 1)))


@pytest.fixture
def interruptible():
    """Shells start programs in the background with SIGINT ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_ctrl_c_stops_a_task(large, interruptible):
    timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
    begun = []

    def progress(fraction):
        if not begun:
            timer.start()
        begun.append(fraction)

    with pytest.raises(KeyboardInterrupt):
        long_task(large, progress)
    # It has begun, and has not gone on to its end, minutes later.
    assert begun and begun[-1] < 0.5


def test_ctrl_c_stops_a_batch(large, interruptible):
    origins = np.broadcast_to(np.array([10.0, 10.0, 150.0]), (40_000_000, 3))
    directions = np.broadcast_to(np.array([1.0, 0.7, 0.001]), (40_000_000, 3))
    answers = np.full(len(origins), 7, np.uint8)
    blocked = answers.view(bool)

    def interrupt():
        while answers[0] == 7:
            time.sleep(0.001)
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt).start()
    with pytest.raises(KeyboardInterrupt):
        large.occluded(origins, directions, out=blocked)
    # It has begun, and has not gone on to the end.
    assert answers[-1] == 7


def test_threads_can_be_limited(large):
    pyscarp.set_threads(1)
    try:
        one = pyscarp.viewshed(large, (500, 500))
    finally:
        pyscarp.set_threads(0)
    assert np.array_equal(one, pyscarp.viewshed(large, (500, 500)))
    with pytest.raises(Error, match="threads"):
        pyscarp.set_threads(-1)


def test_terrains_do_not_leak():
    heights = np.zeros((300, 300), np.float32)

    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def round_trip():
        terrain = Terrain(heights, cell=1)
        hits = terrain.cast([[5, 5, 9]] * 100, [0, 0, -1])
        pyscarp.viewshed(terrain, (5, 5))
        for wrong in (lambda: terrain.cast([np.nan, 0, 0], [0, 0, 1]), lambda: pyscarp.viewshed(terrain, (999, 0))):
            with pytest.raises(Error):
                wrong()
        return hits

    for _ in range(20):
        round_trip()
    before = resident()
    for _ in range(60):
        round_trip()
    # A leaked map has 90 kB, a leaked terrain a pyramid of 60 kB.
    assert resident() - before < 60 * 30_000


def test_callbacks_may_run_tasks_of_their_own(large):
    small = Terrain(hills(40, 40), cell=10)
    refused = []

    def nested(fraction):
        pyscarp.horizon(small, 4, progress=lambda f: None)
        with pytest.raises(Error, match="cannot edit"):
            large.edit(5, slice(0, 2), slice(0, 2))
        refused.append(fraction)

    pyscarp.horizon(large, 40, progress=nested)
    assert refused


def test_a_false_of_numpy_stops_a_task(large):
    with pytest.raises(pyscarp.Interrupted if hasattr(pyscarp, "Interrupted") else Error):
        long_task(large, progress=lambda fraction: np.bool_(False))


def test_ctrl_c_stops_all_hits(large, interruptible):
    rays = (3_000_000, 3)
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        origins = np.broadcast_to(np.array([10.0, 10.0, 150.0]), rays)
        large.all_hits(origins, np.broadcast_to(np.array([1.0, 0.7, 0.001]), rays))
    assert timer.finished.is_set()


@pytest.mark.parametrize("with_tqdm", [True, False])
def test_a_bar_shows_progress(large, capfd, monkeypatch, with_tqdm):
    if with_tqdm:
        pytest.importorskip("tqdm")
    else:
        monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    pyscarp.shadow(large, sun=(135, 20), progress=True)
    shown = capfd.readouterr().err
    assert ("100%|" if with_tqdm else "\r100 %\n") in shown
