// SPDX-License-Identifier: MIT
#include "scarp/accel/empty_cubes.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "scarp/accel/voxel_nearness.h"
#include "scarp/accel/voxel_rows.h"

namespace scarp {
namespace {

// Eight bytes, 1 for each bit that is 0.
constexpr std::array<std::uint64_t, 256> make_zeros() {
  std::array<std::uint64_t, 256> zeros{};
  for (unsigned bits = 0; bits < 256; ++bits) {
    for (unsigned i = 0; i < 8; ++i) zeros[bits] |= std::uint64_t{~bits >> i & 1} << (8 * i);
  }
  return zeros;
}
constexpr std::array<std::uint64_t, 256> kZeros = make_zeros();

}  // namespace

EmptyCubes::EmptyCubes(const VoxelGrid& grid, CubeBuilder builder)
    : distances_(glm::min(grid.size(), kMaxAcceleratedSide), kFarthest) {
  require_accelerable(grid.size(), "empty cubes");
  if (grid.solid_count() == 0) return;
  switch (builder) {
    case CubeBuilder::rows:
      rows(grid, grid.box());
      break;
    case CubeBuilder::bit_parallel:
      bit_parallel(grid);
      break;
    case CubeBuilder::summed_area:
      summed_area(grid);
      break;
  }
}

void EmptyCubes::update(const VoxelGrid& grid, const VoxelBox& changed) {
  if (changed.empty()) return;
  // A voxel changes if its nearest solid voxel was in the box, or is there now and is nearer than before: at most its
  // previous distance away. If everything around the box is nearer to other solid voxels, that bounds the region.
  int reach = 1;
  for (;; reach *= 2) {
    const VoxelBox region = intersection(changed.grown(reach), grid.box());
    if (region == grid.box() || reach >= kFarthest) break;
    // The outermost voxels of the region: none of them may be as far from solid voxels as from the edit.
    bool nearer = true;
    for (int axis = 0; axis < 3 && nearer; ++axis) {
      for (const bool up : {false, true}) {
        VoxelBox side = region;
        (up ? side.low : side.high)[axis] = up ? region.high[axis] - 1 : region.low[axis] + 1;
        const int away = up ? side.low[axis] - (changed.high[axis] - 1) : changed.low[axis] - side.low[axis];
        // There is nothing beyond the border of the grid.
        if (up ? region.high[axis] == grid.size()[axis] : region.low[axis] == 0) continue;
        for_each_voxel(side, [&](const ivec3& v) { nearer = nearer && distances_[v] < away; });
      }
    }
    if (nearer) break;
  }
  rows(grid, intersection(changed.grown(std::min(reach, kFarthest)), grid.box()));
}

void EmptyCubes::rows(const VoxelGrid& grid, const VoxelBox& region) {
  const VoxelBox seen = intersection(region.grown(1), grid.box());
  VoxelNearness near(grid, seen);
  // Distances beyond the region's border are known.
  for_each_row(seen, [&](int y, int z) {
    std::uint8_t* const row = near.row(y - seen.low.y, z - seen.low.z);
    const bool inner = y >= region.low.y && y < region.high.y && z >= region.low.z && z < region.high.z;
    for (int x = seen.low.x; x < seen.high.x; ++x) {
      if (inner && x == region.low.x) x = region.high.x;
      if (x < seen.high.x) row[x - seen.low.x] = static_cast<std::uint8_t>(kFarthest - distances_[{x, y, z}]);
    }
  });
  near.spread();
  near.write_far(region, kFarthest, distances_);
}

void EmptyCubes::bit_parallel(const VoxelGrid& grid) {
  VoxelRows rows(grid);
  const ivec3& size = grid.size();
  const std::size_t groups = (static_cast<std::size_t>(size.x) + 7) / 8;
  // Eight counters per word; each row starts a new word.
  std::vector<std::uint64_t> counters(groups * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z));
  for (int round = 0; round < kFarthest && !rows.full(); ++round) {
    if (round > 0) rows.dilate();
    std::uint64_t* counter = counters.data();
    for (std::size_t begin = 0; begin < rows.words.size(); begin += rows.words_per_row) {
      for (std::size_t i = 0; i < groups; ++i) *counter++ += kZeros[rows.words[begin + i / 8] >> (8 * (i % 8)) & 255];
    }
  }
  const std::uint64_t* counter = counters.data();
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y, counter += groups)
      std::memcpy(distances_.at({0, y, z}), counter, static_cast<std::size_t>(size.x));
  }
}

void EmptyCubes::summed_area(const VoxelGrid& grid) {
  const ivec3 size = grid.size(), corners = size + 1;
  std::vector<std::int64_t> sums(static_cast<std::size_t>(corners.x) * static_cast<std::size_t>(corners.y) *
                                 static_cast<std::size_t>(corners.z));
  const auto sum = [&](int x, int y, int z) -> std::int64_t& {
    return sums[static_cast<std::size_t>(x) +
                static_cast<std::size_t>(corners.x) *
                    (static_cast<std::size_t>(y) + static_cast<std::size_t>(corners.y) * static_cast<std::size_t>(z))];
  };
  for_each_voxel(grid.box(), [&](const ivec3& v) {
    const auto [x, y, z] = std::array{v.x, v.y, v.z};
    sum(x + 1, y + 1, z + 1) = grid.solid(v) + sum(x, y + 1, z + 1) + sum(x + 1, y, z + 1) + sum(x + 1, y + 1, z) -
                               sum(x, y, z + 1) - sum(x, y + 1, z) - sum(x + 1, y, z) + sum(x, y, z);
  });
  const auto solid_in = [&](const VoxelBox& box) {
    const VoxelBox b = intersection(box, grid.box());
    return sum(b.high.x, b.high.y, b.high.z) - sum(b.low.x, b.high.y, b.high.z) - sum(b.high.x, b.low.y, b.high.z) -
           sum(b.high.x, b.high.y, b.low.z) + sum(b.low.x, b.low.y, b.high.z) + sum(b.low.x, b.high.y, b.low.z) +
           sum(b.high.x, b.low.y, b.low.z) - sum(b.low.x, b.low.y, b.low.z);
  };
  for_each_voxel(grid.box(), [&](const ivec3& v) {
    // The least radius whose cube is not empty.
    int empty = -1, full = kFarthest;
    while (full - empty > 1) {
      const int radius = (empty + full) / 2;
      (solid_in(VoxelBox{v, v + 1}.grown(radius)) == 0 ? empty : full) = radius;
    }
    distances_[v] = static_cast<std::uint8_t>(full);
  });
}

}  // namespace scarp
