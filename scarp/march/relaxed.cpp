// SPDX-License-Identifier: MIT
#include "scarp/march/relaxed.h"

#include <algorithm>
#include <cmath>

#include "scarp/march/height/ground.h"

namespace scarp {
namespace {

template <class T>
Hit march(const Ground<T>& ground, const Ray& ray, const RelaxedSettings& settings, MarchStats& stats) {
  Hit hit;
  if (!ground.crosses()) return hit;
  const double per_metre = 1 / ground.metres_per_t();
  // The stride over a hole, where there is no height to go by, and the first step off the surface.
  const double cell = ground.cell_time();
  const bool on_surface = ray.start == RayStart::on_surface;
  double t = ground.t_enter + (on_surface ? cell : 0.0);
  for (int step = 0; t <= ground.t_exit; ++step) {
    if (step == settings.max_steps) {
      hit.status = HitStatus::exhausted;
      hit.t = t;
      return hit;
    }
    ++stats.steps;
    const auto sample = ground.at(t);
    if (!sample.valid) {
      t += cell;
      continue;
    }
    const double h = sample.clearance * per_metre;
    if (std::abs(h) < settings.tolerance * (t - ray.t_min)) return ground.hit(t, sample);
    if (h < 0 && step == 0) {
      // Below at the first look: the way back would leave the ray's range.
      if (on_surface) return ground.hit(t, sample);
      hit.status = HitStatus::below;
      return hit;
    }
    t = std::max(t + settings.step_factor * h, ground.t_enter);
  }
  return hit;
}

}  // namespace

Hit march_relaxed(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  MarchStats counted;
  Hit hit;
  if (target.field->has_cells() && !target.field->all_nodata()) {
    hit = target.field->visit(
        [&](const auto& grid) { return march(Ground(*target.field, grid, ray), ray, settings.relaxed, counted); });
  }
  if (stats) *stats = counted;
  return hit;
}

}  // namespace scarp
