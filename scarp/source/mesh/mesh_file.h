// SPDX-License-Identifier: MIT
// Triangle meshes from files: Wavefront OBJ (with its .mtl) and glTF 2.0 (.gltf, .glb).
//
// Reads triangles (polygons are split, strips and fans expanded), normals and plain colours: in OBJ, `Kd` of .mtl and
// colours after the coordinates of `v`; in glTF, base colours of materials and the first colours of vertices. glTF
// nodes are placed as in the default scene. Textures, animations, points and lines are ignored and reported in a note.
// Requires a build with tinyobjloader and tinygltf (SCARP_MESH).
#pragma once

#include <string>
#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

/// Default colour of surfaces, in linear light.
constexpr vec3 kMeshGrey(0.6f);

/// A vertex of a triangle.
struct MeshCorner {
  dvec3 position;          ///< in the file's units, z up; finite
  vec3 normal;             ///< unit length; the triangle's plane normal if the file has none
  vec3 colour{kMeshGrey};  ///< linear light, 0..1
};

/// Triangles read from a file.
struct TriangleMesh {
  std::vector<MeshCorner> corners;  ///< three per triangle; at least one triangle, and none with zero area
  std::vector<std::string> notes;   ///< what was ignored
};

enum class MeshUp { y, z };

/// Reads a mesh. `up` is the axis that points up in the file; glTF prescribes y. Throws Error naming the file, in one
/// line: unreadable or damaged, another format, coordinates that are not finite numbers, missing vertices, no
/// triangles, an unsupported required glTF extension, a build without meshes.
TriangleMesh read_mesh(const std::string& path, MeshUp up = MeshUp::y);

}  // namespace scarp
