// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_octants.h"

#include "scarp/accel/octant_cubes.h"
#include "scarp/march/voxel/voxel_loop.h"

namespace scarp {
namespace {

auto octant_by_octant(const VoxelTarget& target, const QuantisedRay& ray) {
  const std::array<int, 3>& step = ray.direction.step;
  const ivec3 back(step[0] < 0, step[1] < 0, step[2] < 0);
  // A cube of side f is v .. v + f if the ray travels in the positive direction, otherwise v - f + 1 .. v + 1.
  return [&octants = *target.octants, back, octant = back.x | back.y << 1 | back.z << 2](auto& walk, const ivec3& voxel,
                                                                                         bool& solid) {
    const int side = octants.side(voxel, octant);
    solid = side == 0;
    if (solid) return false;
    if (side == 1) return walk.step();
    const ivec3 low = voxel - (side - 1) * back;
    return walk.leave({low, low + side});
  };
}

}  // namespace

VoxelHit march_voxel_octants(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats) {
  return first_voxel(target, ray, stats, octant_by_octant(target, ray));
}

VoxelHit traced_voxel_octants(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats,
                              MarchTrace& trace) {
  return traced_voxel(target, ray, stats, trace, octant_by_octant(target, ray));
}

bool occluded_voxel_octants(const VoxelTarget& target, const QuantisedRay& ray) {
  return any_voxel(target, ray, octant_by_octant(target, ray));
}

}  // namespace scarp
