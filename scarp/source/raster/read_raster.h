// SPDX-License-Identifier: MIT
// Reads heights from files in any supported format.
#pragma once

#include <string>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/source/raster/raster.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Reads a raster: with read_raw() if options.raw is set, else with read_npy() for .npy and .npz, read_exr() for .exr,
/// read_tiles() for a folder, and read_gdal_raster() for all other files. Throws Error as these functions do, and if an
/// option does not apply to the file.
Raster read_raster(const std::string& path, const RasterOptions& options, const Progress& progress = {});

/// Reads several files and folders as one mosaic, placed by their georeference. A folder contributes all rasters in it,
/// sorted by name. Where tiles overlap, the later one wins. Gaps become holes, reported in a note. A single file is
/// read as by read_raster(). Throws Error naming the file if it has no georeference; if its CRS, cell size, sample
/// type, nodata value, scale or vertical unit differs from the first file's; if its samples are not on the first file's
/// grid; or if a folder contains no rasters.
Raster read_tiles(const std::vector<std::string>& inputs, const RasterOptions& options, const Progress& progress = {});

}  // namespace scarp
