// SPDX-License-Identifier: MIT
// The verdicts on some rays of a picture and on one pixel, as text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scarp/render/look/judged_rays.h"

namespace scarp::viewer {

/// "23.4 steps per ray; 3 of 1000 sampled rays wrong: 2 lost, 1 early"; empty if no rays were judged.
std::string verdict_text(const std::optional<JudgedRays>& judged);

/// The ray of a pixel.
struct JudgedPixel {
  std::uint32_t steps = 0;
  std::optional<Verdict> verdict{};  ///< nullopt: the march judges itself
  double error_m = 0;                ///< of error_metres()
};
/// Traces a ray by the marches of `scene`, and judges its hit if `judges`, the result of Scene::judge(), has others.
/// Throws Error for fields that are only on a device.
JudgedPixel judge_pixel(const Scene& scene, const Scene& judges, const Ray& ray, const ErrorSettings& settings);
/// "12 steps here: early by 3.21 m"; "12 steps here".
std::string pixel_text(const JudgedPixel& pixel);

}  // namespace scarp::viewer
