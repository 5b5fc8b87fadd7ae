// SPDX-License-Identifier: MIT
// Internal: the shrink factor of lipschitz and its guarantee.
#pragma once

#include <string>

#include "scarp/march/guarantee.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// Returns the largest shrink factor that a slope bound c proves: 1 / sqrt(1 + c^2).
double largest_proven_shrink(double slope);
/// Returns the guarantee over ground with this slope bound (NaN: unknown): approximate if the settings have a shrink
/// factor that the slope bound does not prove, else conservative.
Guarantee lipschitz_guarantee(const LipschitzSettings& settings, double slope);
/// Returns a message for users if the guarantee is approximate, without a full stop; empty if it is conservative.
std::string lipschitz_caveat(const LipschitzSettings& settings, double slope);

struct ShrinkFactor {
  double factor;        ///< fraction of the vertical distance
  Guarantee guarantee;  ///< conservative if the slope bound proves the factor, else approximate
};

/// Returns the factor of the settings or, if that is 0, largest_proven_shrink(slope) reduced by the fraction
/// `rounding`. Throws Error if the factor is 0 and the slope is unknown (NaN).
ShrinkFactor shrink_factor(const LipschitzSettings& settings, double slope, double rounding = 0);

}  // namespace scarp
