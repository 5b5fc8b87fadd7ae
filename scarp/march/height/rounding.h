// SPDX-License-Identifier: MIT
// Rounding error bounds of a ray's clearance, derived in doc/dev/numerics.md.
#pragma once

#include <algorithm>
#include <cmath>

#include "scarp/field/height_field.h"

namespace scarp {

/// Returns the maximum rounding error of ray height - surface height at time t, in sample units, from world coordinates
/// to a march's clearance: 16 u times the magnitude of the operands, including the offset of the ray into the grid.
/// `relief` is the height difference around the ray: of its cell, or of the whole field.
inline double rounding_of_clearance(const HeightField& field, const GridRay& ray, double t, double relief) {
  constexpr double kUnit = 0x1p-53;  // unit roundoff of double
  constexpr double kRoundings = 16;  // numerics.md counts 11
  const double low = field.min_sample(), high = field.max_sample();
  const double sideways = std::abs(ray.origin.x) + std::abs(ray.direction.x * t) + std::abs(ray.origin.y) +
                          std::abs(ray.direction.y * t) + field.rows();
  const double upright = std::abs(ray.origin.z) + std::abs(ray.direction.z * t) +
                         std::max(std::abs(low), std::abs(high)) +
                         std::abs(field.settings().offset) / field.settings().scale;
  return kRoundings * kUnit * (upright + sideways * relief);
}
inline double rounding_of_clearance(const HeightField& field, const GridRay& ray, double t) {
  return rounding_of_clearance(field, ray, t, field.max_sample() - field.min_sample());
}

}  // namespace scarp
