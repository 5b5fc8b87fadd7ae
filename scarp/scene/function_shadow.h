// SPDX-License-Identifier: MIT
// Private to the station: where shadow rays of terrain functions begin, on the CPU and on devices.
#pragma once

#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"

namespace scarp {

/// The surface that throws shadows may have other octaves than the one that is seen (FunctionUse): a ray that begins on
/// a surface is moved to that of the shadows, above or below the point that was seen.
inline Ray on_shadow_surface(const HeightFunction& function, const Ray& ray) {
  Ray r = ray;
  if (ray.start == RayStart::on_surface) {
    const dvec3 p = ray.at(ray.t_min);
    r.origin.z += function.value(p.x, p.y, FunctionUse::shadow) - p.z;
  }
  return r;
}

}  // namespace scarp
