// SPDX-License-Identifier: MIT
// The one entry for files with heights: picks the reader.
#pragma once

#include <string>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/source/raster.h"
#include "scarp/source/raster_options.h"

namespace scarp {

/// With options.raw by read_raw(); else .npy and .npz by read_npy(), .exr by read_exr(), a folder by read_tiles(), all
/// else by read_gdal_raster(). Throws as they do, and for options that the reader has no use for.
Raster read_raster(const std::string& path, const RasterOptions& options, const Progress& progress = {});

/// Several files and folders of them as one raster, put together by their georeference. A folder stands for all rasters
/// in it, by name. Where tiles overlap the later one wins; gaps become holes, which a note tells. A single file is read
/// as read_raster() does. Throws Error naming the file: no georeference, or another CRS, cell size, sample type, nodata
/// value, scale or vertical unit than the first; samples of it beside those of the first; a folder without rasters.
Raster read_tiles(const std::vector<std::string>& inputs, const RasterOptions& options, const Progress& progress = {});

}  // namespace scarp
