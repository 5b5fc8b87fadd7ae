// SPDX-License-Identifier: MIT
#include "scarp/accel/octant_cubes.h"

#include <algorithm>

namespace scarp {

OctantCubes::OctantCubes(const VoxelGrid& grid) : sides_(glm::min(grid.size(), kMaxAcceleratedSide), 8, 0) {
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
  const ivec3 ahead(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1), count = region.high - region.low;
  const VoxelBox box = grid.box();
  // Counted from the far end, so that what lies ahead is known.
  for_each_voxel({ivec3(0), count}, [&](const ivec3& n) {
    ivec3 v;
    for (int axis = 0; axis < 3; ++axis)
      v[axis] = ahead[axis] > 0 ? region.high[axis] - 1 - n[axis] : region.low[axis] + n[axis];
    int least = -1;
    if (!grid.solid(v)) {
      least = kLargest - 1;
      for (int i = 1; i < 8; ++i) {
        const ivec3 neighbour = v + ahead * ivec3(i & 1, i >> 1 & 1, i >> 2);
        if (box.contains(neighbour)) least = std::min<int>(least, sides_.at(neighbour)[octant]);
      }
    }
    sides_.at(v)[octant] = static_cast<std::uint8_t>(least + 1);
    largest_ = std::max(largest_, least + 1);
  });
}

}  // namespace scarp
