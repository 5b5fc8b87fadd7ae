// SPDX-License-Identifier: MIT
// For each empty voxel the distance from its box to the box of the nearest solid voxel, rounded down: from any of its
// points a ray may travel so far and meets nothing. Outside of the grid all is empty; 254 stands for 254 and more.
//
//   the distance of two boxes, |delta| voxels apart along an axis, is sqrt(sum of max(0, |delta| - 1)^2): that of the
//   voxel to the nearest one of the solid voxels grown by one in all directions
//
// Built one axis after the other, exact in whole numbers (sphere_rows.h). Cost: a byte per voxel.
#pragma once

#include <cstddef>

#include "scarp/accel/voxel_bytes.h"

namespace scarp {

class EmptySpheres {
 public:
  static constexpr int kFarthest = 254;
  static constexpr int kSolid = 255;

  /// Throws Error for grids above kMaxAcceleratedSide.
  explicit EmptySpheres(const VoxelGrid& grid);

  /// After an edit of the same grid, with the box that it returned: as if built anew. Looks again at voxels as far from
  /// the box as the largest distance before the edit.
  void update(const VoxelGrid& grid, const VoxelBox& changed);

  /// kSolid for solid voxels.
  int distance(const ivec3& voxel) const { return distances_[voxel]; }
  std::size_t bytes() const { return sizeof(*this) + distances_.bytes(); }
  friend bool operator==(const EmptySpheres& a, const EmptySpheres& b) { return a.distances_ == b.distances_; }

 private:
  void build(const VoxelGrid& grid, const VoxelBox& region);

  VoxelBytes distances_;
  int largest_ = 0;  // no distance is larger
};

}  // namespace scarp
