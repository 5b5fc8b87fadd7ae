// SPDX-License-Identifier: MIT
// The point of the ground that is closest to a given one: for contacts, clearances and distance checks.
//
//            . p          blocks of the pyramid, the nearest first: a block whose box is farther than the best point
//           /             so far holds nothing closer. A cell's triangles are compared in closed form, a bilinear
//   ___    x___           cell by Newton's method (patch_contact.h).
//      \__/
//
// Guarantee: exact for `triangles`, to rounding. For `bilinear` the distance is too large by at most 2^-20 of the
// shorter side of a cell. Cost: a few blocks per level, and the cells around the point.
#pragma once

#include <limits>
#include <optional>

#include "scarp/march/height/height_target.h"

namespace scarp {

struct ClosestPoint {
  dvec3 point{0.0};     ///< on the ground
  double distance = 0;  ///< metres, >= 0
  dvec3 normal{0.0};    ///< upward unit normal of the surface there; on an edge that of one of its sides
  Cell cell{};
  double u = 0, v = 0;  ///< position in the cell, 0..1
};

/// Returns the closest point of the ground within `max_distance` metres of p, from any side; nullopt if there is none.
/// Requires the field's pyramid. Throws Error without it, and for a wrapped field.
std::optional<ClosestPoint> closest_point(const HeightTarget& target, const dvec3& p,
                                          double max_distance = std::numeric_limits<double>::infinity());

}  // namespace scarp
