// SPDX-License-Identifier: MIT
// Procedural terrain as a GeoTIFF that may be far larger than memory.
#pragma once

#include <functional>
#include <string>

#include "scarp/base/progress.h"
#include "scarp/source/procedural_dem.h"

namespace scarp {

/// Writes the terrain to `path`: float32 metres, tiles of 256 x 256, compressed without loss (deflate), BigTIFF where
/// needed. Strips of 256 rows are made on all threads and written one after the other, so memory holds few of them.
///
/// It lies around latitude 0, longitude 0 on a Transverse Mercator of scale 1 whose origin is the terrain's centre, so
/// that there the map's metres are the ground's and north is up.
///
/// The file appears whole or not at all. Throws Error (settings, folder, disk full), Interrupted.
void write_procedural_dem(const std::string& path, const ProceduralDem& settings, const Progress& progress = {});

/// Any other heights that are computed when they are asked for.
struct ComputedDem {
  int cols = 0, rows = 0;     ///< samples, 1..kLargestProceduralSide
  double cell_m = 1;          ///< metres from sample to sample, > 0, <= kLargestProceduralCell
  std::string description{};  ///< for the file
  /// Writes the heights in metres of `rows` rows from `row` on, north to south, `cols` each. Called from many threads.
  std::function<void(int row, int rows, float* out)> fill;
};
/// The same file of these.
void write_computed_dem(const std::string& path, const ComputedDem& dem, const Progress& progress = {});

}  // namespace scarp
