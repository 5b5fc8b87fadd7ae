// SPDX-License-Identifier: MIT
// Progress on a terminal, and interruption by Ctrl-C.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "scarp/base/progress.h"

namespace scarp::cli {

/// The exit status of a program ended by a signal is this plus the signal's number, as in shells.
constexpr int kSignalled = 128;

/// From now on the first SIGINT, SIGTERM, SIGHUP or SIGQUIT makes every terminal_progress() request a stop, so that
/// partial files are removed on exit. A second signal ends the program immediately, and so does the first if it is not
/// polled within two seconds; partial files are removed in both cases. Signals that were ignored when the program
/// started stay ignored. A file size limit (SIGXFSZ) makes writing fail and does not end the program.
void catch_interrupts();

/// The signal that was caught, or 0.
int caught_signal();

/// Throws Interrupted if a signal was caught: for use between two long tasks.
void stop_if_interrupted();

/// Prints a line "what 0...10...20" to stderr if that is a terminal and the task takes more than two seconds; requests
/// a stop after a signal.
Progress terminal_progress(std::string_view what);

/// While it exists, terminal_progress() prints nothing: for --quiet, and for parts of a task that has its own line.
class SilentProgress {
 public:
  SilentProgress();
  ~SilentProgress();
  SilentProgress(const SilentProgress&) = delete;
  SilentProgress& operator=(const SilentProgress&) = delete;
};

/// Ends an incomplete progress line, so that a message starts on its own line.
void end_progress_line();

/// Prints "note: NOTE" lines to stderr. Called last: a run that fails prints only one line.
void print_notes(std::span<const std::string> notes);

}  // namespace scarp::cli
