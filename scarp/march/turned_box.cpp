// SPDX-License-Identifier: MIT
#include "scarp/march/turned_box.h"

#include <algorithm>
#include <cmath>

#include "scarp/base/error.h"

namespace scarp {

void validate(const TurnedBox& box) {
  bool good = box.half.x >= 0 && box.half.y >= 0 && box.half.z >= 0 && std::isfinite(length(box.half)) &&
              std::isfinite(length(box.centre));
  // Allows many roundings of multiplied rotations, but no intentional shear.
  constexpr double kRigid = 1e-9;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) good = good && std::abs(dot(box.turn[i], box.turn[j]) - (i == j ? 1 : 0)) <= kRigid;
  }
  if (!good) throw Error("overlap: a box is finite, with sides that are not negative and a rotation");
}

bool overlaps(const TurnedBox& box, const Triangle& triangle) {
  // In the box's own space, where it is axis-aligned.
  Triangle t;
  for (std::size_t i = 0; i < 3; ++i) t[i] = (triangle[i] - box.centre) * box.turn;
  const auto separates = [&](const dvec3& axis) {
    const double a = dot(axis, t[0]), b = dot(axis, t[1]), c = dot(axis, t[2]), reach = dot(box.half, abs(axis));
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  const dvec3 sides[3] = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  for (int i = 0; i < 3; ++i) {
    dvec3 axis(0.0);
    axis[i] = 1;
    if (separates(axis)) return false;
    for (const dvec3& side : sides) {
      if (separates(cross(axis, side))) return false;
    }
  }
  return !separates(cross(sides[0], sides[1]));
}

bool overlaps(const TurnedBox& box, const dvec3& low, const dvec3& high) {
  const dvec3 half = 0.5 * (high - low), to = 0.5 * (low + high) - box.centre;
  const auto separates = [&](const dvec3& axis) {
    const double own = box.half.x * std::abs(dot(box.turn[0], axis)) + box.half.y * std::abs(dot(box.turn[1], axis)) +
                       box.half.z * std::abs(dot(box.turn[2], axis));
    return std::abs(dot(to, axis)) > own + dot(half, abs(axis));
  };
  for (int i = 0; i < 3; ++i) {
    dvec3 axis(0.0);
    axis[i] = 1;
    if (separates(axis) || separates(box.turn[i])) return false;
    for (int j = 0; j < 3; ++j) {
      if (separates(cross(axis, box.turn[j]))) return false;
    }
  }
  return true;
}

}  // namespace scarp
