// SPDX-License-Identifier: MIT
#include "scarp/accel/octant_cubes.h"

#include "scarp/accel/octant_edit.h"
#include "scarp/accel/octant_rows.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

// Neighbours ahead along x.
VoxelNearness::Sides ahead_of(int octant) { return {.lower = (octant & 1) != 0, .upper = (octant & 1) == 0}; }

}  // namespace

OctantCubes::OctantCubes(const VoxelGrid& grid)
    : sides_(glm::min(grid.size(), kMaxAcceleratedSide) * ivec3(1, 1, 8), 0) {
  require_accelerable(grid.size(), "octant cubes", 8);
  VoxelNearness up(grid, grid.box()), down = up;
  up.along_x(ahead_of(0));
  down.along_x(ahead_of(1));
  for (int octant = 0; octant < 4; ++octant)
    build_octants({octant, true, octant & 1 ? &down : &up}, grid.box(), sides_);
}

void OctantCubes::update(const VoxelGrid& grid, const VoxelBox& changed) {
  const VoxelBox box = intersection(changed, grid.box());
  if (box.empty()) return;
  const VoxelNearness solid(grid, box);
  parallel_for(8, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t octant = begin; octant < end; ++octant)
      update_octant(static_cast<int>(octant), solid, box, sides_);
  });
}

}  // namespace scarp
