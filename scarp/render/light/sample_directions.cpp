// SPDX-License-Identifier: MIT
#include "scarp/render/light/sample_directions.h"

#include <cmath>

#include "scarp/render/light/sample_directions.glsl.h"

namespace scarp {

dvec2 on_disc(dvec2 square) { return glsl::scarp_on_disc(square); }

Frame::Frame(const dvec3& n) : axis(n) {
  const glsl::ScarpSides sides = glsl::scarp_sides(n);
  side = sides.side;
  other = sides.other;
}

dvec3 cosine_weighted(dvec2 square) { return glsl::scarp_cosine_weighted(square); }

double cap_depth(double radius) { return 2 * std::sin(radius / 2) * std::sin(radius / 2); }

dvec3 in_cap(dvec2 square, double radius) { return glsl::scarp_in_cap(square, cap_depth(radius)); }

}  // namespace scarp
