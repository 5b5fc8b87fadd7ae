// SPDX-License-Identifier: MIT
#include "scarp/c/threads.h"

#include "scarp/c/structures.h"

namespace scarp::c {
namespace {

class CallerThreads final : public Executor {
 public:
  void run(std::int64_t pieces, const std::function<void(std::int64_t)>& piece) override {
    const auto call = [](void* context, std::int64_t index) {
      (*static_cast<const std::function<void(std::int64_t)>*>(context))(index);
    };
    given.run(given.user_data, pieces, call, const_cast<std::function<void(std::int64_t)>*>(&piece));
  }

  scarp_threads given{};
};

thread_local CallerThreads threads_of_caller;

}  // namespace

Executor* caller_threads() { return threads_of_caller.given.run ? &threads_of_caller : nullptr; }

}  // namespace scarp::c

scarp_status scarp_use_threads(const scarp_threads* threads) {
  using namespace scarp::c;
  return guarded([&] {
    scarp_threads given{};
    if (threads) {
      given = read(threads, "threads");
      if (!given.run) throw scarp::Error("threads: run is NULL");
    }
    threads_of_caller.given = given;
  });
}
