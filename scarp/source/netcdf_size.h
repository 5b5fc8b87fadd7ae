// SPDX-License-Identifier: MIT
// How long must a netCDF file be? The netCDF library reads zeros beyond the end of a classic file (versions 1, 2 and
// 5), so that one that was cut off would show a plain at height 0. The header tells where each variable ends. A netCDF
// file of version 4 is one of HDF5, which is refused when it is cut off, but not called so.
//
// Sources: Unidata, "NetCDF Classic Format Specification", 2022; The HDF Group, "HDF5 File Format Specification Version
// 3.0", II.A: the superblock.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace scarp {

/// Bytes from a file's start that hold the header of any netCDF file worth reading.
inline constexpr std::size_t kNetcdfHeaderBytes = 1 << 20;

/// The least length in bytes of the classic netCDF file that begins with `start`; nothing when it is none, or its
/// header goes beyond `start` or makes no sense.
std::optional<double> netcdf_classic_bytes(std::string_view start);

/// The length in bytes of the HDF5 file that begins with `start`; nothing when it is none, or made in a way that is not
/// known here.
std::optional<double> hdf5_bytes(std::string_view start);

}  // namespace scarp
