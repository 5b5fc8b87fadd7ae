// SPDX-License-Identifier: MIT
// The sampling marches (march/sampling/) over terrain functions. Each returns the closest hit that it finds within
// settings.function.reach. `stats` is overwritten unless null.
#pragma once

#include "scarp/base/march_trace.h"
#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"
#include "scarp/march/march_settings.h"

namespace scarp {

/// A ray that starts below the ground hits at its start. A ray that starts on the surface takes its first step without
/// a test. Uses settings.naive and settings.sampling.
Hit march_naive(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);

/// Steps are settings.function.step long, or grow with the distance by settings.function.step_share. Uses
/// settings.sampling.
Hit march_fixed_step(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                     MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);

/// Rays that start on the surface first step by 2^-10 of the exit distance. Uses settings.relaxed and
/// settings.sampling.
Hit march_relaxed(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                  MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);

/// The guarantee includes rounding. Rays that start on the surface first step by 2^-10 of the exit distance. Uses
/// settings.lipschitz.
Hit march_lipschitz(const HeightFunction& function, const Ray& ray, const MarchSettings& settings = {},
                    MarchStats* stats = nullptr, FunctionUse use = FunctionUse::march);

/// The same with FunctionUse::march, recorded: `trace` is overwritten.
Hit traced_naive(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                 MarchTrace& trace);
Hit traced_fixed_step(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                      MarchTrace& trace);
Hit traced_relaxed(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                   MarchTrace& trace);
Hit traced_lipschitz(const HeightFunction& function, const Ray& ray, const MarchSettings& settings, MarchStats* stats,
                     MarchTrace& trace);

}  // namespace scarp
