// SPDX-License-Identifier: MIT
#include "app/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>

#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

volatile std::sig_atomic_t signal_caught = 0;
bool line_open = false;

// One tick per 2.5 %, a number every fourth, as GDALTermProgress does.
constexpr int kTicks = 40;
constexpr int kTicksPerNumber = 4;

}  // namespace

extern "C" void scarp_note_signal(int number) { signal_caught = number; }

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = scarp_note_signal;
  // The handler is gone after the first signal: the second one has its usual effect.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

int caught_signal() { return signal_caught; }

void stop_if_interrupted() {
  if (signal_caught != 0) throw Interrupted();
}

Progress terminal_progress(std::string_view what) {
  if (::isatty(STDERR_FILENO) == 0) return [](double) { return signal_caught == 0; };
  // std::function wants to copy its target: the count is shared.
  return [name = std::string(what), ticks = std::make_shared<int>(-1)](double share) {
    const int now = std::clamp(static_cast<int>(share * kTicks), 0, kTicks);
    if (*ticks < 0) {
      fmt::print(stderr, "{} ", name);
      line_open = true;
    }
    while (*ticks < now) {
      ++*ticks;
      if (*ticks % kTicksPerNumber == 0) {
        fmt::print(stderr, "{}", 100 * *ticks / kTicks);
      } else {
        fmt::print(stderr, ".");
      }
      if (*ticks == kTicks) end_progress_line();
    }
    std::fflush(stderr);
    return signal_caught == 0;
  };
}

void end_progress_line() {
  if (!line_open) return;
  std::fputc('\n', stderr);
  line_open = false;
}

}  // namespace scarp::cli
