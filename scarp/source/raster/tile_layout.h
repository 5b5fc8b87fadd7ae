// SPDX-License-Identifier: MIT
// Coverage of a mosaic by its tiles, as rectangles of whole samples.
#pragma once

#include <cstdint>
#include <vector>

namespace scarp {

/// Samples [col, col + cols) x [row, row + rows) of the mosaic.
struct TileRect {
  std::int64_t col = 0;
  std::int64_t row = 0;
  std::int64_t cols = 0;  ///< >= 1
  std::int64_t rows = 0;  ///< >= 1
};

/// Returns the smallest rectangle around all tiles; there must be at least one.
TileRect bounding_rect(const std::vector<TileRect>& tiles);

/// West and east edge of a tile, in longitudes of any unit; west < east.
struct TileSpan {
  double west = 0;
  double east = 0;
};

/// Returns, for each tile, how many full circles to add to its longitudes so that all tiles are side by side: the
/// circle of longitudes is cut at its widest gap. All are 0 if that saves less than `least`, a fraction of a cell.
/// Time: n log n.
std::vector<int> turns_side_by_side(const std::vector<TileSpan>& tiles, double circle, double least);

/// Returns the number of samples covered by at least one tile. Time: number of tiles times number of distinct edges.
double covered_samples(const std::vector<TileRect>& tiles);

}  // namespace scarp
