// SPDX-License-Identifier: MIT
// The sampling marches (march/sampling/) over height fields. Each returns the closest hit that it finds, in
// [t_min, t_max] and inside the field; `stats` is overwritten unless null.
#pragma once

#include "scarp/base/march_trace.h"
#include "scarp/march/height/height_target.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// The hit's `height` is that of the ray's point. A ray that starts below the ground hits at its start. A ray that
/// starts on the surface takes its first step without a test. Uses settings.naive and settings.sampling; no pyramid.
Hit march_naive(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                MarchStats* stats = nullptr);

/// Walls of solid ground are hit at the first sample behind them. Uses settings.fixed_step and settings.sampling; no
/// pyramid.
Hit march_fixed_step(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                     MarchStats* stats = nullptr);

/// A ray that starts on the surface steps off it by one cell without a test. A ray that starts below the ground is
/// `below`. Uses settings.relaxed and settings.sampling; no pyramid.
Hit march_relaxed(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                  MarchStats* stats = nullptr);

/// Conventions as in ray.h. Uses settings.lipschitz, and target.slope unless a shrink factor is set there. Throws Error
/// when both are missing.
Hit march_lipschitz(const HeightTarget& target, const Ray& ray, const MarchSettings& settings = {},
                    MarchStats* stats = nullptr);

/// The same, recorded: `trace` is overwritten.
Hit traced_naive(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                 MarchTrace& trace);
Hit traced_fixed_step(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                      MarchTrace& trace);
Hit traced_relaxed(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                   MarchTrace& trace);
Hit traced_lipschitz(const HeightTarget& target, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                     MarchTrace& trace);

}  // namespace scarp
