// SPDX-License-Identifier: MIT
#include "scarp/accel/voxel_rows.h"

#include <fmt/format.h>

#include <algorithm>

#include "scarp/accel/voxel_bytes.h"
#include "scarp/base/error.h"

namespace scarp {

void require_accelerable(const ivec3& size, std::string_view what, int bytes_per_voxel) {
  if (std::max({size.x, size.y, size.z}) <= kMaxAcceleratedSide) return;
  throw Error(fmt::format(
      "{}: {} x {} x {} voxels would take {} bytes (limited to {} voxels per side; use voxel-bricks)", what, size.x,
      size.y, size.z, std::int64_t{bytes_per_voxel} * size.x * size.y * size.z, kMaxAcceleratedSide));
}

VoxelRows::VoxelRows(const VoxelGrid& grid)
    : size(grid.size()), words_per_row((static_cast<std::size_t>(size.x) + 63) / 64) {
  words.resize(words_per_row * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z));
  grid.for_each_solid_brick([&](const ivec3& brick, std::uint64_t mask) {
    const ivec3 rows = glm::min(size - 4 * brick, 4);
    const int shift = 4 * (brick.x % 16);
    for (int z = 0; z < rows.z; ++z) {
      for (int y = 0; y < rows.y; ++y)
        row(4 * brick.y + y, 4 * brick.z + z)[brick.x / 16] |= (mask >> (4 * y + 16 * z) & 15) << shift;
    }
  });
}

void VoxelRows::dilate() {
  const std::size_t slab = words_per_row * static_cast<std::size_t>(size.y), all = words.size();
  // Along x.
  for (std::size_t begin = 0; begin < all; begin += words_per_row) {
    std::uint64_t before = 0;
    for (std::size_t i = 0; i < words_per_row; ++i) {
      std::uint64_t& word = words[begin + i];
      const std::uint64_t now = word, after = i + 1 < words_per_row ? words[begin + i + 1] : 0;
      word = now | now << 1 | before >> 63 | now >> 1 | after << 63;
      before = now;
    }
    words[begin + words_per_row - 1] &= last_word_mask();
  }
  // Along y and then z: OR with the words of the previous and next row or slab.
  const auto spread = [&](std::size_t stride, std::size_t period) {
    scratch_ = words;
    for (std::size_t begin = 0; begin < all; begin += period) {
      for (std::size_t i = begin; i + stride < begin + period; ++i) words[i] |= scratch_[i + stride];
      for (std::size_t i = begin + stride; i < begin + period; ++i) words[i] |= scratch_[i - stride];
    }
  };
  spread(words_per_row, slab);
  spread(slab, all);
}

bool VoxelRows::full() const {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool last = (i + 1) % words_per_row == 0;
    if (words[i] != (last ? last_word_mask() : ~std::uint64_t{0})) return false;
  }
  return true;
}

}  // namespace scarp
