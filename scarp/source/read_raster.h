// SPDX-License-Identifier: MIT
// The one entry for files with heights: picks the reader.
#pragma once

#include <string>

#include "scarp/base/progress.h"
#include "scarp/source/raster.h"
#include "scarp/source/raster_options.h"

namespace scarp {

/// .npy and .npz by read_npy(), all else by read_gdal_raster(); throws as they do.
Raster read_raster(const std::string& path, const RasterOptions& options, const Progress& progress = {});

}  // namespace scarp
