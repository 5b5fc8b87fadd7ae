// SPDX-License-Identifier: MIT
// Private to the station: the extent of a mesh.
#pragma once

#include <cmath>
#include <glm/common.hpp>

#include "scarp/base/error.h"
#include "scarp/scene/tree/box_tree.h"
#include "scarp/source/mesh/mesh_file.h"

namespace scarp {

inline bool finite(const dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Throws Error if there are no triangles, or corners are not finite.
inline WorldBox box_of(const TriangleMesh& mesh) {
  if (mesh.corners.empty() || mesh.corners.size() % 3 != 0) throw Error("mesh: has no whole triangles");
  WorldBox box;
  for (const MeshCorner& corner : mesh.corners) {
    if (!finite(corner.position)) throw Error("mesh: its coordinates must be finite numbers");
    box.low = glm::min(box.low, corner.position);
    box.high = glm::max(box.high, corner.position);
  }
  return box;
}

inline dvec3 middle(const WorldBox& box) { return box.low + 0.5 * (box.high - box.low); }

}  // namespace scarp
