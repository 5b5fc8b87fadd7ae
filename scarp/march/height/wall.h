// SPDX-License-Identifier: MIT
// The walls of solid ground that rays hit.
#pragma once

#include "scarp/base/ray.h"

namespace scarp {

/// Returns the unit normal of the wall that was hit, towards the ray's side: horizontal, along the x or the y axis.
/// `hit.wall` must be set, and the direction must not be vertical: vertical rays cannot hit a wall from outside.
dvec3 wall_normal(const Ray& ray, const Hit& hit);

}  // namespace scarp
