// SPDX-License-Identifier: MIT
// Private to the station: limits the memory of grids and accelerators before it is allocated.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "scarp/base/error.h"

namespace scarp {

/// Number of voxels that readers add to a grid at once. Limits the memory in use.
inline constexpr std::size_t kVoxelsAtOnce = std::size_t{1} << 20;

class VoxelMemory {
 public:
  /// `voxels`: number of voxels listed in the file. Grids may take 1 GiB or, if that is more, 16 bytes per voxel: four
  /// times the size of a voxel in a .vox file.
  explicit VoxelMemory(std::int64_t voxels) : most_(std::max(std::int64_t{1} << 30, 16 * voxels)) {}

  /// Throws Error with the remedy if the sum exceeds the limit.
  void add(std::int64_t bytes, std::string_view remedy) {
    bytes_ += bytes;
    if (bytes_ <= most_) return;
    throw Error(
        fmt::format("its voxels need more than {:.2g} GB of memory ({})", static_cast<double>(most_) / 1e9, remedy));
  }

 private:
  std::int64_t most_, bytes_ = 0;
};

}  // namespace scarp
