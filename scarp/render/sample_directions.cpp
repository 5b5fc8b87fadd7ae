// SPDX-License-Identifier: MIT
#include "scarp/render/sample_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scarp {

dvec2 on_disc(dvec2 square) {
  const double a = 2 * square.x - 1, b = 2 * square.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  constexpr double kQuarter = std::numbers::pi / 4;
  if (std::abs(a) > std::abs(b)) return {a * std::cos(kQuarter * (b / a)), a * std::sin(kQuarter * (b / a))};
  return {b * std::sin(kQuarter * (a / b)), b * std::cos(kQuarter * (a / b))};
}

Frame::Frame(const dvec3& n) : axis(n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1 / (sign + n.z), b = n.x * n.y * a;
  side = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  other = {b, sign + n.y * n.y * a, -n.y};
}

dvec3 cosine_weighted(dvec2 square) {
  const dvec2 disc = on_disc(square);
  return {disc.x, disc.y, std::sqrt(std::max(0.0, 1 - dot(disc, disc)))};
}

dvec3 in_cap(dvec2 square, double radius) {
  const dvec2 disc = on_disc(square);
  // 1 - cos(radius), without its loss of digits for the few milliradians of the sun.
  const double depth = 2 * std::sin(radius / 2) * std::sin(radius / 2);
  const double below_pole = depth * dot(disc, disc);
  const double across = std::sqrt(depth * (2 - below_pole));
  return {disc.x * across, disc.y * across, 1 - below_pole};
}

}  // namespace scarp
