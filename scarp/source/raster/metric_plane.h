// SPDX-License-Identifier: MIT
// The plane in metres on which maps are computed, for rasters in any CRS, without a warp.
//
// Samples keep their rows and columns; every step has the ground length that it has at the plane's centre. The plane's
// error, in cells, is the distance between a sample's position on the plane and its position by geodesic distance and
// azimuth from the centre.
#pragma once

#include "scarp/base/georeference.h"

namespace scarp {

struct MetricPlane {
  double cell_x = 1, cell_y = 1;  ///< lengths of a column and a row step, metres
  double grid_north_azimuth = 0;  ///< radians, as Georeference::grid_north_azimuth, at the centre
  double error_cells = 0;         ///< largest error within `reach` of the centre; 0 without a CRS
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

/// Returns the plane centred on a sample; without a CRS, cell sizes and azimuth are those of the georeference. `reach`:
/// distance, in metres, within which samples matter. Throws Error without the file's name if PROJ cannot use the CRS.
MetricPlane metric_plane(const Georeference& georeference, int cols, int rows, double col, double row, double reach);

}  // namespace scarp
