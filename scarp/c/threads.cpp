// SPDX-License-Identifier: MIT
#include "scarp/c/threads.h"

#include "scarp/c/structures.h"

namespace scarp::c {
namespace {

// Without a destructor: see kKeepsMemory in base/kept_memory.h.
thread_local scarp_threads threads_given{};

// An executor on the threads that the calling thread was given.
class CallerThreads final : public Executor {
 public:
  void run(std::int64_t pieces, const std::function<void(std::int64_t)>& piece) override {
    const auto call = [](void* context, std::int64_t index) {
      (*static_cast<const std::function<void(std::int64_t)>*>(context))(index);
    };
    threads_given.run(threads_given.user_data, pieces, call, const_cast<std::function<void(std::int64_t)>*>(&piece));
  }
};

CallerThreads threads_of_caller;

}  // namespace

Executor* caller_threads() { return threads_given.run ? &threads_of_caller : nullptr; }

}  // namespace scarp::c

scarp_status scarp_use_threads(const scarp_threads* threads) {
  using namespace scarp::c;
  return guarded([&] {
    scarp_threads own{};
    if (threads) {
      own = read(threads, "threads");
      if (!own.run) throw scarp::Error("threads: run is NULL");
    }
    threads_given = own;
  });
}
