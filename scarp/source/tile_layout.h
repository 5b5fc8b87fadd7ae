// SPDX-License-Identifier: MIT
// Tiles as rectangles of whole samples: how much of the raster that they make together is under none of them?
#pragma once

#include <cstdint>
#include <vector>

namespace scarp {

/// Samples [col, col + cols) x [row, row + rows) of the whole.
struct TileRect {
  std::int64_t col = 0;
  std::int64_t row = 0;
  std::int64_t cols = 0;  ///< >= 1
  std::int64_t rows = 0;  ///< >= 1
};

/// The least rectangle that holds all tiles, of which there must be one.
TileRect bounding_rect(const std::vector<TileRect>& tiles);

/// Samples under at least one tile; those under several count once. Time: tiles times their different edges.
double covered_samples(const std::vector<TileRect>& tiles);

}  // namespace scarp
