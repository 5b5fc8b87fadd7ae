// SPDX-License-Identifier: MIT
// Directions that are meant to be vertical.
#pragma once

#include <cmath>
#include <numbers>

#include "bench/random.h"

namespace scarp::bench {

/// Deviation of a direction from the vertical: the cosine of 90 degrees, the noise of quaternions, 2^-30 to 2^-1000.
inline double off_vertical(Random& random) {
  const double sign = random.below(2) ? 1 : -1;
  switch (random.below(4)) {
    case 0:
      return sign * std::cos(std::numbers::pi / 2);
    case 1:
      return random.uniform(-4, 4) * 0x1p-53;
    case 2:
      return sign * std::ldexp(random.uniform(0.5, 1), -30 - random.below(60));
    default:
      return sign * std::ldexp(random.uniform(0.5, 1), -30 - random.below(971));
  }
}

}  // namespace scarp::bench
