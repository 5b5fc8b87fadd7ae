// SPDX-License-Identifier: MIT
#include "app/viewer/verdict_text.h"

#include <fmt/format.h>

namespace scarp::viewer {

std::string verdict_text(const std::optional<JudgedRays>& judged) {
  if (!judged) return {};
  int count = 0, wrong = 0;
  std::string what;
  for (int i = 0; i < kVerdicts; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    const int rays = (*judged)[verdict];
    count += rays;
    if (rays == 0 || verdict == Verdict::right_hit || verdict == Verdict::right_miss || verdict == Verdict::not_judged)
      continue;
    wrong += rays;
    what += fmt::format("{}{} {}", what.empty() ? ": " : ", ", rays, name_of(verdict));
  }
  return fmt::format("{:.1f} steps per ray; {} of {} sampled rays wrong{}", judged->mean_steps, wrong, count, what);
}

JudgedPixel judge_pixel(const Scene& scene, const Scene& judges, const Ray& ray, const ErrorSettings& settings) {
  JudgedPixel pixel;
  Hit answer;
  scene.closest_hits({&ray, 1}, {&answer, 1}, {&pixel.steps, 1});
  if (scene.marches() == judges.marches()) return pixel;
  const Hit truth = judges.closest_hit(ray);
  pixel.verdict = judge(answer, truth, hit_tolerance(judges, truth, settings));
  pixel.error_m = error_metres(*pixel.verdict, ray, answer, truth);
  return pixel;
}

std::string pixel_text(const JudgedPixel& pixel) {
  const std::string steps = fmt::format("{} {} here", pixel.steps, pixel.steps == 1 ? "step" : "steps");
  if (!pixel.verdict) return steps;
  const std::string metres = has_metres(*pixel.verdict) ? fmt::format(" by {:.2f} m", pixel.error_m) : std::string();
  return fmt::format("{}: {}{}", steps, name_of(*pixel.verdict), metres);
}

}  // namespace scarp::viewer
