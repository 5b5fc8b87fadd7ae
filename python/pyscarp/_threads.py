# SPDX-License-Identifier: MIT
"""Threads of all calls."""

from __future__ import annotations

from . import _core
from ._arguments import whole


def set_threads(threads: int) -> None:
    """Limits the threads of all calls that start afterwards.

    Args:
        threads: their number; 0: all.

    Raises:
        Error: a number below 0.

    >>> set_threads(0)
    """
    _core.set_threads(whole(threads, "threads"))
