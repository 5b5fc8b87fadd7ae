// SPDX-License-Identifier: MIT
#include "scarp/march/fixed_step.h"

#include <algorithm>
#include <cmath>

#include "scarp/march/height/ground.h"

namespace scarp {
namespace {

template <class T>
Hit march(const Ground<T>& ground, const HeightTarget& target, const Ray& ray, const FixedStepSettings& settings,
          MarchStats& stats) {
  Hit hit;
  if (!ground.crosses()) return hit;
  const bool on_surface = ray.start == RayStart::on_surface, solid = target.field->settings().solid;
  const double step = settings.step * ground.cell_time();
  bool above = on_surface, known = on_surface;  // known: the sample before was over ground
  double t_before = ground.t_enter, clearance_before = 0;
  for (int i = on_surface ? 1 : 0;; ++i) {
    if (i == settings.max_steps) {
      hit.status = HitStatus::exhausted;
      hit.t = t_before;
      return hit;
    }
    const double t = std::min(ground.t_enter + i * step, ground.t_exit);
    ++stats.steps;
    const auto sample = ground.at(t);
    if (!sample.valid) {
      known = false;
    } else if (sample.clearance > 0 || (on_surface && sample.clearance == 0)) {
      above = known = true;
    } else if (known && above) {
      if (settings.interpolate && clearance_before != 0) {
        const double between = t_before + (t - t_before) * (clearance_before / (clearance_before - sample.clearance));
        const auto nearer = ground.at(between);
        if (nearer.valid) return ground.hit(between, nearer);
      }
      return ground.hit(t, sample);
    } else if (!known && sample.clearance == 0) {
      return ground.hit(t, sample);
    } else {
      const bool first = stats.steps == 1;
      if (!known && solid && (!first || ground.t_enter > ray.t_min)) {
        hit = ground.hit(t, sample);
        hit.wall = true;
        return hit;
      }
      if (first) hit.status = HitStatus::below;
      above = false;
      known = true;
    }
    t_before = t;
    clearance_before = sample.clearance;
    if (!(t < ground.t_exit)) return hit;
  }
}

}  // namespace

Hit march_fixed_step(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  MarchStats counted;
  Hit hit;
  if (target.field->has_cells() && !target.field->all_nodata()) {
    hit = target.field->visit([&](const auto& grid) {
      return march(Ground(*target.field, grid, ray), target, ray, settings.fixed_step, counted);
    });
  }
  if (stats) *stats = counted;
  return hit;
}

}  // namespace scarp
