// SPDX-License-Identifier: MIT
// What rounding can do to the clearance of a ray, derived in doc/dev/numerics.md.
#pragma once

#include <algorithm>
#include <cmath>

#include "scarp/field/height_field.h"

namespace scarp {

/// The most that rounding adds to ray height - surface height at time t, in sample units, on the way from world
/// coordinates to a march's clearance: 16 u times the quantities that go into it, those that the ray was shifted by on
/// its way into the grid included.
/// `relief` is how far heights differ where the ray is: in its cell, or in the whole field.
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
