// SPDX-License-Identifier: MIT
// From a band of GDAL's to samples in memory: types, holes, sick values, sizes that memory cannot hold.
//
//   in the file                        in memory
//   Int16, UInt16, Float32             the same
//   Int8                               int16
//   Byte                               uint16
//   Int32, UInt32, Int64, UInt64,      float32, with a note that names the largest rounding
//   Float64, Float16
//   complex                            refused
//   any, with a mask or alpha band     float32 with NaN where the mask says so
//   that hides samples
#pragma once

#include <gdal_priv.h>

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster_options.h"

namespace scarp {

/// What read_band() makes of a band.
struct BandSamples {
  std::variant<std::vector<std::int16_t>, std::vector<std::uint16_t>, std::vector<float>> samples;
  std::optional<double> nodata;
  std::vector<std::string> notes;
};

/// Reads a window (which must lie inside the band), rows as stored. `nodata` wins over the band's own. Throws Error
/// whose text has no file name: unreadable, complex, infinite or all nodata, too large for the memory that is free.
BandSamples read_band(GDALRasterBand& band, const RasterWindow& window, std::optional<double> nodata,
                      GdalSession& session, const Progress& progress);

/// Reads whole rows of a window as `type` into `out`. Throws Error when the file does not have them.
void read_rows(GDALRasterBand& band, const RasterWindow& window, int row, int rows, GDALDataType type, void* out,
               GdalSession& session);

/// Whether the samples are signed bytes, which GDAL before 3.7 knows only as a remark on Byte.
bool is_signed_byte(GDALRasterBand& band);

/// The band's own nodata value, in the sign of its samples.
std::optional<double> nodata_of(GDALRasterBand& band);

/// Whether the band has a mask that says more than its nodata value.
bool has_own_mask(GDALRasterBand& band);

/// Throws Error when the window's samples need more memory than is free.
void refuse_beyond_memory(const RasterWindow& window, int bytes_per_sample);

}  // namespace scarp
