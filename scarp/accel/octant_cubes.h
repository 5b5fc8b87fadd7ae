// SPDX-License-Identifier: MIT
// For each voxel and direction octant, the side of the largest empty cube with the voxel in the corner where rays of
// that octant enter: 0 for solid voxels, capped at 255. Space outside the grid is empty.
//
//   side = 1 + the least side of the 7 neighbours ahead, built in rows (octant_rows.h)
//
// Octant: bit i is set if rays travel in the negative direction of axis i. Source: L. Deakin, M. Knackstedt,
// "Accelerated volume rendering with Chebyshev distance maps", SIGGRAPH Asia 2019. O(n). Cost: 8 bytes per voxel.
#pragma once

#include <cstddef>

#include "scarp/accel/voxel_bytes.h"

namespace scarp {

/// Empty cubes ahead of each voxel, per direction octant.
class OctantCubes {
 public:
  static constexpr int kLargest = 255;

  /// Throws Error for grids larger than kMaxAcceleratedSide.
  explicit OctantCubes(const VoxelGrid& grid);

  /// Updates the sides after an edit of the same grid that returned `changed`. Equal to a rebuild. Revisits only
  /// voxels whose sides change (octant_edit.h); octants in parallel.
  void update(const VoxelGrid& grid, const VoxelBox& changed);

  int side(const ivec3& voxel, int octant) const { return sides_[in_plane(voxel, octant)]; }
  /// Eight grids stacked along z, one per octant, so that rays in similar directions read nearby memory.
  const VoxelBytes& sides() const { return sides_; }
  std::size_t bytes() const { return sizeof(*this) + sides_.bytes(); }
  friend bool operator==(const OctantCubes& a, const OctantCubes& b) { return a.sides_ == b.sides_; }

 private:
  ivec3 in_plane(const ivec3& voxel, int octant) const {
    return {voxel.x, voxel.y, voxel.z + octant * (sides_.size().z / 8)};
  }

  VoxelBytes sides_;
};

}  // namespace scarp
