// SPDX-License-Identifier: MIT
// Occupancy of bricks: a 64-bit mask per sector of 4 x 4 x 4 bricks (16 x 16 x 16 voxels), bit x + 4 y + 16 z as in the
// bricks themselves. Cost: 8 bytes per sector, 1/64 of the grid's masks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scarp/field/voxel_grid.h"

namespace scarp {

/// Occupancy of the bricks of a voxel grid.
class BrickMasks {
 public:
  explicit BrickMasks(const VoxelGrid& grid);

  /// Updates the masks after an edit of the same grid that returned `changed`. Equal to a rebuild.
  void update(const VoxelGrid& grid, const VoxelBox& changed);

  /// Mask of the sector with these coordinates, which must exist.
  std::uint64_t sector(const ivec3& sector) const { return masks_[index(sector)]; }
  /// Sectors per axis, and all masks, x fastest.
  const ivec3& sectors() const { return sectors_; }
  std::span<const std::uint64_t> masks() const { return masks_; }
  std::size_t bytes() const { return sizeof(*this) + masks_.size() * sizeof(std::uint64_t); }
  friend bool operator==(const BrickMasks&, const BrickMasks&) = default;

 private:
  std::size_t index(const ivec3& sector) const {
    return static_cast<std::size_t>(sector.x) +
           static_cast<std::size_t>(sectors_.x) *
               (static_cast<std::size_t>(sector.y) +
                static_cast<std::size_t>(sectors_.y) * static_cast<std::size_t>(sector.z));
  }

  ivec3 sectors_;
  std::vector<std::uint64_t> masks_;
};

}  // namespace scarp
