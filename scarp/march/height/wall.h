// SPDX-License-Identifier: MIT
// The walls of solid ground, as a ray meets them.
#pragma once

#include "scarp/base/ray.h"

namespace scarp {

/// The unit normal, towards the ray's side, of the wall that the hit says the ray has met: level, and across the x or
/// the y axis. `hit.wall` must be set, and the direction must not be vertical: no such ray meets a wall from outside.
dvec3 wall_normal(const Ray& ray, const Hit& hit);

}  // namespace scarp
