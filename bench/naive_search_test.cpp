// SPDX-License-Identifier: MIT
#include "bench/naive_search.h"

#include <gtest/gtest.h>

namespace scarp::bench {
namespace {

// The number of steps falls as any setting grows; settings below three limits are good.
NaiveTrial limited(const NaiveSettings& settings) {
  return {settings.step_factor <= 0.2 && settings.min_step <= 1.0 / 1000 && settings.tolerance <= 0.01,
          100 / settings.step_factor + 0.1 / settings.min_step + 1 / (settings.tolerance + 0.001)};
}

TEST(NaiveSearch, LowersTheFactorUntilNaiveIsAccurate) {
  const auto found = cheapest_naive(limited);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->step_factor, 0.7 / 4);
  EXPECT_EQ(found->min_step, 1.0 / 1024);
  EXPECT_FALSE(cheapest_naive([](const NaiveSettings&) { return NaiveTrial{false, 1}; }));
}

TEST(NaiveSearch, CoarsensSettingsWhileAccurateAndCheaper) {
  const NaiveSettings found = *cheapest_naive(limited), coarser = coarsened_naive(found, limited);
  EXPECT_TRUE(limited(coarser).good);
  EXPECT_LT(limited(coarser).steps, limited(found).steps);
  EXPECT_GT(coarser.tolerance, 0.005);
  const NaiveSettings kept = coarsened_naive(found, [&](const NaiveSettings& settings) {
    return NaiveTrial{settings.min_step <= found.min_step, 100};
  });
  EXPECT_EQ(kept.min_step, found.min_step);
  EXPECT_EQ(kept.tolerance, found.tolerance);
}

TEST(NaiveSearch, KeepsTheToleranceIfEarlyHitsAreIgnored) {
  // Every tolerance is good, and larger ones take fewer steps.
  const auto attempt = [](const NaiveSettings& settings) {
    return NaiveTrial{settings.min_step <= 1.0 / 1000, 1 / settings.min_step + 1 / settings.tolerance};
  };
  const NaiveSettings found = *cheapest_naive(attempt);
  EXPECT_EQ(coarsened_naive(found, attempt, EarlyHits::ignored).tolerance, found.tolerance);
}

}  // namespace
}  // namespace scarp::bench
