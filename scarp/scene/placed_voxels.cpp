// SPDX-License-Identifier: MIT
#include "scarp/scene/placed_voxels.h"

#include <algorithm>

namespace scarp {
namespace {

constexpr std::int64_t kMostOctants = std::int64_t{1} << 20;  // voxels: 8 MiB, built in a few milliseconds
constexpr int kLongestOctants = 512;                          // voxels per side

}  // namespace

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
