// SPDX-License-Identifier: MIT
// The look `hillshade`: Lambert's law in grey, 1 to 255, as gdaldem writes it; black (0) is no ground. There are no
// shadows, no colours and no light of the sky.
#pragma once

#include <cstdint>

#include "scarp/base/vec.h"

namespace scarp {

/// 1 + 254 times the cosine between two unit vectors, rounded; 1 where the surface faces away from the sun.
std::uint8_t grey_of_normal(const dvec3& normal, const dvec3& to_sun);

}  // namespace scarp
