// SPDX-License-Identifier: MIT
// The look `hillshade`: Lambert's law in grey levels 1 to 255, as in gdaldem; 0 means no ground. No shadows, colours or
// skylight.
#pragma once

#include <cstdint>

#include "scarp/base/vec.h"

namespace scarp {

/// Returns 1 + 254 times the cosine between two unit vectors, rounded; 1 if the surface faces away from the sun.
std::uint8_t grey_of_normal(const dvec3& normal, const dvec3& to_sun);

}  // namespace scarp
