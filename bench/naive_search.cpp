// SPDX-License-Identifier: MIT
#include "bench/naive_search.h"

namespace scarp::bench {
namespace {

constexpr double kCoarsestStep = 1.0 / 64, kFinestStep = 1.0 / (1 << 20);
constexpr int kFactorHalvings = 6;
// The height above ground that counts as a hit, relative to the least step: small enough that early hits of naive, like
// its misses, depend only on the step.
constexpr double kTolerancePerStep = 1.0 / 16;
// A gain below this fraction of the steps does not count.
constexpr double kLeastGain = 0.01;
constexpr double kMostFactor = 1;

}  // namespace

std::optional<NaiveSettings> cheapest_naive(const std::function<NaiveTrial(const NaiveSettings&)>& attempt,
                                            double most_steps) {
  std::optional<NaiveSettings> best;
  double best_steps = 0;
  NaiveSettings settings;
  for (int halving = 0; halving <= kFactorHalvings; ++halving, settings.step_factor /= 2) {
    for (double min_step = kCoarsestStep; min_step >= kFinestStep; min_step /= 2) {
      settings.min_step = min_step;
      settings.tolerance = kTolerancePerStep * min_step;
      // No ray needs more steps than with only minimum steps, so none is given up.
      settings.max_steps = static_cast<int>(1 / min_step) + 2;
      const NaiveTrial trial = attempt(settings);
      // Finer settings only take more steps.
      if (best && trial.steps >= best_steps) break;
      if (trial.good) {
        best = settings;
        best_steps = trial.steps;
        break;
      }
      if (trial.steps > most_steps) break;
    }
  }
  return best;
}

NaiveSettings coarsened_naive(NaiveSettings settings, const std::function<NaiveTrial(const NaiveSettings&)>& attempt,
                              EarlyHits early) {
  struct Coarsening {
    double NaiveSettings::*member;
    double ratio;
  };
  constexpr Coarsening kCoarsenings[] = {
      {&NaiveSettings::tolerance, 4},  {&NaiveSettings::tolerance, 1.5},   {&NaiveSettings::min_step, 1.4},
      {&NaiveSettings::min_step, 1.2}, {&NaiveSettings::step_factor, 1.4}, {&NaiveSettings::step_factor, 1.2},
  };
  double steps = attempt(settings).steps;
  for (const auto& [member, ratio] : kCoarsenings) {
    if (early == EarlyHits::ignored && member == &NaiveSettings::tolerance) continue;
    for (;;) {
      NaiveSettings coarser = settings;
      coarser.*member *= ratio;
      if (coarser.step_factor > kMostFactor) break;
      const NaiveTrial trial = attempt(coarser);
      if (!trial.good || trial.steps > (1 - kLeastGain) * steps) break;
      settings = coarser;
      steps = trial.steps;
    }
  }
  return settings;
}

}  // namespace scarp::bench
