// SPDX-License-Identifier: MIT
// The crossings of a straight line with the grid lines of a field, in integers.
//
// The line starts at (x, y) / scale in columns and rows and runs along the integer vector (a, b). It crosses column
// line k at parameter tau = |k scale - x| / |a|, between rows j and j + 1 with weights that are integers:
//
//   position  (y |a| + b |k scale - x|) / (scale |a|)  =  j + w1 / (w0 + w1),   w0 + w1 = scale |a|
//
// and row lines likewise. numerics.md ("Maps") bounds the integers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "scarp/analysis/sight.h"

namespace scarp {

/// One crossing: the ground there is (w0 height(first) + w1 height(second)) / (w0 + w1). If w1 is 0 the crossing is at
/// a node, and `second` may not exist.
struct Crossing {
  Node first, second;
  std::int64_t w0, w1;
  std::int64_t steps;  ///< parameter tau = steps / length
  std::int64_t length;
};

/// A line over a field. Products of its members stay below 2^62: |x|, |y|, |a|, |b| <= 2^30 with scale kSubcells, or
/// x, y <= 2^20 and |a|, |b| <= 2^26 with scale 1.
struct GridLine {
  std::int64_t x, y, a, b, scale;
};

/// Grid lines of one axis by index, both included.
struct LineRange {
  std::int64_t first = 0, last = kMaxSightSide;
};

/// Calls visit(crossing) for the column lines (axis 0) or row lines (axis 1) of `range` that `line` crosses with
/// 0 < tau, and with tau < 1 if `ends`, inside the field, outwards from the start, which may be outside. Stops if visit
/// returns false. A line that runs along grid lines of one axis crosses only those of the other. Returns whether visit
/// never returned false.
template <class Visit>
bool visit_crossings(const GridLine& line, int axis, int cols, int rows, bool ends, const Visit& visit,
                     const LineRange& range = {}) {
  const std::int64_t x = axis == 0 ? line.x : line.y, y = axis == 0 ? line.y : line.x;
  const std::int64_t a = axis == 0 ? line.a : line.b, b = axis == 0 ? line.b : line.a;
  const std::int64_t lines = axis == 0 ? cols : rows, across = axis == 0 ? rows : cols;
  if (a == 0) return true;
  const std::int64_t length = std::abs(a), whole = line.scale * length, sign = a > 0 ? 1 : -1;
  // The first line strictly after the start: x may lie between lines.
  const std::int64_t floor = x >= 0 ? x / line.scale : -((line.scale - 1 - x) / line.scale);
  std::int64_t k = sign > 0 ? floor + 1 : (floor * line.scale == x ? floor - 1 : floor);
  const std::int64_t low_line = std::max<std::int64_t>(range.first, 0), high_line = std::min(range.last, lines - 1);
  if (sign > 0 ? k < low_line : k > high_line) k = sign > 0 ? low_line : high_line;
  for (; k >= low_line && k <= high_line; k += sign) {
    const std::int64_t steps = std::abs(k * line.scale - x);
    if (ends && steps >= length) break;
    const std::int64_t place = y * length + b * steps;
    // Beside the field: either the line has left it, or it may still enter.
    if (place < 0) {
      if (b > 0) continue;
      break;
    }
    const std::int64_t j = place / whole, w1 = place - j * whole;
    if (j >= across || (w1 > 0 && j + 1 >= across)) {
      if (b < 0) continue;
      break;
    }
    const int line_index = static_cast<int>(k), low = static_cast<int>(j);
    const Crossing crossing{axis == 0 ? Node{line_index, low} : Node{low, line_index},
                            axis == 0 ? Node{line_index, low + 1} : Node{low + 1, line_index},
                            whole - w1,
                            w1,
                            steps,
                            length};
    if (!visit(crossing)) return false;
  }
  return true;
}

}  // namespace scarp
