// SPDX-License-Identifier: MIT
#include "scarp/accel/empty_cubes.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "scarp/accel/cube_edit.h"
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
      rows(grid);
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
  const VoxelBox box = intersection(changed, grid.box());
  if (!box.empty()) update_cubes(VoxelNearness(grid, box), box, distances_);
}

void EmptyCubes::rows(const VoxelGrid& grid) {
  VoxelNearness near(grid, grid.box());
  near.spread();
  near.write_far(grid.box(), kFarthest, distances_);
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
    // Searches for the smallest radius whose cube is not empty.
    int empty = -1, full = kFarthest;
    while (full - empty > 1) {
      const int radius = (empty + full) / 2;
      (solid_in(VoxelBox{v, v + 1}.grown(radius)) == 0 ? empty : full) = radius;
    }
    distances_[v] = static_cast<std::uint8_t>(full);
  });
}

}  // namespace scarp
