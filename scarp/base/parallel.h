// SPDX-License-Identifier: MIT
// Loops over many independent pieces of work, on all cores (oneTBB).
#pragma once

#include <cstdint>
#include <functional>

#include "scarp/base/progress.h"

namespace scarp {

/// Calls body(begin, end) for pieces of [0, count) of at most `grain` (>= 1), in any order, on all threads that the
/// process may use. Reports progress and throws Interrupted when it is asked to stop; lets the body's exceptions
/// through.
void parallel_for(std::int64_t count, std::int64_t grain, const std::function<void(std::int64_t, std::int64_t)>& body,
                  const Progress& progress = {});

/// Limits the threads of every later parallel_for while it lives; threads >= 1, or 0 for all.
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
