// SPDX-License-Identifier: MIT
// An ellipsoid of revolution, and points and directions on it in space: near the poles, where longitudes and latitudes
// change fast, differences between points in space need no special case.
#pragma once

#include <cmath>

#include "scarp/base/vec.h"

namespace scarp {

/// Angles in radians, latitudes geodetic, lengths in metres. WGS 84 by default.
struct Ellipsoid {
  double a = 6378137;            ///< semi-major axis
  double e2 = 0.00669437999014;  ///< eccentricity squared

  /// Radii of curvature.
  double prime_vertical_radius(double lat) const { return a / std::sqrt(1 - e2 * std::sin(lat) * std::sin(lat)); }
  double meridian_radius(double lat) const {
    const double w2 = 1 - e2 * std::sin(lat) * std::sin(lat);
    return a * (1 - e2) / (w2 * std::sqrt(w2));
  }
  /// The point in space: z along the axis, x towards longitude 0.
  dvec3 point(double lon, double lat) const {
    const double n = prime_vertical_radius(lat);
    return {n * std::cos(lat) * std::cos(lon), n * std::cos(lat) * std::sin(lon), n * (1 - e2) * std::sin(lat)};
  }
};

/// Unit vectors east and north at a point in space. At a pole, the longitude decides.
inline dvec3 east_of(double lon) { return {-std::sin(lon), std::cos(lon), 0}; }
inline dvec3 north_of(double lon, double lat) {
  return {-std::sin(lat) * std::cos(lon), -std::sin(lat) * std::sin(lon), std::cos(lat)};
}

}  // namespace scarp
