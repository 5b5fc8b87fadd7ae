# SPDX-License-Identifier: MIT
"""What a node sees, by the definition of scarp/analysis/sight.h, in rational numbers: ground is linear where the line
crosses grid lines, and blocks where it is strictly above the line."""

from fractions import Fraction

import numpy as np


def height_at(heights, col, row):
    """Height of a crossing: at a node, or between two nodes of one side; None over a hole."""
    c, r = int(col // 1), int(row // 1)
    u, v = col - c, row - r
    corners = [(c, r)] if u == 0 and v == 0 else [(c, r), (c + 1, r)] if v == 0 else [(c, r), (c, r + 1)]
    values = [heights[y, x] for x, y in corners]
    if any(np.isnan(values)):
        return None
    share = u if v == 0 else v
    return Fraction(float(values[0])) + share * (Fraction(float(values[-1])) - Fraction(float(values[0])))


def crossings(col, row, step_col, step_row, cols, rows, last):
    """Shares above 0 and below `last` at which a ray from a node crosses grid lines inside the field."""
    shares = set()
    for start, step, count in ((col, step_col, cols), (row, step_row, rows)):
        if step != 0:
            shares |= {Fraction(line - start) / step for line in range(count)}
    for share in sorted(s for s in shares if s > 0 and (last is None or s < last)):
        x, y = col + share * step_col, row + share * step_row
        if 0 <= x <= cols - 1 and 0 <= y <= rows - 1:
            yield share, x, y


def sees(heights, observer, target, eye, target_height):
    """Whether the eye over one node sees the target over another, on a flat Earth."""
    (c, r), (tc, tr) = observer, target
    rows, cols = heights.shape
    low = Fraction(float(heights[r, c])) + Fraction(eye)
    high = Fraction(float(heights[tr, tc])) + Fraction(target_height)
    for share, x, y in crossings(c, r, Fraction(tc - c), Fraction(tr - r), cols, rows, 1):
        ground = height_at(heights, x, y)
        if ground is not None and ground > low + share * (high - low):
            return False
    return True


def first_block(heights, node, step, rise):
    """Index of the first crossing that blocks the ray, counted from 0; None: lit."""
    (c, r), rows, cols = node, heights.shape[0], heights.shape[1]
    start = Fraction(float(heights[r, c]))
    for index, (share, x, y) in enumerate(crossings(c, r, step[0], step[1], cols, rows, None)):
        ground = height_at(heights, x, y)
        if ground is not None and ground > start + share * rise:
            return index
    return None
