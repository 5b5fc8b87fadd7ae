// SPDX-License-Identifier: MIT
// `fixed-step`: samples at a constant distance along the ray; the first sample that is no longer above the ground is a
// hit.
//
//   o   o   o   o          plain: the hit is the sample that is first on or below the ground
//        _____  \ x        interpolated: between the last two samples, where a straight line between their clearances
//   ____/     \_/ o\_      crosses zero (the default); or bisected (Refinement)
//
// Guarantee: approximate. Steps over anything thinner than a step. The last sample is where the ray leaves the field or
// its range ends. Sample positions are computed from their index, not accumulated. Sources: the ray caster for
// semi-voxel terrain of the founding texts, first plain, then interpolating the last two samples; I. Quilez, "Terrain
// raymarching", 2002. Cost: one height per step.
#pragma once

#include <algorithm>
#include <cmath>

#include "scarp/march/march_settings.h"
#include "scarp/march/sampling/sampling.h"

namespace scarp {

template <class Probe>
Hit fixed_step_over(const Probe& probe, const MarchSettings& all, MarchStats& stats) {
  const FixedStepSettings& settings = all.fixed_step;
  const Ray& ray = probe.ray();
  const bool on_surface = ray.start == RayStart::on_surface;
  const double stride = probe.stride(all), share = probe.stride_share(all);
  const auto stops = [](double, double clearance) { return clearance <= 0; };
  Hit hit;
  bool above = on_surface;
  SamplePoint before{probe.t_enter, 0, on_surface};
  for (int i = on_surface ? 1 : 0;; ++i) {
    if (i == settings.max_steps) return exhausted_at(before.t);
    // Computed from the count, not accumulated, while steps are equal.
    double t = probe.t_enter + i * stride;
    if (share > 0 && i > 0) t = before.t + std::max(stride, share * (before.t - ray.t_min));
    t = std::min(t, probe.t_exit);
    ++stats.steps;
    const auto sample = probe.at(t);
    const SamplePoint point{t, sample.clearance, sample.valid};
    if (point.known) {
      if (point.h > 0 || (on_surface && point.h == 0)) {
        above = true;
      } else if (before.known && above) {
        // From a point on the surface there is no interval to refine.
        if (!(before.h > 0)) return probe.hit(t, sample);
        return refined_hit(probe, all.sampling, refinement_of_fixed_step(all), before, point, sample, 0, stops, stats);
      } else if (!before.known && point.h == 0) {
        return probe.hit(t, sample);
      } else {
        const bool first = stats.steps == 1;
        if (!before.known && probe.solid() && (!first || probe.from_outside())) return wall(probe.hit(t, sample));
        if (first) hit = below();
        above = false;
      }
    }
    before = point;
    if (!(t < probe.t_exit)) return hit;
  }
}

}  // namespace scarp
