// SPDX-License-Identifier: MIT
// Checks of input files for which GDAL reports misleading errors, or reads zeros.
#pragma once

#include <gdal_priv.h>

#include <cstdint>
#include <string>

namespace scarp {

/// Throws Error (without the file's name) if `path` is a pipe or a device, an empty file, a Git LFS pointer or not
/// readable. Accepts names that are not files: they may be GDAL's own.
void check_file(const std::string& path);

/// Throws Error (without the file's name) if a file is truncated, judging by its start: HDF5 (netCDF-4), classic
/// netCDF, .zip. For files that GDAL cannot open.
void check_end(const std::string& path);

/// Returns up to `count` bytes from `begin`. Throws Error (without the file's name) if the file cannot be opened.
std::string bytes_from(const std::string& path, std::uint64_t begin, std::size_t count);

/// Throws Error if the file of an open dataset is shorter than its header requires, for formats whose drivers then read
/// zeros (classic netCDF, ENVI).
void check_length(GDALDataset& dataset);

}  // namespace scarp
