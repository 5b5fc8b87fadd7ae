// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <glm/trigonometric.hpp>

#include "scarp/base/error.h"
#include "scarp/scene/mesh/mesh_box.h"
#include "scarp/scene/mesh/scene_mesh.h"

namespace scarp {

Placement mesh_placement(const TriangleMesh& mesh, const MeshPlacement& placement) {
  if (!(std::isfinite(placement.scale) && placement.scale > 0))
    throw Error(fmt::format("mesh: the scale is {} (must be above 0)", placement.scale));
  if (!std::isfinite(placement.turn_deg) || !finite(placement.at))
    throw Error("mesh: its place and its turn must be finite numbers");
  const WorldBox box = box_of(mesh);
  const dvec3 foot(middle(box).x, middle(box).y, box.low.z);
  const double turn = glm::radians(placement.turn_deg), c = std::cos(turn), s = std::sin(turn);
  Placement placed{.scale = placement.scale};
  placed.turn[0] = {c, -s, 0};
  placed.turn[1] = {s, c, 0};
  placed.origin = placement.at - placement.scale * (placed.turn * foot);
  if (!finite(placed.world_from_field(box.low)) || !finite(placed.world_from_field(box.high)))
    throw Error("mesh: is too large at this scale");
  return placed;
}

}  // namespace scarp
