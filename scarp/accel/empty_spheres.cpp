// SPDX-License-Identifier: MIT
#include "scarp/accel/empty_spheres.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/accel/voxel_rows.h"

namespace scarp {
namespace {

// A square beyond all that count: farther than kFarthest by more than a grid's side.
constexpr std::int32_t kFar = 1 << 20;

// The lower envelope of the parabolas (i - j)^2 + square[j].
class Envelope {
 public:
  explicit Envelope(int most) : centre_(static_cast<std::size_t>(most)), from_(centre_.size()) {}

  // values[i] = min over j < count of (i - j)^2 + square(j), for begin <= i < end.
  template <class Square, class Store>
  void evaluate(int count, const Square& square, int begin, int end, const Store& store) {
    int last = -1;
    for (int j = 0; j < count; ++j) {
      const std::int64_t height = square(j);
      if (height >= kFar) continue;
      int from = std::numeric_limits<int>::min();
      while (last >= 0) {
        // From where on j's parabola is no higher than that of the last centre.
        const std::int64_t i = centre_[last], rise = height + std::int64_t{j} * j - square(static_cast<int>(i)) - i * i;
        from = static_cast<int>(std::ceil(static_cast<double>(rise) / static_cast<double>(2 * (j - i))));
        if (from > from_[last]) break;
        --last;
        from = std::numeric_limits<int>::min();
      }
      ++last;
      centre_[last] = j;
      from_[last] = from;
    }
    for (int i = begin, k = 0; i < end; ++i) {
      if (last < 0) {
        store(i, kFar);
        continue;
      }
      while (k < last && from_[k + 1] <= i) ++k;
      const int away = i - centre_[k];
      store(i, std::min(kFar, away * away + square(centre_[k])));
    }
  }

 private:
  std::vector<int> centre_, from_;
};

}  // namespace

EmptySpheres::EmptySpheres(const VoxelGrid& grid) : distances_(glm::min(grid.size(), kMaxAcceleratedSide), kFarthest) {
  require_accelerable(grid, "empty spheres");
  build(grid, grid.box());
  largest_ = largest_in(grid.box());
}

void EmptySpheres::update(const VoxelGrid& grid, const VoxelBox& changed) {
  if (changed.empty()) return;
  // Distances of boxes are rounded down, and a voxel less than those of coordinates.
  const VoxelBox region = intersection(changed.grown(largest_ + 2), grid.box());
  build(grid, region);
  largest_ = std::max(largest_, largest_in(region));
}

int EmptySpheres::largest_in(const VoxelBox& box) const {
  int largest = 0;
  for_each_voxel(box, [&](const ivec3& v) {
    if (distances_[v] != kSolid) largest = std::max<int>(largest, distances_[v]);
  });
  return largest;
}

void EmptySpheres::build(const VoxelGrid& grid, const VoxelBox& region) {
  VoxelRows grown(grid);
  grown.dilate();
  // What is farther away does not count.
  const VoxelBox window = intersection(region.grown(kFarthest + 2), grid.box());
  const ivec3 inner = region.high - region.low, outer = window.high - window.low;
  // Squares of distances for x in the region and (y, z) in the window; then for y in the region, too.
  std::vector<std::int32_t> squares(static_cast<std::size_t>(inner.x) * static_cast<std::size_t>(outer.y) *
                                    static_cast<std::size_t>(outer.z));
  const auto at = [&](int x, int y, int z) -> std::int32_t& {
    return squares[static_cast<std::size_t>(x) +
                   static_cast<std::size_t>(inner.x) *
                       (static_cast<std::size_t>(y) + static_cast<std::size_t>(outer.y) * static_cast<std::size_t>(z))];
  };
  std::vector<std::int32_t> line(static_cast<std::size_t>(std::max(outer.x, std::max(outer.y, outer.z))));
  for (int z = 0; z < outer.z; ++z) {
    for (int y = 0; y < outer.y; ++y) {
      constexpr std::int32_t kNone = 2048;
      std::int32_t distance = kNone;
      for (int x = 0; x < outer.x; ++x) {
        distance = grown.test(window.low + ivec3(x, y, z)) ? 0 : distance + 1;
        line[x] = distance;
      }
      distance = kNone;
      for (int x = outer.x - 1; x >= 0; --x) {
        distance = grown.test(window.low + ivec3(x, y, z)) ? 0 : distance + 1;
        line[x] = std::min(line[x], distance);
      }
      const int first = region.low.x - window.low.x;
      for (int x = 0; x < inner.x; ++x) {
        const std::int32_t away = line[first + x];
        at(x, y, z) = away >= kNone ? kFar : away * away;
      }
    }
  }
  Envelope envelope(static_cast<int>(line.size()));
  const ivec3 shift = region.low - window.low;
  for (int z = 0; z < outer.z; ++z) {
    for (int x = 0; x < inner.x; ++x) {
      envelope.evaluate(
          outer.y, [&](int y) { return at(x, y, z); }, shift.y, shift.y + inner.y,
          [&](int y, std::int32_t square) { line[y] = square; });
      for (int y = shift.y; y < shift.y + inner.y; ++y) at(x, y, z) = line[y];
    }
  }
  for (int y = 0; y < inner.y; ++y) {
    for (int x = 0; x < inner.x; ++x) {
      envelope.evaluate(
          outer.z, [&](int z) { return at(x, shift.y + y, z); }, shift.z, shift.z + inner.z,
          [&](int z, std::int32_t square) {
            const ivec3 voxel = region.low + ivec3(x, y, z - shift.z);
            // Whole squares have exact roots.
            const int distance = std::min(kFarthest, static_cast<int>(std::sqrt(static_cast<double>(square))));
            distances_[voxel] = static_cast<std::uint8_t>(grid.solid(voxel) ? kSolid : distance);
          });
    }
  }
}

}  // namespace scarp
