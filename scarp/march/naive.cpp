// SPDX-License-Identifier: MIT
#include "scarp/march/naive.h"

#include <algorithm>
#include <cmath>

#include "scarp/march/function/function_probe.h"
#include "scarp/march/height/height_probe.h"

namespace scarp {
namespace {

template <class Probe>
Hit naive_over(const Probe& probe, const MarchSettings& all, MarchStats& stats) {
  const NaiveSettings settings = all.naive;
  // Distances count from the ray's start, in t: an unnormalised direction changes the unit of t and nothing else.
  const double start = probe.ray().t_min, per_clearance = probe.per_clearance();
  const bool on_surface = probe.ray().start == RayStart::on_surface;
  const double near = all.sampling.tolerance * probe.per_metre();
  // Rays from the surface start within the tolerance: they step over it, and hit only deeper ground.
  const double least = std::max(settings.min_step * (probe.t_exit - start), on_surface ? near : 0.0);
  const auto limit = [&](double t) {
    const double share = settings.tolerance * (t - start);
    return on_surface ? share - near : std::max(near, share);
  };
  const auto stops = [&](double t, double clearance) { return clearance * per_clearance < limit(t); };
  Underground ground(probe.from_outside());
  double t = probe.t_enter + (on_surface ? least : 0.0);
  for (int step = 0; t <= probe.t_exit; ++step) {
    if (step == settings.max_steps) return exhausted_at(t);
    ++stats.steps;
    const auto sample = probe.at(t);
    const SamplePoint point{t, sample.clearance * per_clearance, sample.valid};
    const bool stopped = point.known && stops(t, sample.clearance);
    ground.take(point, probe.under_ground(sample), !stopped);
    if (ground.comes_in() && probe.solid()) return wall(probe.hit(t, sample));
    if (stopped && !ground.is_under()) {
      return refined_hit(probe, all.sampling, all.sampling.refinement, ground.before(), point, sample, limit(t), stops,
                         stats);
    }
    ground.step_from(point);
    // Over a hole there is no height to go by.
    t += std::max(point.known ? settings.step_factor * std::abs(point.h) : 0.0, least);
  }
  return ground.missed();
}

}  // namespace

Hit march_naive(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  return march_over(target, ray, stats,
                    [&](const auto& probe, MarchStats& counted) { return naive_over(probe, settings, counted); });
}

Hit march_naive(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                FunctionUse use) {
  return march_over(function, ray, use, settings.function.reach, stats,
                    [&](const auto& probe, MarchStats& counted) { return naive_over(probe, settings, counted); });
}

}  // namespace scarp
