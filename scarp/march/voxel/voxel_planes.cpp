// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_planes.h"

#include "scarp/march/voxel/voxel_loop.h"

namespace scarp {
namespace {

auto plane_by_plane(const VoxelTarget& target) {
  return [&grid = *target.grid](auto& walk, const ivec3& voxel, bool& solid) {
    solid = grid.solid(voxel);
    return !solid && walk.step();
  };
}

}  // namespace

VoxelHit march_voxel_planes(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats) {
  return first_voxel(target, ray, stats, plane_by_plane(target));
}

VoxelHit traced_voxel_planes(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats, MarchTrace& trace) {
  return traced_voxel(target, ray, stats, trace, plane_by_plane(target));
}

VoxelHit march_voxel_planes_accepted(const VoxelTarget& target, const QuantisedRay& ray, const VoxelFilter& accept,
                                     MarchStats* stats) {
  return first_voxel(target, ray, stats, [&](VoxelWalk& walk, const ivec3& voxel, bool& solid) {
    if (target.grid->solid(voxel)) {
      const VoxelHit hit = walk.hit(*target.grid);
      solid = !hit || accept(hit);  // the walk also ends beyond the ray's end
    }
    return !solid && walk.step();
  });
}

bool occluded_voxel_planes(const VoxelTarget& target, const QuantisedRay& ray) {
  return any_voxel(target, ray, plane_by_plane(target));
}

}  // namespace scarp
