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
#include "scarp/base/executor.h"
#include "scarp/base/progress_part.h"

namespace scarp {
namespace {

TEST(ParallelFor, CoversTheRangeOnceForAnyGrain) {
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

TEST(ParallelFor, DoesNothingForAnEmptyRange) {
  for (const std::int64_t count : {0, -1}) {
    parallel_for(count, 1, [](std::int64_t, std::int64_t) { FAIL(); });
  }
}

// Written by many threads without locks and read afterwards, for the thread sanitizer.
TEST(ParallelFor, WritesAreVisibleAfterwards) {
  std::vector<int> squares(100000, -1);
  parallel_for(100000, 100, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) squares[static_cast<std::size_t>(i)] = static_cast<int>(i % 1000);
  });
  EXPECT_EQ(std::accumulate(squares.begin(), squares.end(), std::int64_t{0}), std::int64_t{100} * 999 * 500);
}

TEST(ParallelFor, PropagatesExceptions) {
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

TEST(ParallelFor, ReportsProgressSeriallyUpToOne) {
  std::vector<double> shares;  // without a lock: parallel_for guarantees one report at a time
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

// Many short pieces, so that threads report in quick succession.
TEST(ParallelFor, ProgressNeverDecreases) {
  double last = 0;
  parallel_for(
      1'000'000, 1, [](std::int64_t, std::int64_t) {},
      [&](double share) {
        EXPECT_GE(share, last);
        last = share;
        return true;
      });
}

TEST(ProgressPart, PartsDivideTheTask) {
  double share = 0;
  bool goes_on = true;
  const Progress all = [&](double now) {
    share = now;
    return goes_on;
  };
  EXPECT_TRUE(progress_part(all, 1, 4)(0.5));
  EXPECT_EQ(share, 0.375);
  EXPECT_TRUE(progress_part(progress_part(all, 3, 4), 1, 2)(1));
  EXPECT_EQ(share, 1);
  goes_on = false;
  EXPECT_FALSE(progress_part(all, 0, 2)(0.5));
  EXPECT_FALSE(progress_part({}, 0, 2)) << "no reports without a callback";
}

TEST(ParallelFor, ThrowsInterruptedWhenProgressReturnsFalse) {
  std::atomic<int> pieces{0};
  EXPECT_THROW(parallel_for(
                   100000, 1, [&](std::int64_t, std::int64_t) { ++pieces; }, [](double) { return false; }),
               Interrupted);
  EXPECT_LT(pieces, 100000) << "the rest of the work was done all the same";
}

TEST(ParallelFor, ReachesOneWhenAnotherThreadHoldsTheReport) {
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

TEST(ParallelFor, ThrowsInterruptedAfterASingleFalseReport) {
  int reports = 0;
  EXPECT_THROW(parallel_for(
                   1000, 1, [](std::int64_t, std::int64_t) {}, [&](double) { return ++reports > 1; }),
               Interrupted);
}

TEST(ParallelFor, ThrowsInterruptedOnTheLastReport) {
  EXPECT_THROW(parallel_for(
                   10, 1, [](std::int64_t, std::int64_t) {}, [](double share) { return share < 1.0; }),
               Interrupted);
}

// A thread pool like an engine's: persistent threads, each with every n-th piece.
class Pool final : public Executor {
 public:
  void run(std::int64_t pieces, const std::function<void(std::int64_t)>& piece) override {
    ++runs;
    std::atomic<std::int64_t> next{0};
    const auto work = [&] {
      in_pool = true;
      for (std::int64_t i = next++; i < pieces; i = next++) piece(i);
    };
    std::thread one(work), two(work);
    one.join();
    two.join();
  }
  std::atomic<int> runs{0};
  static thread_local bool in_pool;
};
thread_local bool Pool::in_pool = false;

TEST(Executor, RunsEveryPieceOnceInThePool) {
  Pool pool;
  const ExecutorScope scope(pool);
  std::vector<std::atomic<int>> visits(1009);
  std::atomic<int> elsewhere{0}, nested{0};
  parallel_for(1009, 10, [&](std::int64_t begin, std::int64_t end) {
    elsewhere += !Pool::in_pool;
    const auto here = std::this_thread::get_id();
    parallel_for(100, 7, [&](std::int64_t b, std::int64_t e) {
      elsewhere += std::this_thread::get_id() != here;
      nested += static_cast<int>(e - b);
    });
    for (std::int64_t i = begin; i < end; ++i) ++visits.at(static_cast<std::size_t>(i));
  });
  EXPECT_TRUE(std::all_of(visits.begin(), visits.end(), [](const std::atomic<int>& v) { return v == 1; }));
  EXPECT_EQ(elsewhere, 0);
  EXPECT_EQ(nested, 101 * 100);
  EXPECT_EQ(pool.runs, 1);
}

TEST(Executor, IsPerThreadAndScoped) {
  Pool pool;
  EXPECT_EQ(current_executor(), nullptr);
  {
    const ExecutorScope scope(pool);
    const ExecutorScope inner(caller_thread());
    EXPECT_EQ(current_executor(), &caller_thread());
    std::thread([] { EXPECT_EQ(current_executor(), nullptr); }).join();
    const auto here = std::this_thread::get_id();
    std::int64_t next = 0;
    parallel_for(1000, 10, [&](std::int64_t begin, std::int64_t end) {
      EXPECT_EQ(std::this_thread::get_id(), here);
      EXPECT_EQ(begin, next);
      next = end;
    });
    EXPECT_EQ(next, 1000);
  }
  EXPECT_EQ(current_executor(), nullptr);
  EXPECT_EQ(pool.runs, 0);
}

TEST(Executor, PropagatesExceptionsAndInterruptions) {
  Pool pool;
  const ExecutorScope scope(pool);
  EXPECT_THROW(parallel_for(1000, 10,
                            [](std::int64_t begin, std::int64_t) {
                              if (begin == 500) throw std::out_of_range("piece 500");
                            }),
               std::out_of_range);
  std::atomic<int> pieces{0};
  EXPECT_THROW(parallel_for(
                   100000, 1, [&](std::int64_t, std::int64_t) { ++pieces; }, [](double) { return false; }),
               Interrupted);
  EXPECT_LT(pieces, 100000);
  std::vector<double> shares;
  parallel_for(
      10, 10, [](std::int64_t, std::int64_t) {},
      [&](double share) {
        shares.push_back(share);
        return true;
      });
  EXPECT_EQ(shares.back(), 1.0);
}

TEST(ThreadLimit, OfOneRunsPiecesSerially) {
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
