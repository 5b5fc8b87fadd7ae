// SPDX-License-Identifier: MIT
// Random calls with hostile arguments: none crashes, hangs or leaks, each returns a status, and every refusal says why.
// The sanitizers judge memory.
#include <gtest/gtest.h>

#include <random>

#include "c/hostile.h"
#include "scarp/scarp_c.h"

namespace {

// Sanitizers take ten times as long.
#if defined(__SANITIZE_ADDRESS__)
constexpr int kCalls = 100'000;
#elif defined(__has_feature)
constexpr int kCalls = __has_feature(address_sanitizer) ? 100'000 : 1'000'000;
#else
constexpr int kCalls = 1'000'000;
#endif

TEST(C, SurvivesHostileCalls) {
  scarp::test::Hostile hostile(std::minstd_rand(5));
  for (int i = 0; i < kCalls; ++i) hostile.call();
  EXPECT_GT(hostile.counts[0], kCalls / 10);
  EXPECT_GT(hostile.counts[1], kCalls / 10);
  EXPECT_EQ(scarp_use_threads(nullptr), SCARP_OK);
}

}  // namespace
