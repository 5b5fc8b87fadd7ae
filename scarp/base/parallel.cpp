// SPDX-License-Identifier: MIT
#include "scarp/base/parallel.h"

#ifndef SCARP_WITHOUT_TBB
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>
#endif

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

#include "scarp/base/error.h"
#include "scarp/base/executor.h"

#ifdef SCARP_TSAN
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
#endif

namespace scarp {

namespace {

// The thread sanitizer cannot see into TBB and reports every hand-over of work as a race. Sanitizer builds compile this
// file without instrumentation and annotate what TBB guarantees: pieces see what was written before the loop, and code
// after the loop sees what pieces wrote. In other builds this does nothing.
#ifdef SCARP_WITHOUT_TBB
// The loops are serial.
#elif defined(SCARP_TSAN)
class HandOver {
 public:
  HandOver() { __tsan_release(&begin_); }
  void enter_piece() { __tsan_acquire(&begin_); }
  void leave_piece() { __tsan_release(&end_); }
  ~HandOver() { __tsan_acquire(&end_); }

 private:
  char begin_ = 0;
  char end_ = 0;
};
#else
struct HandOver {
  void enter_piece() {}
  void leave_piece() {}
};
#endif

// The pieces of a loop, on any thread: counts the completed items for `progress`.
class Pieces {
 public:
  Pieces(std::int64_t count, const std::function<void(std::int64_t, std::int64_t)>& body, const Progress& progress)
      : count_(count), body_(body), progress_(progress) {}

  /// Returns false when no more pieces need to run.
  bool run(std::int64_t begin, std::int64_t end) {
    body_(begin, end);
    if (!progress_) return true;
    done_ += end - begin;
    // A thread skips its report if another thread is reporting, instead of waiting. The fraction is read under the
    // lock; otherwise an older value could follow a newer one.
    const std::unique_lock<std::mutex> lock(reporting_, std::try_to_lock);
    if (lock && !progress_(static_cast<double>(done_) / static_cast<double>(count_))) stopped_ = true;
    return !stopped_;
  }
  bool stopped() const { return stopped_; }

 private:
  std::int64_t count_;
  const std::function<void(std::int64_t, std::int64_t)>& body_;
  const Progress& progress_;
  std::atomic<std::int64_t> done_{0};
  std::atomic<bool> stopped_{false};
  std::mutex reporting_;
};

#ifdef SCARP_WITHOUT_TBB
void run_on_all_threads(std::int64_t count, std::int64_t grain, Pieces& pieces) {
  for (std::int64_t begin = 0; begin < count && pieces.run(begin, std::min(count, begin + grain)); begin += grain) {
  }
}
#else
void run_on_all_threads(std::int64_t count, std::int64_t grain, Pieces& pieces) {
  tbb::task_group_context context;
  HandOver hand_over;
  tbb::parallel_for(
      tbb::blocked_range<std::int64_t>(0, count, static_cast<std::size_t>(grain)),
      [&](const tbb::blocked_range<std::int64_t>& range) {
        hand_over.enter_piece();
        if (!pieces.run(range.begin(), range.end())) context.cancel_group_execution();
        hand_over.leave_piece();
      },
      tbb::simple_partitioner(), context);
}
#endif

void run_on(Executor& executor, std::int64_t count, std::int64_t grain, Pieces& pieces) {
  std::atomic<bool> over{false};
  std::exception_ptr thrown;
  std::mutex throwing;
  executor.run((count - 1) / grain + 1, [&](std::int64_t piece) {
    if (over) return;
    // Loops within the piece run in its thread.
    const ExecutorScope own(caller_thread());
    try {
      if (!pieces.run(piece * grain, std::min(count, (piece + 1) * grain))) over = true;
    } catch (...) {
      const std::scoped_lock lock(throwing);
      if (!thrown) thrown = std::current_exception();
      over = true;
    }
  });
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace

void parallel_for(std::int64_t count, std::int64_t grain, const std::function<void(std::int64_t, std::int64_t)>& body,
                  const Progress& progress) {
  if (count <= 0) return;
  // A single piece runs here, without waking another thread.
  if (count <= grain && !progress) return body(0, count);
  Pieces pieces(count, body, progress);
  Executor* const executor = current_executor();
  if (executor && count > grain) {
    run_on(*executor, count, grain, pieces);
  } else if (executor) {
    pieces.run(0, count);
  } else {
    run_on_all_threads(count, grain, pieces);
  }
  if (pieces.stopped()) throw Interrupted();
  if (progress && !progress(1.0)) throw Interrupted();
}

#ifdef SCARP_WITHOUT_TBB
ThreadLimit::ThreadLimit(int) {}
ThreadLimit::~ThreadLimit() = default;
#else
ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0) {
    control_ = new tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
}

ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(control_); }
#endif

}  // namespace scarp
