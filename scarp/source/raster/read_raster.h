// SPDX-License-Identifier: MIT
// Reads heights from files in any supported format.
#pragma once

#include <string>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/source/raster/raster.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Reads one band of the raster at `path`: headerless samples if options.raw is set, a NumPy array if the name ends in
/// .npy or .npz, an OpenEXR image if it ends in .exr, a mosaic if it is a folder (read_tiles()), and otherwise a file
/// or any other name that GDAL opens: /vsizip/..., NETCDF:"f.nc":var. Accepts rasters with one row or column. Throws
/// Error, in one line with the path: missing, empty, truncated, not a raster, a Git LFS pointer, a photograph, several
/// bands without a choice, rotated, infinite or all nodata, larger than the free memory, an option that does not apply
/// to the file. Throws Interrupted if `progress` stops it. Prints nothing.
Raster read_raster(const std::string& path, const RasterOptions& options, const Progress& progress = {});

/// Reads several files and folders as one mosaic, placed by their georeference. A folder contributes all rasters in it,
/// sorted by name. Where tiles overlap, the later one wins. Gaps become holes, reported in a note. A single file is
/// read as by read_raster(). Throws Error naming the file if it has no georeference; if its CRS, cell size, sample
/// type, nodata value, scale or vertical unit differs from the first file's; if its samples are not on the first file's
/// grid; or if a folder contains no rasters.
Raster read_tiles(const std::vector<std::string>& inputs, const RasterOptions& options, const Progress& progress = {});

}  // namespace scarp
