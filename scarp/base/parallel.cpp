// SPDX-License-Identifier: MIT
#include "scarp/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <atomic>
#include <mutex>

#include "scarp/base/error.h"

#ifdef SCARP_TSAN
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
#endif

namespace scarp {

namespace {

// The thread sanitizer cannot see into TBB and reports every hand-over of work as a race. Sanitizer builds compile this
// file without instrumentation and annotate what TBB guarantees: pieces see what was written before the loop, and code
// after the loop sees what pieces wrote. In other builds this does nothing.
#ifdef SCARP_TSAN
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

}  // namespace

void parallel_for(std::int64_t count, std::int64_t grain, const std::function<void(std::int64_t, std::int64_t)>& body,
                  const Progress& progress) {
  if (count <= 0) return;
  // A single piece runs here: no other thread need wake.
  if (count <= grain && !progress) return body(0, count);
  tbb::task_group_context context;
  std::atomic<std::int64_t> done{0};
  std::atomic<bool> stopped{false};
  std::mutex reporting;
  const auto run_piece = [&](std::int64_t begin, std::int64_t end) {
    body(begin, end);
    if (!progress) return;
    done += end - begin;
    // A thread that finds another one reporting skips its report instead of waiting. The fraction is read under the
    // lock; otherwise an older value could follow a newer one.
    const std::unique_lock<std::mutex> lock(reporting, std::try_to_lock);
    if (lock && !progress(static_cast<double>(done) / static_cast<double>(count))) {
      stopped = true;
      context.cancel_group_execution();
    }
  };
  {
    HandOver hand_over;
    tbb::parallel_for(
        tbb::blocked_range<std::int64_t>(0, count, static_cast<std::size_t>(grain)),
        [&](const tbb::blocked_range<std::int64_t>& range) {
          hand_over.enter_piece();
          run_piece(range.begin(), range.end());
          hand_over.leave_piece();
        },
        tbb::simple_partitioner(), context);
  }
  if (stopped) throw Interrupted();
  if (progress && !progress(1.0)) throw Interrupted();
}

ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0) {
    control_ = new tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
}

ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(control_); }

}  // namespace scarp
