// SPDX-License-Identifier: MIT
#include "scarp/source/tile_layout.h"

#include <algorithm>
#include <limits>

namespace scarp {

TileRect bounding_rect(const std::vector<TileRect>& tiles) {
  TileRect all = tiles.front();
  for (const TileRect& tile : tiles) {
    const std::int64_t east = std::max(all.col + all.cols, tile.col + tile.cols);
    const std::int64_t south = std::max(all.row + all.rows, tile.row + tile.rows);
    all.col = std::min(all.col, tile.col);
    all.row = std::min(all.row, tile.row);
    all.cols = east - all.col;
    all.rows = south - all.row;
  }
  return all;
}

double covered_samples(const std::vector<TileRect>& tiles) {
  std::vector<std::int64_t> edges;
  for (const TileRect& tile : tiles) {
    edges.push_back(tile.col);
    edges.push_back(tile.col + tile.cols);
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<TileRect> by_row = tiles;
  std::sort(by_row.begin(), by_row.end(), [](const TileRect& a, const TileRect& b) { return a.row < b.row; });

  // Between adjacent edges every column has the same tiles: merge their rows from north to south.
  double covered = 0;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    std::int64_t rows = 0, south = std::numeric_limits<std::int64_t>::min();
    for (const TileRect& tile : by_row) {
      if (tile.col > edges[i] || tile.col + tile.cols <= edges[i]) continue;
      const std::int64_t end = tile.row + tile.rows;
      rows += std::max<std::int64_t>(0, end - std::max(south, tile.row));
      south = std::max(south, end);
    }
    covered += static_cast<double>(rows) * static_cast<double>(edges[i + 1] - edges[i]);
  }
  return covered;
}

}  // namespace scarp
