// SPDX-License-Identifier: MIT
// Private to the station: where shadow rays of terrain functions start, on the CPU and on devices.
#pragma once

#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"

namespace scarp {

/// The surface that casts shadows may have different octaves from the visible one (FunctionUse): a ray that starts on a
/// surface is moved to the shadow-casting one, above or below the visible point.
inline Ray on_shadow_surface(const HeightFunction& function, const Ray& ray) {
  Ray r = ray;
  if (ray.start == RayStart::on_surface) {
    const dvec3 p = ray.at(ray.t_min);
    r.origin.z += function.value(p.x, p.y, FunctionUse::shadow) - p.z;
  }
  return r;
}

}  // namespace scarp
