// SPDX-License-Identifier: MIT
// What voxel marches take, and their signatures.
#pragma once

#include "scarp/field/voxel_grid.h"
#include "scarp/march/voxel/voxel_ray.h"

namespace scarp {

class EmptySpheres;
class EmptyCubes;
class OctantCubes;
class BrickMasks;

/// What is marched. Accelerators may be null for marches that do not need them.
struct VoxelTarget {
  const VoxelGrid* grid = nullptr;
  /// The part of the grid that rays are followed in: grid->box(), or, with nothing lost, grid->bounds().
  VoxelBox box;
  const EmptySpheres* spheres = nullptr;
  const EmptyCubes* cubes = nullptr;
  const OctantCubes* octants = nullptr;
  const BrickMasks* bricks = nullptr;
};

/// The first solid voxel of the box on a ray that was quantised for it. `stats`, when given, is overwritten.
using VoxelMarch = VoxelHit (*)(const VoxelTarget& target, const QuantisedRay& ray, MarchStats* stats);

/// Whether there is one within the ray's range.
using VoxelOcclusion = bool (*)(const VoxelTarget& target, const QuantisedRay& ray);

}  // namespace scarp
