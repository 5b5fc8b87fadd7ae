// SPDX-License-Identifier: MIT
// Rasters in any format that GDAL reads: GeoTIFF and COG, .hgt, USGS .dem, ESRI ASCII, PNG, netCDF, VRT, ...
#pragma once

#include <gdal_priv.h>

#include <string>

#include "scarp/source/gdal_errors.h"

namespace scarp {

/// Returns whether GDAL reads the dataset as an ESRI ASCII grid.
bool is_ascii_grid(GDALDataset& dataset);

/// Opens the raster at `path` (a file, or any name that GDAL opens: /vsizip/..., NETCDF:"f.nc":var). ESRI ASCII grids
/// get a type that suits all their samples. Requires a StrictReading on the stack. Throws Error without the file's
/// name: missing, empty, truncated, not a raster, a Git LFS pointer.
GDALDatasetUniquePtr open_gdal_raster(const std::string& path, const GdalSession& session);

}  // namespace scarp
