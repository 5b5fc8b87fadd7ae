// SPDX-License-Identifier: MIT
// Euclidean distance from the box of each empty voxel to the box of the nearest solid voxel, rounded down: the length
// that a ray may travel from any point of the voxel without a hit. Space outside the grid is empty; distances are
// capped at 254.
//
//   two boxes |delta| voxels apart along each axis are sqrt(sum of max(0, |delta| - 1)^2) apart, which is the distance
//   from the voxel to the nearest voxel of the solid set, dilated by one in all directions
//
// Built one axis after the other, exact in integers (sphere_rows.h). Cost: one byte per voxel.
#pragma once

#include <cstddef>

#include "scarp/accel/voxel_bytes.h"

namespace scarp {

struct SphereRows;

/// Euclidean distances of a voxel grid.
class EmptySpheres {
 public:
  static constexpr int kFarthest = 254;
  static constexpr int kSolid = 255;

  /// Throws Error for grids larger than kMaxAcceleratedSide.
  explicit EmptySpheres(const VoxelGrid& grid);

  /// Updates the distances after an edit of the same grid that returned `changed`. Equal to a rebuild. Revisits the
  /// voxels that were at least as far from solid voxels as from the box (sphere_rows.h).
  void update(const VoxelGrid& grid, const VoxelBox& changed);

  /// Returns kSolid for solid voxels.
  int distance(const ivec3& voxel) const { return distances_[voxel]; }
  const VoxelBytes& distances() const { return distances_; }
  std::size_t bytes() const { return sizeof(*this) + distances_.bytes(); }
  friend bool operator==(const EmptySpheres& a, const EmptySpheres& b) { return a.distances_ == b.distances_; }

 private:
  int build(const VoxelGrid& grid, const SphereRows& rows);

  VoxelBytes distances_;
};

}  // namespace scarp
