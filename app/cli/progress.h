// SPDX-License-Identifier: MIT
// Progress on a terminal, and the way out with Ctrl-C.
#pragma once

#include <string_view>

#include "scarp/base/progress.h"

namespace scarp::cli {

/// The exit status of a program that a signal has ended is this and the signal's number, as shells have it.
constexpr int kSignalled = 128;

/// From now on the first SIGINT, SIGTERM, SIGHUP or SIGQUIT makes every terminal_progress() ask for a stop, so that
/// files half written are removed on the way out. A second one ends the program at once, and so does the first where
/// within two seconds nobody has asked whether there was one; then, too, the files are removed. One that was ignored
/// when the program was started stays so. A limit on the size of files (SIGXFSZ) makes writing fail and does not end
/// the program.
void catch_interrupts();

/// The signal that was caught, or 0.
int caught_signal();

/// Throws Interrupted when a signal was caught: for the places between two long tasks.
void stop_if_interrupted();

/// A line "what 0...10...20" on stderr when that is a terminal, nothing otherwise; asks for a stop after a signal.
Progress terminal_progress(std::string_view what);

/// Ends a progress line that has not come to its end, so that a message begins on a line of its own.
void end_progress_line();

}  // namespace scarp::cli
