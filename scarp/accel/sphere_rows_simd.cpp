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

// Squares of the non-empty rows, or of the non-empty slabs of rows.
struct Lines {
  std::size_t stride;
  std::vector<int> places;  // ascending
  std::vector<std::uint16_t> squares;

  void add(int place) {
    places.push_back(place);
    squares.resize(stride * places.size());
  }
  void drop() {
    places.pop_back();
    squares.resize(stride * places.size());
  }
  void clear() {
    places.clear();
    squares.clear();
  }
  bool empty() const { return places.empty(); }
  std::uint16_t* last() { return squares.data() + squares.size() - stride; }
};

// A vector of each line, one after the other.
class Column {
 public:
  void load(const Lines& lines, std::size_t at) {
    places_ = &lines.places;
    squares_.resize(N * places_->size());
    V least = hn::Set(d16, 65535);
    for (std::size_t i = 0; i < squares_.size(); i += N, at += lines.stride) {
      const V square = hn::LoadU(d16, lines.squares.data() + at);
      least = hn::Min(least, square);
      hn::StoreU(square, d16, squares_.data() + i);
    }
    hn::StoreU(least, d16, least_);
  }

  // Minimum over all lines as seen from line `place`. `beyond`: the first of places() at or beyond it.
  HWY_INLINE V least(int place, std::size_t beyond) const {
    const V least = hn::LoadU(d16, least_);
    const int* const places = places_->data();
    const std::size_t count = places_->size();
    V found = hn::Set(d16, 65535);
    for (std::size_t up = beyond, down = beyond;;) {
      const int above = up < count ? places[up] - place : kReach + 1;
      const int below = down > 0 ? place - places[down - 1] : kReach + 1;
      const int away = std::min(above, below);
      if (away > kReach) break;
      const V square = hn::Set(d16, static_cast<std::uint16_t>(away * away)), bound = hn::SaturatedAdd(least, square);
      if (hn::AllTrue(d16, hn::Eq(hn::Max(found, bound), bound))) break;
      const std::size_t line = above <= below ? up++ : --down;
      found = hn::Min(found, hn::SaturatedAdd(hn::LoadU(d16, squares_.data() + N * line), square));
    }
    return found;
  }

 private:
  const std::vector<int>* places_ = nullptr;
  std::vector<std::uint16_t> squares_;
  std::uint16_t least_[N];
};

// Squared distances from a box, along an axis: 65535 for those beyond kReach.
std::uint16_t square_from(const VoxelBox& box, int axis, int place) {
  const int away = std::max({box.low[axis] - place, place - (box.high[axis] - 1), 1}) - 1;
  return away > kReach ? 65535 : static_cast<std::uint16_t>(away * away);
}
std::uint16_t saturated(int sum) { return static_cast<std::uint16_t>(std::min(sum, 65535)); }

// From the box of an edit, to the voxels of a region.
class FromBox {
 public:
  FromBox(const VoxelBox& box, const VoxelBox& region)
      : box_(box), x_(to_size(region.high.x - region.low.x) + N, 65535) {
    for (int x = region.low.x; x < region.high.x; ++x) x_[to_size(x - region.low.x)] = square_from(box, 0, x);
  }
  std::uint16_t of_row(int y, int z) const { return saturated(square_from(box_, 1, y) + square_from(box_, 2, z)); }
  // Whether distances plus `slack` reach the box. Distances of solid voxels never do.
  HWY_INLINE hn::Mask<decltype(d16)> reached(V distances, int slack, std::size_t x, std::uint16_t of_row) const {
    const auto solid = hn::Eq(distances, hn::Set(d16, EmptySpheres::kSolid));
    const V far = hn::Min(hn::Add(distances, hn::Set(d16, static_cast<std::uint16_t>(slack))), hn::Set(d16, kReach));
    const V square = hn::Mul(far, far);
    const V from = hn::SaturatedAdd(hn::LoadU(d16, x_.data() + x), hn::Set(d16, of_row));
    return hn::AndNot(solid, hn::And(hn::Eq(hn::Max(square, from), square), hn::Ne(from, hn::Set(d16, 65535))));
  }

 private:
  VoxelBox box_;
  std::vector<std::uint16_t> x_;
};

// A voxel beside the straight path to the box is less than 1 away from the path, so each of the two distances is off by
// less than 1; both are also rounded down.
constexpr int kBeside = 3;

SphereEdit find(const VoxelBox& changed, const VoxelBytes& distances) {
  const ivec3 size = distances.size();
  const FromBox from_box(changed, distances.box());
  SphereEdit found{changed, 0};
  V most = hn::Zero(d16);
  const auto row = [&](int y, int z) {
    const std::uint8_t* const bytes = distances.at({0, y, z});
    const std::uint16_t of_row = from_box.of_row(y, z);
    bool any = false;
    for (int x = 0; x < size.x; x += static_cast<int>(N)) {
      const V distance = hn::PromoteTo(d16, hn::LoadU(d16_bytes, bytes + x));
      const auto reached = from_box.reached(distance, kBeside, to_size(x), of_row);
      if (hn::AllFalse(d16, reached)) continue;
      any = true;
      most = hn::Max(most, hn::IfThenElseZero(reached, distance));
      found.region = around(found.region, {{x, y, z}, {std::min(x + static_cast<int>(N), size.x), y + 1, z + 1}});
    }
    return any;
  };
  for (const bool up : {true, false}) {
    int low = changed.low.y, high = changed.high.y;  // of the previous slab
    for (int z = up ? changed.low.z : changed.low.z - 1; z >= 0 && z < size.z; z += up ? 1 : -1) {
      int low_here = size.y, high_here = 0;
      const auto search = [&](int y) {
        const bool any = row(y, z);
        if (any) low_here = std::min(low_here, y), high_here = std::max(high_here, y + 1);
        return any;
      };
      for (int y = std::max(low - 1, 0); y < std::min(high + 1, size.y); ++y) search(y);
      for (int y = std::min(high + 1, size.y); y < size.y && high_here == y && search(y); ++y) {
      }
      for (int y = std::max(low - 1, 0) - 1; y >= 0 && low_here == y + 1 && search(y); --y) {
      }
      if (low_here >= high_here) {
        if (z >= changed.low.z && z < changed.high.z) continue;
        break;
      }
      low = low_here, high = high_here;
    }
  }
  found.most = hn::GetLane(hn::MaxOfLanes(d16, most));
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

int build(const VoxelNearness& along_x, const SphereRows& work, VoxelBytes& distances) {
  const VoxelBox &window = work.window, &region = work.region;
  const VoxelBox* const changed = work.changed;
  const ivec3 inner = region.high - region.low, outer = window.high - window.low, shift = region.low - window.low;
  const std::size_t end = to_size(inner.x), stride = (end + N - 1) / N * N;
  // For the voxels of a row; lanes beyond them hold 0, which ends any search.
  std::vector<std::uint16_t> in_row(stride);
  for (std::size_t x = 0; x < end; ++x) in_row[x] = 65535;

  Lines rows{stride, {}, {}}, slabs{stride * to_size(inner.y), {}, {}};
  Column column;
  // Nearest within a slab and both adjacent ones, row by row, between two rows where nothing is in range.
  std::vector<std::uint8_t> nearest_of_3(stride * to_size(outer.y + 2));
  for (int z = 0; z < outer.z; ++z) {
    const int below = std::max(z - 1, 0), above = std::min(z + 1, outer.z - 1);
    V any_row = hn::Zero(d16);
    for (int y = 0; y < outer.y; ++y) {
      for (std::size_t x = 0; x < end; x += N) {
        const auto row = [&](int slab) { return hn::LoadU(d16_bytes, along_x.row(y, slab) + shift.x + x); };
        const auto nearest = hn::Max(row(z), hn::Max(row(below), row(above)));
        any_row = hn::Or(any_row, hn::PromoteTo(d16, nearest));
        hn::StoreU(nearest, d16_bytes, nearest_of_3.data() + stride * to_size(y + 1) + x);
      }
    }
    if (hn::AllTrue(d16, hn::Eq(any_row, hn::Zero(d16)))) continue;
    rows.clear();
    for (int y = 0; y < outer.y; ++y) {
      V any = hn::Zero(d16);
      rows.add(y);
      for (std::size_t x = 0; x < end; x += N) {
        const auto row = [&](int i) { return hn::LoadU(d16_bytes, nearest_of_3.data() + stride * to_size(i) + x); };
        const auto nearest = hn::Max(row(y), hn::Max(row(y + 1), row(y + 2)));
        // Boxes are dilated by one along x, too; out of range, 0, stays 0.
        const V in = hn::LoadU(d16, in_row.data() + x), near = hn::And(hn::PromoteTo(d16, nearest), in);
        const V away =
            hn::IfThenElse(hn::Eq(near, hn::Zero(d16)), hn::Set(d16, 255), hn::SaturatedSub(hn::Set(d16, 254), near));
        any = hn::Or(any, near);
        hn::StoreU(hn::And(hn::Mul(away, away), in), d16, rows.last() + x);
      }
      if (hn::AllTrue(d16, hn::Eq(any, hn::Zero(d16)))) rows.drop();
    }
    if (rows.empty()) continue;
    slabs.add(z);
    for (std::size_t x = 0; x < end; x += N) {
      column.load(rows, x);
      std::size_t beyond = 0;
      for (int y = 0; y < inner.y; ++y) {
        while (beyond < rows.places.size() && rows.places[beyond] < shift.y + y) ++beyond;
        hn::StoreU(column.least(shift.y + y, beyond), d16, slabs.last() + stride * to_size(y) + x);
      }
    }
  }

  const FromBox from_box(changed ? *changed : region, region);
  V most = hn::Zero(d16);
  alignas(64) std::array<std::uint8_t, N> bytes;
  for (int y = 0; y < inner.y; ++y) {
    for (std::size_t x = 0; x < end; x += N) {
      column.load(slabs, stride * to_size(y) + x);
      const V in = hn::LoadU(d16, in_row.data() + x);
      std::size_t beyond = 0;
      for (int z = 0; z < inner.z; ++z) {
        const ivec3 v = region.low + ivec3(0, y, z);
        std::uint8_t* const to = distances.at(v) + x;
        const V before = hn::PromoteTo(d16, hn::LoadU(d16_bytes, to));
        auto solid = hn::Eq(before, hn::Set(d16, EmptySpheres::kSolid));
        // Rows of the box are read from the grid.
        if (!changed ||
            (v.y >= changed->low.y && v.y < changed->high.y && v.z >= changed->low.z && v.z < changed->high.z)) {
          const std::uint8_t* const near = along_x.row(shift.y + y, shift.z + z) + shift.x + x;
          solid = hn::Eq(hn::PromoteTo(d16, hn::LoadU(d16_bytes, near)), hn::Set(d16, 255));
        } else if (hn::AllFalse(d16, from_box.reached(before, 1, x, from_box.of_row(v.y, v.z)))) {
          continue;
        }
        while (beyond < slabs.places.size() && slabs.places[beyond] < shift.z + z) ++beyond;
        const V found = hn::And(column.least(shift.z + z, beyond), in);
        V distance = hn::Min(roots(found), hn::Set(d16, EmptySpheres::kFarthest));
        if (work.only_added) distance = hn::Min(distance, before);
        most = hn::Max(most, hn::And(hn::IfThenZeroElse(solid, distance), in));
        const auto told =
            hn::DemoteTo(d16_bytes, hn::BitCast(hn::RebindToSigned<decltype(d16)>(),
                                                hn::IfThenElse(solid, hn::Set(d16, EmptySpheres::kSolid), distance)));
        if (x + N <= end) {
          hn::StoreU(told, d16_bytes, to);
        } else {
          hn::Store(told, d16_bytes, bytes.data());
          std::memcpy(to, bytes.data(), end - x);
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

HWY_EXPORT(find);
HWY_EXPORT(build);

}  // namespace

SphereEdit find_spheres(const VoxelBox& changed, const VoxelBytes& distances) {
  return HWY_DYNAMIC_DISPATCH(find)(changed, distances);
}

int build_spheres(const VoxelNearness& along_x, const SphereRows& rows, VoxelBytes& distances) {
  return HWY_DYNAMIC_DISPATCH(build)(along_x, rows, distances);
}

}  // namespace scarp
#endif
