// SPDX-License-Identifier: MIT
// Chebyshev distance D from each voxel to the nearest solid voxel, 0 for solid voxels: the cube of radius D - 1 around
// the voxel is empty. Space outside the grid is empty; distances are capped at 255.
//
// Three builders with identical results:
//   rows          one axis after the other, 16 voxels at a time (voxel_nearness.h). O(n): the default, also used for
//                 edits
//   bit_parallel  dilates the solid voxels by one in all directions, 64 voxels at a time, and counts the steps for
//                 which each voxel stays outside. O(n D): fast if no voxel is far from solid voxels
//   summed_area   a summed-area table in 64 bits, then a binary search for the largest empty cube. O(n log n). Source:
//                 C. Leak, "Raymarching voxel rendering"; F. Crow, "Summed-area tables for texture mapping", SIGGRAPH
//                 1984
// Cost: one byte per voxel.
#pragma once

#include <cstddef>

#include "scarp/accel/voxel_bytes.h"

namespace scarp {

enum class CubeBuilder { rows, bit_parallel, summed_area };

/// Chebyshev distances of a voxel grid.
class EmptyCubes {
 public:
  static constexpr int kFarthest = 255;

  /// Throws Error for grids larger than kMaxAcceleratedSide.
  explicit EmptyCubes(const VoxelGrid& grid, CubeBuilder builder = CubeBuilder::rows);

  /// Updates the distances after an edit of the same grid that returned `changed`. Equal to a rebuild. Revisits the
  /// voxels that were at least as far from solid voxels as from the box (cube_edit.h).
  void update(const VoxelGrid& grid, const VoxelBox& changed);

  int distance(const ivec3& voxel) const { return distances_[voxel]; }
  const VoxelBytes& distances() const { return distances_; }
  std::size_t bytes() const { return sizeof(*this) + distances_.bytes(); }
  friend bool operator==(const EmptyCubes& a, const EmptyCubes& b) { return a.distances_ == b.distances_; }

 private:
  void rows(const VoxelGrid& grid);
  void bit_parallel(const VoxelGrid& grid);
  void summed_area(const VoxelGrid& grid);

  VoxelBytes distances_;
};

}  // namespace scarp
