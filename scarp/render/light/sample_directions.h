// SPDX-License-Identifier: MIT
// Maps points of the unit square to directions. Neighbouring points stay neighbours and areas keep their proportions,
// so points that are well distributed in the square are well distributed in the sky.
#pragma once

#include "scarp/base/vec.h"

namespace scarp {

/// Point of the unit disc, uniform in area (Shirley and Chiu 1997, concentric squares to concentric circles).
dvec2 on_disc(dvec2 square);

/// Two unit vectors that form a right-handed frame with a unit vector (Duff et al. 2017, without branches).
struct Frame {
  explicit Frame(const dvec3& axis);
  /// The z of `v` is along the axis.
  dvec3 to_world(const dvec3& v) const { return v.x * side + v.y * other + v.z * axis; }

  dvec3 axis, side, other;
};

/// Unit vector of the hemisphere around +z, with density proportional to z (Malley's method: a disc, projected to the
/// sphere).
dvec3 cosine_weighted(dvec2 square);

/// Unit vector of the cap around +z with an angular radius of `radius` radians, 0 to pi/2, uniform in solid angle (the
/// disc lifted by Lambert's equal-area projection).
dvec3 in_cap(dvec2 square, double radius);
/// 1 - cos(radius), without cancellation for the few milliradians of the sun.
double cap_depth(double radius);

}  // namespace scarp
