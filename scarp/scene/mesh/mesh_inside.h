// SPDX-License-Identifier: MIT
// Private to the station: decides which points are inside a closed mesh, by the parity of the number of triangles above
// them.
//
// Seen from above, a triangle contains a point if an odd number of its edges pass it in the east. Each edge is decided
// by one expression of its two corners, so both its triangles decide alike. Therefore a vertical line through any point
// meets an even number of triangles of a closed mesh: none is lost or counted twice at an edge or a corner.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "scarp/scene/mesh/scene_mesh.h"
#include "scarp/scene/tree/box_tree.h"

namespace scarp {

/// Counts the edges of triangles, three corners each. Corners with equal coordinates are the same.
MeshEdges count_edges(std::span<const vec3> corners);

class MeshInside {
 public:
  /// `corners`, three per triangle, must outlive it.
  explicit MeshInside(std::span<const vec3> corners);

  /// Whether every edge belongs to an even number of triangles.
  bool closed() const { return closed_; }
  /// The nearest triangle above a point inside the mesh; nullopt outside, and everywhere if the mesh is not closed.
  std::optional<std::uint32_t> above(const dvec3& p) const;

 private:
  std::span<const vec3> corners_;
  bool closed_;
  BoxTree tree_;  // over the triangles; empty unless closed
};

}  // namespace scarp
