// SPDX-License-Identifier: MIT
// Nearness to the nearest solid voxel by Chebyshev distance, in rows of bytes. Empty cubes are built from it; empty
// spheres and octant cubes use its first step, along x alone.
//
//   255 on solid voxels, one less per step away, 0 from 255 steps on: a step is a saturating subtraction,
//   and 16 or 32 of them are one instruction
//
// One axis after the other: along x in strides of 1, 2, 4, ...; then each row takes the values of its neighbour in y
// and of that row's neighbours in x; then each slab likewise along z. This is exact: some shortest path first moves
// along x, then along x and y, then along all three axes. O(n) for any content of the grid. Source: A. Rosenfeld, J.
// Pfaltz, "Distance functions on digital pictures", Pattern Recognition 1968 (the two passes of its chessboard
// distance).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scarp/accel/voxel_bytes.h"

namespace scarp {

/// Rows of bytes, separated by zeros.
struct NearRows {
  ivec3 size;
  std::size_t used;    ///< bytes of a row, rounded up to whole blocks; those beyond its voxels are undefined
  std::size_t stride;  ///< bytes from row to row
  std::uint8_t* first;

  std::uint8_t* row(int y, int z) const {
    return first +
           stride * (static_cast<std::size_t>(y) + static_cast<std::size_t>(size.y) * static_cast<std::size_t>(z));
  }
};

class VoxelNearness {
 public:
  static constexpr std::size_t kBlock = 32;  // bytes

  /// Which neighbours along an axis are used.
  struct Sides {
    bool lower = true, upper = true;
  };

  /// Covers a window of a grid; values are not spread yet.
  VoxelNearness(const VoxelGrid& grid, const VoxelBox& window);

  /// Spreads along x alone: nearness within each row.
  void along_x(const Sides& sides);
  /// Spreads along all axes.
  void spread();

  /// Writes `farthest` minus nearness, modulo 256, for the voxels of a part of the window.
  void write_far(const VoxelBox& part, std::uint8_t farthest, VoxelBytes& to) const;

  /// Returns a row of the window; y and z are relative to the window's lowest ones. kBlock bytes beyond its voxels are
  /// readable but undefined; if only upper neighbours are used, those up to a multiple of kBlock are 0.
  std::uint8_t* row(int y, int z) { return rows().row(y, z); }
  const std::uint8_t* row(int y, int z) const { return const_cast<VoxelNearness*>(this)->row(y, z); }
  std::ptrdiff_t slabs_apart() const { return static_cast<std::ptrdiff_t>(stride_) * size_.y; }

 private:
  NearRows rows() { return {size_, used_, stride_, bytes_.data() + kMargin}; }

  static constexpr std::size_t kMargin = 8;  // zero bytes before and after each row

  ivec3 low_, size_;  // window
  std::size_t used_, stride_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace scarp
