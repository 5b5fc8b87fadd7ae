// SPDX-License-Identifier: MIT
// Triangle meshes from files: Wavefront OBJ (with its .mtl) and glTF 2.0 (.gltf, .glb).
//
// What is read: triangles (polygons are cut into some, strips and fans unrolled), normals, plain colours: `Kd` of .mtl
// and colours behind the coordinates of `v` in OBJ; base colours of materials and the first colours of corners in glTF,
// whose nodes are put where the default scene has them. Textures, animations and what is no triangle are left out, and
// a note says so. Needs a build with tinyobjloader and tinygltf (SCARP_MESH).
#pragma once

#include <string>
#include <vector>

#include "scarp/base/vec.h"

namespace scarp {

/// What has no colour of its own, in linear light.
constexpr vec3 kMeshGrey(0.6f);

struct MeshCorner {
  dvec3 position;          ///< in the file's units, z up; finite
  vec3 normal;             ///< unit; of the triangle's plane where the file has none
  vec3 colour{kMeshGrey};  ///< linear light, 0..1
};

struct TriangleMesh {
  std::vector<MeshCorner> corners;  ///< three per triangle, none without area; at least one triangle
  std::vector<std::string> notes;   ///< what was left out
};

enum class MeshUp { y, z };

/// `up` is the axis that points up in the file; glTF says y. Throws Error naming the file, in one line: unreadable or
/// damaged, another format, coordinates that are no finite numbers, corners that are not there, no triangles, an
/// extension of glTF that is needed and not known, a build without meshes.
TriangleMesh read_mesh(const std::string& path, MeshUp up = MeshUp::y);

}  // namespace scarp
