// SPDX-License-Identifier: MIT
#include "python/bind/tasks.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "scarp/base/error.h"

namespace scarp::python {
namespace {

namespace py = pybind11;

constexpr std::chrono::milliseconds kPause(50);

thread_local bool in_callback = false;

// Callbacks may run tasks with callbacks of their own.
class InCallback {
 public:
  InCallback() : before_(std::exchange(in_callback, true)) {}
  ~InCallback() { in_callback = before_; }
  InCallback(const InCallback&) = delete;
  InCallback& operator=(const InCallback&) = delete;

 private:
  bool before_;
};

// Calls the user's function; returns whether to go on: unless it answers False, of Python or NumPy.
bool call(const py::object& progress, double fraction) {
  const InCallback inside;
  const py::object answer = progress(fraction);
  return answer.is_none() || static_cast<bool>(py::bool_(answer));
}

}  // namespace

void run_task(const py::object& progress, const std::function<void(const Progress&)>& work) {
  std::mutex mutex;
  std::condition_variable changed;
  bool done = false;
  std::atomic<double> fraction = 0;
  std::atomic<bool> stop = false;
  std::exception_ptr error, raised;
  std::thread worker([&] {
    std::exception_ptr caught;
    try {
      work([&](double done_so_far) {
        fraction = done_so_far;
        return !stop;
      });
    } catch (...) {
      caught = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    error = caught;
    done = true;
    changed.notify_one();
  });
  while (true) {
    {
      const py::gil_scoped_release release;
      std::unique_lock lock(mutex);
      if (changed.wait_for(lock, kPause, [&] { return done; })) break;
    }
    if (stop) continue;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!progress.is_none() && !call(progress, fraction)) stop = true;
    } catch (...) {
      raised = std::current_exception();
      stop = true;
    }
  }
  worker.join();
  if (raised) std::rethrow_exception(raised);
  if (error) std::rethrow_exception(error);
  if (!progress.is_none() && !stop) call(progress, 1);
}

void require_no_callback() {
  if (in_callback) throw Error("edit: a progress callback cannot edit (edit after the task)");
}

void check_signals() {
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

}  // namespace scarp::python
