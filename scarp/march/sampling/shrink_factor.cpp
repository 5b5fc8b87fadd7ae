// SPDX-License-Identifier: MIT
#include "scarp/march/sampling/shrink_factor.h"

#include <fmt/format.h>

#include <cmath>

#include "scarp/base/error.h"

namespace scarp {

double largest_proven_shrink(double slope) { return 1 / std::hypot(1.0, slope); }

Guarantee lipschitz_guarantee(const LipschitzSettings& settings, double slope) {
  // NaN, an unknown slope, proves nothing.
  const bool proven = settings.shrink == 0 || settings.shrink <= largest_proven_shrink(slope);
  return proven ? Guarantee::conservative : Guarantee::approximate;
}

std::string lipschitz_caveat(const LipschitzSettings& settings, double slope) {
  if (lipschitz_guarantee(settings, slope) == Guarantee::conservative) return {};
  return fmt::format(
      "lipschitz with shrink factor {:.4g} is approximate: the slope bound {:.4g} proves only factors up to {:.4g}",
      settings.shrink, slope, largest_proven_shrink(slope));
}

ShrinkFactor shrink_factor(const LipschitzSettings& settings, double slope, double rounding) {
  if (settings.shrink > 0) return {settings.shrink, lipschitz_guarantee(settings, slope)};
  if (std::isnan(slope)) throw Error("lipschitz: neither the field's slope bound nor a shrink factor is given");
  return {(1 - rounding) * largest_proven_shrink(slope), Guarantee::conservative};
}

}  // namespace scarp
