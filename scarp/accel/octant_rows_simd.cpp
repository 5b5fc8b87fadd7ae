// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "scarp/accel/octant_rows.h"

// This file is compiled once for each instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/accel/octant_rows_simd.cpp"
#include "hwy/foreach_target.h"
// foreach_target.h comes first.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace scarp {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<std::uint8_t, VoxelNearness::kBlock> d8;
constexpr std::size_t N = hn::MaxLanes(d8);
using V = hn::Vec<decltype(d8)>;

constexpr std::uint8_t kSolid = 255;  // as near as can be

std::size_t blocks(int bytes) {
  return (static_cast<std::size_t>(bytes) + VoxelNearness::kBlock - 1) / VoxelNearness::kBlock * VoxelNearness::kBlock;
}

// Of one octant: nearness in the slab that is built and in the one ahead of it. Rows are counted from the one ahead of
// the region on.
class Slabs {
 public:
  Slabs(const VoxelBox& region, int octant, const VoxelBytes& sides)
      : region_(region),
        octant_(octant),
        sides_(sides),
        size_({sides.size().x, sides.size().y, sides.size().z / 8}),
        stride_(blocks(region.high.x - region.low.x) + 2 * kMargin),
        bytes_(2 * stride_ * static_cast<std::size_t>(region.high.y - region.low.y + 1)),
        here_(bytes_.data() + kMargin),
        ahead_(here_ + bytes_.size() / 2) {
    for (int i = 0; i <= region.high.y - region.low.y; ++i)
      read(y(i - 1), z(-1), ahead_ + stride_ * static_cast<std::size_t>(i));
  }

  // Coordinates of the i-th row, and slab, of the region; -1: ahead of it.
  int y(int i) const { return down(1) ? region_.low.y + i : region_.high.y - 1 - i; }
  int z(int i) const { return down(2) ? region_.low.z + i : region_.high.z - 1 - i; }
  int x_ahead() const { return down(0) ? region_.low.x - 1 : region_.high.x; }

  // Of a slab: the row ahead, then the others, in the octant's order.
  struct Rows {
    std::uint8_t* here;
    const std::uint8_t* ahead;
    // The first row's, and how far apart they are.
    const std::uint8_t* own;  // spread along x alone
    std::uint8_t* to;         // sides
    std::ptrdiff_t own_apart, to_apart;
    std::ptrdiff_t next;  // of voxels along x
    bool ends_ahead;
  };
  std::ptrdiff_t rows_apart() const { return static_cast<std::ptrdiff_t>(stride_); }
  Rows begin_slab(int i, const VoxelNearness& along_x, VoxelBytes& sides) {
    read(y(-1), z(i), here_);
    const int first = y(0), window_y = first - region_.low.y, window_z = z(i) - region_.low.z;
    const std::ptrdiff_t row = along_x.rows_apart();
    return {here_,
            ahead_,
            along_x.row(window_y, window_z),
            sides.at({region_.low.x, first, z(i) + octant_ * size_.z}),
            down(1) ? row : -row,
            down(1) ? size_.x : -size_.x,
            down(0) ? -1 : 1,
            x_ahead() < 0 || x_ahead() >= size_.x};
  }
  void end_slab() { std::swap(here_, ahead_); }

  // What is known of a voxel ahead of the region; outside of the grid nothing is near.
  std::uint8_t known(const ivec3& voxel) const {
    if (glm::any(glm::lessThan(voxel, ivec3(0))) || glm::any(glm::greaterThanEqual(voxel, size_))) return 0;
    return static_cast<std::uint8_t>(kSolid - sides_[voxel + ivec3(0, 0, octant_ * size_.z)]);
  }

 private:
  bool down(int axis) const { return octant_ >> axis & 1; }

  // A row ahead of the region, with its voxel ahead of it along x; outside of the grid it stays 0.
  void read(int y, int z, std::uint8_t* to) const {
    if (y < 0 || y >= size_.y || z < 0 || z >= size_.z) return;
    for (int x = region_.low.x; x < region_.high.x; ++x) to[x - region_.low.x] = known({x, y, z});
    to[x_ahead() - region_.low.x] = known({x_ahead(), y, z});
  }

  static constexpr std::size_t kMargin = 8;

  VoxelBox region_;
  int octant_;
  const VoxelBytes& sides_;
  ivec3 size_;  // of the grid
  std::size_t stride_;
  std::vector<std::uint8_t> bytes_;
  std::uint8_t *here_, *ahead_;
};

// The nearer of each voxel and the next one along x.
HWY_INLINE V widened(const std::uint8_t* from, std::ptrdiff_t next) {
  return hn::Max(hn::LoadU(d8, from), hn::LoadU(d8, from + next));
}

// kOne: rows are of one whole vector.
template <bool kOne>
int build_rows(std::span<const OctantRows> which, const VoxelBox& region, VoxelBytes& sides) {
  const ivec3 size = region.high - region.low;
  std::vector<Slabs> octants;
  octants.reserve(which.size());
  for (const OctantRows& octant : which) octants.emplace_back(region, octant.octant, sides);
  // 255 for the voxels of a row.
  std::vector<std::uint8_t> row_of(blocks(size.x));
  std::fill_n(row_of.begin(), size.x, std::uint8_t{255});
  const std::size_t end = kOne ? N : static_cast<std::size_t>(size.x);
  const V one = hn::Set(d8, 1), all = hn::Set(d8, 255);
  V largest = hn::Zero(d8);
  const std::ptrdiff_t apart = octants[0].rows_apart();
  std::array<Slabs::Rows, 8> at;
  for (int slab = 0; slab < size.z; ++slab) {
    for (std::size_t i = 0; i < octants.size(); ++i) at[i] = octants[i].begin_slab(slab, *which[i].along_x, sides);
    for (int row = 0; row < size.y; ++row) {
      for (std::size_t i = 0; i < octants.size(); ++i) {
        const Slabs::Rows& rows = at[i];
        const std::ptrdiff_t next = rows.next;
        const std::uint8_t *const a = rows.here + row * apart, *const c = rows.ahead + row * apart,
                                  *const b = c + apart, *const own = rows.own + row * rows.own_apart;
        std::uint8_t *const here = rows.here + (row + 1) * apart, *const to = rows.to + row * rows.to_apart;
        for (std::size_t x = 0; x < end; x += N) {
          const V nearest = hn::Max(widened(a + x, next), hn::Max(widened(b + x, next), widened(c + x, next)));
          const V near = hn::Max(hn::LoadU(d8, own + x), hn::SaturatedSub(nearest, one)), side = hn::Sub(all, near);
          hn::StoreU(near, d8, here + x);
          largest = hn::Max(largest, kOne ? side : hn::And(side, hn::LoadU(d8, row_of.data() + x)));
          if (kOne || x + N <= end) {
            hn::StoreU(side, d8, to + x);
          } else {
            alignas(64) std::array<std::uint8_t, N> some;
            hn::Store(side, d8, some.data());
            std::memcpy(to + x, some.data(), end - x);
          }
        }
        if (rows.ends_ahead) continue;
        // From the voxel ahead of the row as far as it is the nearest.
        const std::uint8_t known = octants[i].known({octants[i].x_ahead(), octants[i].y(row), octants[i].z(slab)});
        here[octants[i].x_ahead() - region.low.x] = known;
        for (int away = 1; away <= size.x && away < known; ++away) {
          const int x = next < 0 ? away - 1 : size.x - away;
          if (here[x] >= known - away) break;
          here[x] = static_cast<std::uint8_t>(known - away);
          to[x] = static_cast<std::uint8_t>(kSolid - here[x]);
        }
      }
    }
    for (Slabs& octant : octants) octant.end_slab();
  }
  alignas(64) std::array<std::uint8_t, N> lanes;
  hn::Store(largest, d8, lanes.data());
  return *std::max_element(lanes.begin(), lanes.end());
}

int build(std::span<const OctantRows> octants, const VoxelBox& region, VoxelBytes& sides) {
  const bool one = region.high.x - region.low.x == static_cast<int>(N);
  return one ? build_rows<true>(octants, region, sides) : build_rows<false>(octants, region, sides);
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

int build_octants(std::span<const OctantRows> octants, const VoxelBox& region, VoxelBytes& sides) {
  return HWY_DYNAMIC_DISPATCH(build)(octants, region, sides);
}

}  // namespace scarp
#endif
