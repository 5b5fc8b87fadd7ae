// SPDX-License-Identifier: MIT
// Colours of voxels by a perfect spatial hash, the 3-D hash that the founding post proposes: compared with the rank of
// VoxelGrid.
//
//   place(p) = (p + offset[p mod r]) mod m     m^3 places for n voxels, r^3 offsets, no two voxels in one place
//
// A bit states whether a voxel is solid, so no key is stored. Source: S. Lefebvre, H. Hoppe, "Perfect spatial hashing",
// SIGGRAPH 2006. Cost: entry_bits per place and three bytes per offset; building it is a search.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "scarp/field/voxel_grid.h"

namespace scarp::bench {

class VoxelHash {
 public:
  /// Hashes the solid voxels, or only those with an empty neighbour.
  VoxelHash(const VoxelGrid& grid, bool surface_only);

  /// The entry of a hashed voxel.
  std::uint32_t entry(const ivec3& voxel) const {
    const std::array<std::uint8_t, 3>& offset = offsets_[index(voxel, r_)];
    return packed(index(voxel + ivec3(offset[0], offset[1], offset[2]), m_));
  }
  std::size_t voxels() const { return count_; }
  std::size_t bytes() const {
    return sizeof(*this) + offsets_.size() * sizeof(offsets_[0]) + words_.size() * sizeof(std::uint64_t);
  }

 private:
  static std::size_t index(const ivec3& v, int side) {
    return static_cast<std::size_t>(v.x % side + side * (v.y % side + side * (v.z % side)));
  }
  std::uint32_t packed(std::size_t place) const;
  bool build(const std::vector<ivec3>& voxels);

  int m_, r_, bits_;
  std::size_t count_;
  std::vector<std::array<std::uint8_t, 3>> offsets_;
  std::vector<std::uint64_t> words_;
};

}  // namespace scarp::bench
