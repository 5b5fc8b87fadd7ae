// SPDX-License-Identifier: MIT
// Private to the station: how mesh readers assemble triangles.
#pragma once

#include <array>
#include <string>

#include "scarp/source/mesh/mesh_file.h"

namespace scarp {

/// A corner as stored in the file; a zero normal means none.
struct FileCorner {
  dvec3 position{0.0};
  dvec3 normal{0.0};
  vec3 colour{kMeshGrey};
};

/// Appends a triangle in the file's axes; uses the normal of its plane unless all three corners have normals. Skips
/// triangles with zero area.
void add_triangle(const std::array<FileCorner, 3>& corners, TriangleMesh& mesh);

/// Throws Error naming the file.
[[noreturn]] void refuse_mesh(const std::string& path, const std::string& what);

// Readers, each in its own source file; axes as in the mesh file.
TriangleMesh read_obj(const std::string& path);
TriangleMesh read_gltf(const std::string& path, bool binary);

}  // namespace scarp
