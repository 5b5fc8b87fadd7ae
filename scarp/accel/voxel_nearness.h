// SPDX-License-Identifier: MIT
// How near the nearest solid voxel is, in the axis where it is farthest (Chebyshev's distance), in rows of bytes: what
// empty cubes are built from, and from its first part, along x alone, empty spheres and octant cubes.
//
//   255 on solid voxels, one less for each step away, 0 for 255 steps and more: a step is a difference that ends at 0,
//   and 16 or 32 of them are one instruction
//
// One axis after the other: along x in strides of 1, 2, 4, ...; then each row takes what its neighbour in y has, and
// the neighbours in x of that one; then each slab likewise along z. That is exact: a shortest way goes along x first,
// then along x and y at once, then along all three. O(n), whatever the grid holds. Source: A. Rosenfeld, J. Pfaltz,
// "Distance functions on digital pictures", Pattern Recognition 1968 (the two passes of its chessboard distance).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scarp/accel/voxel_bytes.h"

namespace scarp {

/// Rows of bytes, each between some that are 0.
struct NearRows {
  ivec3 size;
  std::size_t used;    ///< bytes of a row in whole blocks; those beyond its voxels mean nothing
  std::size_t stride;  ///< of rows
  std::uint8_t* first;

  std::uint8_t* row(int y, int z) const {
    return first +
           stride * (static_cast<std::size_t>(y) + static_cast<std::size_t>(size.y) * static_cast<std::size_t>(z));
  }
};

class VoxelNearness {
 public:
  static constexpr std::size_t kBlock = 32;  // bytes

  /// Which neighbours along an axis count.
  struct Sides {
    bool lower = true, upper = true;
  };

  /// Of a window of a grid; not spread yet.
  VoxelNearness(const VoxelGrid& grid, const VoxelBox& window);

  /// Along x alone: how near the nearest one in the same row is.
  void along_x(const Sides& sides);
  /// Along all axes.
  void spread();

  /// `farthest` less how near voxels are, for those of a part of the window; modulo 256.
  void write_far(const VoxelBox& part, std::uint8_t farthest, VoxelBytes& to) const;

  /// Of the voxels of a row of the window, y and z counted from its lowest ones. It may be read on, not believed, for
  /// kBlock bytes beyond its voxels; where only upper sides count, those up to a multiple of kBlock are 0.
  std::uint8_t* row(int y, int z) { return rows().row(y, z); }
  const std::uint8_t* row(int y, int z) const { return const_cast<VoxelNearness*>(this)->row(y, z); }
  std::ptrdiff_t slabs_apart() const { return static_cast<std::ptrdiff_t>(stride_) * size_.y; }

 private:
  NearRows rows() { return {size_, used_, stride_, bytes_.data() + kMargin}; }

  static constexpr std::size_t kMargin = 8;  // bytes that are 0, before and after each row

  ivec3 low_, size_;  // of the window
  std::size_t used_, stride_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace scarp
