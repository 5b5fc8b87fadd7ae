// SPDX-License-Identifier: MIT
// Rasters of every format that GDAL reads: GeoTIFF and COG, .hgt, USGS .dem, ESRI ASCII, PNG, netCDF, VRT, ...
#pragma once

#include <string>

#include "scarp/base/progress.h"
#include "scarp/source/raster.h"
#include "scarp/source/raster_options.h"

namespace scarp {

/// Reads one band of the raster at `path` (a file, or any name that GDAL opens: /vsizip/..., NETCDF:"f.nc":var). A
/// raster of one row or column is legal. Throws Error, in one line "raster 'path': what; what would be right": missing,
/// empty, cut off, no raster, a Git LFS pointer, a photograph, several bands and none chosen, rotated, infinite or all
/// nodata, larger than the free memory; Interrupted when `progress` says so. Nothing is printed.
Raster read_gdal_raster(const std::string& path, const RasterOptions& options, const Progress& progress = {});

}  // namespace scarp
