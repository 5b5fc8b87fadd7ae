// SPDX-License-Identifier: MIT
// Private to the station: the shrink factor of lipschitz, and whether a slope bound proves it.
#pragma once

#include <cmath>

#include "scarp/base/error.h"
#include "scarp/march/lipschitz.h"
#include "scarp/march/march_settings.h"

namespace scarp {

struct ShrinkFactor {
  double factor;        ///< of the vertical distance
  Guarantee guarantee;  ///< conservative if the slope bound proves the factor, else approximate
};

/// The factor of the settings, or the largest one that the slope bound c proves, 1 / sqrt(1 + c^2), less the share
/// `rounding`. Throws Error if there is neither a factor nor a slope bound, which is NaN if unknown.
inline ShrinkFactor shrink_factor(const LipschitzSettings& settings, double slope, double rounding = 0) {
  if (settings.shrink > 0) return {settings.shrink, lipschitz_guarantee(settings, slope)};
  if (std::isnan(slope)) throw Error("lipschitz: neither the field's slope bound nor a shrink factor is given");
  return {(1 - rounding) * largest_proven_shrink(slope), Guarantee::conservative};
}

}  // namespace scarp
