// SPDX-License-Identifier: MIT
// Private to the station: shared by naive, fixed-step, relaxed and lipschitz. Each is one loop over a probe, which is a
// ray over a field: HeightProbe (height/height_probe.h) or FunctionProbe (function/function_probe.h).
//
//   march: t ──▶ probe.at(t): clearance, or nothing over a hole ──▶ hit, or the next t
//
// A ray that enters below the ground, through the border or from a hole, does not hit there (Underground). It hits
// where it later crosses the ground from above. Walls of solid ground are hit where the ray enters.
#pragma once

#include <algorithm>

#include "scarp/base/ray.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// A point of the ray that a march has sampled.
struct SamplePoint {
  double t = 0;
  double h = 0;        ///< clearance, in the unit of the test for a hit
  bool known = false;  ///< whether it is over ground
};

/// The result of a ray that starts below the ground, or enters below it through the border, and hits nothing.
inline Hit below() {
  Hit hit;
  hit.status = HitStatus::below;
  return hit;
}
/// A hit on a wall at the rim of solid ground.
inline Hit wall(Hit hit) {
  hit.wall = true;
  return hit;
}
/// The result of a march that has reached its step limit.
inline Hit exhausted_at(double t) {
  Hit hit;
  hit.status = HitStatus::exhausted;
  hit.t = t;
  return hit;
}

/// Tracks a ray that enters below the ground; equals scarp_comes_in_under() and scarp_mark_under() of sampling.glsl.h.
class Underground {
 public:
  /// `from_outside`: whether the ray's first point is on the border, where it enters.
  explicit Underground(bool from_outside) : from_outside_(from_outside) {}

  /// Takes the next point. `sunk`: it is below the ground; `clear`: it is above the ground by more than the hit
  /// tolerance.
  void take(const SamplePoint& point, bool sunk, bool clear) {
    comes_in_ = point.known && sunk && !before_.known && (!first_ || from_outside_);
    const bool was_above = before_.known && before_.h >= 0;
    if (comes_in_) {
      under_ = true;
      entered_below_ = entered_below_ || first_;
    } else if (point.known && (clear || (was_above && point.h < before_.h))) {
      under_ = false;  // it has emerged, or descends again
    }
  }
  /// Ends the iteration of the point taken last.
  void step_from(const SamplePoint& point) {
    before_ = point;
    first_ = false;
  }

  bool comes_in() const { return comes_in_; }  ///< with the last point
  bool is_under() const { return under_; }     ///< it has entered, and has not emerged since
  const SamplePoint& before() const { return before_; }
  /// The result of a ray without a hit.
  Hit missed() const { return entered_below_ ? below() : Hit{}; }

 private:
  SamplePoint before_;
  bool from_outside_, first_ = true;
  bool comes_in_ = false, under_ = false, entered_below_ = false;
};

/// Returns the hit between `before`, where the test stops(t, clearance) fails, and `last`, where it holds, refined
/// towards the point where it starts to hold. The secant assumes a clearance of `limit` there. The hit stays at `last`
/// if `before` or the refined point is over a hole.
template <class Probe, class Stops>
Hit refined_hit(const Probe& probe, const SamplingSettings& settings, Refinement how, const SamplePoint& before,
                const SamplePoint& last, const typename Probe::Sample& sample, double limit, const Stops& stops,
                MarchStats& stats) {
  if (!before.known || how == Refinement::none) return probe.hit(last.t, sample);
  if constexpr (requires { probe.refines(); }) probe.refines();
  double from = before.t, to = last.t;
  if (how == Refinement::bisect) {
    for (int i = 0; i < settings.halvings; ++i) {
      const double t = 0.5 * (from + to);
      ++stats.steps;
      const auto middle = probe.at(t);
      (middle.valid && stops(t, middle.clearance) ? to : from) = t;
    }
  } else if (before.h != last.h) {
    to = from + (to - from) * std::clamp((before.h - limit) / (before.h - last.h), 0.0, 1.0);
  }
  return probe.hit_before(to, last.t, sample);
}

}  // namespace scarp
