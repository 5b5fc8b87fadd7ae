// SPDX-License-Identifier: MIT
#include "scarp/base/executor.h"

#include <utility>

namespace scarp {
namespace {

thread_local Executor* t_executor = nullptr;

class CallerThread final : public Executor {
  void run(std::int64_t pieces, const std::function<void(std::int64_t)>& piece) override {
    for (std::int64_t i = 0; i < pieces; ++i) piece(i);
  }
};

}  // namespace

Executor& caller_thread() {
  static CallerThread executor;
  return executor;
}

ExecutorScope::ExecutorScope(Executor& executor) : before_(std::exchange(t_executor, &executor)) {}
ExecutorScope::~ExecutorScope() { t_executor = before_; }

Executor* current_executor() { return t_executor; }

}  // namespace scarp
