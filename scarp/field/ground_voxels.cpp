// SPDX-License-Identifier: MIT
#include "scarp/field/ground_voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

// Tops of columns, with summaries for each brick.
class Columns {
 public:
  Columns(const ivec3& size, std::span<const std::int32_t> tops)
      : size_(size), tops_(tops), bricks_((size + 3) / 4), of_brick_(to_size(bricks_.x) * to_size(bricks_.y)) {
    parallel_for(bricks_.y, 4, [&](std::int64_t begin, std::int64_t end) {
      for (auto y = static_cast<int>(begin); y < end; ++y) {
        for (int x = 0; x < bricks_.x; ++x) of_brick_[to_size(x) + to_size(bricks_.x) * to_size(y)] = tops_in(x, y);
      }
    });
  }

  /// Returns the top of a column, 0 outside the grid.
  int top(int x, int y) const {
    return x < 0 || y < 0 || x >= size_.x || y >= size_.y ? 0 : tops_[to_size(x) + to_size(size_.x) * to_size(y)];
  }
  /// Voxels below this height are hidden: the lowest neighbour's top, or the column's top voxel if that is lower.
  int hidden_below(int x, int y) const {
    return std::min({top(x, y) - 1, top(x - 1, y), top(x + 1, y), top(x, y - 1), top(x, y + 1)});
  }
  VoxelGrid::Contents contents(const VoxelBox& box) const {
    int highest = 0, hidden = size_.z;
    const int end_x = std::min(box.high.x / 4, bricks_.x), end_y = std::min(box.high.y / 4, bricks_.y);
    for (int y = box.low.y / 4; y < end_y; ++y) {
      for (int x = box.low.x / 4; x < end_x; ++x) {
        const Tops& tops = of_brick_[to_size(x) + to_size(bricks_.x) * to_size(y)];
        highest = std::max(highest, tops.highest);
        hidden = std::min(hidden, tops.hidden);
      }
    }
    if (box.low.z >= highest) return VoxelGrid::Contents::empty;
    return box.high.z <= hidden ? VoxelGrid::Contents::full : VoxelGrid::Contents::mixed;
  }

 private:
  struct Tops {
    int highest = 0, hidden = 0;
  };
  static std::size_t to_size(int i) { return static_cast<std::size_t>(i); }

  Tops tops_in(int brick_x, int brick_y) const {
    Tops tops{0, size_.z};
    for (int y = 4 * brick_y; y < std::min(4 * brick_y + 4, size_.y); ++y) {
      for (int x = 4 * brick_x; x < std::min(4 * brick_x + 4, size_.x); ++x) {
        tops.highest = std::max(tops.highest, top(x, y));
        tops.hidden = std::min(tops.hidden, hidden_below(x, y));
      }
    }
    return tops;
  }

  ivec3 size_;
  std::span<const std::int32_t> tops_;
  ivec3 bricks_;
  std::vector<Tops> of_brick_;
};

}  // namespace

VoxelGrid ground_voxels(const ivec3& size, std::span<const std::int32_t> tops, int entry_bits,
                        const std::function<std::uint32_t(const ivec3&)>& entry) {
  VoxelGrid::require_size(size, entry_bits);
  if (static_cast<std::int64_t>(tops.size()) != std::int64_t{size.x} * size.y)
    throw Error(fmt::format("ground of voxels: {} tops for {} x {} columns", tops.size(), size.x, size.y));
  for (const std::int32_t top : tops) {
    if (top < 0 || top > size.z)
      throw Error(fmt::format("ground of voxels: a top of {} (must be 0 to {})", top, size.z));
  }
  const Columns columns(size, tops);
  VoxelGrid::Source source;
  source.contents = [&](const VoxelBox& page) { return columns.contents(page); };
  source.fill = [&](const ivec3& brick, std::span<std::uint32_t, 64> entries) {
    VoxelGrid::Brick filled;
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 4; ++x) {
        const ivec3 low = 4 * brick + ivec3(x, y, 0);
        const int top = columns.top(low.x, low.y) - low.z, hidden = columns.hidden_below(low.x, low.y) - low.z;
        for (int z = 0; z < std::min(top, 4); ++z) {
          const int bit = x + 4 * y + 16 * z;
          filled.solid |= std::uint64_t{1} << bit;
          if (z < hidden) continue;
          filled.coloured |= std::uint64_t{1} << bit;
          entries[static_cast<std::size_t>(bit)] = entry(low + ivec3(0, 0, z));
        }
      }
    }
    return filled;
  };
  return VoxelGrid::built(size, entry_bits, source);
}

}  // namespace scarp
