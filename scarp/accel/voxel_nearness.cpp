// SPDX-License-Identifier: MIT
#include "scarp/accel/voxel_nearness.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace scarp {
namespace {

constexpr std::size_t kBlock = 16;   // bytes at once
constexpr std::size_t kFarthest = 255;  // steps that count; also the bytes before and after a row in a margin

// Four bytes, 255 where the bit is set.
constexpr std::array<std::uint32_t, 16> make_bytes_of() {
  std::array<std::uint32_t, 16> bytes{};
  for (unsigned bits = 0; bits < 16; ++bits) {
    for (unsigned i = 0; i < 4; ++i) bytes[bits] |= (bits >> i & 1) * 255u << (8 * i);
  }
  return bytes;
}
constexpr std::array<std::uint32_t, 16> kBytesOf = make_bytes_of();

// 16 numbers in one register: the vectors of GCC and clang, whose operators work number by number.
using Bytes = std::uint8_t __attribute__((vector_size(kBlock)));

Bytes greater(const Bytes& a, const Bytes& b) { return a > b ? a : b; }

// to = max(to, from - steps), block by block.
void take(std::uint8_t* to, const std::uint8_t* from, std::size_t count, std::uint8_t steps) {
  const Bytes step = Bytes{} + steps;
  for (std::size_t i = 0; i < count; i += kBlock) {
    Bytes here, there;
    std::memcpy(&here, to + i, kBlock);
    std::memcpy(&there, from + i, kBlock);
    here = greater(here, greater(there, step) - step);
    std::memcpy(to + i, &here, kBlock);
  }
}

}  // namespace

VoxelNearness::VoxelNearness(const VoxelGrid& grid, const VoxelBox& window)
    : size_(window.high - window.low),
      stride_((static_cast<std::size_t>(size_.x) + kBlock - 1) / kBlock * kBlock),
      bytes_(stride_ * static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(size_.z)),
      margin_(stride_ + 2 * kFarthest + 2),
      next_(margin_.size()) {
  const int first = window.low.x >> 2, last = (window.high.x - 1) >> 2, shift = window.low.x - 4 * first;
  std::vector<std::uint8_t> bricks(4 * static_cast<std::size_t>(last - first + 1));
  for (int z = 0; z < size_.z; ++z) {
    for (int y = 0; y < size_.y; ++y) {
      const int gy = window.low.y + y, gz = window.low.z + z, bit = 4 * (gy & 3) + 16 * (gz & 3);
      const std::uint64_t* mask = grid.masks().data() + grid.brick_index({first, gy >> 2, gz >> 2});
      for (std::size_t i = 0; i < bricks.size(); i += 4)
        std::memcpy(bricks.data() + i, &kBytesOf[*mask++ >> bit & 15], 4);
      std::memcpy(row(y, z), bricks.data() + shift, static_cast<std::size_t>(size_.x));
    }
  }
}

void VoxelNearness::spread(const Sides& x, const Sides& y, const Sides& z) {
  along_x(x);
  along_y(x, y);
  along_z(x, y, z);
}

void VoxelNearness::along_x(const Sides& x) {
  const std::size_t reach = std::min<std::size_t>(static_cast<std::size_t>(size_.x) - 1, kFarthest - 1);
  std::uint8_t *here = margin_.data() + kFarthest, *next = next_.data() + kFarthest;
  for (int z = 0; z < size_.z; ++z) {
    for (int y = 0; y < size_.y; ++y) {
      std::uint8_t* const to = row(y, z);
      if (std::all_of(to, to + stride_, [](std::uint8_t byte) { return byte == 0; })) continue;
      std::memcpy(here, to, stride_);
      // What 1, 2, ... steps bring is nearer by 2 * steps - 1 afterwards.
      for (std::size_t steps = 1; steps <= reach; steps *= 2) {
        std::memcpy(next, here, stride_);
        if (x.lower) take(next, here - steps, stride_, static_cast<std::uint8_t>(steps));
        if (x.upper) take(next, here + steps, stride_, static_cast<std::uint8_t>(steps));
        std::swap(here, next);
      }
      std::memcpy(to, here, stride_);
    }
  }
  std::fill(margin_.begin(), margin_.end(), 0);
  std::fill(next_.begin(), next_.end(), 0);
}

void VoxelNearness::widen(const std::uint8_t* row, const Sides& x, std::uint8_t* to) {
  std::uint8_t* const here = margin_.data() + kFarthest;
  std::memcpy(here, row, stride_);
  std::memcpy(to, row, stride_);
  if (x.lower) take(to, here - 1, stride_, 0);
  if (x.upper) take(to, here + 1, stride_, 0);
}

void VoxelNearness::along_y(const Sides& x, const Sides& y) {
  for (int z = 0; z < size_.z; ++z) {
    for (int i = 1; y.lower && i < size_.y; ++i) {
      widen(row(i - 1, z), x, next_.data());
      take(row(i, z), next_.data(), stride_, 1);
    }
    for (int i = size_.y - 2; y.upper && i >= 0; --i) {
      widen(row(i + 1, z), x, next_.data());
      take(row(i, z), next_.data(), stride_, 1);
    }
  }
}

void VoxelNearness::along_z(const Sides& x, const Sides& y, const Sides& z) {
  slab_.resize(stride_ * static_cast<std::size_t>(size_.y));
  const auto pass = [&](int from, int to) {
    for (int i = 0; i < size_.y; ++i) widen(row(i, from), x, slab_.data() + stride_ * static_cast<std::size_t>(i));
    const std::size_t count = slab_.size();
    std::uint8_t* const slab = row(0, to);
    take(slab, slab_.data(), count, 1);
    if (y.lower) take(slab + stride_, slab_.data(), count - stride_, 1);
    if (y.upper) take(slab, slab_.data() + stride_, count - stride_, 1);
  };
  for (int i = 1; z.lower && i < size_.z; ++i) pass(i - 1, i);
  for (int i = size_.z - 2; z.upper && i >= 0; --i) pass(i + 1, i);
}

}  // namespace scarp
