// SPDX-License-Identifier: MIT
// One byte per voxel: storage of voxel accelerators.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "scarp/field/voxel_grid.h"

namespace scarp {

/// Maximum grid side for accelerators with bytes per voxel.
constexpr int kMaxAcceleratedSide = 512;

/// Throws Error, naming `what` and its size in bytes, if a side exceeds kMaxAcceleratedSide.
void require_accelerable(const ivec3& size, std::string_view what, int bytes_per_voxel = 1);

/// Bytes of a grid, x fastest.
class VoxelBytes {
 public:
  VoxelBytes(const ivec3& size, std::uint8_t value)
      : size_(size),
        bytes_(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z) +
                   2 * kReadBeyond,
               value) {}

  std::size_t index(const ivec3& voxel) const {
    return static_cast<std::size_t>(voxel.x) +
           static_cast<std::size_t>(size_.x) * (static_cast<std::size_t>(voxel.y) +
                                                static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(voxel.z));
  }
  std::uint8_t operator[](const ivec3& voxel) const { return *at(voxel); }
  std::uint8_t& operator[](const ivec3& voxel) { return *at(voxel); }
  const std::uint8_t* at(const ivec3& voxel) const { return data() + index(voxel); }
  std::uint8_t* at(const ivec3& voxel) { return bytes_.data() + kReadBeyond + index(voxel); }

  const ivec3& size() const { return size_; }
  VoxelBox box() const { return {ivec3(0), size_}; }
  /// First voxel. kReadBeyond bytes before it and after the last one are readable, for vector code.
  const std::uint8_t* data() const { return bytes_.data() + kReadBeyond; }
  static constexpr std::size_t kReadBeyond = 64;
  std::size_t bytes() const { return bytes_.size(); }
  friend bool operator==(const VoxelBytes&, const VoxelBytes&) = default;

 private:
  ivec3 size_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace scarp
