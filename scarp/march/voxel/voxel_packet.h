// SPDX-License-Identifier: MIT
// Many rays at one voxel grid, side by side in the lanes of vectors: voxel-planes, -cubes, -octants and -bricks.
//
//   lanes   r0 r1 r2 ... r7     each is clipped to the box and quantised there, as voxel_ray.h has it, then goes from
//           |  |  |      |      event to event, as voxel_walk.h has it: whole numbers of 32 bits, products of 64
//   rounds  every vector takes one step, then the next one: while one waits for memory, others compute. Where a round
//           leaves enough lanes empty, the others move together
//
// The answers are those of the scalar marches, bit for bit, and so are the steps: the same roundings in double, the
// same whole numbers afterwards. Source: T. Aila, S. Laine, "Understanding the efficiency of ray traversal on GPUs",
// HPG 2009, for rays in lanes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <span>

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

/// Up to kRays rays, and what has been found out about them. Arrays by axis and ray.
struct VoxelPacket {
  static constexpr std::size_t kRays = 64;
  template <class Number>
  using Lanes = Number[kRays + 8];  // vectors write beyond the last one

  // Set by load_voxel_packet(), in world space.
  std::size_t count = 0;
  alignas(64) Lanes<double> origin[3], direction[3];
  alignas(64) Lanes<double> t_min, t_max;  ///< t_max: below t_min for rays that are done

  // Set by aim_voxel_packet(): VoxelDirection of each ray in the space of a grid.
  alignas(64) Lanes<double> given[3], inverse[3], t_per_s;
  alignas(64) Lanes<std::int64_t> speed[3], down[3];  ///< down: -1 where a ray goes down the axis, else 0

  // Set by a march: hits, in no particular order.
  std::size_t hits = 0;
  alignas(64) Lanes<std::int64_t> ray, face;  ///< ray: its index
  alignas(64) Lanes<std::int64_t> voxel[3];
  alignas(64) Lanes<double> t;

  alignas(64) Lanes<double> t_in;  ///< for the marches alone: where rays come into the box
  std::uint64_t steps = 0;         ///< added to by marches
};

/// Where a grid stands: p_world = world_from_grid * p_grid + origin.
struct VoxelStand {
  glm::dmat3 grid_from_world{1.0};
  dvec3 origin{0.0};
};

/// Up to kRays world rays; what they know of a surface that they begin on is left out. False: a direction is not of
/// usual length (usual_ray.h); of those that are too short marches tell that they meet nothing.
[[nodiscard]] bool load_voxel_packet(VoxelPacket& packet, std::span<const Ray> rays);

/// To be called before marches, and again when rays are to go through grids that are turned otherwise.
void aim_voxel_packet(VoxelPacket& packet, const glm::dmat3& grid_from_world);

/// The rays whose bits are set, as free rays, within [t_min, t_max]. Returns which of them came into the box.
using VoxelPacketMarch = std::uint64_t (*)(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                           std::uint64_t rays);

std::uint64_t march_packet_voxel_planes(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                        std::uint64_t rays);
std::uint64_t march_packet_voxel_cubes(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                       std::uint64_t rays);
std::uint64_t march_packet_voxel_octants(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                         std::uint64_t rays);
std::uint64_t march_packet_voxel_bricks(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                        std::uint64_t rays);

}  // namespace scarp
