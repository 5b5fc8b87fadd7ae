// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>

#include "scarp/accel/voxel_nearness.h"

// Compiled once per instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/accel/voxel_nearness_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<std::uint8_t, VoxelNearness::kBlock> d8;
constexpr std::size_t N = hn::MaxLanes(d8);
using V = hn::Vec<decltype(d8)>;

constexpr std::size_t kFarthest = 255;  // maximum number of steps

// Maximum of each value and its neighbours in a row.
HWY_INLINE V widened(const std::uint8_t* from) {
  return hn::Max(hn::LoadU(d8, from), hn::Max(hn::LoadU(d8, from - 1), hn::LoadU(d8, from + 1)));
}

// Loads that straddle recent stores would stall, so slabs and columns of rows take each step together.

// kOne: each row is one vector.
template <bool kLower, bool kUpper, bool kOne>
HWY_INLINE void stride_by(std::size_t stride, const NearRows& rows, const std::uint8_t* HWY_RESTRICT from,
                          std::uint8_t* HWY_RESTRICT to) {
  const V steps = hn::Set(d8, static_cast<std::uint8_t>(stride));
  const std::size_t used = kOne ? N : rows.used, wide = 2 * used;
  for (std::size_t row = 0; row < wide * static_cast<std::size_t>(rows.size.y); row += wide) {
    for (std::size_t i = row; i < row + used; i += N) {
      V bytes = hn::LoadU(d8, from + i);
      if (kLower) bytes = hn::Max(bytes, hn::SaturatedSub(hn::LoadU(d8, from + i - stride), steps));
      if (kUpper) bytes = hn::Max(bytes, hn::SaturatedSub(hn::LoadU(d8, from + i + stride), steps));
      hn::StoreU(bytes, d8, to + i);
    }
  }
}

template <bool kLower, bool kUpper, bool kOne>
void rows_along_x(const NearRows& rows) {
  const std::size_t reach = std::min<std::size_t>(static_cast<std::size_t>(rows.size.x) - 1, kFarthest - 1);
  // Rows of a slab, in two copies, between bytes that stay 0.
  const std::size_t wide = 2 * rows.used, count = static_cast<std::size_t>(rows.size.y);
  std::vector<std::uint8_t> slabs(2 * (wide * count + rows.used));
  std::uint8_t *here = slabs.data() + rows.used, *next = here + slabs.size() / 2;
  for (int z = 0; z < rows.size.z; ++z) {
    V any = hn::Zero(d8);
    for (int y = 0; y < rows.size.y; ++y) {
      const std::uint8_t* const from = rows.row(y, z);
      std::uint8_t* const to = here + wide * static_cast<std::size_t>(y);
      for (std::size_t i = 0; i < rows.used; i += N) {
        const V bytes = hn::LoadU(d8, from + i);
        any = hn::Or(any, bytes);
        hn::StoreU(bytes, d8, to + i);
      }
    }
    if (hn::AllTrue(d8, hn::Eq(any, hn::Zero(d8)))) continue;
    // After strides of 1, 2, ..., n, everything within 2 n - 1 steps is known.
    for (std::size_t stride = 1; stride <= reach; stride *= 2) {
      stride_by<kLower, kUpper, kOne>(stride, rows, here, next);
      std::swap(here, next);
    }
    for (int y = 0; y < rows.size.y; ++y) {
      const std::uint8_t* const from = here + wide * static_cast<std::size_t>(y);
      std::uint8_t* const to = rows.row(y, z);
      for (std::size_t i = 0; i < rows.used; i += N) hn::StoreU(hn::LoadU(d8, from + i), d8, to + i);
    }
  }
}

template <bool kLower, bool kUpper>
void sides_along_x(const NearRows& rows) {
  rows.used == N ? rows_along_x<kLower, kUpper, true>(rows) : rows_along_x<kLower, kUpper, false>(rows);
}

void along_x(const NearRows& rows, bool lower, bool upper) {
  if (lower && upper) {
    sides_along_x<true, true>(rows);
  } else if (lower) {
    sides_along_x<true, false>(rows);
  } else {
    sides_along_x<false, true>(rows);
  }
}

void along_y(const NearRows& rows) {
  const V step = hn::Set(d8, 1);
  const auto pass = [&](int from, int to) {
    for (int z = 0; z < rows.size.z; ++z) {
      const std::uint8_t* const source = rows.row(from, z);
      std::uint8_t* const target = rows.row(to, z);
      for (std::size_t i = 0; i < rows.used; i += N)
        hn::StoreU(hn::Max(hn::LoadU(d8, target + i), hn::SaturatedSub(widened(source + i), step)), d8, target + i);
    }
  };
  for (int i = 1; i < rows.size.y; ++i) pass(i - 1, i);
  for (int i = rows.size.y - 2; i >= 0; --i) pass(i + 1, i);
}

void along_z(const NearRows& rows) {
  const V step = hn::Set(d8, 1);
  // Rows of a slab, widened, between two rows of zeros.
  std::vector<std::uint8_t> slab(rows.used * (static_cast<std::size_t>(rows.size.y) + 2));
  const auto pass = [&](int from, int to) {
    for (int i = 0; i < rows.size.y; ++i) {
      const std::uint8_t* const source = rows.row(i, from);
      std::uint8_t* const wide = slab.data() + rows.used * static_cast<std::size_t>(i + 1);
      for (std::size_t j = 0; j < rows.used; j += N) hn::StoreU(widened(source + j), d8, wide + j);
    }
    for (int i = 0; i < rows.size.y; ++i) {
      const std::uint8_t* const wide = slab.data() + rows.used * static_cast<std::size_t>(i + 1);
      std::uint8_t* const target = rows.row(i, to);
      for (std::size_t j = 0; j < rows.used; j += N) {
        const V bytes = hn::Max(hn::LoadU(d8, wide + j),
                                hn::Max(hn::LoadU(d8, wide + j - rows.used), hn::LoadU(d8, wide + j + rows.used)));
        hn::StoreU(hn::Max(hn::LoadU(d8, target + j), hn::SaturatedSub(bytes, step)), d8, target + j);
      }
    }
  };
  for (int i = 1; i < rows.size.z; ++i) pass(i - 1, i);
  for (int i = rows.size.z - 2; i >= 0; --i) pass(i + 1, i);
}

void spread(const NearRows& rows) {
  along_x(rows, true, true);
  along_y(rows);
  along_z(rows);
}

void far(const std::uint8_t* near, std::uint8_t farthest, std::size_t count, std::uint8_t* to) {
  const V most = hn::Set(d8, farthest);
  std::size_t i = 0;
  for (; i + N <= count; i += N) hn::StoreU(hn::Sub(most, hn::LoadU(d8, near + i)), d8, to + i);
  for (; i < count; ++i) to[i] = static_cast<std::uint8_t>(farthest - near[i]);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(along_x);
HWY_EXPORT(spread);
HWY_EXPORT(far);

}  // namespace

void VoxelNearness::along_x(const Sides& sides) { HWY_DYNAMIC_DISPATCH(along_x)(rows(), sides.lower, sides.upper); }
void VoxelNearness::spread() { HWY_DYNAMIC_DISPATCH(spread)(rows()); }

void VoxelNearness::write_far(const VoxelBox& part, std::uint8_t farthest, VoxelBytes& to) const {
  const auto write = HWY_DYNAMIC_DISPATCH(far);
  for_each_row(part, [&](int y, int z) {
    write(row(y - low_.y, z - low_.z) + (part.low.x - low_.x), farthest,
          static_cast<std::size_t>(part.high.x - part.low.x), to.at({part.low.x, y, z}));
  });
}

}  // namespace scarp
#endif
