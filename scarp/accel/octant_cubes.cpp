// SPDX-License-Identifier: MIT
#include "scarp/accel/octant_cubes.h"

#include <algorithm>

#include "scarp/accel/octant_rows.h"

namespace scarp {
namespace {

// Neighbours ahead along x.
VoxelNearness::Sides ahead_of(int octant) { return {.lower = (octant & 1) != 0, .upper = (octant & 1) == 0}; }

}  // namespace

OctantCubes::OctantCubes(const VoxelGrid& grid)
    : sides_(glm::min(grid.size(), kMaxAcceleratedSide) * ivec3(1, 1, 8), 0) {
  require_accelerable(grid.size(), "octant cubes");
  VoxelNearness up(grid, grid.box()), down = up;
  up.along_x(ahead_of(0));
  down.along_x(ahead_of(1));
  for (int octant = 0; octant < 4; ++octant)
    largest_ = std::max(largest_, build_octants({octant, true, octant & 1 ? &down : &up}, grid.box(), sides_));
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
    region = intersection(region, grid.box());
    VoxelNearness near(grid, region);
    near.along_x(ahead_of(octant));
    largest_ = std::max(largest_, build_octants({octant, false, &near}, region, sides_));
  }
}

}  // namespace scarp
