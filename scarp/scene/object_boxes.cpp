// SPDX-License-Identifier: MIT
#include "scarp/scene/object_boxes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scarp/base/error.h"
#include "scarp/march/usual_ray.h"

namespace scarp {
namespace {

// Tolerance for the orthogonality of a rotation: permits many roundings, but no intentional shear.
constexpr double kRigid = 1e-9;

bool is_rigid(const glm::dmat3& turn) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      if (!(std::abs(dot(turn[i], turn[j]) - (i == j ? 1 : 0)) <= kRigid)) return false;
    }
  }
  return dot(cross(turn[0], turn[1]), turn[2]) > 0;
}

}  // namespace

void require_placement(const Placement& p, std::size_t object) {
  if (std::isfinite(p.scale) && p.scale > 0 && std::isfinite(p.origin.x + p.origin.y + p.origin.z) && is_rigid(p.turn))
    return;
  throw Error(
      fmt::format("scene: object {}: its placement must be a rotation, a scale above 0, a finite place", object));
}

WorldBox world_box(const Placement& placement, const WorldBox& box) {
  WorldBox world;
  if (box.empty()) return world;
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 p = placement.world_from_field(box.corner(corner));
    world = around(world, {p, p});
  }
  return world;
}

double farthest_of(const Placement& placement, double in_field, const WorldBox& extent) {
  if (!(in_field > 0)) return 0;
  return std::max(
      {in_field * placement.scale, longest_of(placement.origin), longest_of(extent.low), longest_of(extent.high)});
}

// A placement rounds as much as the objects of a field do (VoxelObjects), hence twice their 2^-48. All objects have the
// same room, because two that meet must agree on which rays are on the plane between them.
double room_of_voxels(double farthest) {
  if (!(farthest > 0)) return 0;
  int exponent = 0;
  std::frexp(farthest, &exponent);
  return std::ldexp(1, exponent - 47);
}

}  // namespace scarp
