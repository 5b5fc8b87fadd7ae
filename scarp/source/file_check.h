// SPDX-License-Identifier: MIT
// What GDAL would answer with a riddle, or with zeros, is asked here first.
#pragma once

#include <gdal_priv.h>

#include <string>

namespace scarp {

/// Throws Error (without the file's name) when `path` is an empty file, a Git LFS pointer or not readable. A name that
/// is no file passes: it may be one of GDAL's own.
void check_file(const std::string& path);

/// Throws Error when the file of an open dataset is shorter than its header says, for the formats whose drivers fill up
/// with zeros then (classic netCDF, ENVI).
void check_length(GDALDataset& dataset);

}  // namespace scarp
