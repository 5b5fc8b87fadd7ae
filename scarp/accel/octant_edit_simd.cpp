// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "scarp/accel/octant_edit.h"

// Compiled once per instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/accel/octant_edit_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h must come first.
#include "hwy/highway.h"
#include "scarp/accel/byte_lanes_simd.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

// Vectors of a row, counted from the one ahead of all others.
struct Range {
  int first = 1 << 30, last = -1;

  bool empty() const { return first > last; }
  void add(const Range& other) {
    first = std::min(first, other.first);
    last = std::max(last, other.last);
  }
};

// kDown: rays travel in the negative direction of x, so that lower voxels are ahead.
template <bool kDown>
class OctantEdit {
 public:
  OctantEdit(int octant, const VoxelNearness& solid, const VoxelBox& changed, VoxelBytes& sides)
      : size_(sides.size().x, sides.size().y, sides.size().z / 8),
        octant_(octant),
        solid_(solid),
        changed_(changed),
        sides_(sides),
        rows_(size_.x),
        empty_(rows_.padded(), 255),
        solid_row_(rows_.padded()) {
    const int a = rows_.vector_of(changed.low.x), b = rows_.vector_of(changed.high.x - 1);
    in_box_.first = kDown ? a : rows_.count() - 1 - b;
    in_box_.last = kDown ? b : rows_.count() - 1 - a;
  }

  void run() {
    const int back_y = back(1), back_z = back(2);
    const int first_y = back_y > 0 ? changed_.low.y : changed_.high.y - 1, end_y = back_y > 0 ? size_.y : -1;
    const int end_z = back_z > 0 ? size_.z : -1;
    // Changes in rows of the slab ahead, and of this one.
    std::vector<Range> before(static_cast<std::size_t>(size_.y)), here(before.size());
    const auto at = [](std::vector<Range>& ranges, int y) -> Range& { return ranges[static_cast<std::size_t>(y)]; };
    int last_before = first_y - back_y;  // hindmost row of the slab ahead that changed
    for (int z = back_z > 0 ? changed_.low.z : changed_.high.z - 1; z != end_z; z += back_z) {
      const bool z_in_box = z >= changed_.low.z && z < changed_.high.z;
      std::fill(here.begin(), here.end(), Range());
      int last_here = first_y - back_y;
      for (int y = first_y; y != end_y; y += back_y) {
        const bool in_box = z_in_box && y >= changed_.low.y && y < changed_.high.y;
        Range todo = at(before, y);
        if (y != first_y) {
          todo.add(at(before, y - back_y));
          todo.add(at(here, y - back_y));
        }
        if (in_box) todo.add(in_box_);
        if (todo.empty()) {
          if (!in_box && (y - last_before) * back_y > 1) break;
          continue;
        }
        at(here, y) = row(y, z, todo, in_box);
        if (!at(here, y).empty()) last_here = y;
      }
      if (!z_in_box && last_here == first_y - back_y) break;
      std::swap(before, here);
      last_before = last_here;
    }
  }

 private:
  bool down(int axis) const { return octant_ >> axis & 1; }
  int back(int axis) const { return down(axis) ? 1 : -1; }
  std::uint8_t* row_at(int y, int z) { return sides_.at({0, y, z + octant_ * size_.z}); }
  const std::uint8_t* ahead(int y, int z) {
    return y < 0 || z < 0 || y >= size_.y || z >= size_.z ? empty_.data() : row_at(y, z);
  }
  std::size_t place(int vector) const {
    return N * static_cast<std::size_t>(kDown ? vector : rows_.count() - 1 - vector);
  }

  // Returns which voxels of a row are solid; in the box, as the edited grid has them.
  const std::uint8_t* solid_row(const std::uint8_t* row, int y, int z) {
    for (std::size_t x = 0; x < rows_.padded(); x += N) {
      const V sides = hn::LoadU(d8, row + x);
      hn::StoreU(hn::VecFromMask(d8, hn::Eq(sides, hn::Zero(d8))), d8, solid_row_.data() + x);
    }
    std::memcpy(solid_row_.data() + changed_.low.x, solid_.row(y - changed_.low.y, z - changed_.low.z),
                static_cast<std::size_t>(changed_.high.x - changed_.low.x));
    return solid_row_.data();
  }

  // Returns the vectors of the row behind this one that the changes in it may reach.
  Range row(int y, int z, const Range& todo, bool in_box) {
    std::uint8_t* const to = row_at(y, z);
    const std::uint8_t* const solid = in_box ? solid_row(to, y, z) : nullptr;
    const int y_ahead = y - back(1), z_ahead = z - back(2);
    const std::uint8_t *const a = ahead(y_ahead, z), *const b = ahead(y, z_ahead), *const c = ahead(y_ahead, z_ahead);
    const V all = hn::Set(d8, 255), one = hn::Set(d8, 1), zero = hn::Zero(d8), away = rows_.template away<kDown>();
    const auto least_ahead = [&](std::size_t x) {
      const V least = hn::Min(hn::LoadU(d8, a + x), hn::Min(hn::LoadU(d8, b + x), hn::LoadU(d8, c + x)));
      return hn::Or(least, rows_.beyond(x));
    };
    V previous = todo.first > 0 ? least_ahead(place(todo.first - 1)) : all;
    Range changes;
    // The side of the voxel ahead of the next vector.
    unsigned passed = 255;
    if (todo.first > 0) passed = to[kDown ? place(todo.first) - 1 : place(todo.first - 1)];
    bool carried = false;  // whether the hindmost voxel of the previous vector has changed
    for (int i = todo.first; i < rows_.count() && (i <= todo.last || carried); ++i) {
      const std::size_t x = place(i);
      const V beyond = rows_.beyond(x), before = hn::LoadU(d8, to + x);
      const V least = least_ahead(x);
      V side = hn::SaturatedAdd(hn::Min(least, beside<kDown>(least, previous)), one);
      previous = least;
      side = hn::IfThenZeroElse(solid ? hn::Ne(hn::LoadU(d8, solid + x), zero) : hn::Eq(before, zero), side);
      side = spread<kDown>(hn::Or(side, beyond));
      // The hindmost side is computed before the vector is complete, so that vectors need not wait for one another.
      const unsigned hindmost =
          std::min<unsigned>(hn::ExtractLane(side, kDown ? N - 1 : 0), std::min<unsigned>(255, passed + N));
      side = hn::Min(side, hn::SaturatedAdd(hn::Set(d8, static_cast<std::uint8_t>(passed)), away));
      passed = hindmost;
      const V change = hn::AndNot(beyond, hn::Xor(side, before));
      carried = false;
      if (hn::AllTrue(d8, hn::Eq(change, zero))) continue;
      carried = i + 1 < rows_.count() && to[kDown ? x + N - 1 : x] != hindmost;
      rows_.store(side, to, x);
      changes.first = std::min(changes.first, i);
      changes.last = carried ? i + 1 : i;
    }
    return changes;
  }

  ivec3 size_;
  int octant_;
  const VoxelNearness& solid_;
  VoxelBox changed_;
  VoxelBytes& sides_;
  ByteRows rows_;
  std::vector<std::uint8_t> empty_, solid_row_;
  Range in_box_;
};

void update(int octant, const VoxelNearness& solid, const VoxelBox& changed, VoxelBytes& sides) {
  if (octant & 1) {
    OctantEdit<true>(octant, solid, changed, sides).run();
  } else {
    OctantEdit<false>(octant, solid, changed, sides).run();
  }
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

void update_octant(int octant, const VoxelNearness& solid, const VoxelBox& changed, VoxelBytes& sides) {
  HWY_DYNAMIC_DISPATCH(update)(octant, solid, changed, sides);
}

}  // namespace scarp
#endif
