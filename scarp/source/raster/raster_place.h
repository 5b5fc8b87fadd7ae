// SPDX-License-Identifier: MIT
// Georeference of a GDAL dataset: converts geotransform and CRS to positions of samples, north up, with true cell sizes
// on the ground.
#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "scarp/base/georeference.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Result of find_place().
struct RasterPlace {
  Georeference georeference;       ///< of the window's samples, after the flips
  bool flip_rows = false;          ///< the file's rows run from south to north
  bool flip_cols = false;          ///< the file's columns run from east to west
  double map_unit = 0;             ///< metres per unit of a projected or local CRS; 0: none
  double vertical_unit = 0;        ///< metres per unit of a vertical CRS; 0: none
  std::string vertical_unit_name;  ///< name of the vertical unit
  std::vector<std::string> notes;
};

/// GDAL's six coefficients: map = (m[0] + m[1] col + m[2] row, m[3] + m[4] col + m[5] row), for pixel edges.
using GeoTransform = std::array<double, 6>;

/// Displacements below this, in cells, count as rounding in the file: 1e-3 cells is Scarp's horizontal accuracy.
inline constexpr double kLargestDriftInCells = 1e-3;

/// Throws Error without the file's name: not finite, rotated, cells of zero size. `nodata_words`: warp_nodata_words().
void check_geotransform(const GeoTransform& map, int cols, int rows, const std::string& nodata_words);

/// Returns a full circle in map units if the map's x is a longitude, otherwise 0. This is decided by the CRS in the
/// options, else by the file's (`own`, may be null), else by whether the bounds fit degrees. Throws Error without the
/// file's name: an unusable CRS.
double turn_of(const OGRSpatialReference* own, const GeoTransform& map, double cols, double rows,
               const RasterOptions& options);

/// Returns metres per unit of the vertical part of a CRS, and the unit's name; 0 if it has none.
std::pair<double, std::string> vertical_unit_of(const OGRSpatialReference& crs);

/// Throws Error without the file's name: a rotated or degenerate geotransform, an unusable CRS.
RasterPlace find_place(GDALDataset& dataset, const RasterWindow& window, const RasterOptions& options);

}  // namespace scarp
