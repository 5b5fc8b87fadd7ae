// SPDX-License-Identifier: MIT
#include "scarp/scene/voxel/placed_voxels.h"

#include <algorithm>

namespace scarp {
namespace {

constexpr std::int64_t kMostOctants = std::int64_t{1} << 20;  // voxels: 8 MiB, built in a few milliseconds
constexpr int kLongestOctants = 512;                          // voxels per side

}  // namespace

WorldBox world_box(const VoxelPlace& place, const VoxelBox& box) {
  WorldBox world;
  for (int corner = 0; corner < 8; ++corner) {
    const ivec3 at(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                   corner & 4 ? box.high.z : box.low.z);
    const dvec3 p = place.world_from_grid * dvec3(at) + place.origin;
    world = around(world, {p, p});
  }
  return world;
}

WorldBox world_box(const PlacedVoxels& voxels) {
  WorldBox world;
  for (const VoxelPlace& place : voxels.places) {
    const VoxelBox& solid = voxels.models[place.model]->grid().bounds();
    if (!solid.empty()) world = around(world, world_box(place, solid));
  }
  return world;
}

const VoxelMarchEntry& file_voxel_march(std::string_view name, std::span<const ivec3> sizes) {
  if (!name.empty()) return find_voxel_march(name);
  std::int64_t voxels = 0;
  int longest = 0;
  for (const ivec3& size : sizes) {
    voxels += std::int64_t{size.x} * size.y * size.z;
    longest = std::max({longest, size.x, size.y, size.z});
  }
  return find_voxel_march(voxels <= kMostOctants && longest <= kLongestOctants ? "voxel-octants" : "voxel-bricks");
}

}  // namespace scarp
