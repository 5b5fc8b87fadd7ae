// SPDX-License-Identifier: MIT
// The cells at a point of a ray: one, or those on both sides of a line, or all four of a node.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "scarp/march/height/grid_axis.h"

namespace scarp {

/// Whether a position on a line is that of a node. Adding this number rounds to an integer.
inline bool passes_node(double place, double rounding) {
  return std::abs(place - ((place + 0x1.8p52) - 0x1.8p52)) <= rounding;
}

/// Cells of one axis at time t: two if the position is within `rounding` of a line, the one after it first.
struct CellsBeside {
  int cell[2];      // may be outside
  double place[2];  // the position in each, 0..1
  int count;

  template <bool Wraps>
  CellsBeside(const GridAxis<Wraps>& axis, double t, double rounding) {
    const double at = axis.at(t), line = std::round(at), first = std::floor(at);
    const auto within = [&](double global) {
      if (!(std::abs(global) < 0x1p62)) return -1;  // outside, as is NaN
      const std::int64_t number = static_cast<std::int64_t>(global) - axis.global_line(0);
      return static_cast<int>(Wraps ? (number % axis.cells + axis.cells) % axis.cells : number);
    };
    count = std::abs(at - line) <= rounding ? 2 : 1;
    cell[0] = within(count == 2 ? line : first), cell[1] = within(line - 1);
    place[0] = count == 2 ? std::max(at - line, 0.0) : at - first, place[1] = std::min(at - line + 1, 1.0);
  }
};

}  // namespace scarp
