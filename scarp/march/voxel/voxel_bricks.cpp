// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_bricks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

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

// An empty block around a voxel: its side as a power of 2, or -1 if the voxel is solid. In the cells of the first
// `entered` levels, from the coarsest down as far as they are not empty; the coarser ones are known not to be.
int empty_side(const VoxelTarget& target, const std::array<std::uint64_t, 64>& ahead, const ivec3& voxel,
               std::size_t entered) {
  const std::span<const BrickMasks::Level> levels = target.bricks->levels();
  for (std::size_t i = entered; i > 0; --i) {
    const int side = static_cast<int>(2 * i);  // of the cell, as a power of 2
    const ivec3 cell = voxel >> side;
    const int bit = VoxelGrid::bit_of(cell);
    const std::uint64_t cells = levels[i - 1].mask(cell >> 2);
    if (cells >> bit & 1) continue;
    const std::uint64_t there = cells & ahead[bit];
    return there == 0 ? side + 2 : pair_empty(there, bit) ? side + 1 : side;
  }
  const ivec3 brick = voxel >> 2;
  const int bit = VoxelGrid::bit_of(voxel);
  const std::uint64_t mask = target.grid->mask(brick) & ahead[bit];
  if (mask != 0) return mask >> bit & 1 ? -1 : pair_empty(mask, bit) ? 1 : 0;
  const int brick_bit = VoxelGrid::bit_of(brick);
  const std::uint64_t sector = levels[0].mask(brick >> 2) & ahead[brick_bit];
  // The brick's own bit may be set by voxels behind the ray.
  if ((sector & ~(std::uint64_t{1} << brick_bit)) == 0) return 4;
  return pair_empty(sector, brick_bit) ? 3 : 2;
}

auto brick_by_brick(const VoxelTarget& target, const QuantisedRay& ray) {
  const std::array<int, 3>& step = ray.direction.step;
  const int octant = (step[0] < 0 ? 1 : 0) | (step[1] < 0 ? 2 : 0) | (step[2] < 0 ? 4 : 0);
  // Grids with sectors only start at the brick.
  const std::size_t levels = target.bricks->levels().size(), descents = levels > 1 ? levels : 0;
  return [&target, &ahead = kAhead[octant], descents, entered = descents](auto& walk, const ivec3& at,
                                                                          bool& solid) mutable {
    const ivec3 voxel = at;
    const int side = empty_side(target, ahead, voxel, entered);
    solid = side < 0;
    if (solid) return false;
    const bool inside = side == 0 ? walk.step() : walk.leave(block(voxel, side));
    // The cells that the ray has left for others, on any axis.
    const ivec3 moved = voxel ^ at;
    const auto places = std::bit_width(static_cast<std::uint32_t>(moved.x | moved.y | moved.z));
    entered = std::min(descents, static_cast<std::size_t>(places - 1) / 2);
    return inside;
  };
}

}  // namespace

VoxelHit march_voxel_bricks(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats) {
  return first_voxel(target, ray, stats, brick_by_brick(target, ray));
}

VoxelHit traced_voxel_bricks(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats, MarchTrace& trace) {
  return traced_voxel(target, ray, stats, trace, brick_by_brick(target, ray));
}

bool occluded_voxel_bricks(const VoxelTarget& target, const QuantisedRay& ray) {
  return any_voxel(target, ray, brick_by_brick(target, ray));
}

}  // namespace scarp
