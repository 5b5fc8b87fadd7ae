// SPDX-License-Identifier: MIT
#include "scarp/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "scarp/base/error.h"

namespace scarp {
namespace {

TEST(ParallelFor, CoversTheRangeOnceWhateverTheGrain) {
  for (const std::int64_t count : {1, 2, 3, 64, 1000, 1009}) {
    for (const std::int64_t grain : {1, 7, 64, 5000}) {
      std::vector<std::atomic<int>> visits(static_cast<std::size_t>(count));
      parallel_for(count, grain, [&](std::int64_t begin, std::int64_t end) {
        ASSERT_LT(begin, end);
        ASSERT_LE(end - begin, grain);
        for (std::int64_t i = begin; i < end; ++i) ++visits.at(static_cast<std::size_t>(i));
      });
      const auto once = [](const std::atomic<int>& v) { return v == 1; };
      EXPECT_TRUE(std::all_of(visits.begin(), visits.end(), once)) << "count " << count << ", grain " << grain;
    }
  }
}

TEST(ParallelFor, CallsNothingForAnEmptyRange) {
  for (const std::int64_t count : {0, -1}) {
    parallel_for(count, 1, [](std::int64_t, std::int64_t) { FAIL(); });
  }
}

// Written by many threads without locks and read afterwards: what the thread sanitizer is run on.
TEST(ParallelFor, WhatTheBodyWroteIsVisibleAfterwards) {
  std::vector<int> squares(100000, -1);
  parallel_for(100000, 100, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) squares[static_cast<std::size_t>(i)] = static_cast<int>(i % 1000);
  });
  EXPECT_EQ(std::accumulate(squares.begin(), squares.end(), std::int64_t{0}), std::int64_t{100} * 999 * 500);
}

TEST(ParallelFor, LetsTheBodysExceptionThrough) {
  const auto body = [](std::int64_t begin, std::int64_t end) {
    if (begin <= 500 && 500 < end) throw std::out_of_range("piece 500");
  };
  try {
    parallel_for(1000, 10, body);
    FAIL() << "no exception";
  } catch (const std::out_of_range& error) {
    EXPECT_STREQ(error.what(), "piece 500");
  }
}

TEST(ParallelFor, ReportsSharesOneAtATimeAndEndsAtOne) {
  std::vector<double> shares;  // no lock of its own: parallel_for promises one report at a time
  parallel_for(
      1000, 10, [](std::int64_t, std::int64_t) {},
      [&](double share) {
        shares.push_back(share);
        return true;
      });
  ASSERT_FALSE(shares.empty());
  EXPECT_EQ(shares.back(), 1.0);
  for (const double share : shares) {
    EXPECT_GT(share, 0.0);
    EXPECT_LE(share, 1.0);
  }
}

// Many short pieces, so that threads come to report just after one another.
TEST(ParallelFor, NeverReportsLessThanBefore) {
  double last = 0;
  parallel_for(
      1'000'000, 1, [](std::int64_t, std::int64_t) {},
      [&](double share) {
        EXPECT_GE(share, last);
        last = share;
        return true;
      });
}

TEST(ParallelFor, StopsWithInterruptedWhenTheReportSaysSo) {
  std::atomic<int> pieces{0};
  EXPECT_THROW(parallel_for(
                   100000, 1, [&](std::int64_t, std::int64_t) { ++pieces; }, [](double) { return false; }),
               Interrupted);
  EXPECT_LT(pieces, 100000) << "the rest of the work was done all the same";
}

TEST(ParallelFor, EndsAtOneEvenWhenTheLastPiecesFoundAnotherThreadReporting) {
  std::atomic<int> pieces{0};
  std::vector<double> shares;
  // The first report takes until all other pieces are done (or, on a single core, a moment).
  const auto report = [&](double share) {
    const auto patience = std::chrono::steady_clock::now() + std::chrono::milliseconds(200);
    while (shares.empty() && pieces < 100 && std::chrono::steady_clock::now() < patience) std::this_thread::yield();
    shares.push_back(share);
    return true;
  };
  parallel_for(
      100, 1, [&](std::int64_t, std::int64_t) { ++pieces; }, report);
  EXPECT_EQ(shares.back(), 1.0);
}

TEST(ParallelFor, StopsWithInterruptedWhenOneReportSaysSoAndLaterOnesWouldNot) {
  int reports = 0;
  EXPECT_THROW(parallel_for(
                   1000, 1, [](std::int64_t, std::int64_t) {}, [&](double) { return ++reports > 1; }),
               Interrupted);
}

TEST(ParallelFor, StopsWithInterruptedAtTheVeryLastReport) {
  EXPECT_THROW(parallel_for(
                   10, 1, [](std::int64_t, std::int64_t) {}, [](double share) { return share < 1.0; }),
               Interrupted);
}

TEST(ThreadLimit, OfOneRunsOnePieceAtATime) {
  const ThreadLimit limit(1);
  std::atomic<int> running{0};
  std::atomic<int> most{0};
  parallel_for(1000, 1, [&](std::int64_t, std::int64_t) {
    most = std::max(most.load(), ++running);
    --running;
  });
  EXPECT_EQ(most, 1);
}

}  // namespace
}  // namespace scarp
