// SPDX-License-Identifier: MIT
// Content of files of listed voxels, in any format: parts, each with its voxels and their colours.
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
  ivec3 low{0};   ///< of the box in the file's space, after its axes were turned
  ivec3 size{1};  ///< each 1..kMaxPartSide
  std::vector<ListedVoxel> voxels;
  /// The file's own coordinates: a corner p of the box is file_turn(p) + file_origin there. Files mirror axes.
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
/// Voxels of a file; limits the size of run-length encoded data of a few bytes.
constexpr std::size_t kMostListedVoxels = std::size_t{1} << 26;

/// Returns whether the ending of a file is one of these formats: .qb, .kv6, .vxl.
bool is_voxel_parts_path(std::string_view path);
/// Returns whether a file is one that read_voxel_parts() reads, by its ending and, for .vox, its first bytes.
bool is_voxel_parts_file(const std::string& path);
/// Reads a .qb, .kv6 or .vxl file, or a .vox file of Voxlap. Throws Error naming the file.
VoxelParts read_voxel_parts(const std::string& path);

}  // namespace scarp
