// SPDX-License-Identifier: MIT
// A tiled terrain: a grid of height fields that share their border samples and act as one field. Tiles can be added and
// removed while other threads query.
//
//   scarp::TiledTerrain terrain({.cols = 100, .rows = 100, .cell_cols = 256, .cell_rows = 256, .ground = {...}});
//   terrain.edit([&](auto& editor) { editor.put({3, 4}, field); });     // one thread
//
//   const scarp::TerrainTiles tiles = terrain.read();                   // others
//   const scarp::Hit hit = scarp::cast(tiles, ray);                     // hit.part: the tile
//
//   (0,0)---(1,0)---+     Tile (0, 0) is the north-west one; rows go south, as in a height field. The south-west
//     |       |     |     sample of the whole grid is at x = y = 0. A tile of cell_cols x cell_rows cells has one
//   (0,1)---(1,1)---+     sample more in each direction: it shares its border samples with its neighbours.
//     |       |     |
//     +-------+-----+     Missing tiles are holes.
//
// A tile may be coarser: its cells are 2, 4, 8, ... times as long, and correspondingly fewer. Where a finer tile meets
// it, the samples of the finer border are replaced by those of the straight lines between the coarser samples, so that
// the surfaces meet without a gap. Stitched samples are float32; where one is rounded, rays that enter below the border
// by at most the rounding hit it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "scarp/field/height_field.h"
#include "scarp/scene/scene.h"

namespace scarp {

struct TileMap;

/// The position of a tile in its grid.
struct TilePlace {
  int col = 0;
  int row = 0;
  friend bool operator==(const TilePlace&, const TilePlace&) = default;
};

struct TileLayout {
  int cols = 1;                  ///< tiles, 1..65536
  int rows = 1;                  ///< tiles, 1..65536
  int cell_cols = 256;           ///< cells of a tile at full resolution, >= 1
  int cell_rows = 256;           ///< >= 1
  HeightFieldSettings ground{};  ///< settings of all tiles at full resolution; without wrap, not solid
};

/// The tiles at one epoch, as a scene of one field. Copies are cheap. Immutable and thread-safe; valid as long as they
/// exist, regardless of later edits. Queries use the march `max-mip`, which is exact.
class TerrainTiles {
 public:
  const Scene& scene() const { return *scene_; }
  operator const Scene&() const { return *scene_; }
  /// Number of edits before this epoch.
  std::uint64_t epoch() const { return epoch_; }

  const TileLayout& layout() const;
  /// Returns the field of a tile, with stitched borders; null if it is missing or outside the grid.
  const HeightField* tile(TilePlace place) const;
  /// Returns the tile of a hit on these tiles: Hit::part is row * cols + col.
  TilePlace place(const Hit& hit) const;
  /// Returns the height of the ground at (x, y), in metres; nullopt outside, over missing tiles and over holes.
  std::optional<double> height(double x, double y) const;

 private:
  friend class TiledTerrain;
  TerrainTiles(std::shared_ptr<const TileMap> map, std::uint64_t epoch);

  std::shared_ptr<const TileMap> map_;
  std::shared_ptr<const Scene> scene_;
  std::uint64_t epoch_;
};

class TiledTerrain {
 public:
  /// A terrain without tiles. Throws Error for a layout out of range, a grid of more than 2^20 cells a side, or ground
  /// that wraps or is solid.
  explicit TiledTerrain(const TileLayout& layout);
  TiledTerrain(const TiledTerrain&) = delete;
  TiledTerrain& operator=(const TiledTerrain&) = delete;

  /// Returns the tiles as they are now. Never waits for an edit. Thread-safe.
  TerrainTiles read() const;

  /// Changes tiles, in edit().
  class Editor {
   public:
    /// Adds a tile. The tile shares its samples with the caller's field: they must not change while the tile is in the
    /// terrain. Samples of HeightField::view() with a known owner are kept alive. Throws Error for a place outside the
    /// grid, a place that has a tile already, or a field that does not fit the layout in its number of samples, cell
    /// size or settings.
    ///
    /// `materials`: one per cell of the field, rows from north to south; null: the object's material.
    void put(TilePlace place, const HeightField& field, CellMaterials materials = nullptr);
    /// Removes a tile. Throws Error if there is none at this place.
    void remove(TilePlace place);

   private:
    friend class TiledTerrain;
    struct Change;
    explicit Editor(Change& change) : change_(change) {}
    Change& change_;
  };

  /// Calls `change`, then publishes its tiles in one step, and returns the new epoch. Readers do not wait, and earlier
  /// results of read() do not change. Builds the pyramids of the tiles that changed and of their finer neighbours.
  /// Throws Error, changing nothing, if `change` throws or tiles would differ in a sample of their shared border
  /// (compared where the coarser one has samples). Edits wait for one another; `change` must not call edit().
  /// Thread-safe.
  std::uint64_t edit(const std::function<void(Editor&)>& change);

 private:
  std::mutex edits_;            // held by an edit
  mutable std::mutex current_;  // held to copy the pointers
  std::optional<TerrainTiles> tiles_;
};

}  // namespace scarp
