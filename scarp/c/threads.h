// SPDX-License-Identifier: MIT
// The threads that the caller gave for this thread's batches and builds.
#pragma once

#include <optional>

#include "scarp/base/executor.h"
#include "scarp/c/failure.h"

namespace scarp::c {

/// Returns the executor of scarp_use_threads() in this thread; null if there is none.
Executor* caller_threads();

/// guarded() on these threads.
template <class Body>
scarp_status guarded_on_threads(const Body& body) noexcept {
  return guarded([&] {
    std::optional<ExecutorScope> scope;
    if (Executor* threads = caller_threads()) scope.emplace(*threads);
    body();
  });
}

}  // namespace scarp::c
