// SPDX-License-Identifier: MIT
// Where a dataset of GDAL's lies: geotransform and CRS become a Georeference at the samples, north up, with the true
// size of its cells on the ground.
#pragma once

#include <gdal_priv.h>

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
  double vertical_unit = 0;        ///< metres per unit of a vertical CRS; 0: there is none
  std::string vertical_unit_name;  ///< its name
  std::vector<std::string> notes;
};

/// Throws Error whose text has no file name: a rotated or degenerate geotransform, a CRS that cannot be used.
RasterPlace find_place(GDALDataset& dataset, const RasterWindow& window, const RasterOptions& options);

}  // namespace scarp
