// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "scarp/accel/empty_spheres.h"
#include "scarp/accel/sphere_rows.h"

// Compiled once per instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/accel/sphere_rows_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<std::uint16_t, VoxelNearness::kBlock> d16;
constexpr hn::Rebind<std::uint8_t, decltype(d16)> d16_bytes;
constexpr hn::CappedTag<float, VoxelNearness::kBlock / 2> df;
constexpr hn::RebindToSigned<decltype(df)> di;
constexpr hn::RebindToUnsigned<decltype(df)> du;
constexpr std::size_t N = hn::MaxLanes(d16);
using V = hn::Vec<decltype(d16)>;

constexpr int kShortBits = 16;
constexpr int kReach = EmptySpheres::kFarthest + 1;  // its square is the largest in 16 bits

std::size_t to_size(int i) { return static_cast<std::size_t>(i); }

// Squares in rows, or in slabs of rows, consecutive.
struct Lines {
  std::vector<std::uint16_t> squares;
  std::size_t stride;
  int low, high = -1;  // first and last line that are not empty

  Lines(std::size_t each, int count) : squares(each * to_size(count)), stride(each), low(count) {}
  std::uint16_t* line(int i) { return squares.data() + stride * to_size(i); }
  HWY_INLINE V load(int i, std::size_t at) const { return hn::LoadU(d16, squares.data() + stride * to_size(i) + at); }
  void holds(int i) {
    low = std::min(low, i);
    high = i;
  }
  bool empty() const { return low > high; }
};

// Minimum over all lines, at least one of them not empty, as seen from line `place`.
HWY_INLINE V least(const Lines& lines, int place, std::size_t at) {
  V found = hn::Set(d16, 65535);
  int away = 1;
  if (place < lines.low) {
    away = lines.low - place;
  } else if (place > lines.high) {
    away = place - lines.high;
  } else {
    found = lines.load(place, at);
  }
  const int end = std::min(kReach, std::max(place - lines.low, lines.high - place));
  for (; away <= end; ++away) {
    const V square = hn::Set(d16, static_cast<std::uint16_t>(away * away));
    if (hn::AllTrue(d16, hn::Eq(hn::Max(found, square), square))) break;
    // A line nearer than `away` (an end line, repeated) counts as too far, which is harmless.
    const V nearest =
        hn::Min(lines.load(std::max(place - away, lines.low), at), lines.load(std::min(place + away, lines.high), at));
    found = hn::Min(found, hn::SaturatedAdd(nearest, square));
  }
  return found;
}

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE V roots(V squares) {
  return hn::Set(d16, static_cast<std::uint16_t>(std::sqrt(static_cast<float>(hn::GetLane(squares)))));
}
#else
// Root rounded down, in the lowest bits. Adds 2^23 - 1/2 to the root of the square plus one half, which is never an
// integer plus one half: floats there have steps of 1, and the sum rounds to nearest.
HWY_INLINE hn::Vec<decltype(di)> root_bits(hn::Vec<decltype(di)> squares) {
  const auto root = hn::Sqrt(hn::Add(hn::ConvertTo(df, squares), hn::Set(df, 0.5f)));
  return hn::BitCast(di, hn::Add(root, hn::Set(df, 0x1p23f - 0.5f)));
}
// Rounded down.
HWY_INLINE V roots(V squares) {
  const auto pairs = hn::BitCast(du, squares);
  const auto low = root_bits(hn::BitCast(di, hn::And(pairs, hn::Set(du, 0xffff)))),
             high = root_bits(hn::BitCast(di, hn::ShiftRight<kShortBits>(pairs)));
  return hn::OddEven(hn::BitCast(d16, hn::ShiftLeft<kShortBits>(high)), hn::BitCast(d16, low));
}
#endif

int build(const VoxelNearness& along_x, const VoxelBox& window, const VoxelBox& region, VoxelBytes& distances) {
  const ivec3 inner = region.high - region.low, outer = window.high - window.low, shift = region.low - window.low;
  const std::size_t end = to_size(inner.x), stride = (end + N - 1) / N * N;
  // For the voxels of a row; lanes beyond them hold 0, which ends any search.
  std::vector<std::uint16_t> in_row(stride);
  for (std::size_t x = 0; x < end; ++x) in_row[x] = 65535;

  Lines rows(stride, outer.y), slabs(stride * to_size(inner.y), outer.z);
  // Nearest within a slab and both adjacent ones, row by row, between two rows where nothing is in range.
  std::vector<std::uint8_t> nearest_of_3(stride * to_size(outer.y + 2));
  for (int z = 0; z < outer.z; ++z) {
    const int below = std::max(z - 1, 0), above = std::min(z + 1, outer.z - 1);
    for (int y = 0; y < outer.y; ++y) {
      for (std::size_t x = 0; x < end; x += N) {
        const auto row = [&](int slab) { return hn::LoadU(d16_bytes, along_x.row(y, slab) + shift.x + x); };
        hn::StoreU(hn::Max(row(z), hn::Max(row(below), row(above))), d16_bytes,
                   nearest_of_3.data() + stride * to_size(y + 1) + x);
      }
    }
    rows.low = outer.y, rows.high = -1;
    for (int y = 0; y < outer.y; ++y) {
      V any = hn::Zero(d16);
      for (std::size_t x = 0; x < end; x += N) {
        const auto row = [&](int i) { return hn::LoadU(d16_bytes, nearest_of_3.data() + stride * to_size(i) + x); };
        const auto nearest = hn::Max(row(y), hn::Max(row(y + 1), row(y + 2)));
        // Boxes are dilated by one along x, too; out of range, 0, stays 0.
        const V in = hn::LoadU(d16, in_row.data() + x), near = hn::And(hn::PromoteTo(d16, nearest), in);
        const V away =
            hn::IfThenElse(hn::Eq(near, hn::Zero(d16)), hn::Set(d16, 255), hn::SaturatedSub(hn::Set(d16, 254), near));
        any = hn::Or(any, near);
        hn::StoreU(hn::And(hn::Mul(away, away), in), d16, rows.line(y) + x);
      }
      if (!hn::AllTrue(d16, hn::Eq(any, hn::Zero(d16)))) rows.holds(y);
    }
    if (!rows.empty()) slabs.holds(z);
    for (int y = 0; y < inner.y; ++y) {
      for (std::size_t x = 0; x < end; x += N) {
        const V found = rows.empty() ? hn::LoadU(d16, in_row.data() + x) : least(rows, shift.y + y, x);
        hn::StoreU(found, d16, slabs.line(z) + stride * to_size(y) + x);
      }
    }
  }

  V most = hn::Zero(d16);
  alignas(64) std::array<std::uint8_t, N> bytes;
  for (int z = 0; z < inner.z; ++z) {
    for (int y = 0; y < inner.y; ++y) {
      const std::uint8_t* const near = along_x.row(shift.y + y, shift.z + z) + shift.x;
      std::uint8_t* const to = distances.at(region.low + ivec3(0, y, z));
      for (std::size_t x = 0; x < end; x += N) {
        const V in = hn::LoadU(d16, in_row.data() + x);
        const V found = slabs.empty() ? in : least(slabs, shift.z + z, stride * to_size(y) + x);
        const V distance = hn::Min(roots(found), hn::Set(d16, EmptySpheres::kFarthest));
        const auto solid = hn::Eq(hn::PromoteTo(d16, hn::LoadU(d16_bytes, near + x)), hn::Set(d16, 255));
        most = hn::Max(most, hn::And(hn::IfThenZeroElse(solid, distance), in));
        const auto told =
            hn::DemoteTo(d16_bytes, hn::BitCast(hn::RebindToSigned<decltype(d16)>(),
                                                hn::IfThenElse(solid, hn::Set(d16, EmptySpheres::kSolid), distance)));
        if (x + N <= end) {
          hn::StoreU(told, d16_bytes, to + x);
        } else {
          hn::Store(told, d16_bytes, bytes.data());
          std::memcpy(to + x, bytes.data(), end - x);
        }
      }
    }
  }
  return hn::GetLane(hn::MaxOfLanes(d16, most));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(build);

}  // namespace

int build_spheres(const VoxelNearness& along_x, const VoxelBox& window, const VoxelBox& region, VoxelBytes& distances) {
  return HWY_DYNAMIC_DISPATCH(build)(along_x, window, region, distances);
}

}  // namespace scarp
#endif
