// SPDX-License-Identifier: MIT
// Contents of files that list voxels, in any format: parts, each with its voxels and their colours.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scarp/base/lattice_rotation.h"
#include "scarp/base/vec.h"

namespace scarp {

/// A voxel of a part.
struct ListedVoxel {
  std::int16_t x = 0, y = 0, z = 0;
  std::array<std::uint8_t, 3> colour{};  ///< red, green, blue
  friend bool operator==(const ListedVoxel&, const ListedVoxel&) = default;
};

/// Voxels in a box, right-handed, z up, each at most once.
struct VoxelPart {
  ivec3 low{0};   ///< lowest corner of the box in the file's space, after its axes were turned
  ivec3 size{1};  ///< each 1..kMaxPartSide
  std::vector<ListedVoxel> voxels;
  /// Converts to the file's own coordinates: a corner p of the box is at file_turn(p) + file_origin there. Some files
  /// mirror axes.
  LatticeRotation file_turn{};
  ivec3 file_origin{0};
};

/// The contents of a file.
struct VoxelParts {
  std::string format;
  std::vector<VoxelPart> parts;
  std::vector<std::string> notes;  ///< for users, one line each
};

constexpr int kMaxPartSide = 2048;
/// Maximum number of voxels in a file; it limits the size to which a few bytes of run-length encoded data can expand.
constexpr std::size_t kMostListedVoxels = std::size_t{1} << 26;

/// Returns whether the file's extension is .qb, .kv6 or .vxl.
bool is_voxel_parts_path(std::string_view path);
/// Returns whether read_voxel_parts() reads this file, judging by its extension and, for .vox, its first bytes.
bool is_voxel_parts_file(const std::string& path);
/// Reads a .qb, .kv6 or .vxl file, or a Voxlap .vox file. Throws Error naming the file.
VoxelParts read_voxel_parts(const std::string& path);

}  // namespace scarp
