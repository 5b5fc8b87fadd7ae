// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <vector>

#include "scarp/accel/cube_edit.h"

// Compiled once per instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/accel/cube_edit_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/highway.h"
#include "scarp/accel/byte_lanes_simd.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

// Vectors of a row, along x.
struct Range {
  std::int16_t first = 0, last = -1;

  bool empty() const { return first > last; }
};

std::uint8_t byte_of(int distance) { return static_cast<std::uint8_t>(std::min(distance, 255)); }

class CubeEdit {
 public:
  CubeEdit(const VoxelNearness& solid, const VoxelBox& changed, VoxelBytes& distances)
      : size_(distances.size()),
        solid_(solid),
        changed_(changed),
        distances_(distances),
        rows_(size_.x),
        none_(rows_.padded(), 255),
        from_box_(rows_.padded()),
        solid_row_(rows_.padded()),
        ranges_(static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(size_.z)),
        todo_(changed) {
    for (int x = 0; x < size_.x; ++x) from_box_[static_cast<std::size_t>(x)] = byte_of(away(0, x));
  }

  void run() {
    find();
    for (int z = todo_.low.z; z < todo_.high.z; ++z) {
      for (int y = todo_.low.y; y < todo_.high.y; ++y) {
        if (!range(y, z).empty()) pass<true>(y, z);
      }
    }
    for (int z = todo_.high.z - 1; z >= todo_.low.z; --z) {
      for (int y = todo_.high.y - 1; y >= todo_.low.y; --y) {
        if (!range(y, z).empty()) pass<false>(y, z);
      }
    }
  }

 private:
  Range& range(int y, int z) {
    return ranges_[static_cast<std::size_t>(y) + static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(z)];
  }
  int away(int axis, int place) const {
    return std::max({changed_.low[axis] - place, place - (changed_.high[axis] - 1), 0});
  }
  V from_box(int y, int z, std::size_t x) const {
    return hn::Max(hn::Set(d8, byte_of(std::max(away(1, y), away(2, z)))), hn::LoadU(d8, from_box_.data() + x));
  }

  // Sets the range of each row, outwards from the box.
  void find() {
    for (const int to_z : {1, -1}) {
      const int first_z = to_z > 0 ? changed_.low.z : changed_.low.z - 1;
      int low_y = 0, high_y = 0;  // rows with a range in the previous slab
      for (int z = first_z; z >= 0 && z < size_.z; z += to_z) {
        const int from_z = away(2, z) == 0 ? z : z - to_z;
        if (z == changed_.low.z - 1) low_y = base_low_y_, high_y = base_high_y_;
        int low_here = size_.y, high_here = -1;
        for (const int to_y : {1, -1}) {
          const int first_y = to_y > 0 ? changed_.low.y : changed_.low.y - 1;
          for (int y = first_y; y >= 0 && y < size_.y; y += to_y) {
            const int from_y = away(1, y) == 0 ? y : y - to_y;
            const Range found =
                from_y == y && from_z == z ? find_in_box(y, z) : find_beside(range(from_y, from_z), y, z);
            if (found.empty()) {
              // Rows farther out can only continue ranges of the previous slab, or of this row.
              if (from_z == z ? from_y != y : to_y > 0 ? y > high_y : y < low_y) break;
              continue;
            }
            range(y, z) = found;
            low_here = std::min(low_here, y), high_here = std::max(high_here, y);
            todo_ = around(todo_, {{todo_.low.x, y, z}, {todo_.high.x, y + 1, z + 1}});
          }
        }
        if (low_here > high_here) break;
        low_y = low_here, high_y = high_here;
        if (z == changed_.low.z) base_low_y_ = low_y, base_high_y_ = high_y;
      }
    }
  }

  bool may_change(int y, int z, int vector) {
    const std::size_t x = N * static_cast<std::size_t>(vector);
    const V distance = hn::AndNot(rows_.beyond(x), hn::LoadU(d8, distances_.at({0, y, z}) + x));
    // Voxels whose distance is at least that from the box. Lanes beyond the row are 0 in `distance` and 255 in `from`.
    const V from = hn::Or(from_box(y, z, x), rows_.beyond(x));
    return !hn::AllTrue(d8, hn::Ne(hn::Max(distance, from), distance));
  }
  Range find_in_box(int y, int z) {
    Range found{static_cast<std::int16_t>(rows_.vector_of(changed_.low.x)),
                static_cast<std::int16_t>(rows_.vector_of(changed_.high.x - 1))};
    while (found.first > 0 && may_change(y, z, found.first - 1)) --found.first;
    while (found.last + 1 < rows_.count() && may_change(y, z, found.last + 1)) ++found.last;
    return found;
  }
  // `towards`: the range of the row one step nearer to the box.
  Range find_beside(const Range& towards, int y, int z) {
    if (towards.empty()) return {};
    Range found{static_cast<std::int16_t>(std::max(0, towards.first - 1)),
                static_cast<std::int16_t>(std::min(rows_.count() - 1, towards.last + 1))};
    while (!found.empty() && !may_change(y, z, found.first)) ++found.first;
    while (!found.empty() && !may_change(y, z, found.last)) --found.last;
    return found;
  }

  const std::uint8_t* row_or_none(int y, int z) {
    return y < 0 || z < 0 || y >= size_.y || z >= size_.z ? none_.data() : distances_.at({0, y, z});
  }

  // kRising: from the rows before this one and the voxels before each in it; otherwise from those after.
  template <bool kRising>
  void pass(int y, int z) {
    constexpr int back = kRising ? -1 : 1;
    const Range todo = range(y, z);
    std::uint8_t* const row = distances_.at({0, y, z});
    const std::array rows = {row_or_none(y + back, z), row_or_none(y - 1, z + back), row_or_none(y, z + back),
                             row_or_none(y + 1, z + back)};
    const bool in_box = away(1, y) == 0 && away(2, z) == 0;
    if (kRising && in_box) {
      std::fill(solid_row_.begin(), solid_row_.end(), std::uint8_t{0});
      std::copy_n(solid_.row(y - changed_.low.y, z - changed_.low.z), changed_.high.x - changed_.low.x,
                  solid_row_.begin() + changed_.low.x);
    }
    const V all = hn::Set(d8, 255), one = hn::Set(d8, 1), away_lanes = rows_.template away<kRising>();
    const auto least = [&](int vector) {
      if (vector < 0 || vector >= rows_.count()) return all;
      const std::size_t x = N * static_cast<std::size_t>(vector);
      const V near = hn::Min(hn::LoadU(d8, rows[0] + x), hn::LoadU(d8, rows[1] + x)),
              far = hn::Min(hn::LoadU(d8, rows[2] + x), hn::LoadU(d8, rows[3] + x));
      return hn::Or(hn::Min(near, far), rows_.beyond(x));
    };
    int vector = kRising ? todo.first : todo.last;
    V below = least(vector - 1), here = least(vector), above = least(vector + 1);
    unsigned passed = 255;  // distance of the voxel before this vector, or after it
    if (kRising ? vector > 0 : vector + 1 < rows_.count())
      passed = kRising ? row[N * static_cast<std::size_t>(vector) - 1] : row[N * static_cast<std::size_t>(vector + 1)];
    for (; kRising ? vector <= todo.last : vector >= todo.first; vector -= back) {
      const std::size_t x = N * static_cast<std::size_t>(vector);
      V distance = hn::LoadU(d8, row + x);
      if constexpr (kRising) {
        const V from = from_box(y, z, x);
        distance = hn::Or(distance, hn::VecFromMask(d8, hn::Eq(hn::Max(distance, from), distance)));
        if (in_box) distance = hn::AndNot(hn::LoadU(d8, solid_row_.data() + x), distance);
      }
      const V beside_it = hn::Min(here, hn::Min(from_below<1>(here, below), from_above<1>(here, above)));
      if (kRising && passed == 255 && hn::AllTrue(d8, hn::Eq(hn::And(distance, beside_it), all))) {
        rows_.store(distance, row, x);
        below = here, here = above, above = least(vector + 2);
        continue;
      }
      distance = hn::Min(distance, hn::SaturatedAdd(beside_it, one));
      distance = spread<kRising>(hn::Or(distance, rows_.beyond(x)));
      // Computed before the vector is complete, so that vectors need not wait for one another.
      const unsigned next = std::min(static_cast<unsigned>(hn::ExtractLane(distance, kRising ? N - 1 : 0)),
                                     std::min<unsigned>(255, passed + N));
      distance = hn::Min(distance, hn::SaturatedAdd(hn::Set(d8, static_cast<std::uint8_t>(passed)), away_lanes));
      passed = next;
      rows_.store(distance, row, x);
      if constexpr (kRising) {
        below = here, here = above, above = least(vector + 2);
      } else {
        above = here, here = below, below = least(vector - 2);
      }
    }
  }

  ivec3 size_;
  const VoxelNearness& solid_;
  VoxelBox changed_;
  VoxelBytes& distances_;
  ByteRows rows_;
  std::vector<std::uint8_t> none_, from_box_, solid_row_;
  std::vector<Range> ranges_;
  int base_low_y_ = 0, base_high_y_ = 0;  // rows with a range in the lowest slab of the box
  VoxelBox todo_;                         // rows with a range, along y and z
};

void update(const VoxelNearness& solid, const VoxelBox& changed, VoxelBytes& distances) {
  CubeEdit(solid, changed, distances).run();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace scarp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace scarp {
namespace {

HWY_EXPORT(update);

}  // namespace

void update_cubes(const VoxelNearness& solid, const VoxelBox& changed, VoxelBytes& distances) {
  HWY_DYNAMIC_DISPATCH(update)(solid, changed, distances);
}

}  // namespace scarp
#endif
