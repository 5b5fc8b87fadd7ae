// SPDX-License-Identifier: MIT
// A thread that answers the newest question of a window in passes, a quick one first, so that the window never waits.
// A newer question cancels all passes of the older one but the first, which is shown even if questions keep coming.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "scarp/base/progress.h"

namespace scarp::viewer {

class AnswerWorker {
 public:
  /// Shows an answer; called by deliver().
  using Show = std::function<void()>;
  /// Computes an answer on the worker's thread. Throws Interrupted if the progress returns false.
  using Pass = std::function<Show(const Progress& progress)>;

  /// `ready` is called on the worker's thread when an answer is available.
  explicit AnswerWorker(std::function<void()> ready);
  ~AnswerWorker();
  AnswerWorker(const AnswerWorker&) = delete;
  AnswerWorker& operator=(const AnswerWorker&) = delete;

  /// Replaces the previous question.
  void ask(std::vector<Pass> passes);
  /// Cancels the question; its answers are not delivered any more.
  void cancel();
  /// Shows the newest answer, and returns whether there was one. Throws the exception of a pass.
  bool deliver();
  /// Whether an answer is computed or not yet delivered.
  bool busy() const;

 private:
  void work();

  std::function<void()> ready_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<std::vector<Pass>> next_{};
  Show done_{};
  std::exception_ptr failed_{};
  bool stop_ = false, cancelled_ = false, busy_ = false;
  std::thread thread_;
};

}  // namespace scarp::viewer
