// SPDX-License-Identifier: MIT
#include "bench/voxel_hash.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace scarp::bench {

VoxelHash::VoxelHash(const VoxelGrid& grid, bool surface_only) : bits_(grid.entry_bits()) {
  std::vector<ivec3> voxels;
  for_each_voxel(grid.bounds(), [&](const ivec3& v) {
    if (!grid.solid(v)) return;
    bool seen = !surface_only;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        ivec3 beside = v;
        beside[axis] += step;
        seen = seen || !grid.box().contains(beside) || !grid.solid(beside);
      }
    }
    if (seen) voxels.push_back(v);
  });
  count_ = voxels.size();
  // The smallest table that fits all voxels, with a sixth as many offsets, increased until an assignment is found.
  const double side = std::cbrt(static_cast<double>(std::max<std::size_t>(count_, 1)));
  for (m_ = 1; static_cast<std::size_t>(m_) * m_ * m_ < count_;) ++m_;
  for (r_ = std::max(1, static_cast<int>(std::ceil(side / std::cbrt(6.0)))); !build(voxels); ++r_) {
  }
  words_.resize((static_cast<std::size_t>(m_) * m_ * m_ * bits_ + 63) / 64 + 1);
  for (const ivec3& v : voxels) {
    const std::array<std::uint8_t, 3>& offset = offsets_[index(v, r_)];
    const std::size_t first = index(v + ivec3(offset[0], offset[1], offset[2]), m_) * static_cast<std::size_t>(bits_);
    const std::uint64_t entry = grid.entry(v);
    words_[first / 64] |= entry << (first % 64);
    if (first % 64 != 0) words_[first / 64 + 1] |= entry >> (64 - first % 64);
  }
}

std::uint32_t VoxelHash::packed(std::size_t place) const {
  const std::size_t first = place * static_cast<std::size_t>(bits_), shift = first % 64;
  std::uint64_t value = words_[first / 64] >> shift;
  if (shift != 0) value |= words_[first / 64 + 1] << (64 - shift);
  return static_cast<std::uint32_t>(value & ((std::uint64_t{1} << bits_) - 1));
}

// Largest buckets first: each takes the first offset at which none of its voxels collides.
bool VoxelHash::build(const std::vector<ivec3>& voxels) {
  // With a common divisor, offsets might not separate some voxels.
  if (m_ > 1 && std::gcd(m_, r_) != 1) return false;
  const std::size_t places = static_cast<std::size_t>(m_) * m_ * m_, buckets = static_cast<std::size_t>(r_) * r_ * r_;
  std::vector<std::vector<ivec3>> of(buckets);
  for (const ivec3& v : voxels) of[index(v, r_)].push_back(v);
  std::vector<std::size_t> order(buckets);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return of[a].size() > of[b].size(); });
  offsets_.assign(buckets, {});
  std::vector<bool> taken(places);
  std::vector<std::size_t> mine;
  std::size_t start = 0;
  for (const std::size_t bucket : order) {
    if (of[bucket].empty()) break;
    bool found = false;
    for (std::size_t i = 0; i < places && !found; ++i) {
      // Starts from a position that differs from bucket to bucket.
      const auto at = static_cast<int>((start + i) % places);
      const ivec3 offset(at % m_, at / m_ % m_, at / m_ / m_);
      mine.clear();
      found = true;
      for (const ivec3& v : of[bucket]) {
        const std::size_t place = index(v + offset, m_);
        found = found && !taken[place] && std::find(mine.begin(), mine.end(), place) == mine.end();
        if (!found) break;
        mine.push_back(place);
      }
      if (!found) continue;
      for (const std::size_t place : mine) taken[place] = true;
      offsets_[bucket] = {static_cast<std::uint8_t>(offset.x), static_cast<std::uint8_t>(offset.y),
                          static_cast<std::uint8_t>(offset.z)};
    }
    if (!found) return false;
    start += 7919;
  }
  return true;
}

}  // namespace scarp::bench
