// SPDX-License-Identifier: MIT
// Targets and signatures of voxel marches.
#pragma once

#include <functional>

#include "scarp/field/voxel_grid.h"
#include "scarp/march/voxel/voxel_ray.h"

namespace scarp {

class EmptySpheres;
class EmptyCubes;
class OctantCubes;
class BrickMasks;

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

/// Returns whether a voxel counts; a ray goes through one that does not as if it were empty.
using VoxelFilter = std::function<bool(const VoxelHit&)>;

/// Returns the first solid voxel of the box on a ray quantised for it. Overwrites `stats` unless null.
using VoxelMarch = VoxelHit (*)(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats);

/// Returns whether there is one within the ray's range.
using VoxelOcclusion = bool (*)(const VoxelTarget& target, const QuantisedRay& ray);

}  // namespace scarp
