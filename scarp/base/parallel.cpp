// SPDX-License-Identifier: MIT
#include "scarp/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <atomic>
#include <mutex>

#include "scarp/base/error.h"

namespace scarp {

void parallel_for(std::int64_t count, std::int64_t grain, const std::function<void(std::int64_t, std::int64_t)>& body,
                  const Progress& progress) {
  if (count <= 0) return;
  tbb::task_group_context context;
  std::atomic<std::int64_t> done{0};
  std::atomic<bool> stopped{false};
  std::mutex reporting;
  tbb::parallel_for(
      tbb::blocked_range<std::int64_t>(0, count, static_cast<std::size_t>(grain)),
      [&](const tbb::blocked_range<std::int64_t>& range) {
        body(range.begin(), range.end());
        if (!progress) return;
        const std::int64_t now = done += range.end() - range.begin();
        // Whoever finds another thread reporting leaves it to that one: a report is never worth a wait.
        const std::unique_lock<std::mutex> lock(reporting, std::try_to_lock);
        if (lock && !progress(static_cast<double>(now) / static_cast<double>(count))) {
          stopped = true;
          context.cancel_group_execution();
        }
      },
      tbb::simple_partitioner(), context);
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
