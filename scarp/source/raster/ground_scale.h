// SPDX-License-Identifier: MIT
// Ground length and direction of map units at a point.
//
// Map units in degrees or in projected metres differ from lengths on the ground: a degree of longitude shrinks with the
// cosine of the latitude, Web Mercator's metres are 1/cos(latitude) too short, and projected grids are rotated against
// true north. At one point the map is described by two vectors on the ground, one per map axis:
//
//   geographic CRS   east step: N(lat) * cos(lat) * angle, north step: M(lat) * angle, with the radii of curvature
//                    N (prime vertical) and M (meridian) of the CRS's own ellipsoid
//   projected CRS    the point scale and convergence of PROJ's transformation: central differences of positions on the
//                    ellipsoid, as points in space, so that poles and the antimeridian need no special case
//                    (PROJ's own proj_factors() fails for maps in feet and for longitudes in grads)
//
// Accuracy: better than 1e-6 of the length at the point; the map's scale changes away from it.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace scarp {

/// Scale and orientation of a map at one point.
struct GroundScale {
  double metres_per_x = 1;         ///< ground length of one map unit along map x, > 0
  double metres_per_y = 1;         ///< ground length of one map unit along map y, > 0
  double grid_north_azimuth = 0;   ///< compass azimuth of map +y, radians, 0 = true north, clockwise
  std::string found;               ///< method, one line for display
  std::vector<std::string> notes;  ///< warnings, one line each
};

/// The ground scales of one CRS. Not thread-safe, because PROJ's transformations are not.
class GroundScales {
 public:
  /// `crs` is WKT or any text that PROJ accepts. Throws Error for a CRS that PROJ cannot use.
  explicit GroundScales(const std::string& crs);
  ~GroundScales();

  /// Returns the ground scale at (x, y), given in the CRS's units with x east (longitude) and y north (latitude),
  /// regardless of the axis order of the CRS. Throws Error: a CRS that PROJ cannot use, a point outside its domain, a
  /// pole of a geographic CRS.
  GroundScale at(double x, double y) const;

 private:
  struct Crs;
  std::unique_ptr<Crs> crs_;
};

/// Returns the ground scales of a CRS, those of the last call of this thread if it asked for the same; only for this
/// thread. Throws Error as the constructor.
std::shared_ptr<const GroundScales> ground_scales_of(const std::string& crs);

/// Returns the ground scale at one point, as GroundScales::at().
GroundScale ground_scale_at(const std::string& crs, double x, double y);

}  // namespace scarp
