// SPDX-License-Identifier: MIT
#include "app/viewer/answer_worker.h"

#include <utility>

#include "scarp/base/error.h"

namespace scarp::viewer {

AnswerWorker::AnswerWorker(std::function<void()> ready) : ready_(std::move(ready)), thread_([this] { work(); }) {}

AnswerWorker::~AnswerWorker() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void AnswerWorker::ask(std::vector<Pass> passes) {
  {
    const std::scoped_lock lock(mutex_);
    next_ = std::move(passes);
    failed_ = nullptr;
  }
  wake_.notify_one();
}

void AnswerWorker::cancel() {
  const std::scoped_lock lock(mutex_);
  cancelled_ = busy_;
  next_.reset();
  done_ = nullptr, failed_ = nullptr;
}

bool AnswerWorker::deliver() {
  Show show;
  std::exception_ptr failed;
  {
    const std::scoped_lock lock(mutex_);
    show = std::exchange(done_, nullptr);
    failed = std::exchange(failed_, nullptr);
  }
  if (failed) std::rethrow_exception(failed);
  if (show) show();
  return show != nullptr;
}

bool AnswerWorker::busy() const {
  const std::scoped_lock lock(mutex_);
  return busy_ || next_ || done_ || failed_;
}

void AnswerWorker::work() {
  for (;;) {
    std::vector<Pass> passes;
    {
      std::unique_lock lock(mutex_);
      busy_ = cancelled_ = false;
      wake_.wait(lock, [&] { return stop_ || next_.has_value(); });
      if (stop_) return;
      passes = std::move(*next_);
      next_.reset();
      busy_ = true;
    }
    for (std::size_t i = 0; i < passes.size(); ++i) {
      const auto outdated = [&] {
        const std::scoped_lock lock(mutex_);
        return stop_ || cancelled_ || (i > 0 && next_);
      };
      if (outdated()) break;
      Show show;
      std::exception_ptr failed;
      try {
        show = passes[i]([&](double) { return !outdated(); });
      } catch (const Interrupted&) {
        break;
      } catch (const std::exception&) {
        failed = std::current_exception();
      }
      {
        const std::scoped_lock lock(mutex_);
        if (stop_ || cancelled_) break;
        done_ = std::move(show), failed_ = failed;
      }
      ready_();
      if (failed) break;
    }
  }
}

}  // namespace scarp::viewer
