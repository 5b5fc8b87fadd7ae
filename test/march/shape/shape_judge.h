// SPDX-License-Identifier: MIT
// Rays against shapes, and the valid answers of `sphere-trace` in single precision: the surface is hit within `delta`.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "field/shape_zoo.h"
#include "scarp/march/shape/sphere_trace.h"

namespace scarp::test {

/// Aimed at positions within 2 or 12 m of the origin, from up to 40 m away, with directions of any length; some start
/// inside.
inline Ray shape_ray(FunctionRandom& random) {
  const auto point = [&](double reach) {
    return dvec3(random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach));
  };
  Ray ray;
  const dvec3 target = point(random.between(0, 1) < 0.7 ? 2 : 12);
  ray.origin = point(random.between(5, 40));
  ray.direction = (target - ray.origin) * std::exp2(random.between(-4, 2));
  ray.t_max = 200 / length(ray.direction);
  return ray;
}

/// Returns why `hit` is wrong, or an empty string.
inline std::string shape_objection(const DistanceField& shape, const Ray& ray, double delta, const Hit& hit) {
  if (hit.status == HitStatus::exhausted) return {};
  const double tolerance = SphereTraceSettings{}.tolerance, speed = length(ray.direction);
  if (hit) {
    const double off = shape.value(ray.at(hit.t)), most = delta + 2 * tolerance * (hit.t - ray.t_min) * speed;
    if (std::abs(off) > most)
      return fmt::format("hit at t = {}, {} m off the surface; {} are allowed", hit.t, off, most);
  }
  const Hit truth = march_sphere_trace(shape, ray);
  if (!truth || (hit && hit.t <= truth.t)) return {};
  // A ray that starts inside has left the solid only where it is farther than delta outside.
  if (hit.status == HitStatus::below) {
    bool outside = false;
    for (int i = 0; i <= 1000; ++i)
      outside = outside || shape.value(ray.at(ray.t_min + (truth.t - ray.t_min) * i / 1000)) > delta;
    if (!outside) return {};
  }
  // Past the first crossing: the ray may have been in the solid by no more than delta.
  const double end = std::min(hit ? hit.t : ray.t_max, truth.t + 30 / speed);
  for (int i = 0; i <= 1000; ++i) {
    const double t = truth.t + (end - truth.t) * i / 1000, f = shape.value(ray.at(t));
    if (f < -delta && !(hit && t >= hit.t - delta / speed))
      return fmt::format("passed a crossing at t = {}: {} m inside at t = {}", truth.t, -f, t);
  }
  return {};
}

}  // namespace scarp::test
