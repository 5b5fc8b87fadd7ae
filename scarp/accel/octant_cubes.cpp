// SPDX-License-Identifier: MIT
#include "scarp/accel/octant_cubes.h"

#include <algorithm>
#include <array>

#include "scarp/accel/voxel_nearness.h"

namespace scarp {

OctantCubes::OctantCubes(const VoxelGrid& grid)
    : sides_(glm::min(grid.size(), kMaxAcceleratedSide) * ivec3(1, 1, 8), 0) {
  require_accelerable(grid, "octant cubes");
  for (int octant = 0; octant < 8; ++octant) build(grid, grid.box(), octant);
}

void OctantCubes::update(const VoxelGrid& grid, const VoxelBox& changed) {
  if (changed.empty()) return;
  const int reach = largest_;
  for (int octant = 0; octant < 8; ++octant) {
    VoxelBox region = changed;
    for (int axis = 0; axis < 3; ++axis) {
      if (octant >> axis & 1) {
        region.high[axis] += reach;
      } else {
        region.low[axis] -= reach;
      }
    }
    build(grid, intersection(region, grid.box()), octant);
  }
}

void OctantCubes::build(const VoxelGrid& grid, const VoxelBox& region, int octant) {
  // What is one ahead of the region is known.
  VoxelBox seen = region;
  std::array<VoxelNearness::Sides, 3> ahead;
  for (int axis = 0; axis < 3; ++axis) {
    const bool down = octant >> axis & 1;
    ahead[axis] = {.lower = down, .upper = !down};
    (down ? seen.low : seen.high)[axis] += down ? -1 : 1;
  }
  seen = intersection(seen, grid.box());
  VoxelNearness near(grid, seen);
  for_each_row(seen, [&](int y, int z) {
    std::uint8_t* const row = near.row(y - seen.low.y, z - seen.low.z);
    const bool inner = y >= region.low.y && y < region.high.y && z >= region.low.z && z < region.high.z;
    for (int x = seen.low.x; x < seen.high.x; ++x) {
      if (inner && x == region.low.x) x = region.high.x;
      if (x < seen.high.x) row[x - seen.low.x] = static_cast<std::uint8_t>(kLargest - side({x, y, z}, octant));
    }
  });
  near.spread(ahead[0], ahead[1], ahead[2]);
  int largest = 0;
  for_each_row(region, [&](int y, int z) {
    const std::uint8_t* const row = near.row(y - seen.low.y, z - seen.low.z) + (region.low.x - seen.low.x);
    std::uint8_t* const to = sides_.at(in_plane({region.low.x, y, z}, octant));
    std::uint8_t here = 0;
    for (int x = 0; x < region.high.x - region.low.x; ++x) {
      const auto side = static_cast<std::uint8_t>(kLargest - row[x]);
      to[x] = side;
      here = std::max(here, side);
    }
    largest = std::max<int>(largest, here);
  });
  largest_ = std::max(largest_, largest);
}

}  // namespace scarp
