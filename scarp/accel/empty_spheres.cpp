// SPDX-License-Identifier: MIT
#include "scarp/accel/empty_spheres.h"

#include <algorithm>

#include "scarp/accel/sphere_rows.h"

namespace scarp {

EmptySpheres::EmptySpheres(const VoxelGrid& grid) : distances_(glm::min(grid.size(), kMaxAcceleratedSide), kFarthest) {
  require_accelerable(grid.size(), "empty spheres");
  build(grid, grid.box());
}

void EmptySpheres::update(const VoxelGrid& grid, const VoxelBox& changed) {
  if (changed.empty()) return;
  // Distances between boxes are rounded down, and one voxel less than those between coordinates.
  build(grid, intersection(changed.grown(largest_ + 2), grid.box()));
}

void EmptySpheres::build(const VoxelGrid& grid, const VoxelBox& region) {
  if (grid.solid_count() == 0) {
    distances_ = VoxelBytes(distances_.size(), kFarthest);
    largest_ = kFarthest;
    return;
  }
  // Voxels farther away do not count.
  const VoxelBox window = intersection(region.grown(kFarthest + 2), grid.box());
  VoxelNearness near(grid, window);
  near.along_x({});
  largest_ = std::max(largest_, build_spheres(near, window, region, distances_));
}

}  // namespace scarp
