// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_spheres.h"

#include "scarp/accel/empty_spheres.h"
#include "scarp/march/voxel/voxel_loop.h"
#include "scarp/march/voxel/voxel_travel.h"

namespace scarp {
namespace {

auto sphere_by_sphere(const VoxelTarget& target, const QuantisedRay& ray) {
  return [&spheres = *target.spheres, travel = travel_per_voxel(ray.direction)](auto& walk, const ivec3& voxel,
                                                                                bool& solid) {
    const int distance = spheres.distance(voxel);
    solid = distance == EmptySpheres::kSolid;
    return !solid && walk.step_and_travel(distance, travel);
  };
}

}  // namespace

VoxelHit march_voxel_spheres(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats) {
  return first_voxel(target, ray, stats, sphere_by_sphere(target, ray));
}

VoxelHit traced_voxel_spheres(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats,
                              MarchTrace& trace) {
  return traced_voxel(target, ray, stats, trace, sphere_by_sphere(target, ray));
}

bool occluded_voxel_spheres(const VoxelTarget& target, const QuantisedRay& ray) {
  return any_voxel(target, ray, sphere_by_sphere(target, ray));
}

}  // namespace scarp
