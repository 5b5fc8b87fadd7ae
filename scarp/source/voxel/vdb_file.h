// SPDX-License-Identifier: MIT
// Voxels from OpenVDB (.vdb) and NanoVDB (.nvdb) files.
//
//   level set (float, double)   solid where the value is negative, including the interior that the narrow band encloses
//   bool or mask grid           solid where active
//   Vec3 grid                   colours in linear light. Alone in a file, it is solid where active
//
// The reader is a separate module (vdb_module.h), which is loaded for the first such file: OpenVDB takes as long to
// start as the rest of the program.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

/// Red, green, blue; sRGB.
using VdbColour = std::array<std::uint8_t, 3>;

/// 8 x 8 x 8 voxels: eight bricks of 4 x 4 x 4, x fastest, each with bit x + 4 y + 16 z.
struct VdbLeaf {
  ivec3 low{0};  ///< multiples of 8
  std::array<std::uint64_t, 8> solid{};
};

/// A completely solid cube.
struct VdbTile {
  ivec3 low{0};  ///< multiples of 8, like the side
  int side = 8;
};

/// Solid voxels by their integer coordinates. Leaves and tiles do not overlap.
struct VdbVoxels {
  std::string format, grid, kind;  ///< for users: "OpenVDB", the grid's name, "level set"
  std::vector<VdbLeaf> leaves;
  std::vector<VdbTile> tiles;
  std::vector<VdbColour>
      colours;                  ///< of the leaves' solid voxels, leaf by leaf in the order of bricks and bits; or none
  dmat3 world_from_index{1.0};  ///< a rotation or reflection, times the side of a voxel
  dvec3 origin{0.0};            ///< centre of voxel (0, 0, 0) in the file's space
  std::vector<std::string> notes;  ///< for users, one line each
};

/// Maximum number of voxels per axis in a file, the same as for grids.
constexpr int kMaxVdbSide = 16384;

/// Returns whether the extension is .vdb or .nvdb.
bool is_vdb_path(std::string_view path);
/// Throws Error naming the file: not readable, no grid, no grid of these kinds, voxels that are not cubes, more than
/// kMaxVdbSide voxels along an axis, or Scarp was built without OpenVDB.
VdbVoxels read_vdb(const std::string& path);
/// Writes a .vdb file with a bool grid, `solid`. Colours are not written. Throws Error naming the file: it cannot be
/// written, the disk is full, or Scarp was built without OpenVDB.
void write_vdb(const std::string& path, const VdbVoxels& voxels);

}  // namespace scarp
