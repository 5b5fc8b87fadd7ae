// SPDX-License-Identifier: MIT
// Axis-aligned boxes in world space.
#pragma once

#include <glm/common.hpp>
#include <limits>

#include "scarp/base/vec.h"

namespace scarp {

/// A closed box in world space, initially empty.
struct WorldBox {
  dvec3 low{std::numeric_limits<double>::infinity()};
  dvec3 high{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(low.x <= high.x); }
  dvec3 middle() const { return 0.5 * (low + high); }
  /// Corner 0..7.
  dvec3 corner(int i) const { return {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z}; }
};

/// Returns the smallest box around both.
inline WorldBox around(const WorldBox& a, const WorldBox& b) {
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

/// Half the surface area; 0 for an empty box.
inline double half_area(const WorldBox& box) {
  const dvec3 size = glm::max(box.high - box.low, dvec3(0.0));
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

}  // namespace scarp
