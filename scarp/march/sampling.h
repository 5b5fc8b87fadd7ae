// SPDX-License-Identifier: MIT
// Private to the station: what naive, fixed-step, relaxed and lipschitz share. Each is one loop over a probe, which
// knows the ray and what is under it: HeightProbe (height/height_probe.h) or FunctionProbe (function/function_probe.h).
//
//   march: t ──▶ probe.at(t): clearance, or nothing over a hole ──▶ hit, or the next t
#pragma once

#include <algorithm>

#include "scarp/base/ray.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// A point where a march has looked.
struct Look {
  double t = 0;
  double h = 0;        ///< clearance, in the unit of the march's test
  bool known = false;  ///< whether it is over ground
};

/// A ray that begins under the ground.
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
/// Used-up steps.
inline Hit exhausted_at(double t) {
  Hit hit;
  hit.status = HitStatus::exhausted;
  hit.t = t;
  return hit;
}

/// The hit between `before`, where the march went on, and `last`, where its test stops(t, clearance) holds: nearer to
/// where it begins to hold, which a straight line takes for clearances of `limit`. Stays at `last` where there is no
/// clearance before, or a hole in between.
template <class Probe, class Stops>
Hit refined_hit(const Probe& probe, const SamplingSettings& settings, Refinement how, const Look& before,
                const Look& last, const typename Probe::Sample& sample, double limit, const Stops& stops,
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
