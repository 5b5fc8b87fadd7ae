// SPDX-License-Identifier: MIT
// Private to the station: the tiles of a TiledTerrain at one epoch. A new epoch shares all unchanged tiles and rows
// with the previous one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "scarp/accel/max_pyramid.h"
#include "scarp/field/height_field.h"
#include "scarp/march/height/height_target.h"
#include "scarp/scene/tiled_terrain.h"

namespace scarp {

/// A height field with its pyramid, ready for rays.
struct TileGround {
  explicit TileGround(HeightField heights) : field(std::move(heights)), pyramid(field) {}
  HeightField field;
  MaxPyramid pyramid;
};

struct Tile {
  Tile(HeightField heights, int tile_level) : given(std::move(heights)), level(tile_level) {}

  /// Returns the material of a cell plus 1, or 0 if the tile has no materials.
  int material(Cell cell) const {
    if (!materials) return 0;
    return 1 + (*materials)[static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(given.cell_cols()) +
                            static_cast<std::size_t>(cell.col)];
  }

  HeightField given;                         ///< as passed to put()
  CellMaterials materials;                   ///< null: that of the object
  int level = 0;                             ///< cells are 2^level times those of the layout
  std::shared_ptr<const void> memory;        ///< keeps the samples of a view alive
  std::shared_ptr<const TileGround> ground;  ///< `given`, or a copy with stitched borders
  bool stitched = false;                     ///< whether it is a copy
  double own_step = 0;   ///< rounding of stitched samples relative to the line that they represent, in sample units
  double seam_step = 0;  ///< HeightTarget::seam_step: the greatest own_step of this tile and its neighbours
};

struct TileMap {
  using Row = std::vector<std::shared_ptr<const Tile>>;  ///< null: missing

  TileLayout layout;
  std::vector<std::shared_ptr<const Row>> rows;

  /// Null if the tile is missing or outside.
  const Tile* find(int col, int row) const {
    if (col < 0 || row < 0 || col >= layout.cols || row >= layout.rows) return nullptr;
    return (*rows[static_cast<std::size_t>(row)])[static_cast<std::size_t>(col)].get();
  }
  double tile_width() const { return layout.cell_cols * layout.ground.cell_x; }
  double tile_depth() const { return layout.cell_rows * layout.ground.cell_y; }
  /// World position of the south-west sample of a tile.
  dvec3 corner(int col, int row) const { return {col * tile_width(), (layout.rows - 1 - row) * tile_depth(), 0}; }

  /// Calls f(tile, col, row, x, y), with the position in the tile, for each tile that contains a point, until f returns
  /// true. Where tiles meet, these are up to four.
  template <class F>
  void at(double x, double y, const F& f) const;
};

/// Distance in cells from a tile's border up to which a point counts as on it: world coordinates at 2^20 cells are
/// accurate to 2^-33 of a cell, and a few operations convert them to a tile.
constexpr double kTileSeam = 0x1p-30;

template <class F>
void TileMap::at(double x, double y, const F& f) const {
  // Position in a tile; on the border if only rounding puts it outside; NaN outside.
  const auto inside = [](double p, double length, double cell) {
    const double slack = kTileSeam * cell;
    return p >= -slack && p <= length + slack ? std::clamp(p, 0.0, length) : std::numeric_limits<double>::quiet_NaN();
  };
  const double width = tile_width(), depth = tile_depth();
  if (!(std::abs(x) < 0x1p31 * width && std::abs(y) < 0x1p31 * depth)) return;
  const int first_col = static_cast<int>(std::floor(x / width - 0.5));
  const int last_row = layout.rows - 1 - static_cast<int>(std::floor(y / depth - 0.5));
  for (int row = last_row - 1; row <= last_row; ++row) {
    for (int col = first_col; col <= first_col + 1; ++col) {
      const Tile* tile = find(col, row);
      if (!tile) continue;
      const dvec3 south_west = corner(col, row);
      const double own_x = inside(x - south_west.x, width, layout.ground.cell_x),
                   own_y = inside(y - south_west.y, depth, layout.ground.cell_y);
      if (own_x == own_x && own_y == own_y && f(*tile, col, row, own_x, own_y)) return;
    }
  }
}

/// The target of marches over a tile.
inline HeightTarget target_of(const Tile& tile) {
  return {&tile.ground->field, &tile.ground->pyramid, std::numeric_limits<double>::quiet_NaN(), kTileSeam,
          tile.seam_step};
}

/// Throws Error if tiles that meet differ in a sample of their shared border.
void require_same_border(const TileMap& map, int col, int row);

/// Sets own_step and Tile::ground, which is stitched where an adjacent tile is coarser.
void build_ground(const TileMap& map, int col, int row, Tile& tile);

/// The tiles as one field of a scene. `march` is `max-mip` or `exhaustive`.
SceneFieldPtr scene_tiles(std::shared_ptr<const TileMap> map,
                          const HeightMarchEntry& march = find_height_march("max-mip"));

}  // namespace scarp
