// SPDX-License-Identifier: MIT
#include "app/viewer/answer_worker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

// Opens once; threads wait at it.
class Gate {
 public:
  void open() {
    const std::scoped_lock lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  void pass() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return open_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
};

struct AnswerWorkerTest : testing::Test {
  std::vector<int> shown;
  std::atomic<int> ready = 0;
  AnswerWorker worker{[this] { ++ready; }};

  AnswerWorker::Pass pass(int number) {
    return
        [this, number](const Progress&) -> AnswerWorker::Show { return [this, number] { shown.push_back(number); }; };
  }
  void finish() {
    while (worker.busy()) {
      worker.deliver();
      std::this_thread::yield();
    }
  }
};

TEST_F(AnswerWorkerTest, DeliversPassesInOrderOnTheCallersThread) {
  Gate between;
  worker.ask({pass(1), [&](const Progress&) -> AnswerWorker::Show {
                between.pass();
                return [this] { shown.push_back(2); };
              }});
  while (!worker.deliver()) std::this_thread::yield();
  EXPECT_EQ(shown, (std::vector{1}));
  EXPECT_TRUE(worker.busy());
  between.open();
  finish();
  EXPECT_EQ(shown, (std::vector{1, 2}));
  EXPECT_EQ(ready, 2);
  EXPECT_FALSE(worker.deliver());
}

TEST_F(AnswerWorkerTest, NewQuestionsCancelAllPassesButTheFirst) {
  Gate begun, asked;
  std::atomic<bool> goes_on = false, cancelled = false;
  worker.ask({[&](const Progress& progress) -> AnswerWorker::Show {
                begun.open();
                asked.pass();
                goes_on = progress(0.5);
                return [this] { shown.push_back(1); };
              },
              pass(2)});
  begun.pass();
  // The first pass of the older question is shown, its second is not begun.
  Gate slow;
  worker.ask({pass(3), [&](const Progress& progress) -> AnswerWorker::Show {
                slow.open();
                while (progress(0.5)) std::this_thread::yield();
                cancelled = true;
                throw Interrupted();
              }});
  asked.open();
  slow.pass();
  EXPECT_TRUE(goes_on);
  worker.ask({pass(4)});
  finish();
  EXPECT_TRUE(cancelled);
  ASSERT_FALSE(shown.empty());
  EXPECT_EQ(shown.back(), 4);
  EXPECT_EQ(std::count(shown.begin(), shown.end(), 2), 0);
}

TEST_F(AnswerWorkerTest, CancelledAnswersAreNotShown) {
  Gate begun, cancelled;
  std::atomic<bool> goes_on = true;
  worker.ask({[&](const Progress& progress) -> AnswerWorker::Show {
    begun.open();
    cancelled.pass();
    goes_on = progress(0.5);
    return [this] { shown.push_back(1); };
  }});
  begun.pass();
  worker.cancel();
  worker.ask({pass(2)});
  cancelled.open();
  finish();
  EXPECT_FALSE(goes_on);
  EXPECT_EQ(shown, (std::vector{2}));
}

TEST_F(AnswerWorkerTest, ErrorsOfPassesReachTheCaller) {
  worker.ask({[](const Progress&) -> AnswerWorker::Show { throw Error("no ground"); }, pass(2)});
  EXPECT_THROW(finish(), Error);
  finish();
  EXPECT_TRUE(shown.empty());
}

TEST(AnswerWorkers, EndWhileTheyWork) {
  Gate begun;
  AnswerWorker worker([] {});
  worker.ask({[&](const Progress& progress) -> AnswerWorker::Show {
    begun.open();
    while (progress(0)) std::this_thread::yield();
    throw Interrupted();
  }});
  begun.pass();
}

}  // namespace
}  // namespace scarp::viewer
