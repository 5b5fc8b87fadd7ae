// SPDX-License-Identifier: MIT
// Internal: the shrink factor of lipschitz and its guarantee.
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

/// Returns the factor of the settings or, if that is 0, largest_proven_shrink(slope) reduced by the share `rounding`.
/// Throws Error if the factor is 0 and the slope is unknown (NaN).
inline ShrinkFactor shrink_factor(const LipschitzSettings& settings, double slope, double rounding = 0) {
  if (settings.shrink > 0) return {settings.shrink, lipschitz_guarantee(settings, slope)};
  if (std::isnan(slope)) throw Error("lipschitz: neither the field's slope bound nor a shrink factor is given");
  return {(1 - rounding) * largest_proven_shrink(slope), Guarantee::conservative};
}

}  // namespace scarp
