// SPDX-License-Identifier: MIT
#include "scarp/march/relaxed.h"

#include <algorithm>
#include <cmath>

#include "scarp/march/function/function_probe.h"
#include "scarp/march/height/height_probe.h"

namespace scarp {
namespace {

template <class Probe>
Hit relaxed_over(const Probe& probe, const MarchSettings& all, MarchStats& stats) {
  const RelaxedSettings& settings = all.relaxed;
  const double start = probe.ray().t_min, per_clearance = probe.per_clearance();
  const double near = all.sampling.tolerance * probe.per_metre(), blind = probe.blind_step();
  const auto limit = [&](double t) { return std::max(near, settings.tolerance * (t - start)); };
  const auto stops = [&](double t, double clearance) { return std::abs(clearance * per_clearance) < limit(t); };
  const bool on_surface = probe.ray().start == RayStart::on_surface;
  Underground ground(probe.from_outside());
  double t = probe.t_enter + (on_surface ? blind : 0.0);
  for (int step = 0; t <= probe.t_exit; ++step) {
    if (step == settings.max_steps) return exhausted_at(t);
    ++stats.steps;
    const auto sample = probe.at(t);
    const SamplePoint point{t, sample.clearance * per_clearance, sample.valid};
    ground.take(point, probe.under_ground(sample), point.h >= limit(t));
    if (ground.comes_in() && probe.solid()) return wall(probe.hit(t, sample));
    if (!point.known) {
      t += blind;
    } else if (ground.is_under()) {
      t += std::max(settings.step_factor * std::abs(point.h), probe.least_step_under(t));
    } else if (stops(t, sample.clearance)) {
      // It may come from above or, having overshot, from below.
      const SamplePoint& before = ground.before();
      const double met = std::copysign(limit(t), before.h);
      return refined_hit(probe, all.sampling, all.sampling.refinement, before, point, sample, met, stops, stats);
    } else if (point.h < 0 && step == 0) {
      // Below at the first sample: stepping back would leave the ray's range.
      return on_surface ? probe.hit(t, sample) : below();
    } else {
      t = std::max(t + settings.step_factor * point.h, probe.t_enter);
    }
    ground.step_from(point);
  }
  return ground.missed();
}

}  // namespace

Hit march_relaxed(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  return march_over(target, ray, stats,
                    [&](const auto& probe, MarchStats& counted) { return relaxed_over(probe, settings, counted); });
}

Hit march_relaxed(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                  FunctionUse use) {
  return march_over(function, ray, use, settings.function.reach, stats,
                    [&](const auto& probe, MarchStats& counted) { return relaxed_over(probe, settings, counted); });
}

}  // namespace scarp
