// SPDX-License-Identifier: MIT
// NumPy arrays: .npy files and members of .npz archives, compressed or not, read through GDAL (/vsizip, raw bands).
//
// The first row of the array is the northernmost, the first column the westernmost; C and Fortran order, both byte
// orders, i1 u1 i2 u2 i4 u4 i8 u8 f2 f4 f8.
#pragma once

#include <string>

#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster/opened_dataset.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Returns whether the name ends in .npy or .npz, ignoring case.
bool is_npy_path(const std::string& path);

/// Opens a two-dimensional array (or three with a leading or trailing 1); from a .npz, the array that options.key
/// names, or the only one. Arrays have no georeference: options.bounds and options.crs provide it. Arrays in Fortran
/// order and of halves are read into memory. Throws Error without the file's name if it cannot be opened, for other
/// kinds and shapes, and for files shorter than their header requires.
OpenedDataset open_npy(const std::string& path, const RasterOptions& options, GdalSession& session);

}  // namespace scarp
