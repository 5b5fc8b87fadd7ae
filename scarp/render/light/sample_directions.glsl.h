// SPDX-License-Identifier: MIT
// Maps points of the unit square to directions: the formulas of sample_directions.h. Compiles as C++ and GLSL.
#ifndef SCARP_RENDER_SAMPLE_DIRECTIONS_GLSL_H
#define SCARP_RENDER_SAMPLE_DIRECTIONS_GLSL_H

#include "scarp/vk/real.glsl.h"

SCARP_GLSL_BEGIN

/// Point of the unit disc, uniform in area.
SCARP_FN real2 scarp_on_disc(real2 square) {
  real a = real(2.0) * square.x - real(1.0);
  real b = real(2.0) * square.y - real(1.0);
  if (a == real(0.0) && b == real(0.0)) return real2(real(0.0), real(0.0));
  real quarter = real(0.78539816339744830962);  // an eighth of a turn
  if (abs(a) > abs(b)) return real2(a * cos(quarter * (b / a)), a * sin(quarter * (b / a)));
  return real2(b * sin(quarter * (a / b)), b * cos(quarter * (a / b)));
}

/// Two unit vectors that form a right-handed frame with the unit vector `axis`.
struct ScarpSides {
  real3 side;
  real3 other;
};
SCARP_FN ScarpSides scarp_sides(real3 axis) {
  real sign_z = axis.z < real(0.0) ? real(-1.0) : real(1.0);
  real a = real(-1.0) / (sign_z + axis.z);
  real b = axis.x * axis.y * a;
  ScarpSides sides;
  sides.side = real3(real(1.0) + sign_z * axis.x * axis.x * a, sign_z * b, -sign_z * axis.x);
  sides.other = real3(b, sign_z + axis.y * axis.y * a, -axis.y);
  return sides;
}
/// Rotates `v` so that its z is along the axis.
SCARP_FN real3 scarp_round_axis(real3 axis, real3 v) {
  ScarpSides sides = scarp_sides(axis);
  return v.x * sides.side + v.y * sides.other + v.z * axis;
}

/// Unit vector of the hemisphere around +z, with density proportional to z.
SCARP_FN real3 scarp_cosine_weighted(real2 square) {
  real2 disc = scarp_on_disc(square);
  return real3(disc.x, disc.y, sqrt(max(real(0.0), real(1.0) - dot(disc, disc))));
}

/// Unit vector of the cap around +z, uniform in solid angle; `depth` is 1 - cos(its radius).
SCARP_FN real3 scarp_in_cap(real2 square, real depth) {
  real2 disc = scarp_on_disc(square);
  real below_pole = depth * dot(disc, disc);
  real across = sqrt(depth * (real(2.0) - below_pole));
  return real3(disc.x * across, disc.y * across, real(1.0) - below_pole);
}

SCARP_GLSL_END

#endif
