// SPDX-License-Identifier: MIT
// Reads samples of a GDAL band into memory: converts types, marks holes, rejects invalid values and sizes beyond
// memory.
//
//   in the file                        in memory
//   Int16, UInt16, Float32             the same
//   Int8                               int16
//   Byte                               uint16
//   Int32, UInt32, Int64, UInt64,      float32, with a note that states the largest rounding
//   Float64, Float16
//   complex                            rejected
//   beyond +-1e30, undeclared          NaN, unless the caller names a nodata value
//   any, with a mask or alpha band     float32 with NaN for masked samples
//   that hides samples                 (if reduced: with any mask or alpha band)
#pragma once

#include <gdal_priv.h>

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scarp/base/progress.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster/raster.h"
#include "scarp/source/raster/raster_options.h"
#include "scarp/source/raster/reading_plan.h"

namespace scarp {

/// Samples in memory, as in Raster.
using SampleVector = std::variant<std::vector<std::int16_t>, std::vector<std::uint16_t>, std::vector<float>>;

/// Result of read_band().
struct BandSamples {
  SampleVector samples;
  int cols = 0;
  int rows = 0;
  SampleSpacing across, down;  ///< of the samples, in columns and rows of the window
  std::optional<double> nodata;
  std::vector<std::string> notes;
};

/// Reads a window, which must lie inside the band; rows as stored. `nodata` overrides the band's own. With `decimation`
/// a large window is reduced. Throws Error without the file's name: unreadable, complex, infinite, too large for the
/// free memory (unless `memory` bytes are given, RasterOptions::memory), blocks too large for `memory`.
BandSamples read_band(GDALRasterBand& band, const RasterWindow& window, std::optional<double> nodata,
                      const std::optional<Decimation>& decimation, std::optional<double> memory, GdalSession& session,
                      const Progress& progress);

/// Returns an empty vector of the type that samples of the band have in memory, masked ones if it has a mask. Throws
/// Error without the file's name for complex samples.
SampleVector empty_samples(GDALRasterBand& band);

/// Returns the value that marks holes in samples of this type; nullopt if none equals `nodata`, or only NaN marks them.
std::optional<double> nodata_in_memory(std::optional<double> nodata, const SampleVector& samples);

/// Throws Error if all samples of `raster`, read from `window`, are nodata.
void refuse_all_nodata(const Raster& raster, const RasterWindow& window);

/// Returns whether the samples are signed bytes, which GDAL before 3.7 reports only as metadata of Byte.
bool is_signed_byte(GDALRasterBand& band);

/// Returns the band's own nodata value, with the sign of its samples.
std::optional<double> nodata_of(GDALRasterBand& band);

/// Returns whether the band has a mask besides its nodata value.
bool has_own_mask(GDALRasterBand& band);

/// Throws Error if the window's samples need more memory than is free.
void refuse_beyond_memory(const RasterWindow& window, int bytes_per_sample);

}  // namespace scarp
