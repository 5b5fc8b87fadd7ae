// SPDX-License-Identifier: MIT
#include "scarp/march/function/lipschitz_local_rules.h"

#include <algorithm>
#include <cmath>

namespace scarp {
namespace {

Ray upside_down(Ray ray) {
  ray.origin.z = -ray.origin.z, ray.direction.z = -ray.direction.z;
  return ray;
}

}  // namespace

HeightFunction upside_down(const HeightFunction& function) {
  return HeightFunction(make_function(Sum{.a = function.function(), .b = make_function(Plane{}), .factor_a = -1}));
}

Hit march_lipschitz_local_filtered(const HeightFunction& function, const HeightFunction& below, const Ray& ray,
                                   const HitFilter& accept, const MarchSettings& settings, MarchStats* stats) {
  MarchStats all;
  MarchSettings left = settings;
  const auto march = [&](const HeightFunction& ground, const Ray& part) {
    MarchStats one;
    const Hit hit = march_lipschitz_local(ground, part, left, &one);
    all.steps += one.steps, all.cell_tests += one.cell_tests;
    left.lipschitz_local.max_steps = std::max(1, left.lipschitz_local.max_steps - static_cast<int>(one.steps));
    return hit;
  };
  Hit hit = march(function, ray);
  Ray rest = ray;
  rest.start = RayStart::on_surface;
  // The reach is measured from the start of the ray.
  const dvec3& d = ray.direction;
  rest.t_max = std::min(ray.t_max, ray.t_min + settings.function.reach / std::hypot(d.x, d.y, d.z));
  while (hit && !accept(hit)) {
    rest.t_min = hit.t;
    hit = march(below, upside_down(rest));
    if (!hit) break;
    rest.t_min = hit.t;
    if (left.lipschitz_local.max_steps > 1) {
      hit = march(function, rest);
    } else {
      hit = {};
      hit.status = HitStatus::exhausted;
      hit.t = rest.t_min;
    }
  }
  if (stats) *stats = all;
  return hit;
}

}  // namespace scarp
