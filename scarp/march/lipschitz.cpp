// SPDX-License-Identifier: MIT
#include "scarp/march/lipschitz.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/march/function/function_probe.h"
#include "scarp/march/height/height_probe.h"
#include "scarp/march/shrink_factor.h"

namespace scarp {
namespace {

template <class Probe>
Hit lipschitz_over(const Probe& probe, const LipschitzSettings& settings, const ShrinkFactor& shrink,
                   MarchStats& stats) {
  const Ray& ray = probe.ray();
  const bool on_surface = ray.start == RayStart::on_surface;
  Underground ground(probe.from_outside());
  double t = probe.t_enter + (on_surface ? probe.blind_step() : 0.0);
  for (int step = 0; t <= probe.t_exit; ++step) {
    if (step == settings.max_steps) return exhausted_at(t);
    ++stats.steps;
    const auto sample = probe.at(t);
    const SamplePoint point{t, sample.clearance, sample.valid};
    const bool sunk = sample.valid && probe.under_ground(sample);
    // Below the ground the bound on the distance is the same as above it.
    const double free = sample.valid ? probe.free_time(sample, shrink.factor) : 0.0;
    const double limit = settings.tolerance * (t - ray.t_min), least = probe.least_step_under(t);
    ground.take(point, sunk, !sunk && free > std::max(limit, least));
    if (ground.comes_in() && probe.solid()) return wall(probe.hit(t, sample));
    // A ray that enters may have touched the edge of the ground, which is a hit, just above or at the corner of a hole.
    const bool approximate = shrink.guarantee == Guarantee::approximate;
    const bool unsure = ground.comes_in() && (free <= least || (step > 0 && !approximate));
    if (sunk && (unsure || !ground.is_under())) {
      if (step == 0 && !unsure) return on_surface ? probe.hit(t, sample) : below();
      return approximate ? probe.hit(t, sample) : exhausted_at(t);
    }
    double next = std::numeric_limits<double>::infinity();
    if (sample.valid && ground.is_under()) {
      next = t + std::max(free, least);
    } else if (sample.valid) {
      // A step too short to advance is a hit.
      if (free <= limit || t + free <= t) return probe.hit(t, sample);
      next = t + free;
    }
    t = std::min(next, probe.bounded_until(sample, t));
    ground.step_from(point);
  }
  return ground.missed();
}

}  // namespace

double largest_proven_shrink(double slope) { return 1 / std::hypot(1.0, slope); }

Guarantee lipschitz_guarantee(const LipschitzSettings& settings, double slope) {
  // NaN, an unknown slope, proves nothing.
  const bool proven = settings.shrink == 0 || settings.shrink <= largest_proven_shrink(slope);
  return proven ? Guarantee::conservative : Guarantee::approximate;
}

std::string lipschitz_caveat(const LipschitzSettings& settings, double slope) {
  if (lipschitz_guarantee(settings, slope) == Guarantee::conservative) return {};
  return fmt::format(
      "lipschitz with shrink factor {:.4g} is approximate: the slope bound {:.4g} proves only factors up to {:.4g}",
      settings.shrink, slope, largest_proven_shrink(slope));
}

Hit march_lipschitz(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats) {
  require(target, settings.lipschitz.shrink == 0 ? HeightPart::pyramid_and_slope : HeightPart::pyramid);
  const ShrinkFactor shrink = shrink_factor(settings.lipschitz, target.slope);
  return march_over(target, ray, stats, [&](const auto& probe, MarchStats& counted) {
    return lipschitz_over(probe, settings.lipschitz, shrink, counted);
  });
}

Hit march_lipschitz(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                    FunctionUse use) {
  // Reduced by more than its three rounding errors.
  const ShrinkFactor shrink = shrink_factor(settings.lipschitz, function.bound_everywhere(use).slope, 0x1p-50);
  return march_over(function, ray, use, settings.function.reach, stats, [&](const auto& probe, MarchStats& counted) {
    return lipschitz_over(probe, settings.lipschitz, shrink, counted);
  });
}

}  // namespace scarp
