// SPDX-License-Identifier: MIT
// Writes procedural terrain to a GeoTIFF that may be far larger than memory.
#pragma once

#include <functional>
#include <string>

#include "scarp/base/progress.h"
#include "scarp/source/raster/procedural_dem.h"

namespace scarp {

/// Writes the terrain to `path`: float32 metres, tiles of 256 x 256, lossless compression (deflate), BigTIFF if needed.
/// Computes strips of 256 rows on all threads and writes them in order, so only a few are in memory at a time.
///
/// The terrain is centred on latitude 0, longitude 0, in a Transverse Mercator projection of scale 1 with its origin
/// there, so that map metres are ground metres at the centre and north is up.
///
/// Throws Error (settings, folder, disk full) or Interrupted; then no file remains.
void write_procedural_dem(const std::string& path, const ProceduralDem& settings, const Progress& progress = {});

/// Heights computed on demand.
struct ComputedDem {
  int cols = 0, rows = 0;     ///< samples, 1..kLargestProceduralSide
  double cell_m = 1;          ///< sample spacing in metres, > 0, <= kLargestProceduralCell
  std::string description{};  ///< stored in the file
  /// Writes the heights in metres of `rows` rows from `row` on, north to south, `cols` each. Called concurrently.
  std::function<void(int row, int rows, float* out)> fill;
};
/// Writes computed heights to the same kind of file.
void write_computed_dem(const std::string& path, const ComputedDem& dem, const Progress& progress = {});

}  // namespace scarp
