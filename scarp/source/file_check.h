// SPDX-License-Identifier: MIT
// What GDAL would answer with a riddle, or with zeros, is asked here first.
#pragma once

#include <gdal_priv.h>

#include <cstdint>
#include <string>

namespace scarp {

/// Throws Error (without the file's name) when `path` is an empty file, a Git LFS pointer or not readable. A name that
/// is no file passes: it may be one of GDAL's own.
void check_file(const std::string& path);

/// Throws Error (without the file's name) when the last bytes of a file are missing, as far as its first ones tell:
/// HDF5 (netCDF-4), classic netCDF, .zip. For what GDAL cannot open.
void check_end(const std::string& path);

/// Up to `count` bytes from `begin`. Throws Error (without the file's name) when it cannot be opened.
std::string bytes_from(const std::string& path, std::uint64_t begin, std::size_t count);

/// Throws Error when the file of an open dataset is shorter than its header says, for the formats whose drivers fill up
/// with zeros then (classic netCDF, ENVI).
void check_length(GDALDataset& dataset);

}  // namespace scarp
