// SPDX-License-Identifier: MIT
// A triangle mesh as a field of a scene, traced by Embree 3 on the CPU:
//
//   TriangleMesh mesh = read_mesh("tower.obj");
//   const Placement place = mesh_placement(mesh, {.at = {500, 300, 1200}});
//   fields.push_back(scene_mesh(std::move(mesh)));
//
// Rays hit both sides of a triangle. within() works for closed meshes, in which every edge belongs to an even number of
// triangles; it finds nothing in other meshes.
//
// Guarantee: approximate. Embree finds the triangle in float32 with its robust setting, so neighbours leave no gaps,
// but which triangle is hit near an edge, and whether a silhouette is hit at all, is uncertain within kMeshRounding of
// the mesh's size. t, u and v are computed in double from the triangle that was found.
#pragma once

#include <cstddef>
#include <optional>

#include "scarp/scene/placement.h"
#include "scarp/scene/scene_field.h"
#include "scarp/source/mesh/mesh_file.h"

namespace scarp {

/// Bound on the error of a hit's position across the ray, as a fraction of half the mesh's largest side: 55 roundings
/// of 2^-24 (derivation: doc/dev/numerics.md, Meshes).
constexpr double kMeshRounding = 0x1p-18;

/// The mesh in the coordinates of its file, coloured by its corners, shaded by their normals. Hit::cell.col is the
/// index of the triangle, u and v are the barycentric weights of its second and third corner. Both sides are hit.
///
/// A ray from a hit (or with RayStart::on_surface and the triangle in start_cell.col) starts in the plane of that
/// triangle and hits neither it nor anything closer than kMeshRounding. Rays are moved to the mesh in double before
/// they are rounded to float32, so distance and coordinates far from the origin cost no accuracy.
///
/// Throws Error if there are no triangles, corners are not finite, or memory is insufficient.
SceneFieldPtr scene_mesh(const TriangleMesh& mesh);

/// Edges of a mesh. It is closed, and has an inside, if none is open.
struct MeshEdges {
  std::size_t all = 0;
  std::size_t open = 0;  ///< edges that belong to an odd number of triangles
};
/// Returns nullopt for other kinds of field.
std::optional<MeshEdges> mesh_edges(const SceneField& field);

/// Placement of a mesh.
struct MeshPlacement {
  dvec3 at{0.0};        ///< metres: position of its centre seen from above, and of its lowest point
  double scale = 1;     ///< metres per unit of the file, > 0
  double turn_deg = 0;  ///< clockwise seen from above
};

/// Throws Error for a number out of range, or a mesh that would not be finite.
Placement mesh_placement(const TriangleMesh& mesh, const MeshPlacement& placement);

}  // namespace scarp
