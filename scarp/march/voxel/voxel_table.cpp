// SPDX-License-Identifier: MIT
#include "scarp/march/voxel/voxel_table.h"

#include <array>

#include "scarp/march/find_entry.h"
#include "scarp/march/voxel/voxel_bricks.h"
#include "scarp/march/voxel/voxel_cubes.h"
#include "scarp/march/voxel/voxel_cubes_jump.h"
#include "scarp/march/voxel/voxel_exhaustive.h"
#include "scarp/march/voxel/voxel_octants.h"
#include "scarp/march/voxel/voxel_packet.h"
#include "scarp/march/voxel/voxel_planes.h"
#include "scarp/march/voxel/voxel_spheres.h"

namespace scarp {
namespace {

constexpr VoxelMarchEntry voxel_march(std::string_view name, VoxelAccelerator accelerator, VoxelMarch cpu,
                                      VoxelOcclusion occluded, VoxelPacketMarch packet, VoxelMarchTraced traced,
                                      std::string_view description) {
  return {{.name = name,
           .guarantee = Guarantee::exact,
           .simd = packet != nullptr,
           .gpu = cpu != march_voxel_exhaustive && cpu != march_voxel_cubes_jump,
           .description = description},
          accelerator,
          cpu,
          occluded,
          packet,
          traced};
}

bool occluded_voxel_exhaustive(const VoxelTarget& target, const QuantisedRay& ray) {
  return static_cast<bool>(march_voxel_exhaustive(target, ray));
}

constexpr std::array kVoxelTable = {
    voxel_march("voxel-exhaustive", VoxelAccelerator::none, march_voxel_exhaustive, occluded_voxel_exhaustive, nullptr,
                nullptr, "tests solid voxels one by one, in exact arithmetic; the reference for voxel marches; slow"),
    voxel_march("voxel-planes", VoxelAccelerator::none, march_voxel_planes, occluded_voxel_planes,
                march_packet_voxel_planes, traced_voxel_planes, "steps from voxel to voxel"),
    voxel_march("voxel-spheres", VoxelAccelerator::spheres, march_voxel_spheres, occluded_voxel_spheres,
                march_packet_voxel_spheres, traced_voxel_spheres, "skips the empty sphere around each voxel"),
    voxel_march("voxel-cubes", VoxelAccelerator::cubes, march_voxel_cubes, occluded_voxel_cubes,
                march_packet_voxel_cubes, traced_voxel_cubes, "skips the largest empty cube around each voxel"),
    voxel_march("voxel-cubes-jump", VoxelAccelerator::cubes, march_voxel_cubes_jump, occluded_voxel_cubes_jump,
                march_packet_voxel_cubes_jump, traced_voxel_cubes_jump,
                "travels the radius of the empty cube around each voxel, as published; baseline for voxel-cubes"),
    voxel_march("voxel-octants", VoxelAccelerator::octants, march_voxel_octants, occluded_voxel_octants,
                march_packet_voxel_octants, traced_voxel_octants,
                "skips the largest empty cube ahead of each voxel, one for each octant of directions"),
    voxel_march("voxel-bricks", VoxelAccelerator::bricks, march_voxel_bricks, occluded_voxel_bricks,
                march_packet_voxel_bricks, traced_voxel_bricks,
                "skips empty blocks of 2 to 16 voxels, found by bit masks; least memory"),
};

}  // namespace

std::span<const VoxelMarchEntry> voxel_marches() { return kVoxelTable; }
const VoxelMarchEntry& find_voxel_march(std::string_view name) { return find_entry(voxel_marches(), name); }

}  // namespace scarp
