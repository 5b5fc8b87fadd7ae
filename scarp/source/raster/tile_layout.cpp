// SPDX-License-Identifier: MIT
#include "scarp/source/raster/tile_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

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

std::vector<int> turns_side_by_side(const std::vector<TileSpan>& tiles, double circle, double least) {
  const auto in_circle = [&](double x) { return x - circle * std::floor(x / circle); };
  std::vector<std::size_t> order(tiles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return in_circle(tiles[a].west) < in_circle(tiles[b].west); });

  // The widest gap ends at a tile's west edge: that tile starts the mosaic. Tiles may extend across the end of the
  // circle, so the gap before the first tile begins at the easternmost edge of all tiles.
  double reached = -circle;
  for (const TileSpan& tile : tiles)
    reached = std::max(reached, in_circle(tile.west) + (tile.east - tile.west) - circle);
  double widest = -1;
  std::size_t begin = order.front();
  for (const std::size_t i : order) {
    const double west = in_circle(tiles[i].west);
    if (west - reached > widest) widest = west - reached, begin = i;
    reached = std::max(reached, west + (tiles[i].east - tiles[i].west));
  }

  std::vector<int> turns(tiles.size());
  const double west = tiles[begin].west;
  double east = tiles[begin].east, least_west = west, greatest_east = east;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    // Tiles in one column may differ by rounding.
    turns[i] = -static_cast<int>(std::floor((tiles[i].west - west + least) / circle));
    east = std::max(east, tiles[i].east + turns[i] * circle);
    least_west = std::min(least_west, tiles[i].west);
    greatest_east = std::max(greatest_east, tiles[i].east);
  }
  if (!((greatest_east - least_west) - (east - west) >= least)) std::fill(turns.begin(), turns.end(), 0);
  return turns;
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

  // Between two adjacent edges, all columns are covered by the same tiles: merges their rows from north to south.
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
