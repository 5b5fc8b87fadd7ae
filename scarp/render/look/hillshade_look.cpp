// SPDX-License-Identifier: MIT
#include "scarp/render/look/hillshade_look.h"

#include <algorithm>
#include <cmath>

namespace scarp {

std::uint8_t grey_of_normal(const dvec3& normal, const dvec3& to_sun) {
  return static_cast<std::uint8_t>(std::lround(1 + 254 * std::max(0.0, dot(normal, to_sun))));
}

}  // namespace scarp
