// SPDX-License-Identifier: MIT
#include "scarp/render/look/function_error.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/function/function_exhaustive.h"
#include "scarp/march/function/lipschitz_local.h"
#include "scarp/render/light/light.h"
#include "scarp/render/surface/ramp.h"

namespace scarp {
namespace {

constexpr int kJudgedEvery = 8;  // in both directions

bool contradicts(const Hit& hit, const FunctionJudgement& judge, const Ray& ray, double tolerance) {
  if (judge.verdict == FunctionVerdict::clear) return static_cast<bool>(hit);
  if (judge.verdict != FunctionVerdict::crossing) return false;
  // Of several crossings within the tolerance any may be told, and a place that cannot be told from one.
  const double slack = tolerance * (judge.crossed_by - ray.t_min);
  return !hit || hit.t > judge.crossed_by + slack;
}

}  // namespace

FunctionErrorPicture render_function_error(const HeightFunction& function, const FunctionMarchEntry& march,
                                           const MarchSettings& march_settings, const Camera& camera,
                                           const FunctionErrorSettings& settings, const Progress& progress) {
  validate(march_settings);
  if (!(settings.share >= 0 && std::isfinite(settings.share))) {
    throw Error(
        fmt::format("picture: the error tolerance is {} of the distance; it must be 0 or more", settings.share));
  }
  if (!(settings.reach > 0 && std::isfinite(settings.reach))) {
    throw Error(fmt::format("picture: the reach is {}; it must be above 0 metres, and finite", settings.reach));
  }
  MarchSettings exact;
  exact.lipschitz_local.max_steps = 1 << 20;
  const Light light(SunSettings{}, 0);
  FunctionErrorPicture picture{Image(settings.width, settings.height), {}, 0, 0};
  std::array<std::atomic<std::int64_t>, kVerdicts> counts{};
  std::atomic<std::int64_t> judged = 0, contradictions = 0;
  parallel_for(
      settings.height, 1,
      [&](std::int64_t begin, std::int64_t end) {
        for (auto y = static_cast<int>(begin); y < end; ++y) {
          for (int x = 0; x < settings.width; ++x) {
            Ray ray = camera.ray(x + 0.5, y + 0.5);
            ray.t_max = settings.reach;
            const Hit truth = march_lipschitz_local(function, ray, exact);
            const Hit answer = march.cpu(function, ray, march_settings, nullptr, FunctionUse::march);
            const Verdict verdict = judge(answer, truth, settings.share * (truth ? truth.t : 0));
            ++counts[static_cast<std::size_t>(verdict)];
            vec3 colour = linear_from_srgb(srgb_of(verdict));
            if (truth) {
              const dvec3 p = ray.at(truth.t);
              const dvec2 slope = function.gradient(p.x, p.y, FunctionUse::march);
              colour *= light.on(normalize(dvec3(-slope.x, -slope.y, 1)), true);
            }
            set_pixel(picture.image, x, y, colour);
            if (x % kJudgedEvery == kJudgedEvery / 2 && y % kJudgedEvery == kJudgedEvery / 2 &&
                truth.status != HitStatus::below) {
              const FunctionJudgement judgement = judge_function(function.function(), ray);
              judged += judgement.verdict != FunctionVerdict::undecided;
              contradictions += contradicts(truth, judgement, ray, exact.lipschitz_local.tolerance);
            }
          }
        }
      },
      progress);
  for (std::size_t i = 0; i < counts.size(); ++i) picture.counts.pixels[i] = counts[i];
  picture.judged = judged, picture.contradictions = contradictions;
  return picture;
}

}  // namespace scarp
