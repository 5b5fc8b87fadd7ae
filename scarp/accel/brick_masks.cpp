// SPDX-License-Identifier: MIT
#include "scarp/accel/brick_masks.h"

namespace scarp {

BrickMasks::BrickMasks(const VoxelGrid& grid)
    : sectors_((grid.bricks() + 3) / 4),
      masks_(static_cast<std::size_t>(sectors_.x) * static_cast<std::size_t>(sectors_.y) *
             static_cast<std::size_t>(sectors_.z)) {
  grid.for_each_solid_brick([&](const ivec3& brick, std::uint64_t) {
    masks_[index(brick >> 2)] |= std::uint64_t{1} << VoxelGrid::bit_of(brick);
  });
}

void BrickMasks::update(const VoxelGrid& grid, const VoxelBox& changed) {
  if (changed.empty()) return;
  for_each_voxel({changed.low >> 4, ((changed.high - 1) >> 4) + 1}, [&](const ivec3& sector) {
    std::uint64_t mask = 0;
    for_each_voxel(intersection({4 * sector, 4 * sector + 4}, {ivec3(0), grid.bricks()}), [&](const ivec3& brick) {
      if (grid.mask(brick) != 0) mask |= std::uint64_t{1} << VoxelGrid::bit_of(brick);
    });
    masks_[index(sector)] = mask;
  });
}

}  // namespace scarp
