// SPDX-License-Identifier: MIT
// Tests spheres, capsules and boxes against the solid voxels of a grid: the first contact of a moving one, overlap, and
// closest points. Works in the grid's space, where voxels have side 1. Voxels are cubes, never rounded. Exact to
// rounding (march/sweep.h): the faces between solid and empty voxels are swept as two triangles each.
//
// Cost: blocks of 2^n voxels along the path, nearest first; empty blocks of 4 x 4 x 4 voxels and larger are skipped.
#pragma once

#include <limits>
#include <optional>

#include "scarp/field/voxel_grid.h"
#include "scarp/march/sweep.h"
#include "scarp/march/turned_box.h"

namespace scarp {

/// `normal` is zero if an end of the centre line starts in the voxel.
struct VoxelContact : Contact {
  ivec3 voxel{-1};
};

/// Returns the first contact of a capsule that moves along `motion`. Throws Error for a capsule or a motion that
/// validate() rejects.
std::optional<VoxelContact> sweep(const VoxelGrid& grid, const Capsule& capsule, const dvec3& motion);

struct VoxelPoint {
  dvec3 point{0.0};
  dvec3 normal{0.0};    ///< unit, from the point towards p; zero if p is in the voxel
  double distance = 0;  ///< in voxel sides
  ivec3 voxel{-1};
};

/// Returns the point of the solid voxels that is closest to p, within `max_distance`; p itself if it is in one.
std::optional<VoxelPoint> closest_point(const VoxelGrid& grid, const dvec3& p,
                                        double max_distance = std::numeric_limits<double>::infinity());

/// Returns whether a solid voxel and the box, both closed, have a point in common.
bool overlaps(const VoxelGrid& grid, const TurnedBox& box);

}  // namespace scarp
