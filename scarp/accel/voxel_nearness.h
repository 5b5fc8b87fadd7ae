// SPDX-License-Identifier: MIT
// How near the nearest solid voxel is, in the axis where it is farthest (Chebyshev's distance), in rows of bytes: what
// empty cubes and octant cubes are built from.
//
//   255 on solid voxels, one less for each step away, 0 for 255 steps and more: a step is a difference that ends at 0,
//   and 16 of them are two instructions
//
// One axis after the other: along x in strides of 1, 2, 4, ...; then each row takes what its neighbour in y has, and
// the neighbours in x of that one; then each slab likewise along z. That is exact: a shortest way goes along x first,
// then along x and y at once, then along all three. O(n), whatever the grid holds. Source: A. Rosenfeld, J. Pfaltz,
// "Distance functions on digital pictures", Pattern Recognition 1968 (the two passes of its chessboard distance).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scarp/field/voxel_grid.h"

namespace scarp {

class VoxelNearness {
 public:
  /// Which neighbours along an axis count.
  struct Sides {
    bool lower = true, upper = true;
  };

  /// Of a window of a grid; not spread yet.
  VoxelNearness(const VoxelGrid& grid, const VoxelBox& window);

  /// For each axis the sides on which what is near counts.
  void spread(const Sides& x, const Sides& y, const Sides& z);

  /// Of the voxels of a row of the window, y and z counted from its lowest ones.
  std::uint8_t* row(int y, int z) {
    return bytes_.data() + kMargin +
           stride_ * (static_cast<std::size_t>(y) + static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(z));
  }

 private:
  void along_x(const Sides& x);
  void along_y(const Sides& x, const Sides& y);
  void along_z(const Sides& x, const Sides& y, const Sides& z);

  static constexpr std::size_t kMargin = 8;  // bytes that are 0, before and after each row

  ivec3 size_;
  std::size_t used_;    // bytes of a row in whole blocks; those beyond its voxels mean nothing
  std::size_t stride_;  // of rows
  std::vector<std::uint8_t> bytes_;
};

}  // namespace scarp
