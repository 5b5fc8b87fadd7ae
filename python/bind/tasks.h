// SPDX-License-Identifier: MIT
// Long tasks without the interpreter's lock: progress by callback, stopped by Ctrl-C.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>

#include "scarp/base/progress.h"

namespace scarp::python {

/// Runs `work` on another thread, without the interpreter's lock, and waits for it. Meanwhile this thread handles
/// signals and calls `progress` (None, or a function of the fraction done, 0..1) about 20 times per second. Stops the
/// work if a signal handler raises (KeyboardInterrupt), if `progress` raises, or if it returns False (Interrupted).
void run_task(const pybind11::object& progress, const std::function<void(const Progress&)>& work);

/// Returns the result of work(progress).
template <class Work>
auto result_of_task(const pybind11::object& progress, const Work& work) {
  decltype(work(Progress())) result;
  run_task(progress, [&](const Progress& report) { result = work(report); });
  return result;
}

/// Throws Error if this thread runs the progress callback of a task: an edit would wait for its own task.
void require_no_callback();

/// Raises what a signal handler raises. Takes the interpreter's lock.
void check_signals();

}  // namespace scarp::python
