// SPDX-License-Identifier: MIT
// `naive`: steps by the vertical distance h between ray and ground, never less than a fraction of the ray's length; it
// hits where h is small, with a tolerance that grows with distance.
//
//   t = t_enter;   h = ray height - ground;   h < tolerance * t: hit;   t += max(step_factor * |h|, min_step * t_exit)
//
// t and t_exit, where the ray leaves the field, count from t_min here: the distance travelled, and its maximum.
// SamplingSettings::tolerance is a height that counts as a hit at any distance. A ray from the surface starts within
// it: its steps are no shorter than this height, and it hits only where it is deeper below ground.
//
// The hit is refined on request (Refinement): `secant`, from I. Quilez, "Rainforest", 2016, draws a straight line
// through the last two clearances, and ends where it reaches the tolerance, not the ground.
//
// Guarantee: approximate. The vertical distance is an overestimate: rays step over steep ground (holes in the picture),
// and rays that graze the ground stop before it. This is the baseline of the max-mip article, in which this march took
// 55.066 ms and max-mip 9.074 ms. Cost: at most 1 / min_step forced steps, plus those determined by h; one height per
// step.
#pragma once

#include <algorithm>
#include <cmath>

#include "scarp/march/march_settings.h"
#include "scarp/march/sampling/sampling.h"

namespace scarp {

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
    // Over a hole no height is known.
    t += std::max(point.known ? settings.step_factor * std::abs(point.h) : 0.0, least);
  }
  return ground.missed();
}

}  // namespace scarp
