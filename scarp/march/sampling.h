// SPDX-License-Identifier: MIT
// Private to the station: shared by naive, fixed-step, relaxed and lipschitz. Each is one loop over a probe, which is a
// ray over a field: HeightProbe (height/height_probe.h) or FunctionProbe (function/function_probe.h).
//
//   march: t ──▶ probe.at(t): clearance, or nothing over a hole ──▶ hit, or the next t
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

/// The answer for a ray that begins under the ground.
inline Hit below() {
  Hit hit;
  hit.status = HitStatus::below;
  return hit;
}
/// A hit of a wall at the rim of solid ground.
inline Hit wall(Hit hit) {
  hit.wall = true;
  return hit;
}
/// The answer of a march that has reached its step limit.
inline Hit exhausted_at(double t) {
  Hit hit;
  hit.status = HitStatus::exhausted;
  hit.t = t;
  return hit;
}

/// Returns the hit between `before`, where the test stops(t, clearance) fails, and `last`, where it holds: nearer to
/// where it begins to hold. The secant takes that for a clearance of `limit`. The hit stays at `last` if `before` is
/// over a hole, or the result is.
template <class Probe, class Stops>
Hit refined_hit(const Probe& probe, const SamplingSettings& settings, Refinement how, const SamplePoint& before,
                const SamplePoint& last, const typename Probe::Sample& sample, double limit, const Stops& stops,
                MarchStats& stats) {
  if (!before.known || how == Refinement::none) return probe.hit(last.t, sample);
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
