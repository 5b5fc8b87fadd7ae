// SPDX-License-Identifier: MIT
// Private to the station: the loops of naive, fixed-step, relaxed and lipschitz as functions of a probe, which the
// queries of each kind of field call with a plain probe or with one that records (traced_probe.h).
#pragma once

#include "scarp/march/sampling/fixed_step.h"
#include "scarp/march/sampling/lipschitz.h"
#include "scarp/march/sampling/naive.h"
#include "scarp/march/sampling/relaxed.h"

namespace scarp {

inline auto naive_loop(const MarchSettings& settings) {
  return [&settings](const auto& probe, MarchStats& counted) { return naive_over(probe, settings, counted); };
}
inline auto fixed_step_loop(const MarchSettings& settings) {
  return [&settings](const auto& probe, MarchStats& counted) { return fixed_step_over(probe, settings, counted); };
}
inline auto relaxed_loop(const MarchSettings& settings) {
  return [&settings](const auto& probe, MarchStats& counted) { return relaxed_over(probe, settings, counted); };
}
inline auto lipschitz_loop(const MarchSettings& settings, const ShrinkFactor& shrink) {
  return [&settings, shrink](const auto& probe, MarchStats& counted) {
    return lipschitz_over(probe, settings.lipschitz, shrink, counted);
  };
}

}  // namespace scarp
