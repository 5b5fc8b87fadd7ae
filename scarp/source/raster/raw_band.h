// SPDX-License-Identifier: MIT
// Raw samples in a file as a GDAL dataset with one band. Shared by the readers of raw files and of NumPy arrays.
#pragma once

#include <gdal_priv.h>

#include <cstdint>
#include <optional>
#include <string>

#include "scarp/source/gdal_errors.h"

namespace scarp {

/// GDAL's name for a sample type.
struct RawSampleType {
  GDALDataType type;
  bool signed_bytes;  ///< in GDAL before 3.7: Byte, with metadata for the sign
};

/// Returns GDAL's type for a sample; `kind` is 'i' signed, 'u' unsigned, 'f' float. Returns nullopt for types that GDAL
/// cannot read raw (half floats).
std::optional<RawSampleType> raw_sample_type(char kind, int bytes);

/// Returns a name that does not depend on the working directory: an absolute path, unless it is one of GDAL's own names
/// (/vsi...).
std::string full_path(const std::string& path);

/// Returns the length of the file in bytes. Throws Error if it does not exist or is a directory.
std::int64_t file_bytes(const std::string& path);

/// Position and layout of the samples.
struct RawBand {
  std::string file;  ///< full_path()
  int cols = 0;
  int rows = 0;
  RawSampleType type{GDT_Byte, false};
  int bytes = 1;  ///< per sample
  bool big_endian = false;
  std::int64_t offset = 0;  ///< of the first sample
};

/// Opens the samples; rows are contiguous. The file must be long enough. Throws Error without the file's name.
GDALDatasetUniquePtr open_raw_band(const RawBand& band, const GdalSession& session);

}  // namespace scarp
