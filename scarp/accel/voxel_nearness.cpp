// SPDX-License-Identifier: MIT
#include "scarp/accel/voxel_nearness.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace scarp {
namespace {

constexpr std::size_t kBlock = 16;      // bytes at once
constexpr std::size_t kFarthest = 255;  // steps that count

// 16 numbers in one register: the vectors of GCC and clang, whose operators work number by number.
using Bytes = std::uint8_t __attribute__((vector_size(kBlock)));

Bytes load(const std::uint8_t* from) {
  Bytes bytes;
  std::memcpy(&bytes, from, kBlock);
  return bytes;
}
void store(const Bytes& bytes, std::uint8_t* to) { std::memcpy(to, &bytes, kBlock); }
Bytes greater(const Bytes& a, const Bytes& b) { return a > b ? a : b; }
// Each some steps farther away, at most out of sight.
Bytes farther(const Bytes& nearness, const Bytes& steps) { return greater(nearness, steps) - steps; }

// A block, or what is nearer of its neighbours in a row.
Bytes widened(const std::uint8_t* from, const VoxelNearness::Sides& x) {
  Bytes bytes = load(from);
  if (x.lower) bytes = greater(bytes, load(from - 1));
  if (x.upper) bytes = greater(bytes, load(from + 1));
  return bytes;
}

// Four bytes, 255 where the bit is set.
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
    : size_(window.high - window.low),
      used_((static_cast<std::size_t>(size_.x) + kBlock - 1) / kBlock * kBlock),
      stride_(used_ + 2 * kMargin),
      bytes_(stride_ * static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(size_.z)) {
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

// What has just been stored is not loaded across blocks at once, which would wait for it: slabs and columns of rows
// take each step together.

void VoxelNearness::spread(const Sides& x, const Sides& y, const Sides& z) {
  along_x(x);
  along_y(x, y);
  along_z(x, y, z);
}

void VoxelNearness::along_x(const Sides& x) {
  const std::size_t reach = std::min<std::size_t>(static_cast<std::size_t>(size_.x) - 1, kFarthest - 1);
  // The rows of a slab, twice, each between bytes that stay 0.
  const std::size_t wide = 2 * used_, rows = static_cast<std::size_t>(size_.y);
  std::vector<std::uint8_t> slabs(2 * (wide * rows + used_));
  std::uint8_t *here = slabs.data() + used_, *next = here + slabs.size() / 2;
  const auto stride_by = [&](std::size_t stride, bool lower, bool upper) {
    const Bytes steps = Bytes{} + static_cast<std::uint8_t>(stride);
    for (std::size_t row = 0; row < wide * rows; row += wide) {
      for (std::size_t i = row; i < row + used_; i += kBlock) {
        Bytes bytes = load(here + i);
        if (lower) bytes = greater(bytes, farther(load(here + i - stride), steps));
        if (upper) bytes = greater(bytes, farther(load(here + i + stride), steps));
        store(bytes, next + i);
      }
    }
    std::swap(here, next);
  };
  for (int z = 0; z < size_.z; ++z) {
    Bytes any{};
    for (int y = 0; y < size_.y; ++y) {
      const std::uint8_t* const from = row(y, z);
      std::uint8_t* const to = here + wide * static_cast<std::size_t>(y);
      for (std::size_t i = 0; i < used_; i += kBlock) {
        const Bytes bytes = load(from + i);
        any |= bytes;
        store(bytes, to + i);
      }
    }
    std::array<std::uint64_t, 2> halves;
    std::memcpy(halves.data(), &any, kBlock);
    if ((halves[0] | halves[1]) == 0) continue;
    // After strides of 1, 2, ..., n all within 2 n - 1 steps is known.
    for (std::size_t stride = 1; stride <= reach; stride *= 2) stride_by(stride, x.lower, x.upper);
    for (int y = 0; y < size_.y; ++y) {
      const std::uint8_t* const from = here + wide * static_cast<std::size_t>(y);
      std::uint8_t* const to = row(y, z);
      for (std::size_t i = 0; i < used_; i += kBlock) store(load(from + i), to + i);
    }
  }
}

void VoxelNearness::along_y(const Sides& x, const Sides& y) {
  const Bytes step = Bytes{} + 1;
  const auto pass = [&](int from, int to) {
    for (int z = 0; z < size_.z; ++z) {
      const std::uint8_t* const source = row(from, z);
      std::uint8_t* const target = row(to, z);
      for (std::size_t i = 0; i < used_; i += kBlock)
        store(greater(load(target + i), farther(widened(source + i, x), step)), target + i);
    }
  };
  for (int i = 1; y.lower && i < size_.y; ++i) pass(i - 1, i);
  for (int i = size_.y - 2; y.upper && i >= 0; --i) pass(i + 1, i);
}

void VoxelNearness::along_z(const Sides& x, const Sides& y, const Sides& z) {
  const Bytes step = Bytes{} + 1;
  // The rows of a slab, widened, between two that are 0.
  std::vector<std::uint8_t> slab(used_ * (static_cast<std::size_t>(size_.y) + 2));
  const auto pass = [&](int from, int to) {
    for (int i = 0; i < size_.y; ++i) {
      const std::uint8_t* const source = row(i, from);
      std::uint8_t* const wide = slab.data() + used_ * static_cast<std::size_t>(i + 1);
      for (std::size_t j = 0; j < used_; j += kBlock) store(widened(source + j, x), wide + j);
    }
    for (int i = 0; i < size_.y; ++i) {
      const std::uint8_t* const wide = slab.data() + used_ * static_cast<std::size_t>(i + 1);
      std::uint8_t* const target = row(i, to);
      for (std::size_t j = 0; j < used_; j += kBlock) {
        Bytes bytes = load(wide + j);
        if (y.lower) bytes = greater(bytes, load(wide + j - used_));
        if (y.upper) bytes = greater(bytes, load(wide + j + used_));
        store(greater(load(target + j), farther(bytes, step)), target + j);
      }
    }
  };
  for (int i = 1; z.lower && i < size_.z; ++i) pass(i - 1, i);
  for (int i = size_.z - 2; z.upper && i >= 0; --i) pass(i + 1, i);
}

}  // namespace scarp
