// SPDX-License-Identifier: MIT
// Occupancy of bricks: a 64-bit mask per sector of 4 x 4 x 4 bricks (16 x 16 x 16 voxels), bit x + 4 y + 16 z as in the
// bricks themselves. Grids with a side above kOneLevel also have coarser levels, a mask per 4 x 4 x 4 cells of the
// level below, up to a single cell: a tree with 64 children per node, addressed by coordinates instead of pointers.
// Cost: 8 bytes per sector, 1/64 of the grid's masks; in grids of more than 2^33 voxels only where something is solid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scarp/field/sparse_table.h"
#include "scarp/field/voxel_grid.h"

namespace scarp {

/// Occupancy of the bricks of a voxel grid.
class BrickMasks {
 public:
  explicit BrickMasks(const VoxelGrid& grid);

  /// Updates the masks after an edit of the same grid that returned `changed`. Equal to a rebuild.
  void update(const VoxelGrid& grid, const VoxelBox& changed);

  /// Mask of the sector with these coordinates, which must exist.
  std::uint64_t sector(const ivec3& sector) const { return levels_[0].mask(sector); }
  /// The largest side of grids that have sectors only.
  static constexpr int kOneLevel = 512;
  /// Cells of 16 * 4^level voxels a side. Bit i of a mask: whether the cell i of the level below has solid voxels.
  struct Level {
    ivec3 size;
    SparseTable<std::uint64_t> masks;

    explicit Level(const ivec3& cells)
        : size(cells),
          masks(static_cast<std::size_t>(cells.x) * static_cast<std::size_t>(cells.y) *
                static_cast<std::size_t>(cells.z)) {}
    std::size_t index(const ivec3& cell) const {
      return static_cast<std::size_t>(cell.x) +
             static_cast<std::size_t>(size.x) * (static_cast<std::size_t>(cell.y) +
                                                 static_cast<std::size_t>(size.y) * static_cast<std::size_t>(cell.z));
    }
    std::uint64_t mask(const ivec3& cell) const { return masks[index(cell)]; }
    friend bool operator==(const Level&, const Level&) = default;
  };
  /// Sectors, then coarser levels.
  std::span<const Level> levels() const { return levels_; }

  std::size_t bytes() const;
  friend bool operator==(const BrickMasks&, const BrickMasks&) = default;

 private:
  std::vector<Level> levels_;
};

}  // namespace scarp
