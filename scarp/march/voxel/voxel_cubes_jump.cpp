// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_cubes_jump.h"

#include "scarp/accel/empty_cubes.h"
#include "scarp/march/voxel/voxel_loop.h"
#include "scarp/march/voxel/voxel_travel.h"

namespace scarp {
namespace {

auto jump_by_jump(const VoxelTarget& target, const QuantisedRay& ray) {
  return
      [&cubes = *target.cubes, travel = travel_per_voxel(ray.direction)](auto& walk, const ivec3& voxel, bool& solid) {
        const int distance = cubes.distance(voxel);
        solid = distance == 0;
        return !solid && walk.step_and_travel(distance - 1, travel);
      };
}

}  // namespace

VoxelHit march_voxel_cubes_jump(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats) {
  return first_voxel(target, ray, stats, jump_by_jump(target, ray));
}

VoxelHit traced_voxel_cubes_jump(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats,
                                 MarchTrace& trace) {
  return traced_voxel(target, ray, stats, trace, jump_by_jump(target, ray));
}

bool occluded_voxel_cubes_jump(const VoxelTarget& target, const QuantisedRay& ray) {
  return any_voxel(target, ray, jump_by_jump(target, ray));
}

}  // namespace scarp
