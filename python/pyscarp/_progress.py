# SPDX-License-Identifier: MIT
"""Progress of long tasks."""

from __future__ import annotations

import contextlib
import sys
import warnings
from typing import Callable, Iterator, Optional, Union

#: None: none; True: a bar (tqdm where it is installed); or a function of the fraction done, 0 to 1, which may return
#: False to stop the task (`Interrupted`).
Progress = Union[None, bool, Callable[[float], Optional[bool]]]


@contextlib.contextmanager
def reporting(progress: Progress) -> Iterator[Optional[Callable[[float], Optional[bool]]]]:
    """Yields the function that the task calls."""
    if progress is None or progress is False:
        yield None
    elif progress is not True:
        if not callable(progress):
            raise TypeError("progress: expected None, True or a function of the fraction done")
        yield progress
    else:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # notebooks without widgets show its bar as text
                from tqdm.auto import tqdm  # type: ignore[import]
        except ImportError:
            yield _percent
            return
        with tqdm(total=100, unit="%", bar_format="{l_bar}{bar}| {elapsed}<{remaining}") as bar:

            def show(fraction: float) -> None:
                bar.update(round(100 * fraction) - bar.n)

            yield show


def _percent(fraction: float) -> None:
    print(f"\r{100 * fraction:3.0f} %", end="\n" if fraction == 1 else "", file=sys.stderr, flush=True)
