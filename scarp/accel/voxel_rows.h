// SPDX-License-Identifier: MIT
// Voxels of a grid as rows of bits along x, 64 per word.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scarp/field/voxel_grid.h"

namespace scarp {

struct VoxelRows {
  ivec3 size;
  std::size_t words_per_row;
  std::vector<std::uint64_t> words;  // bit x % 64 of word x / 64 of row (y, z), y first; bits beyond the size are 0

  explicit VoxelRows(const VoxelGrid& grid);

  const std::uint64_t* row(int y, int z) const {
    return words.data() + words_per_row * (static_cast<std::size_t>(y) +
                                           static_cast<std::size_t>(size.y) * static_cast<std::size_t>(z));
  }
  std::uint64_t* row(int y, int z) {
    return const_cast<std::uint64_t*>(static_cast<const VoxelRows&>(*this).row(y, z));
  }
  bool test(const ivec3& voxel) const { return row(voxel.y, voxel.z)[voxel.x / 64] >> (voxel.x % 64) & 1; }

  /// Sets all voxels within Chebyshev distance 1 of a set voxel.
  void dilate();
  /// Returns whether all voxels of the grid are set.
  bool full() const;

 private:
  std::uint64_t last_word_mask() const {
    return ~std::uint64_t{0} >> (64 * words_per_row - static_cast<std::size_t>(size.x));
  }

  std::vector<std::uint64_t> scratch_;
};

}  // namespace scarp
