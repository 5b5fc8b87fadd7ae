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

/// Returns the number of samples covered by at least one tile. Time: tiles times their distinct edges.
double covered_samples(const std::vector<TileRect>& tiles);

}  // namespace scarp
