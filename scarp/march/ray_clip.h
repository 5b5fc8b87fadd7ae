// SPDX-License-Identifier: MIT
// The part of a ray between two planes.
#pragma once

#include <algorithm>
#include <limits>

namespace scarp {

/// Shortens [t_enter, t_exit] to the part where o + d t is in [low, high], up to the rounding of two quotients; empty
/// (t_enter > t_exit) if there is none.
inline void clip_to_range(double low, double high, double o, double d, double& t_enter, double& t_exit) {
  if (d == 0) {
    if (!(o >= low && o <= high)) t_exit = -std::numeric_limits<double>::infinity();
    return;
  }
  const double a = (low - o) / d, b = (high - o) / d;
  t_enter = std::max(t_enter, std::min(a, b));
  t_exit = std::min(t_exit, std::max(a, b));
}

}  // namespace scarp
