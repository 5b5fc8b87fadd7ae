// SPDX-License-Identifier: MIT
#include "scarp/source/mesh/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/input_file.h"
#include "scarp/source/incomplete_file.h"
#include "scarp/source/mesh/mesh_corners.h"

namespace scarp {

void refuse_mesh(const std::string& path, const std::string& what) { throw Error(fmt::format("{}: {}", path, what)); }

void add_triangle(const std::array<FileCorner, 3>& corners, TriangleMesh& mesh) {
  const dvec3 across = cross(corners[1].position - corners[0].position, corners[2].position - corners[0].position);
  const double area = length(across);
  if (!(area > 0)) return;
  const bool has_normals =
      std::all_of(corners.begin(), corners.end(), [](const FileCorner& corner) { return length(corner.normal) > 0; });
  for (const FileCorner& corner : corners) {
    mesh.corners.push_back({corner.position, vec3(has_normals ? normalize(corner.normal) : across / area),
                            glm::clamp(corner.colour, 0.0f, 1.0f)});
  }
}

#ifdef SCARP_MESH

namespace {

void require_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) refuse_mesh(path, "is a directory");
  if (!std::filesystem::exists(path, error)) refuse_mesh(path, "cannot be opened");
  refuse_special_file(path, path + ": ");
  // Streams can be read only once.
  if (!std::filesystem::is_regular_file(path, error)) return;
  std::string start(kLfsPointer.size(), '\0');
  std::ifstream(path, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start == kLfsPointer) refuse_mesh(path, kLfsAdvice);
}

}  // namespace

TriangleMesh read_mesh(const std::string& path, MeshUp up) {
  const std::string extension = extension_of(path);
  const bool binary = extension == ".glb", gltf = binary || extension == ".gltf";
  if (!gltf && extension != ".obj") refuse_mesh(path, "unknown mesh format (the name must end in .obj, .gltf or .glb)");
  require_file(path);
  TriangleMesh mesh = gltf ? read_gltf(path, binary) : read_obj(path);
  if (mesh.corners.empty()) {
    refuse_mesh(path, mesh.notes.empty() ? "no triangles" : fmt::format("no triangles ({})", mesh.notes.back()));
  }
  if (up == MeshUp::z) return mesh;
  for (MeshCorner& corner : mesh.corners) {
    corner.position = {corner.position.x, -corner.position.z, corner.position.y};
    corner.normal = {corner.normal.x, -corner.normal.z, corner.normal.y};
  }
  return mesh;
}

#else

TriangleMesh read_mesh(const std::string& path, MeshUp) {
  refuse_mesh(path, "this build of Scarp does not read meshes (build with -D SCARP_MESH=ON)");
}

#endif

}  // namespace scarp
