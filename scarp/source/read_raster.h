// SPDX-License-Identifier: MIT
// Reads heights from files in any supported format.
#pragma once

#include <string>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/source/raster.h"
#include "scarp/source/raster_options.h"

namespace scarp {

/// Selects the reader: read_raw() with options.raw; read_npy() for .npy and .npz, read_exr() for .exr, read_tiles() for
/// a folder, otherwise read_gdal_raster(). Throws as they do, and for options that do not apply to the file.
Raster read_raster(const std::string& path, const RasterOptions& options, const Progress& progress = {});

/// Reads several files and folders as one mosaic, placed by their georeference. A folder stands for all rasters in it,
/// by name. Where tiles overlap the later one wins; gaps become holes, with a note. A single file is read as by
/// read_raster(). Throws Error naming the file: no georeference; a CRS, cell size, sample type, nodata value, scale or
/// vertical unit that differs from the first file's; samples off the first file's grid; a folder without rasters.
Raster read_tiles(const std::vector<std::string>& inputs, const RasterOptions& options, const Progress& progress = {});

}  // namespace scarp
