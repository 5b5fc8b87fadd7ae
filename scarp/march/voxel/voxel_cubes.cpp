// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_cubes.h"

#include "scarp/accel/empty_cubes.h"
#include "scarp/march/voxel/voxel_loop.h"

namespace scarp {
namespace {

auto cube_by_cube(const VoxelTarget& target) {
  return [&cubes = *target.cubes](auto& walk, const ivec3& voxel, bool& solid) {
    const int distance = cubes.distance(voxel);
    solid = distance == 0;
    if (solid) return false;
    return distance == 1 ? walk.step() : walk.leave({voxel - (distance - 1), voxel + distance});
  };
}

}  // namespace

VoxelHit march_voxel_cubes(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats) {
  return first_voxel(target, ray, stats, cube_by_cube(target));
}

VoxelHit traced_voxel_cubes(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats, MarchTrace& trace) {
  return traced_voxel(target, ray, stats, trace, cube_by_cube(target));
}

bool occluded_voxel_cubes(const VoxelTarget& target, const QuantisedRay& ray) {
  return any_voxel(target, ray, cube_by_cube(target));
}

}  // namespace scarp
