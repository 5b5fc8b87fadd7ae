// SPDX-License-Identifier: MIT
// Rasters in any format that GDAL reads: GeoTIFF and COG, .hgt, USGS .dem, ESRI ASCII, PNG, netCDF, VRT, ...
#pragma once

#include <string>

#include "scarp/base/progress.h"
#include "scarp/source/raster/raster.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Reads one band of the raster at `path` (a file, or any name that GDAL opens: /vsizip/..., NETCDF:"f.nc":var).
/// Accepts rasters with one row or column. Throws Error, in one line with the path: missing, empty, truncated, not a
/// raster, a Git LFS pointer, a photograph, several bands without a choice, rotated, infinite or all nodata, larger
/// than the free memory. Throws Interrupted if `progress` stops it. Prints nothing.
Raster read_gdal_raster(const std::string& path, const RasterOptions& options, const Progress& progress = {});

}  // namespace scarp
