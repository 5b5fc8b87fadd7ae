// SPDX-License-Identifier: MIT
// Batches of rays against one voxel grid, in vector lanes: voxel-planes, -spheres, -cubes, -cubes-jump,
// -octants and -bricks.
//
//   lanes   r0 r1 r2 ... r7     each is clipped to the box and quantised there, as in voxel_ray.h, then advances from
//           |  |  |      |      event to event, as in voxel_walk.h: integers of 32 bits, products of 64 bits
//   rounds  every vector takes one step in turn: while one waits for memory, others compute. If a round leaves enough
//           lanes empty, the others are compacted
//
// Answers equal those of the scalar marches bit for bit, and so do the steps: the same roundings in double, the same
// integers afterwards. Source: T. Aila, S. Laine, "Understanding the efficiency of ray traversal on GPUs", HPG 2009,
// for rays in lanes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <span>

#include "scarp/march/voxel/voxel_target.h"

namespace scarp {

/// Up to kRays rays and their results. Arrays by axis and ray.
struct VoxelPacket {
  static constexpr std::size_t kRays = 64;
  template <class Number>
  using Lanes = Number[kRays + 8];  // vectors write beyond the last one

  // Set by load_voxel_packet(), in world space.
  std::size_t count = 0;
  alignas(64) Lanes<double> origin[3], direction[3];
  alignas(64) Lanes<double> t_min, t_max;  ///< t_max: below t_min for finished rays

  // Set by aim_voxel_packet(): VoxelDirection of each ray in the space of a grid.
  alignas(64) Lanes<double> given[3], inverse[3], t_per_s;
  alignas(64) Lanes<std::int64_t> exact;  ///< QuantisedDirection::exact: -1 or 0
  bool slow = false;                      ///< whether any ray is level or slow along an axis
  alignas(64) Lanes<std::int64_t> speed[3],
      down[3];  ///< down: -1 if a ray's step along the axis is -1, otherwise 0

  // Set by a march: hits, in no particular order.
  std::size_t hits = 0;
  alignas(64) Lanes<std::int64_t> ray, face;  ///< ray: its index
  alignas(64) Lanes<std::int64_t> voxel[3];
  alignas(64) Lanes<double> t;

  alignas(64) Lanes<double> t_in;  ///< internal to marches: where rays enter the box
  std::uint64_t steps = 0;         ///< incremented by marches
};

/// Placement of a grid: p_world = world_from_grid * p_grid + origin.
struct VoxelStand {
  dmat3 grid_from_world{1.0};
  dvec3 origin{0.0};
  VoxelTies ties{};   ///< of the matrix
  double room = 0.0;  ///< VoxelRay::room
};

/// Loads up to kRays world rays; ignores surfaces that they start on. Returns false if a direction does not have a
/// usual length (usual_ray.h); marches report a miss for directions that are too short.
[[nodiscard]] bool load_voxel_packet(VoxelPacket& packet, std::span<const Ray> rays);

/// Call before marches, and again before rays traverse grids with another orientation.
void aim_voxel_packet(VoxelPacket& packet, const dmat3& grid_from_world, VoxelTies ties = {});

/// The marches of packets (VoxelPacketMarch).
std::uint64_t march_packet_voxel_planes(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                        std::uint64_t rays);
std::uint64_t march_packet_voxel_spheres(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                         std::uint64_t rays);
std::uint64_t march_packet_voxel_cubes(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                       std::uint64_t rays);
std::uint64_t march_packet_voxel_cubes_jump(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                            std::uint64_t rays);
std::uint64_t march_packet_voxel_octants(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                         std::uint64_t rays);
std::uint64_t march_packet_voxel_bricks(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                        std::uint64_t rays);

}  // namespace scarp
