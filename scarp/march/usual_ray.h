// SPDX-License-Identifier: MIT
// Rays whose directions are so long or short that their squares or reciprocals overflow are marched at usual length:
// scaled near 1 by a power of two, which is exact; t is scaled back by the same factor.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/base/ray.h"

namespace scarp {

/// The absolute value of the longest component, which the functions below use as the length.
inline double longest_of(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Far from the limits of doubles.
constexpr double kShortestUsual = 0x1p-500, kLongestUsual = 0x1p500;
inline bool is_usual(double longest) { return longest > kShortestUsual && longest < kLongestUsual; }

/// Whether the direction is valid: neither zero nor infinite nor NaN.
inline bool is_direction(double longest) { return longest > 0 && std::isfinite(longest); }

/// Whether validate() accepts the ray's numbers; for others, marches may not terminate.
inline bool is_followable(const Ray& ray) {
  const double origin = longest_of(ray.origin);
  const bool numbers =
      std::isfinite(ray.origin.x + ray.origin.y + ray.origin.z) || (std::isfinite(origin) && ray.origin == ray.origin);
  return numbers && is_direction(longest_of(ray.direction)) && ray.direction == ray.direction &&
         std::isfinite(ray.t_min) && ray.t_min <= ray.t_max;
}

/// The ray with its direction divided by 2^exponent, and its range multiplied; its t are 2^exponent times those of
/// `ray`. The range is cut where t of `ray` would overflow: hits beyond are missed.
inline Ray scaled_down(const Ray& ray, int exponent) {
  Ray scaled = ray;
  for (int axis = 0; axis < 3; ++axis) scaled.direction[axis] = std::ldexp(ray.direction[axis], -exponent);
  scaled.t_min = std::max(std::ldexp(ray.t_min, exponent), std::numeric_limits<double>::lowest());
  scaled.t_max = std::ldexp(std::min(ray.t_max, std::numeric_limits<double>::max()), exponent);
  return scaled;
}

/// Returns the closest hit of a ray of unusual length: calls `march` with the ray scaled to usual length.
template <class March>
Hit at_usual_length(const Ray& ray, double longest, const March& march) {
  if (!is_direction(longest)) return {};
  const int exponent = std::ilogb(longest);
  Hit hit = march(scaled_down(ray, exponent));
  hit.t = std::ldexp(hit.t, -exponent);
  return hit;
}

}  // namespace scarp
