// SPDX-License-Identifier: MIT
// Where a dataset of GDAL's lies: geotransform and CRS become a Georeference at the samples, north up, with the true
// size of its cells on the ground.
#pragma once

#include <gdal_priv.h>

#include <array>
#include <string>
#include <vector>

#include "scarp/base/georeference.h"
#include "scarp/source/raster_options.h"

namespace scarp {

/// What find_place() makes of a dataset.
struct RasterPlace {
  Georeference georeference;       ///< of the window's samples, after the flips
  bool flip_rows = false;          ///< the file's rows run from south to north
  bool flip_cols = false;          ///< the file's columns run from east to west
  double map_unit = 0;             ///< metres per unit of a projected or local CRS; 0: there is none
  double vertical_unit = 0;        ///< metres per unit of a vertical CRS; 0: there is none
  std::string vertical_unit_name;  ///< its name
  std::vector<std::string> notes;
};

/// GDAL's six numbers: map = (m[0] + m[1] col + m[2] row, m[3] + m[4] col + m[5] row), of the edges of pixels.
using GeoTransform = std::array<double, 6>;

/// What moves no sample by more than this share of a cell is rounding in the file: 1e-3 cell is the sideways accuracy
/// that Scarp promises.
inline constexpr double kLargestDriftInCells = 1e-3;

/// Throws Error whose text has no file name: not finite, rotated, cells without size.
void check_geotransform(const GeoTransform& map, int cols, int rows);

/// Throws Error whose text has no file name: a rotated or degenerate geotransform, a CRS that cannot be used.
RasterPlace find_place(GDALDataset& dataset, const RasterWindow& window, const RasterOptions& options);

}  // namespace scarp
