// SPDX-License-Identifier: MIT
// Which bricks of a voxel grid hold solid voxels: a 64-bit mask per sector of 4 x 4 x 4 bricks (16 x 16 x 16 voxels),
// bit x + 4 y + 16 z as in the bricks themselves. Cost: 8 bytes per sector, 1/64 of the grid's masks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scarp/field/voxel_grid.h"

namespace scarp {

class BrickMasks {
 public:
  explicit BrickMasks(const VoxelGrid& grid);

  /// After an edit of the same grid, with the box that it returned: as if built anew.
  void update(const VoxelGrid& grid, const VoxelBox& changed);

  /// Of the sector with these coordinates; it must exist.
  std::uint64_t sector(const ivec3& sector) const {
    return masks_[static_cast<std::size_t>(sector.x) +
                  static_cast<std::size_t>(sectors_.x) *
                      (static_cast<std::size_t>(sector.y) +
                       static_cast<std::size_t>(sectors_.y) * static_cast<std::size_t>(sector.z))];
  }
  /// Sectors per axis, and the masks of all of them, x fastest.
  const ivec3& sectors() const { return sectors_; }
  std::span<const std::uint64_t> masks() const { return masks_; }
  std::size_t bytes() const { return sizeof(*this) + masks_.size() * sizeof(std::uint64_t); }
  friend bool operator==(const BrickMasks&, const BrickMasks&) = default;

 private:
  ivec3 sectors_;
  std::vector<std::uint64_t> masks_;
};

}  // namespace scarp
