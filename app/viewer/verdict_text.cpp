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

}  // namespace scarp::viewer
