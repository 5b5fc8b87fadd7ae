// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_spheres.h"

#include <cmath>

#include "scarp/accel/empty_spheres.h"
#include "scarp/march/voxel/voxel_loop.h"

namespace scarp {
namespace {

// Travel along the ray's longest axis, in 2^-20 voxel, per voxel of distance: rounded down, so that it never travels
// too far.
std::int64_t travel_per_voxel(const QuantisedDirection& direction) {
  double square = 0;
  for (const std::int64_t speed : direction.speed) square += static_cast<double>(speed) * static_cast<double>(speed);
  const std::int64_t length = static_cast<std::int64_t>(std::sqrt(square)) + 2;
  return (std::int64_t{1} << (kPlaceBits + kDirectionBits)) / length;
}

auto sphere_by_sphere(const VoxelTarget& target, const QuantisedRay& ray) {
  return [&spheres = *target.spheres, travel = travel_per_voxel(ray.direction)](VoxelWalk& walk, const ivec3& voxel,
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

bool occluded_voxel_spheres(const VoxelTarget& target, const QuantisedRay& ray) {
  return any_voxel(target, ray, sphere_by_sphere(target, ray));
}

}  // namespace scarp
