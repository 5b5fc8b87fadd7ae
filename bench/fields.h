// SPDX-License-Identifier: MIT
// The ground of the benchmarks: procedural or a real DEM, always in cells. One world unit is the distance between two
// columns, so that all engines see the same small numbers and an error in t is an error in cells.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scarp/field/height_field.h"

namespace scarp::bench {

struct FieldOptions {
  int size = 2049;              ///< samples per side of a procedural DEM, >= 33
  std::string kind = "ridged";  ///< "ridged" or "fbm"
  std::uint64_t seed = 1;
  std::string dem;                   ///< a raster file instead of a procedural DEM
  std::string samples = "float32";   ///< of a procedural DEM; "int16": in steps of 1/32 cell
  std::string surface = "bilinear";  ///< of Scarp, or "triangles"
};

/// A field and its description in results.
struct BenchField {
  HeightField field;
  std::string name;           ///< "ridged, seed 1" or the file's path
  double relief = 0;          ///< highest minus lowest point, in cells
  double mean_slope_deg = 0;  ///< mean angle of the cells' slope in their middle
};

/// The samples, not exaggerated. Throws Error when the file cannot be used: unreadable, a
/// single row or column, or with holes (over which the engines would answer different questions).
BenchField load_field(const FieldOptions& options);

/// The same samples, not copied, under another exaggeration; `ground` must outlive the result.
BenchField exaggerated(const BenchField& ground, double exaggeration);

/// Height at (x, y) of the surface that triangle engines trace: two triangles per cell, split from (col+1, row) to
/// (col, row+1). Nothing outside the field.
std::optional<double> triangle_height(const HeightField& field, double x, double y);

}  // namespace scarp::bench
