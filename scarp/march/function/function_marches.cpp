// SPDX-License-Identifier: MIT
#include "scarp/march/function/function_marches.h"

#include <algorithm>
#include <cmath>

#include "scarp/march/function/function_ray.h"

namespace scarp {
namespace {

constexpr double kBlindStep = 0x1p-10;  // share of the way out

bool on_surface(const FunctionRay& r) { return r.ray().start == RayStart::on_surface; }

// A place where a march has looked.
struct Look {
  double t = 0, h = 0;  // h in the unit of t
};

// Between `before`, where the march went on, and `last`, where it stops: nearer to where its test begins to hold. The
// test is that of a limit which the clearance before lies beyond.
template <class Stops>
double refined(const FunctionRay& r, Refinement refinement, int halvings, Look before, const Look& last, double limit,
               const Stops& stops, MarchStats& stats) {
  if (refinement == Refinement::secant && before.h != last.h) {
    return before.t + (last.t - before.t) * std::clamp((before.h - limit) / (before.h - last.h), 0.0, 1.0);
  }
  if (refinement != Refinement::bisect) return last.t;
  double from = before.t, to = last.t;
  for (int i = 0; i < halvings; ++i) {
    const double t = 0.5 * (from + to);
    ++stats.steps;
    (stops(t, r.clearance(t) / r.metres_per_t()) ? to : from) = t;
  }
  return to;
}

Hit naive(const FunctionRay& r, const MarchSettings& all, MarchStats& stats) {
  const NaiveSettings& settings = all.naive;
  const double least = settings.min_step * (r.t_exit - r.ray().t_min), per_metre = 1 / r.metres_per_t();
  const auto limit = [&](double t) {
    return std::max(all.function.tolerance * per_metre, settings.tolerance * (t - r.ray().t_min));
  };
  const auto stops = [&](double t, double h) { return h < limit(t); };
  Look before;
  double t = r.t_enter + (on_surface(r) ? least : 0.0);
  for (int step = 0; t <= r.t_exit; ++step) {
    if (step == settings.max_steps) return r.ended(HitStatus::exhausted, t);
    ++stats.steps;
    const double h = r.clearance(t) * per_metre;
    if (stops(t, h)) {
      const Refinement how = step > 0 ? all.function.refinement : Refinement::none;
      return r.hit(refined(r, how, all.function.halvings, before, {t, h}, limit(t), stops, stats));
    }
    before = {t, h};
    t += std::max(settings.step_factor * std::abs(h), least);
  }
  return {};
}

Hit fixed_step(const FunctionRay& r, const MarchSettings& all, MarchStats& stats) {
  const FixedStepSettings& settings = all.fixed_step;
  const double per_metre = 1 / r.metres_per_t(), stride = all.function.step * per_metre;
  const Refinement how = all.function.refinement != Refinement::none ? all.function.refinement
                         : settings.interpolate                      ? Refinement::secant
                                                                     : Refinement::none;
  const auto stops = [](double, double h) { return h <= 0; };
  Hit hit;
  bool above = on_surface(r);
  Look before{r.t_enter, 0};
  for (int i = on_surface(r) ? 1 : 0;; ++i) {
    if (i == settings.max_steps) return r.ended(HitStatus::exhausted, before.t);
    // Counted, not summed up, while steps are equal.
    double t = r.t_enter + i * stride;
    if (all.function.step_share > 0 && i > 0) {
      t = before.t + std::max(stride, all.function.step_share * (before.t - r.ray().t_min));
    }
    t = std::min(t, r.t_exit);
    ++stats.steps;
    const double h = r.clearance(t) * per_metre;
    if (h > 0 || (h == 0 && on_surface(r))) {
      above = true;
    } else if (above && before.h > 0) {
      return r.hit(refined(r, how, all.function.halvings, before, {t, h}, 0, stops, stats));
    } else if (above || (i == 0 && h == 0)) {
      return r.hit(t);
    } else if (i == 0) {
      hit.status = HitStatus::below;
    }
    before = {t, h};
    if (!(t < r.t_exit)) return hit;
  }
}

Hit relaxed(const FunctionRay& r, const MarchSettings& all, MarchStats& stats) {
  const RelaxedSettings& settings = all.relaxed;
  const double per_metre = 1 / r.metres_per_t(), least = all.function.tolerance * per_metre;
  const auto limit = [&](double t) { return std::max(least, settings.tolerance * (t - r.ray().t_min)); };
  const auto stops = [&](double t, double h) { return std::abs(h) < limit(t); };
  Look before;
  double t = r.t_enter + (on_surface(r) ? kBlindStep * (r.t_exit - r.t_enter) : 0.0);
  for (int step = 0; t <= r.t_exit; ++step) {
    if (step == settings.max_steps) return r.ended(HitStatus::exhausted, t);
    ++stats.steps;
    const double h = r.clearance(t) * per_metre;
    if (stops(t, h)) {
      const Refinement how = step > 0 ? all.function.refinement : Refinement::none;
      // It may come from above or, having overshot, from below.
      const double met = std::copysign(limit(t), before.h);
      return r.hit(refined(r, how, all.function.halvings, before, {t, h}, met, stops, stats));
    }
    if (h < 0 && step == 0) return on_surface(r) ? r.hit(t) : r.ended(HitStatus::below, t);
    before = {t, h};
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
Hit marched(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
            FunctionUse use, March march) {
  MarchStats counted;
  Hit hit;
  const FunctionRay r(function, ray, use, settings.function.reach);
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
  return marched(function, ray, settings, stats, use,
                 [&](const FunctionRay& r, MarchStats& counted) { return naive(r, settings, counted); });
}

Hit march_fixed_step(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                     FunctionUse use) {
  return marched(function, ray, settings, stats, use,
                 [&](const FunctionRay& r, MarchStats& counted) { return fixed_step(r, settings, counted); });
}

Hit march_relaxed(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                  FunctionUse use) {
  return marched(function, ray, settings, stats, use,
                 [&](const FunctionRay& r, MarchStats& counted) { return relaxed(r, settings, counted); });
}

Hit march_lipschitz(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                    FunctionUse use) {
  // A step of the factor 1 / sqrt(1 + c^2), rounded towards 0 by more than its three roundings.
  const double certified = (1 - 0x1p-50) / std::hypot(1.0, function.bound_everywhere(use).slope);
  const double shrink = settings.lipschitz.shrink > 0 ? settings.lipschitz.shrink : certified;
  return marched(function, ray, settings, stats, use, [&](const FunctionRay& r, MarchStats& counted) {
    return lipschitz(r, settings.lipschitz, shrink, counted);
  });
}

}  // namespace scarp
