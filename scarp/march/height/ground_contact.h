// SPDX-License-Identifier: MIT
// Tests spheres, capsules and boxes against the ground: the first contact of a moving one, and overlap.
//
// Guarantee: exact to rounding for `triangles` (march/sweep.h). Over bilinear surfaces nothing is deeper in the ground
// than 2^-21 of the shorter side of a cell (patch_contact.h). Both sides of the surface count; the ground below it does
// not, nor do walls of solid ground. Cost: a few blocks per level and per cell along the path, found best first in the
// pyramid.
#pragma once

#include <optional>

#include "scarp/march/height/height_target.h"
#include "scarp/march/sweep.h"
#include "scarp/march/turned_box.h"

namespace scarp {

struct GroundContact : Contact {
  Cell cell{};
};

/// Returns the first contact of a capsule that moves along `motion` in metres. Requires the field's pyramid. Throws
/// Error without it, for a wrapped field, and for a capsule or a motion that validate() rejects.
std::optional<GroundContact> sweep(const HeightTarget& target, const Capsule& capsule, const dvec3& motion);

/// Returns whether the surface and the box, both closed, have a point in common. Errors as for sweep(), and for a box
/// that validate() rejects.
bool overlaps(const HeightTarget& target, const TurnedBox& box);

}  // namespace scarp
