// SPDX-License-Identifier: MIT
#include "scarp/scene/tiled_terrain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/scene/tile_map.h"

namespace scarp {
namespace {

constexpr int kMostTiles = 65536, kMostCells = 1 << 20;

[[noreturn]] void refuse(TilePlace place, const std::string& why) {
  throw Error(fmt::format("tiles: ({}, {}): {}", place.col, place.row, why));
}

void require_inside(const TileLayout& layout, TilePlace place) {
  if (place.col >= 0 && place.row >= 0 && place.col < layout.cols && place.row < layout.rows) return;
  refuse(place, fmt::format("outside the grid of {} x {} tiles", layout.cols, layout.rows));
}

void require_layout(const TileLayout& layout) {
  const auto in_range = [](std::string_view what, int value, int most) {
    if (value >= 1 && value <= most) return;
    throw Error(fmt::format("tiles: {} is {}; it must be 1 to {}", what, value, most));
  };
  in_range("the number of columns of tiles", layout.cols, kMostTiles);
  in_range("the number of rows of tiles", layout.rows, kMostTiles);
  in_range("the number of columns of cells", layout.cell_cols, kMostCells / layout.cols);
  in_range("the number of rows of cells", layout.cell_rows, kMostCells / layout.rows);
  if (layout.ground.wrap != Wrap::none) throw Error("tiles: tiles do not wrap round (set wrap to none)");
  if (layout.ground.solid)
    throw Error("tiles: tiles are not solid: walls would stand between them (set solid to false)");
  // The field itself checks the rest.
  const float sample = 0;
  HeightField::view(&sample, 1, 1, layout.ground);
}

// The level of a tile with this number of samples; -1 if no level has it.
int level_of(const TileLayout& layout, const HeightField& field) {
  for (int level = 0; layout.cell_cols >> level >= 1 && layout.cell_rows >> level >= 1; ++level) {
    if (layout.cell_cols % (1 << level) != 0 || layout.cell_rows % (1 << level) != 0) return -1;
    if (field.cols() == (layout.cell_cols >> level) + 1 && field.rows() == (layout.cell_rows >> level) + 1)
      return level;
  }
  return -1;
}

// Throws Error if the field does not fit; returns its level.
int require_fitting(const TileLayout& layout, TilePlace place, const HeightField& field) {
  const int level = level_of(layout, field);
  if (level < 0) {
    refuse(place, fmt::format("{} x {} samples; a tile has {} x {}, or its cells are 2, 4, 8, ... times as long",
                              field.cols(), field.rows(), layout.cell_cols + 1, layout.cell_rows + 1));
  }
  const HeightFieldSettings &own = field.settings(), &wanted = layout.ground;
  const double cell_x = std::ldexp(wanted.cell_x, level), cell_y = std::ldexp(wanted.cell_y, level);
  if (own.cell_x != cell_x || own.cell_y != cell_y) {
    refuse(place, fmt::format("cells of {} x {} m; with this many samples they are {} x {} m", own.cell_x, own.cell_y,
                              cell_x, cell_y));
  }
  const char* other = own.scale != wanted.scale                 ? "scale"
                      : own.offset != wanted.offset             ? "offset"
                      : own.exaggeration != wanted.exaggeration ? "exaggeration"
                      : own.nodata != wanted.nodata             ? "nodata value"
                      : own.surface != wanted.surface           ? "surface"
                      : own.wrap != wanted.wrap                 ? "wrap"
                      : own.solid != wanted.solid               ? "solid"
                                                                : nullptr;
  if (other) refuse(place, fmt::format("its setting '{}' is not that of the layout", other));
  return level;
}

}  // namespace

TerrainTiles::TerrainTiles(std::shared_ptr<const TileMap> map, std::uint64_t epoch)
    : map_(std::move(map)), scene_(std::make_shared<const Scene>(scene_tiles(map_))), epoch_(epoch) {}

const TileLayout& TerrainTiles::layout() const { return map_->layout; }

const HeightField* TerrainTiles::tile(TilePlace place) const {
  const Tile* tile = map_->find(place.col, place.row);
  return tile ? &tile->ground->field : nullptr;
}

TilePlace TerrainTiles::place(const Hit& hit) const {
  const auto cols = static_cast<std::uint32_t>(map_->layout.cols);
  return {static_cast<int>(hit.part % cols), static_cast<int>(hit.part / cols)};
}

std::optional<double> TerrainTiles::height(double x, double y) const { return scene_->height(x, y); }

// The new map. Rows are copied before they change.
struct TiledTerrain::Editor::Change {
  TileMap map;
  std::set<std::pair<int, int>> changed{};  // row, column
  std::set<int> own_rows{};

  std::shared_ptr<const Tile>& at(int col, int row) {
    auto& shared = map.rows[static_cast<std::size_t>(row)];
    if (own_rows.insert(row).second) shared = std::make_shared<TileMap::Row>(*shared);
    // Made here, so not const.
    return const_cast<TileMap::Row&>(*shared)[static_cast<std::size_t>(col)];
  }
  template <class F>
  void for_each_beside(const F& f) {
    std::set<std::pair<int, int>> beside;
    for (const auto& [row, col] : changed) {
      for (int r = row - 1; r <= row + 1; ++r)
        for (int c = col - 1; c <= col + 1; ++c)
          if (map.find(c, r)) beside.emplace(r, c);
    }
    for (const auto& place : beside) f(place.second, place.first);
  }
  void finish();
};

void TiledTerrain::Editor::Change::finish() {
  for (const auto& place : changed) require_same_border(map, place.second, place.first);
  // Rebuilds the ground of changed tiles and of finer tiles beside them, except ground that neither is nor must be
  // stitched.
  for_each_beside([&](int col, int row) {
    const Tile& now = *map.find(col, row);
    const auto coarser = [&](int c, int r) {
      const Tile* beside = map.find(c, r);
      return beside && beside->level > now.level;
    };
    const bool stitch =
        coarser(col - 1, row) || coarser(col + 1, row) || coarser(col, row - 1) || coarser(col, row + 1);
    if (now.ground && !now.stitched && !stitch) return;
    auto tile = std::make_shared<Tile>(now);
    build_ground(map, col, row, *tile);
    at(col, row) = std::move(tile);
  });
  for_each_beside([&](int col, int row) {
    const Tile& now = *map.find(col, row);
    double step = now.own_step;
    for (const auto& [c, r] : {std::pair(col - 1, row), {col + 1, row}, {col, row - 1}, {col, row + 1}})
      if (const Tile* beside = map.find(c, r)) step = std::max(step, beside->own_step);
    if (step == now.seam_step) return;
    auto tile = std::make_shared<Tile>(now);
    tile->seam_step = step;
    at(col, row) = std::move(tile);
  });
}

TiledTerrain::TiledTerrain(const TileLayout& layout) {
  require_layout(layout);
  const auto row = std::make_shared<const TileMap::Row>(static_cast<std::size_t>(layout.cols));
  auto map = std::make_shared<TileMap>(TileMap{layout, {}});
  map->rows.assign(static_cast<std::size_t>(layout.rows), row);
  tiles_ = TerrainTiles(std::move(map), 0);
}

TerrainTiles TiledTerrain::read() const {
  const std::scoped_lock held(current_);
  return *tiles_;
}

void TiledTerrain::Editor::put(TilePlace place, const HeightField& field, CellMaterials materials) {
  require_inside(change_.map.layout, place);
  if (change_.map.find(place.col, place.row)) refuse(place, "there is a tile already (remove it first)");
  auto tile = std::make_shared<Tile>(field, require_fitting(change_.map.layout, place, field));
  require_materials(field, materials);
  tile->materials = std::move(materials);
  if (const auto* memory = field.memory()) {
    tile->memory = memory->lock();
    if (!tile->memory) refuse(place, "the memory of its samples was freed");
  }
  change_.at(place.col, place.row) = std::move(tile);
  change_.changed.emplace(place.row, place.col);
}

void TiledTerrain::Editor::remove(TilePlace place) {
  require_inside(change_.map.layout, place);
  if (!change_.map.find(place.col, place.row)) refuse(place, "there is no tile to remove");
  change_.at(place.col, place.row).reset();
  change_.changed.emplace(place.row, place.col);
}

std::uint64_t TiledTerrain::edit(const std::function<void(Editor&)>& change) {
  const std::scoped_lock one_at_a_time(edits_);
  const TerrainTiles before = read();
  Editor::Change now{*before.map_};
  Editor editor(now);
  change(editor);
  now.finish();
  TerrainTiles after(std::make_shared<const TileMap>(std::move(now.map)), before.epoch() + 1);
  const std::scoped_lock held(current_);
  tiles_ = after;
  return after.epoch();
}

}  // namespace scarp
