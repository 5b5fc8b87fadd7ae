// SPDX-License-Identifier: MIT
// `relaxed`: the march of many terrain shaders. t += 0.4 * h, a hit where |h| < 0.0015 * t, 300 steps; t counts from
// t_min.
//
// The factor below 1 stands in for the unknown slope: on gentle ground the march approaches the surface from above; on
// steep ground it steps through and returns (h < 0 steps backwards).
//
// Guarantee: approximate. Stops within the tolerance of a surface, which may not be the first one; refined on request
// (Refinement). Unlike its source, it reports the step limit as exhausted, not as a hit. Source: R. Ma, "Heightfield
// Raycast", procedural_shader_framework; the constants go back to I. Quilez, "Elevated", 2009. Cost: up to 300 heights
// per ray.
#pragma once

#include <algorithm>
#include <cmath>

#include "scarp/march/march_settings.h"
#include "scarp/march/sampling/sampling.h"

namespace scarp {

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

}  // namespace scarp
