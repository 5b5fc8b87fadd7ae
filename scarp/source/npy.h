// SPDX-License-Identifier: MIT
// NumPy's arrays: .npy files and the members of .npz archives, compressed or not, read through GDAL (/vsizip, raw
// bands).
//
// The first row of the array is the northern one, the first column the western one; C and Fortran order, both byte
// orders, i1 u1 i2 u2 i4 u4 f4 f8.
#pragma once

#include <string>

#include "scarp/base/progress.h"
#include "scarp/source/raster.h"
#include "scarp/source/raster_options.h"

namespace scarp {

/// Whether the name ends in .npy or .npz, in any case.
bool is_npy_path(const std::string& path);

/// Reads a two-dimensional array (three with a leading or trailing 1 will do); in a .npz the one named by options.key,
/// or the only one. Such files have no georeference: options.bounds and options.crs give it. Throws as
/// read_gdal_raster() does, and for arrays of other kinds and shapes, and files shorter than their header says.
Raster read_npy(const std::string& path, const RasterOptions& options, const Progress& progress = {});

}  // namespace scarp
