// SPDX-License-Identifier: MIT
// `lipschitz`: sphere tracing of a height field. The vertical distance h overestimates the distance to the ground, but
// with a bound c on the ground's slope no ground is nearer than h / sqrt(1 + c^2), so a step of that length is safe.
//
//            o  h above the ground: the nearest ground can rise towards the ray by c per metre, and no more,
//           /|\                     so a ball of radius h / sqrt(1 + c^2) is free of it
//          / | \      shrink = 1 / sqrt(1 + c^2)
//    _____/__|__\____
//
// c is slope_bound() of the field, the certified slope of the function, or given (settings.lipschitz.shrink). This
// bound does not hold across a hole: the ground may have any height on its far side. Steps therefore stay within the
// largest hole-free block of the pyramid around the point; over a hole a step ends at the edge of its cell.
//
// Guarantee: conservative. A hit is reported above the ground, within the tolerance; a ray that comes too close to
// advance is exhausted. A ray that starts on the surface steps off it by one cell without a test. A ray that starts
// below the ground is `below`. A ray that enters below it through the border is followed (sampling.h) with the same
// factor; it may skip stretches above the ground that are shorter than 2^-12 of a cell. A ray that enters below the
// ground from a hole is exhausted, because it may have touched the rim.
//
// With a shrink factor above 1 / sqrt(1 + c^2), steps may pass through the ground, as in shaders whose factor was found
// by trial and error. The guarantee is then approximate: the first sample below the ground is the hit, and pictures
// show holes and halos. Source: J. C. Hart, "Sphere tracing", The Visual Computer 12, 1996; the factor for height
// functions as in the founding text on Lipschitz bounds. Cost: up to 1024 heights per ray, most on steep fields, where
// c is that of the steepest cell.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "scarp/march/march_settings.h"
#include "scarp/march/sampling/sampling.h"
#include "scarp/march/sampling/shrink_factor.h"

namespace scarp {

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

}  // namespace scarp
