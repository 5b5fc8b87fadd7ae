// SPDX-License-Identifier: MIT
#include "scarp/accel/brick_masks.h"

#include <algorithm>

namespace scarp {
namespace {

std::uint64_t bit(const ivec3& cell) { return std::uint64_t{1} << VoxelGrid::bit_of(cell); }

}  // namespace

BrickMasks::BrickMasks(const VoxelGrid& grid) {
  ivec3 cells = (grid.bricks() + 3) / 4;
  levels_.emplace_back(cells);
  const ivec3& size = grid.size();
  if (std::max({size.x, size.y, size.z}) > kOneLevel) {
    while (std::max({cells.x, cells.y, cells.z}) > 1) {
      cells = (cells + 3) / 4;
      levels_.emplace_back(cells);
    }
  }
  grid.for_each_solid_brick([&](const ivec3& brick, std::uint64_t) {
    ivec3 cell = brick;
    for (Level& level : levels_) {
      std::uint64_t& mask = level.masks.at(level.index(cell >> 2));
      // If the cell was present before, it is present in all coarser levels.
      if (mask & bit(cell)) break;
      mask |= bit(cell);
      cell = cell >> 2;
    }
  });
}

void BrickMasks::update(const VoxelGrid& grid, const VoxelBox& changed) {
  if (changed.empty()) return;
  // Cells of the level below with changes.
  VoxelBox cells = {changed.low >> 2, ((changed.high - 1) >> 2) + 1};
  ivec3 below = grid.bricks();
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    Level& level = levels_[i];
    cells = {cells.low >> 2, ((cells.high - 1) >> 2) + 1};
    for_each_voxel(cells, [&](const ivec3& cell) {
      std::uint64_t mask = 0;
      for_each_voxel(intersection({4 * cell, 4 * cell + 4}, {ivec3(0), below}), [&](const ivec3& child) {
        const std::uint64_t inside = i == 0 ? grid.mask(child) : levels_[i - 1].mask(child);
        if (inside != 0) mask |= bit(child);
      });
      // Zeros need no chunk.
      if (mask != level.mask(cell)) level.masks.at(level.index(cell)) = mask;
    });
    below = level.size;
  }
}

std::size_t BrickMasks::bytes() const {
  std::size_t sum = sizeof(*this);
  for (const Level& level : levels_) sum += sizeof(level) + level.masks.bytes();
  return sum;
}

}  // namespace scarp
