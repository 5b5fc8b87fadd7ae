// SPDX-License-Identifier: MIT
// The ground of the benchmarks: procedural or a real DEM, always in units of cells. One world unit is the distance
// between two columns, so all engines get the same small numbers and an error in t is an error in cells.
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
  std::string surface = "bilinear";  ///< surface of Scarp: this or "triangles"
};

/// A field and its description in results.
struct BenchField {
  HeightField field;
  std::string name;           ///< "ridged, seed 1" or the file's path
  double relief = 0;          ///< highest minus lowest point, in cells
  double mean_slope_deg = 0;  ///< mean slope angle at the centres of the cells
};

/// The samples, not exaggerated. Throws Error if the file cannot be used: it is unreadable, has a single row or column,
/// or has holes (which the engines treat differently).
BenchField load_field(const FieldOptions& options);

/// The same samples, not copied, under another exaggeration; `ground` must outlive the result.
BenchField exaggerated(const BenchField& ground, double exaggeration);

/// Height at (x, y) of the surface that triangle engines trace: two triangles per cell, split from (col+1, row) to
/// (col, row+1). Nullopt outside the field.
std::optional<double> triangle_height(const HeightField& field, double x, double y);

}  // namespace scarp::bench
