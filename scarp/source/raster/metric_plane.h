// SPDX-License-Identifier: MIT
// Planes in metres on which maps are computed, for rasters in any CRS, without a warp.
//
// Samples keep their rows and columns; every step has the same ground length everywhere on a plane. The plane's error,
// in cells, is the distance between a sample's position on the plane and its position by geodesic distance and azimuth
// from the plane's origin.
//
//   around a place   scale and north are those at the place
//   along a line     the scale is that at the middle of the line, lengthened so that the line has its geodesic length;
//                    the origin is its start, from where the plane's azimuth to its end is the geodesic's
#pragma once

#include <memory>

#include "scarp/base/georeference.h"
#include "scarp/base/vec.h"

namespace scarp {

struct MetricPlane {
  double cell_x = 1, cell_y = 1;  ///< lengths of a column and a row step, metres
  double grid_north_azimuth = 0;  ///< radians, as Georeference::grid_north_azimuth, at the place or the middle
  double error_cells = 0;         ///< largest error in reach, or on the line; 0 without a CRS
};

/// The celestial body that a CRS refers to.
struct Body {
  double semi_major = 6378137;  ///< metres
  bool earth = true;            ///< within 5 % of the size of WGS 84's ellipsoid
};
/// Returns the body of the georeference's CRS; the Earth without a CRS.
Body body_of(const Georeference& georeference);

/// Whether the CRS uses degrees.
bool is_geographic(const Georeference& georeference);

/// The planes of one raster, the samples of which count from its north-west. Not thread-safe, because PROJ's
/// transformations are not.
class MetricPlanes {
 public:
  /// Without a geographic or projected CRS, all planes have the cell sizes and the azimuth of the georeference. Throws
  /// Error without the file's name if PROJ cannot use the CRS.
  MetricPlanes(const Georeference& georeference, int cols, int rows);
  ~MetricPlanes();

  /// Returns the plane around a place. `reach`: distance, in metres, within which samples matter. Throws Error for a
  /// place outside the domain of the CRS.
  MetricPlane around(const dvec2& at, double reach) const;
  /// Returns the plane along a line. Throws Error as around().
  MetricPlane along(const dvec2& from, const dvec2& to) const;
  /// Returns the geodesic distance between two places in metres; NaN outside the domain of the CRS.
  double distance(const dvec2& from, const dvec2& to) const;

 private:
  struct Ground;
  MetricPlane local(const dvec2& at) const;

  Georeference georeference_;
  int cols_, rows_;
  std::unique_ptr<Ground> ground_;  // only for geographic and projected CRS
};

}  // namespace scarp
