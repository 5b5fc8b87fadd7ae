// SPDX-License-Identifier: MIT
// For each voxel and each octant of directions the side of the largest empty cube that has the voxel in the corner
// which rays of that octant come from: 0 for solid voxels, 255 for 255 and more. Outside of the grid all is empty.
//
//   side = 1 + the least side of the 7 neighbours ahead, built in rows (octant_rows.h)
//
// Octant: bit i is set where a ray goes down axis i. Source: L. Deakin, M. Knackstedt, "Accelerated volume rendering
// with Chebyshev distance maps", SIGGRAPH Asia 2019. O(n). Cost: 8 bytes per voxel.
#pragma once

#include <cstddef>

#include "scarp/accel/voxel_bytes.h"

namespace scarp {

class OctantCubes {
 public:
  static constexpr int kLargest = 255;

  /// Throws Error for grids above kMaxAcceleratedSide.
  explicit OctantCubes(const VoxelGrid& grid);

  /// After an edit of the same grid, with the box that it returned: as if built anew. Looks again at the voxels behind
  /// the box, as far away as the largest cube before the edit.
  void update(const VoxelGrid& grid, const VoxelBox& changed);

  int side(const ivec3& voxel, int octant) const { return sides_[in_plane(voxel, octant)]; }
  /// One grid above the other, by octant: what rays that go the same way ask stands together.
  const VoxelBytes& sides() const { return sides_; }
  std::size_t bytes() const { return sizeof(*this) + sides_.bytes(); }
  friend bool operator==(const OctantCubes& a, const OctantCubes& b) { return a.sides_ == b.sides_; }

 private:
  ivec3 in_plane(const ivec3& voxel, int octant) const {
    return {voxel.x, voxel.y, voxel.z + octant * (sides_.size().z / 8)};
  }

  VoxelBytes sides_;
  int largest_ = 0;  // no side is larger
};

}  // namespace scarp
