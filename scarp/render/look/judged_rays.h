// SPDX-License-Identifier: MIT
// The verdicts of the look `error` for arbitrary rays, with the steps that they took.
#pragma once

#include <array>
#include <span>

#include "scarp/base/progress.h"
#include "scarp/render/look/error_look.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// Returns the tolerance along the ray for a true hit, in metres; `judges` is the scene that found the hit.
double hit_tolerance(const Scene& judges, const Hit& truth, const ErrorSettings& settings);

struct JudgedRays {
  std::array<int, kVerdicts> rays{};  ///< number of rays by Verdict
  double mean_steps = 0;              ///< steps per ray

  int operator[](Verdict verdict) const { return rays[static_cast<std::size_t>(verdict)]; }
};

/// Judges the hits of these rays on `scene` by those on `judges`, the result of Scene::judge() for the same objects.
/// Throws Interrupted if `progress` returns false.
JudgedRays judge_rays(const Scene& scene, const Scene& judges, std::span<const Ray> rays, const ErrorSettings& settings,
                      const Progress& progress = {});

}  // namespace scarp
