// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "scarp/accel/octant_rows.h"

// Compiled once per instruction set.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scarp/accel/octant_rows_simd.cpp"
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
static_assert(N + 1 <= VoxelBytes::kReadBeyond, "vectors are read one voxel beside rows");

std::size_t to_size(int i) { return static_cast<std::size_t>(i); }

// State common to all rows of a region, as an octant sees them along x.
class Row {
 public:
  Row(const VoxelBox& region, const ivec3& grid, bool down)
      : size_(to_size(region.high.x - region.low.x)),
        end_((size_ + N - 1) / N * N),
        down_(down),
        ends_(down ? region.low.x == 0 : region.high.x == grid.x),
        bytes_(3 * end_) {
    std::fill_n(bytes_.begin(), size_, std::uint8_t{255});
    if (ends_) bytes_[end_ + (down ? 0 : size_ - 1)] = 255;
    for (std::size_t x = 0; x < size_; ++x)
      bytes_[2 * end_ + x] = static_cast<std::uint8_t>(std::min<std::size_t>(255, down ? x + 1 : size_ - x));
  }

  bool whole() const { return size_ == end_; }  // whether the row consists of whole vectors
  bool ends() const { return ends_; }           // whether it ends at the grid's border
  std::ptrdiff_t next() const { return down_ ? -1 : 1; }
  std::ptrdiff_t ahead() const { return down_ ? -1 : static_cast<std::ptrdiff_t>(size_); }

  struct Block {
    std::size_t x, size;
    V in, edge, away;
  };
  // Calls `work` for each vector of a row, starting with the one ahead.
  template <class Work>
  HWY_INLINE void for_each_block(const Work& work) const {
    for (std::size_t i = 0; i < end_; i += N) {
      const std::size_t x = down_ ? i : end_ - N - i;
      const std::uint8_t* const bytes = bytes_.data() + x;
      work(Block{x, std::min(N, size_ - x), hn::LoadU(d8, bytes), hn::LoadU(d8, bytes + end_),
                 hn::LoadU(d8, bytes + 2 * end_)});
    }
  }

 private:
  std::size_t size_, end_;
  bool down_, ends_;
  // For each voxel: 255; 255 if the next one is outside the grid; distance of the voxel ahead of the row.
  std::vector<std::uint8_t> bytes_;
};

// Minimum of each side and that of the next voxel. Space outside the grid is empty.
HWY_INLINE V least(const std::uint8_t* sides, std::ptrdiff_t next, V edge) {
  return hn::Min(hn::LoadU(d8, sides), hn::Or(hn::LoadU(d8, sides + next), edge));
}

template <bool kWhole>
HWY_INLINE void store(V sides, std::size_t size, std::uint8_t* to) {
  if (kWhole || size == N) {
    hn::StoreU(sides, d8, to);
  } else {
    alignas(64) std::array<std::uint8_t, N> some;
    hn::Store(sides, d8, some.data());
    std::memcpy(to, some.data(), size);
  }
}

// Sides of one octant. Rows and slabs of the region count from the side ahead; -1 is ahead of the region.
class Octant {
 public:
  Octant(int octant, const VoxelBox& region, VoxelBytes& sides) : octant_(octant), region_(region) {
    const ivec3 grid = {sides.size().x, sides.size().y, sides.size().z / 8};
    first_ = sides.at({region.low.x, place(1, 0), place(2, 0) + octant * grid.z});
    to_next_row_ = down(1) ? grid.x : -grid.x;
    to_next_slab_ = (down(2) ? 1 : -1) * std::ptrdiff_t{grid.x} * grid.y;
    for (const int axis : {1, 2}) begins_[axis] = down(axis) ? region.low[axis] == 0 : region.high[axis] == grid[axis];
  }

  bool down(int axis) const { return octant_ >> axis & 1; }
  int count(int axis) const { return region_.high[axis] - region_.low[axis]; }
  // Counted from the lowest one of the region.
  int from_low(int axis, int i) const { return place(axis, i) - region_.low[axis]; }
  // Whether the space ahead of the region is in the grid.
  bool known_ahead(int axis) const { return !begins_[axis]; }
  std::uint8_t* row(int y, int z) const { return first_ + y * to_next_row_ + z * to_next_slab_; }
  std::ptrdiff_t to_next_row() const { return to_next_row_; }
  std::ptrdiff_t to_next_slab() const { return to_next_slab_; }

 private:
  int place(int axis, int i) const { return down(axis) ? region_.low[axis] + i : region_.high[axis] - 1 - i; }

  int octant_;
  VoxelBox region_;
  std::uint8_t* first_;
  std::ptrdiff_t to_next_row_, to_next_slab_;
  std::array<bool, 3> begins_{};  // at the grid's border
};

// Loads that straddle recent stores would stall, so this many slabs take turns.
constexpr int kTogether = 8;

// Each slab by itself. Byte stores may alias anything: loop variables are local copies, here and below; otherwise they
// would be reloaded for each row.
template <bool kWhole>
void along_y(const Octant& octant, const Row& rows, const VoxelNearness& along_x) {
  const V one = hn::Set(d8, 1), all = hn::Set(d8, 255);
  const std::ptrdiff_t next = rows.next(), to_ahead = -octant.to_next_row(), to_next_slab = octant.to_next_slab();
  for (int begin = 0; begin < octant.count(2); begin += kTogether) {
    const int slabs = std::min(kTogether, octant.count(2) - begin);
    for (int y = 0; y < octant.count(1); ++y) {
      const bool ahead = y > 0 || octant.known_ahead(1);
      const std::uint8_t* const own_row = along_x.row(octant.from_low(1, y), octant.from_low(2, begin));
      const std::ptrdiff_t to_next_own = octant.down(2) ? along_x.slabs_apart() : -along_x.slabs_apart();
      std::uint8_t* const row = octant.row(y, begin);
      rows.for_each_block([&](const typename Row::Block& block) {
        const std::uint8_t* own = own_row + block.x;
        std::uint8_t* to = row + block.x;
        for (int i = 0; i < slabs; ++i, own += to_next_own, to += to_next_slab) {
          V side = hn::Sub(all, hn::LoadU(d8, own));
          if (ahead) side = hn::Min(side, hn::SaturatedAdd(least(to + to_ahead, next, block.edge), one));
          if (!rows.ends()) {
            const V known = hn::Set(d8, to[rows.ahead() - static_cast<std::ptrdiff_t>(block.x)]);
            side = hn::Min(side, hn::SaturatedAdd(known, block.away));
          }
          store<kWhole>(side, block.size, to);
        }
      });
    }
  }
}

// From slab to slab. `flat` has been processed along y.
template <bool kWhole>
void along_z(const Octant& flat, const Octant& octant, const Row& rows) {
  const V one = hn::Set(d8, 1), all = hn::Set(d8, 255);
  const std::ptrdiff_t next = rows.next(), to_next = octant.to_next_row(), to_ahead = -octant.to_next_slab();
  const int count = octant.count(1);
  for (int z = 0; z < octant.count(2); ++z) {
    const std::uint8_t* const flat_row = flat.row(0, flat.down(2) == octant.down(2) ? z : octant.count(2) - 1 - z);
    std::uint8_t* const row = octant.row(0, z);
    const bool ahead = z > 0 || octant.known_ahead(2);
    rows.for_each_block([&](const typename Row::Block& block) {
      const std::uint8_t* from = flat_row + block.x;
      std::uint8_t* to = row + block.x;
      V before = ahead && octant.known_ahead(1) ? least(to + to_ahead - to_next, next, block.edge) : all;
      for (int y = 0; y < count; ++y, from += to_next, to += to_next) {
        V side = hn::LoadU(d8, from);
        if (ahead) {
          const V beside = least(to + to_ahead, next, block.edge);
          side = hn::Min(side, hn::SaturatedAdd(hn::Min(before, beside), one));
          before = beside;
        }
        store<kWhole>(side, block.size, to);
      }
    });
  }
}

template <bool kWhole>
void build_rows(const OctantRows& which, const VoxelBox& region, const Row& rows, VoxelBytes& sides) {
  const Octant octant(which.octant, region, sides);
  along_y<kWhole>(octant, rows, *which.along_x);
  if (which.and_opposite) along_z<kWhole>(octant, {which.octant ^ 4, region, sides}, rows);
  along_z<kWhole>(octant, octant, rows);
}

void build(const OctantRows& which, const VoxelBox& region, VoxelBytes& sides) {
  const Row rows(region, sides.size(), which.octant & 1);
  rows.whole() ? build_rows<true>(which, region, rows, sides) : build_rows<false>(which, region, rows, sides);
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

void build_octants(const OctantRows& which, const VoxelBox& region, VoxelBytes& sides) {
  HWY_DYNAMIC_DISPATCH(build)(which, region, sides);
}

}  // namespace scarp
#endif
