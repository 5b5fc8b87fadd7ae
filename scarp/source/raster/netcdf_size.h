// SPDX-License-Identifier: MIT
// Expected length of netCDF files. The netCDF library reads zeros beyond the end of a classic file (versions 1, 2 and
// 5), so a truncated file would appear to contain a plain at height 0. The header states where each variable ends.
// netCDF version 4 is HDF5, which the library rejects when truncated, but with a misleading error.
//
// Sources: Unidata, "NetCDF Classic Format Specification", 2022; The HDF Group, "HDF5 File Format Specification Version
// 3.0", II.A: the superblock.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace scarp {

/// Bytes from a file's start that contain the header of any realistic netCDF file.
inline constexpr std::size_t kNetcdfHeaderBytes = 1 << 20;

/// Returns the minimum length in bytes of the classic netCDF file that starts with `start`, or nullopt if it is not
/// such a file, or if its header exceeds `start` or is invalid.
std::optional<double> netcdf_classic_bytes(std::string_view start);

/// Returns the length in bytes of the HDF5 file that starts with `start`, or nullopt if it is not such a file, or is an
/// unknown variant.
std::optional<double> hdf5_bytes(std::string_view start);

}  // namespace scarp
