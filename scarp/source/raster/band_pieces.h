// SPDX-License-Identifier: MIT
// Reads a GDAL band piece by piece: every block of the file is decoded once, with little memory.
#pragma once

#include <gdal_priv.h>

#include <cstdint>
#include <functional>

#include "scarp/base/nested_limit.h"
#include "scarp/base/progress.h"
#include "scarp/source/gdal_errors.h"
#include "scarp/source/raster/raster_options.h"

namespace scarp {

/// Limits GDAL's block cache to what reading by pieces needs.
using GdalCacheLimit = NestedLimit<GDALGetCacheMax64, GDALSetCacheMax64, kGdalCacheBytes>;

/// Callbacks of for_pieces().
struct PieceCalls {
  std::function<void(const RasterWindow&)> piece;  ///< in columns and rows of the band
  std::function<void(int)> rows_done;              ///< all pieces of rows before this one are complete; may be empty
};

/// Covers the window with pieces that end at the band's block boundaries, in strips from the first row to the last.
/// Throws Interrupted.
void for_pieces(GDALRasterBand& band, const RasterWindow& window, int bytes_per_sample, const Progress& progress,
                const PieceCalls& calls);

/// Reads a piece as `type` into `out`, rows `row_samples` samples apart. Throws Error if the file does not contain the
/// samples.
void read_piece(GDALRasterBand& band, const RasterWindow& piece, GDALDataType type, void* out, int row_samples,
                GdalSession& session);

/// Returns whether the file stores nothing for the piece, so that all of its samples have the band's nodata value.
bool is_empty_piece(GDALRasterBand& band, const RasterWindow& piece);

}  // namespace scarp
