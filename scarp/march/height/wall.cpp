// SPDX-License-Identifier: MIT
#include "scarp/march/height/wall.h"

namespace scarp {

// A wall is on the side of its cell through which the ray entered: the one that contains the hit.
dvec3 wall_normal(const Ray& ray, const Hit& hit) {
  const dvec3& d = ray.direction;
  const double from_x = d.x > 0 ? hit.u : 1 - hit.u, from_y = d.y > 0 ? 1 - hit.v : hit.v;
  if (d.y == 0 || (d.x != 0 && from_x <= from_y)) return {d.x > 0 ? -1 : 1, 0, 0};
  return {0, d.y > 0 ? -1 : 1, 0};
}

}  // namespace scarp
