// SPDX-License-Identifier: MIT
// Lets the caller supply the threads that Scarp's parallel work runs on.
//
//   struct Jobs final : scarp::Executor {
//     void run(std::int64_t pieces, const std::function<void(std::int64_t)>& piece) override {
//       engine_pool.for_each_index_and_wait(pieces, piece);
//     }
//   } jobs;
//
//   const scarp::ExecutorScope scope(jobs);     // for this thread, until the scope ends
//   scarp::cast(scene, rays, hits);             // on the engine's threads
//
// Without an executor, batches run on all threads of oneTBB. Nothing here is process-wide: each thread uses the
// executor of its innermost scope.
#pragma once

#include <cstdint>
#include <functional>

namespace scarp {

class Executor {
 public:
  virtual ~Executor() = default;
  /// Calls piece(i) once for each i in [0, pieces), on any threads and in any order, and returns when all calls have
  /// returned; what they wrote must be visible then. `pieces` is at least 2. `piece` does not throw: Scarp catches
  /// exceptions and rethrows them to its caller. May be called by several threads at once if several have a scope of
  /// this executor. Batches that a piece starts run in the thread of that piece, so run() is not called from within
  /// itself.
  virtual void run(std::int64_t pieces, const std::function<void(std::int64_t)>& piece) = 0;
};

/// Returns an executor that runs all pieces in the calling thread, in order.
Executor& caller_thread();

/// During its lifetime, batches and builds that this thread starts run on `executor`, which must outlive it. Scopes
/// nest.
class ExecutorScope {
 public:
  explicit ExecutorScope(Executor& executor);
  ~ExecutorScope();
  ExecutorScope(const ExecutorScope&) = delete;
  ExecutorScope& operator=(const ExecutorScope&) = delete;

 private:
  Executor* before_;
};

/// Returns the executor of this thread's innermost scope; null if there is none.
Executor* current_executor();

}  // namespace scarp
