// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_bricks.h"

#include <array>
#include <cstdint>

#include "scarp/accel/brick_masks.h"
#include "scarp/march/voxel/voxel_ahead.h"
#include "scarp/march/voxel/voxel_loop.h"

namespace scarp {
namespace {

bool pair_empty(std::uint64_t mask, int bit) { return (mask >> (bit & kEven) & kPair) == 0; }

// The aligned block with sides of 2^level voxels around a voxel.
VoxelBox block(const ivec3& voxel, int level) {
  const ivec3 low = (voxel >> level) << level;
  return {low, low + (1 << level)};
}

auto brick_by_brick(const VoxelTarget& target, const QuantisedRay& ray) {
  const std::array<int, 3>& step = ray.direction.step;
  const int octant = (step[0] < 0 ? 1 : 0) | (step[1] < 0 ? 2 : 0) | (step[2] < 0 ? 4 : 0);
  return [&grid = *target.grid, &bricks = *target.bricks, &ahead = kAhead[octant]](VoxelWalk& walk, const ivec3& voxel,
                                                                                   bool& solid) {
    const ivec3 brick = voxel >> 2;
    const int bit = VoxelGrid::bit_of(voxel);
    const std::uint64_t mask = grid.mask(brick) & ahead[bit];
    if (mask != 0) {
      solid = mask >> bit & 1;
      if (solid) return false;
      return pair_empty(mask, bit) ? walk.leave(block(voxel, 1)) : walk.step();
    }
    // The block that is left: from level to level, while nothing in the cell around it is ahead of the ray.
    int side = 2;  // as a power of 2
    for (const BrickMasks::Level& level : bricks.levels()) {
      const ivec3 cell = voxel >> side;
      const int cell_bit = VoxelGrid::bit_of(cell);
      const std::uint64_t cells = level.mask(cell >> 2) & ahead[cell_bit];
      // The cell's own bit may be set by voxels behind the ray.
      if ((cells & ~(std::uint64_t{1} << cell_bit)) != 0)
        return walk.leave(block(voxel, pair_empty(cells, cell_bit) ? side + 1 : side));
      side += 2;
    }
    return walk.leave(block(voxel, side));
  };
}

}  // namespace

VoxelHit march_voxel_bricks(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats) {
  return first_voxel(target, ray, stats, brick_by_brick(target, ray));
}

bool occluded_voxel_bricks(const VoxelTarget& target, const QuantisedRay& ray) {
  return any_voxel(target, ray, brick_by_brick(target, ray));
}

}  // namespace scarp
