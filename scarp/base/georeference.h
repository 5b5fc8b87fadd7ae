// SPDX-License-Identifier: MIT
// Where on Earth a raster lies, and how large its cells are on the ground.
#pragma once

#include <array>
#include <string>

namespace scarp {

/// The place of a raster. Plain data: filled by source/, used by output/ and the apps.
struct Georeference {
  bool present = false;  ///< false: node = integer, cells of 1 m, north up
  /// map x = m[0] + col*m[1] + row*m[2], map y = m[3] + col*m[4] + row*m[5], at the *nodes* (samples), in CRS units;
  /// m[2] = m[4] = 0 and m[5] < 0 (rotated rasters are refused, south-up ones flipped).
  std::array<double, 6> map_from_node{0, 1, 0, 0, 0, -1};
  std::string crs_wkt;   ///< empty when the file names none
  std::string crs_name;  ///< short, for people: "WGS 84 / UTM zone 10N (EPSG:32610)"; empty when unknown
  double cell_x_m = 1;   ///< true length of a step of one column on the ground at the raster's centre, metres, > 0
  double cell_y_m = 1;   ///< the same for one row
  /// Compass azimuth of the raster's "up" (decreasing row) at its centre, radians, 0 = true north (meridian
  /// convergence).
  double grid_north_azimuth = 0;
  std::string cell_size_found;  ///< how the two lengths were found, one line for people
};

}  // namespace scarp
