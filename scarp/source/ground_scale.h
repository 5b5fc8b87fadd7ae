// SPDX-License-Identifier: MIT
// How long is a map unit on the ground, here? And where is north?
//
// A map in degrees, or in the metres of a projection, is not the ground: one degree of longitude shrinks with the
// cosine of the latitude, Web Mercator's metres are 1/cos(latitude) too short, and the grid of a projection is turned
// against true north. At one point the map is described by two vectors on the ground, one per map axis:
//
//   geographic CRS   east step: N(lat) * cos(lat) * angle, north step: M(lat) * angle, with the radii of curvature
//                    N (prime vertical) and M (meridian) of the CRS's own ellipsoid
//   projected CRS    the point scale and convergence of PROJ's transformation: central differences of the positions on
//   the
//                    ellipsoid, taken as points in space, so that poles and the antimeridian need no special case
//                    (PROJ's own proj_factors() fails for maps in feet and for longitudes in grads)
//
// Accuracy: better than 1e-6 of the length at the point; away from it the map's scale changes.
#pragma once

#include <string>
#include <vector>

namespace scarp {

/// A map at one point.
struct GroundScale {
  double metres_per_x = 1;         ///< ground length of one map unit along map x, > 0
  double metres_per_y = 1;         ///< the same along map y
  double grid_north_azimuth = 0;   ///< compass azimuth of map +y, radians, 0 = true north, clockwise
  std::string found;               ///< how, one line for people
  std::vector<std::string> notes;  ///< what deserves attention
};

/// The ground scale at (x, y), given in the CRS's units with x east (longitude) and y north (latitude), whatever order
/// the CRS itself prescribes. `crs` is WKT or any text that PROJ knows. Throws Error: a CRS that PROJ cannot use, a
/// point outside of its domain, a pole of a geographic CRS.
GroundScale ground_scale_at(const std::string& crs, double x, double y);

}  // namespace scarp
