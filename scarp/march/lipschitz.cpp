// SPDX-License-Identifier: MIT
#include "scarp/march/lipschitz.h"

#include <algorithm>
#include <cmath>

#include "scarp/base/error.h"
#include "scarp/march/function/function_probe.h"
#include "scarp/march/height/height_probe.h"

namespace scarp {
namespace {

// `shrink` is the factor that steps are shorter by than the vertical distance.
template <class Probe>
Hit march(const Probe& probe, const LipschitzSettings& settings, double shrink, MarchStats& stats) {
  const Ray& ray = probe.ray();
  const bool on_surface = ray.start == RayStart::on_surface;
  double t = probe.t_enter + (on_surface ? probe.blind_step() : 0.0);
  for (int step = 0; t <= probe.t_exit; ++step) {
    if (step == settings.max_steps) return exhausted_at(t);
    ++stats.steps;
    const auto sample = probe.at(t);
    if (!sample.valid) {
      t = probe.bounded_until(sample, t);
      continue;
    }
    if (probe.under_ground(sample)) {
      // There from the start, or out of a hole.
      if (on_surface && step == 0) return probe.hit(t, sample);
      if (probe.solid() && t > ray.t_min) return wall(probe.hit(t, sample));
      return step == 0 ? below() : exhausted_at(t);
    }
    const double free = probe.free_time(sample, shrink);
    // A step that is too short to be one is no way on.
    if (free <= settings.tolerance * (t - ray.t_min) || t + free <= t) return probe.hit(t, sample);
    t = std::min(t + free, probe.bounded_until(sample, t));
  }
  return {};
}

}  // namespace

Hit march_lipschitz(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  double shrink = settings.lipschitz.shrink;
  if (shrink == 0) {
    if (std::isnan(target.slope))
      throw Error("lipschitz: neither the field's slope bound (HeightTarget::slope) nor a shrink factor is given");
    shrink = 1 / std::hypot(1.0, target.slope);
  }
  return march_over(target, ray, stats, [&](const auto& probe, MarchStats& counted) {
    return march(probe, settings.lipschitz, shrink, counted);
  });
}

Hit march_lipschitz(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                    FunctionUse use) {
  // A step of the factor 1 / sqrt(1 + c^2), rounded towards 0 by more than its three roundings.
  const double certified = (1 - 0x1p-50) / std::hypot(1.0, function.bound_everywhere(use).slope);
  const double shrink = settings.lipschitz.shrink > 0 ? settings.lipschitz.shrink : certified;
  return march_over(function, ray, use, settings.function.reach, stats, [&](const auto& probe, MarchStats& counted) {
    return march(probe, settings.lipschitz, shrink, counted);
  });
}

}  // namespace scarp
