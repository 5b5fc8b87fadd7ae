// SPDX-License-Identifier: MIT
// NumPy arrays: .npy files and members of .npz archives, compressed or not, read through GDAL (/vsizip, raw bands).
//
// The first row of the array is the northernmost, the first column the westernmost; C and Fortran order, both byte
// orders, i1 u1 i2 u2 i4 u4 i8 u8 f2 f4 f8.
#pragma once

#include <string>

#include "scarp/base/progress.h"
#include "scarp/source/raster/raster.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Returns whether the name ends in .npy or .npz, ignoring case.
bool is_npy_path(const std::string& path);

/// Reads a two-dimensional array (or three with a leading or trailing 1); from a .npz, the array that options.key
/// names, or the only one. Arrays have no georeference: options.bounds and options.crs provide it. Throws as
/// read_gdal_raster() does, and also for other kinds and shapes, and for files shorter than their header requires.
Raster read_npy(const std::string& path, const RasterOptions& options, const Progress& progress = {});

}  // namespace scarp
