// SPDX-License-Identifier: MIT
// Targets and signatures of voxel marches, and how voxels are rounded.
#pragma once

#include <cstdint>
#include <functional>

#include "scarp/field/voxel_grid.h"
#include "scarp/march/voxel/voxel_ray.h"

namespace scarp {

class EmptySpheres;
class EmptyCubes;
class OctantCubes;
class BrickMasks;
struct MarchTrace;   // base/march_trace.h
struct VoxelPacket;  // voxel_packet.h
struct VoxelStand;

/// A grid with its accelerators. Accelerators may be null for marches that do not need them.
struct VoxelTarget {
  const VoxelGrid* grid = nullptr;
  /// Part of the grid in which rays are followed: grid->box(), or, equivalently, grid->bounds().
  VoxelBox box;
  const EmptySpheres* spheres = nullptr;
  const EmptyCubes* cubes = nullptr;
  const OctantCubes* octants = nullptr;
  const BrickMasks* bricks = nullptr;
};

/// Settings of rounded voxels (rounded_voxels.h).
struct VoxelRounding {
  double radius = 0;  ///< of edges and corners, in voxel sides: 0 (cubes) to 0.5 (a single voxel is a ball)
  bool each = false;  ///< rounds every voxel separately

  explicit operator bool() const { return radius > 0; }

  bool operator==(const VoxelRounding&) const = default;
};

/// Throws Error naming the setting out of range.
void validate(const VoxelRounding& rounding);

/// Returns whether a voxel counts; a ray goes through one that does not as if it were empty.
using VoxelFilter = std::function<bool(const VoxelHit&)>;

/// Returns the first solid voxel of the box on a ray quantised for it. Overwrites `stats` unless null.
using VoxelMarch = VoxelHit (*)(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats);

/// Returns whether there is one within the ray's range.
using VoxelOcclusion = bool (*)(const VoxelTarget& target, const QuantisedRay& ray);

/// Marches the rays whose bits are set, as free rays, within [t_min, t_max]. Returns those that entered the box.
using VoxelPacketMarch = std::uint64_t (*)(const VoxelTarget& target, const VoxelStand& stand, VoxelPacket& packet,
                                           std::uint64_t rays);

}  // namespace scarp
