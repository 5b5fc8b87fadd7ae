// SPDX-License-Identifier: MIT
#include "scarp/march/naive.h"

#include <algorithm>
#include <cmath>

#include "scarp/march/height/ground.h"

namespace scarp {
namespace {

template <class T>
Hit march(const Ground<T>& ground, const Ray& ray, const NaiveSettings& settings, MarchStats& stats) {
  Hit hit;
  if (!ground.crosses()) return hit;
  // Distances count from the ray's start, in t: an unnormalised direction changes the unit of t and nothing else.
  const double least = settings.min_step * (ground.t_exit - ray.t_min);
  const double per_metre = 1 / ground.metres_per_t();
  double t = ground.t_enter;
  if (ray.start == RayStart::on_surface) t += least;
  for (int step = 0; t <= ground.t_exit; ++step) {
    if (step == settings.max_steps) {
      hit.status = HitStatus::exhausted;
      hit.t = t;
      return hit;
    }
    ++stats.steps;
    const auto sample = ground.at(t);
    const double h = sample.clearance * per_metre;
    if (sample.valid && h < settings.tolerance * (t - ray.t_min)) return ground.hit(t, sample);
    // Over a hole there is no height to go by.
    t += std::max(sample.valid ? settings.step_factor * std::abs(h) : 0.0, least);
  }
  return hit;
}

}  // namespace

Hit march_naive(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  MarchStats counted;
  Hit hit;
  if (target.field->has_cells() && !target.field->all_nodata()) {
    hit = target.field->visit(
        [&](const auto& grid) { return march(Ground(*target.field, grid, ray), ray, settings.naive, counted); });
  }
  if (stats) *stats = counted;
  return hit;
}

}  // namespace scarp
