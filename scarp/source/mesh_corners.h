// SPDX-License-Identifier: MIT
// Private to the station: how readers of mesh files put triangles together.
#pragma once

#include <array>
#include <string>

#include "scarp/source/mesh_file.h"

namespace scarp {

/// A corner as a file has it; a normal of 0 is none.
struct FileCorner {
  dvec3 position{0.0};
  dvec3 normal{0.0};
  vec3 colour{kMeshGrey};
};

/// Appends a triangle, as the file has its axes; with the normal of its plane unless all three corners have one.
/// Nothing where it has no area.
void add_triangle(const std::array<FileCorner, 3>& corners, TriangleMesh& mesh);

/// Throws Error.
[[noreturn]] void refuse_mesh(const std::string& path, const std::string& what);

// In files of their own; axes as in the file.
TriangleMesh read_obj(const std::string& path);
TriangleMesh read_gltf(const std::string& path, bool binary);

}  // namespace scarp
