// SPDX-License-Identifier: MIT
// Position of a raster on Earth and the size of its cells on the ground.
#pragma once

#include <array>
#include <string>

namespace scarp {

/// Position of a raster. Filled by source/, used by output/ and the apps.
struct Georeference {
  bool present = false;  ///< false: integer node coordinates, cells of 1 m, north up
  /// Map coordinates of a node (sample), in CRS units: x = m[0] + col*m[1] + row*m[2], y = m[3] + col*m[4] + row*m[5].
  /// m[2] = m[4] = 0 and m[5] < 0: readers reject rotated rasters and flip south-up ones.
  std::array<double, 6> map_from_node{0, 1, 0, 0, 0, -1};
  std::string crs_wkt;   ///< empty if the file has no CRS
  std::string crs_name;  ///< short name for display: "WGS 84 / UTM zone 10N (EPSG:32610)"; empty if unknown
  double cell_x_m = 1;   ///< length of one column step on the ground at the raster's centre, metres, > 0
  double cell_y_m = 1;   ///< length of one row step on the ground at the raster's centre, metres, > 0
  /// Compass azimuth of decreasing row at the raster's centre, radians, 0 = true north (meridian convergence).
  double grid_north_azimuth = 0;
  std::string cell_size_found;  ///< how the two lengths were determined, one line for display
};

}  // namespace scarp
