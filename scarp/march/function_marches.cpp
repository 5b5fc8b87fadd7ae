// SPDX-License-Identifier: MIT
#include "scarp/march/function_marches.h"

#include <algorithm>
#include <cmath>

#include "scarp/march/function_ray.h"

namespace scarp {
namespace {

constexpr double kBlindStep = 0x1p-10;  // share of the way out

bool on_surface(const FunctionRay& r) { return r.ray().start == RayStart::on_surface; }

Hit naive(const FunctionRay& r, const NaiveSettings& settings, MarchStats& stats) {
  const double least = settings.min_step * (r.t_exit - r.ray().t_min), per_metre = 1 / r.metres_per_t();
  double t = r.t_enter + (on_surface(r) ? least : 0.0);
  for (int step = 0; t <= r.t_exit; ++step) {
    if (step == settings.max_steps) return r.ended(HitStatus::exhausted, t);
    ++stats.steps;
    const double h = r.clearance(t) * per_metre;
    if (h < settings.tolerance * (t - r.ray().t_min)) return r.hit(t);
    t += std::max(settings.step_factor * std::abs(h), least);
  }
  return {};
}

Hit relaxed(const FunctionRay& r, const RelaxedSettings& settings, MarchStats& stats) {
  const double per_metre = 1 / r.metres_per_t();
  double t = r.t_enter + (on_surface(r) ? kBlindStep * (r.t_exit - r.t_enter) : 0.0);
  for (int step = 0; t <= r.t_exit; ++step) {
    if (step == settings.max_steps) return r.ended(HitStatus::exhausted, t);
    ++stats.steps;
    const double h = r.clearance(t) * per_metre;
    if (std::abs(h) < settings.tolerance * (t - r.ray().t_min)) return r.hit(t);
    if (h < 0 && step == 0) return on_surface(r) ? r.hit(t) : r.ended(HitStatus::below, t);
    t = std::max(t + settings.step_factor * h, r.t_enter);
  }
  return {};
}

Hit lipschitz(const FunctionRay& r, const LipschitzSettings& settings, double shrink, MarchStats& stats) {
  double t = r.t_enter + (on_surface(r) ? kBlindStep * (r.t_exit - r.t_enter) : 0.0);
  for (int step = 0; t <= r.t_exit; ++step) {
    if (step == settings.max_steps) return r.ended(HitStatus::exhausted, t);
    ++stats.steps;
    const double h = r.clearance(t);
    if (h < -r.rounding()) return on_surface(r) && step == 0 ? r.hit(t) : r.ended(HitStatus::below, t);
    const double free = (h - r.rounding()) * shrink / r.metres_per_t();
    // A step that is too short to be one is no way on.
    if (free <= settings.tolerance * (t - r.ray().t_min) || t + free <= t) return r.hit(t);
    t += free;
  }
  return {};
}

template <class March>
Hit marched(const HeightFunction& function, const Ray& ray, MarchStats* stats, FunctionUse use, March march) {
  MarchStats counted;
  Hit hit;
  const FunctionRay r(function, ray, use);
  if (r.begins_under) {
    hit.status = HitStatus::below;
  } else if (r.crosses()) {
    hit = march(r, counted);
  }
  if (stats) *stats = counted;
  return hit;
}

}  // namespace

Hit march_naive(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                FunctionUse use) {
  return marched(function, ray, stats, use,
                 [&](const FunctionRay& r, MarchStats& counted) { return naive(r, settings.naive, counted); });
}

Hit march_relaxed(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                  FunctionUse use) {
  return marched(function, ray, stats, use,
                 [&](const FunctionRay& r, MarchStats& counted) { return relaxed(r, settings.relaxed, counted); });
}

Hit march_lipschitz(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                    FunctionUse use) {
  // A step of the factor 1 / sqrt(1 + c^2), rounded towards 0 by more than its three roundings.
  const double certified = (1 - 0x1p-50) / std::hypot(1.0, function.bound_everywhere(use).slope);
  const double shrink = settings.lipschitz.shrink > 0 ? settings.lipschitz.shrink : certified;
  return marched(function, ray, stats, use, [&](const FunctionRay& r, MarchStats& counted) {
    return lipschitz(r, settings.lipschitz, shrink, counted);
  });
}

}  // namespace scarp
