// SPDX-License-Identifier: MIT
// Parallel loops over independent work items: on the executor of the calling thread (executor.h), otherwise on oneTBB.
#pragma once

#include <cstdint>
#include <functional>

#include "scarp/base/progress.h"

namespace scarp {

/// Calls body(begin, end) for disjoint pieces of [0, count), each of at most `grain` (>= 1) items, in any order, on
/// the executor of this thread's scope, or without one on all threads available to the process. Throws Interrupted if
/// `progress` returns false; rethrows exceptions of the body.
void parallel_for(std::int64_t count, std::int64_t grain, const std::function<void(std::int64_t, std::int64_t)>& body,
                  const Progress& progress = {});

/// Limits the threads of every parallel_for in the process that starts during its lifetime and has no executor:
/// threads >= 1, or 0 for all. For programs; a library that uses Scarp sets an ExecutorScope.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* control_ = nullptr;
};

}  // namespace scarp
