// SPDX-License-Identifier: MIT
#include "scarp/accel/voxel_nearness.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace scarp {
namespace {

// Four bytes, 255 for each set bit.
constexpr std::array<std::uint32_t, 16> make_bytes_of() {
  std::array<std::uint32_t, 16> bytes{};
  for (unsigned bits = 0; bits < 16; ++bits) {
    for (unsigned i = 0; i < 4; ++i) bytes[bits] |= (bits >> i & 1) * 255u << (8 * i);
  }
  return bytes;
}
constexpr std::array<std::uint32_t, 16> kBytesOf = make_bytes_of();

}  // namespace

VoxelNearness::VoxelNearness(const VoxelGrid& grid, const VoxelBox& window)
    : low_(window.low),
      size_(window.high - window.low),
      used_((static_cast<std::size_t>(size_.x) + kBlock - 1) / kBlock * kBlock),
      stride_(used_ + 2 * kMargin),
      bytes_(stride_ * static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(size_.z) + kBlock) {
  // Brick by brick; bits outside the window along x are cleared afterwards.
  const VoxelBox bricks = {window.low >> 2, (window.high + 3) >> 2}, inner = {(window.low + 3) >> 2, window.high >> 2};
  const std::size_t to_next_row = stride_, to_next_slab = stride_ * static_cast<std::size_t>(size_.y);
  for_each_voxel(bricks, [&](const ivec3& brick) {
    const std::uint64_t mask = grid.mask(brick);
    if (mask == 0) return;
    const ivec3 at = 4 * brick - window.low;
    // Most bricks are whole. Separated so that values which stores might alias are not reloaded.
    if (inner.contains(brick)) {
      std::uint8_t* to = row(at.y, at.z) + at.x;
      for (std::uint64_t bits = mask, left = 4; left > 0; --left, bits >>= 16, to += to_next_slab) {
        for (unsigned i = 0; i < 4; ++i) std::memcpy(to + i * to_next_row, &kBytesOf[bits >> (4 * i) & 15], 4);
      }
      return;
    }
    for (int z = std::max(0, -at.z); z < std::min(4, size_.z - at.z); ++z) {
      for (int y = std::max(0, -at.y); y < std::min(4, size_.y - at.y); ++y)
        std::memcpy(row(at.y + y, at.z + z) + at.x, &kBytesOf[mask >> (4 * y + 16 * z) & 15], 4);
    }
  });
  const int before = window.low.x - 4 * bricks.low.x, after = 4 * bricks.high.x - window.high.x;
  if (before == 0 && after == 0) return;
  for (int z = 0; z < size_.z; ++z) {
    for (int y = 0; y < size_.y; ++y) {
      for (int i = 1; i <= before; ++i) row(y, z)[-i] = 0;
      for (int i = 0; i < after; ++i) row(y, z)[size_.x + i] = 0;
    }
  }
}

}  // namespace scarp
