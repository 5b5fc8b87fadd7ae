// SPDX-License-Identifier: MIT
// The part of a ray between two planes.
#pragma once

#include <algorithm>
#include <limits>

namespace scarp {

/// Shortens [t_enter, t_exit] to where o + d t is in [low, high], but for the rounding of two quotients; empty
/// (t_enter > t_exit) where that is nowhere.
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
