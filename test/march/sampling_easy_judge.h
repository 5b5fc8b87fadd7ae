// SPDX-License-Identifier: MIT
// Answers that the easy texts of naive, fixed-step, relaxed and lipschitz (march/sampling/*_easy.glsl) may give in
// floats. The judge follows the rule in double, point by point, and keeps with each time a bound on its distance from
// the shader's own time (doc/dev/numerics.md, "The easy texts over functions"). Where a decision is within its bound,
// both answers count.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scarp/base/ray.h"
#include "scarp/field/height_function.h"
#include "scarp/march/march_settings.h"

namespace scarp::test {

/// A status as in march_state.glsl.h, and a time with its bound; they matter for hits and exhausted rays.
struct TimedStatus {
  int status = 0;
  double t = 0, off = 0;
};

/// The answers of one ray.
struct EasyAnswers {
  TimedStatus exact;                 ///< of the rule in double
  std::vector<TimedStatus> allowed;  ///< of the shader; one, unless a decision was within its bound
  bool lost = false;                 ///< the bound became too wide to go on: the shader may also give other answers

  /// Empty if the shader may give this answer, otherwise the reason.
  std::string objection(int status, double t) const;
};

/// Follows a ray from t = 0 to ray.t_max, all of whose numbers are floats. The shader's ground is function.value() at a
/// float position, rounded to float. `march`: naive, fixed-step, relaxed, lipschitz.
EasyAnswers easy_answers(std::string_view march, const MarchSettings& settings, const HeightFunction& function,
                         const Ray& ray);

/// Whether the shader may hit at t by its own rule, whatever points came before. Not for fixed-step, whose points are
/// known beforehand.
bool may_hit_at(std::string_view march, const MarchSettings& settings, const HeightFunction& function, const Ray& ray,
                double t);

}  // namespace scarp::test
