// SPDX-License-Identifier: MIT
#include "scarp/render/look/judged_rays.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "scarp/base/error.h"

namespace scarp {
namespace {

// A ray traced by `exhaustive` may take a millisecond: this many rays take a tenth of a second on one processor.
constexpr std::size_t kRaysAtOnce = 100;

}  // namespace

double hit_tolerance(const Scene& judges, const Hit& truth, const ErrorSettings& settings) {
  if (!truth) return 0;
  const double cell = judges.field_of(truth.object).cell_side() * judges.objects()[truth.object].placement.scale;
  return cell > 0 ? settings.tolerance * cell : settings.share * truth.t;
}

JudgedRays judge_rays(const Scene& scene, const Scene& judges, std::span<const Ray> rays, const ErrorSettings& settings,
                      const Progress& progress) {
  JudgedRays judged;
  std::vector<Hit> answers(rays.size()), truths(rays.size());
  std::vector<std::uint32_t> steps(rays.size());
  scene.closest_hits(rays, answers, steps);
  for (std::size_t first = 0; first < rays.size(); first += kRaysAtOnce) {
    if (progress && !progress(static_cast<double>(first) / static_cast<double>(rays.size()))) throw Interrupted();
    const std::size_t count = std::min(kRaysAtOnce, rays.size() - first);
    judges.closest_hits(rays.subspan(first, count), std::span(truths).subspan(first, count));
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Verdict verdict = judge(answers[i], truths[i], hit_tolerance(judges, truths[i], settings));
    ++judged.rays[static_cast<std::size_t>(verdict)];
  }
  if (!rays.empty())
    judged.mean_steps = std::accumulate(steps.begin(), steps.end(), 0.0) / static_cast<double>(rays.size());
  return judged;
}

}  // namespace scarp
