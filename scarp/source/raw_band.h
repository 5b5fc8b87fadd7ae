// SPDX-License-Identifier: MIT
// Bare samples in a file, seen by GDAL as a dataset of one band. Shared by the readers of raw files and of NumPy's.
#pragma once

#include <gdal_priv.h>

#include <cstdint>
#include <optional>
#include <string>

#include "scarp/source/gdal_errors.h"

namespace scarp {

/// GDAL's name for a kind of sample.
struct RawSampleType {
  GDALDataType type;
  bool signed_bytes;  ///< GDAL before 3.7: Byte, and a remark that it has a sign
};

/// `kind` is 'i' signed, 'u' unsigned, 'f' float. Nothing for what GDAL cannot read raw (half floats).
std::optional<RawSampleType> raw_sample_type(char kind, int bytes);

/// The name by which GDAL finds the file from anywhere: absolute, unless it is one of GDAL's own (/vsi...).
std::string full_path(const std::string& path);

/// Length of the file. Throws Error: it does not exist, it is a directory.
std::int64_t file_bytes(const std::string& path);

/// Where the samples lie.
struct RawBand {
  std::string file;  ///< full_path()
  int cols = 0;
  int rows = 0;
  RawSampleType type{GDT_Byte, false};
  int bytes = 1;  ///< per sample
  bool big_endian = false;
  std::int64_t offset = 0;  ///< of the first sample
};

/// Opens it; rows lie one behind the other. The file must be long enough. Throws Error whose text has no file name.
GDALDatasetUniquePtr open_raw_band(const RawBand& band, const GdalSession& session);

}  // namespace scarp
