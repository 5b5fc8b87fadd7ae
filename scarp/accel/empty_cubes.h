// SPDX-License-Identifier: MIT
// For each voxel the distance D to the nearest solid one in the axis where it is farther (Chebyshev's), 0 for solid
// voxels: the cube of radius D - 1 around the voxel is empty. Outside of the grid all is empty; 255 stands for 255 and
// more.
//
// Three builders with one result:
//   rows          one axis after the other, 16 voxels at once (voxel_nearness.h). O(n): the one that is used, and for
//                 edits
//   bit_parallel  the solid voxels grow by one in all directions, 64 voxels at once, and every voxel counts how long it
//                 stays outside. O(n D): fast where nothing is far from solid voxels
//   summed_area   sums of all voxels before each (a summed-area table, in 64 bits), then a binary search for the
//                 largest empty cube. O(n log n). Source: C. Leak, "Raymarching voxel rendering"; F. Crow, "Summed-area
//                 tables for texture mapping", SIGGRAPH 1984
// Cost: a byte per voxel.
#pragma once

#include <cstddef>

#include "scarp/accel/voxel_bytes.h"

namespace scarp {

enum class CubeBuilder { rows, bit_parallel, summed_area };

class EmptyCubes {
 public:
  static constexpr int kFarthest = 255;

  /// Throws Error for grids above kMaxAcceleratedSide.
  explicit EmptyCubes(const VoxelGrid& grid, CubeBuilder builder = CubeBuilder::rows);

  /// After an edit of the same grid, with the box that it returned: as if built anew. Looks again at voxels as far from
  /// the box as the largest distance before the edit.
  void update(const VoxelGrid& grid, const VoxelBox& changed);

  int distance(const ivec3& voxel) const { return distances_[voxel]; }
  const VoxelBytes& distances() const { return distances_; }
  std::size_t bytes() const { return sizeof(*this) + distances_.bytes(); }
  friend bool operator==(const EmptyCubes& a, const EmptyCubes& b) { return a.distances_ == b.distances_; }

 private:
  void rows(const VoxelGrid& grid, const VoxelBox& region);
  void bit_parallel(const VoxelGrid& grid);
  void summed_area(const VoxelGrid& grid);

  VoxelBytes distances_;
};

}  // namespace scarp
