// SPDX-License-Identifier: MIT
#include "app/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>

#include "scarp/base/error.h"
#include "scarp/base/replace_file.h"

namespace scarp::cli {
namespace {

// Shared by signal handlers and all threads.
std::atomic<int> signal_caught = 0;
std::atomic<bool> signal_seen = false;  // the signal was noticed, and the program is stopping
std::atomic<bool> line_open = false;
std::atomic<int> silences = 0;  // SilentProgress objects
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

// Signals by which users, shells and systems end programs. HUP: the terminal was closed.
constexpr std::array kEndings = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};

// Rendering polls several times a second. Tasks that poll less often, such as reading a large file, are ended after the
// time that users are willing to wait.
constexpr unsigned kPatience = 2;  // seconds

// One tick per 2.5 %, a number every fourth, as GDALTermProgress does.
constexpr int kTicks = 40;
constexpr int kTicksPerNumber = 4;
// Tasks that take less time have no line.
constexpr std::chrono::seconds kUnnoticed{2};

// Uses only functions that are safe in a signal handler.
[[noreturn]] void end_now(int number) {
  remove_temporary_files();
  constexpr std::string_view kWord = "\nscarp: interrupted\n";
  const std::size_t skip = line_open ? 0 : 1;
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kWord.data() + skip, kWord.size() - skip);
  ::_exit(kSignalled + number);
}

bool stop_wanted() {
  if (signal_caught == 0) return false;
  signal_seen = true;
  return true;
}

}  // namespace

extern "C" void scarp_note_signal(int number) {
  int none = 0;
  if (!signal_caught.compare_exchange_strong(none, number)) end_now(number);
  ::alarm(kPatience);
}

extern "C" void scarp_end_patience(int) {
  if (!signal_seen) end_now(signal_caught);
}

void catch_interrupts() {
  struct sigaction action {};
  // Reads and writes are restarted: readers would report the signal as a file error.
  action.sa_flags = SA_RESTART;
  // The second signal must not interrupt the handler of the first, or it would be treated as the first.
  for (const int number : kEndings) ::sigaddset(&action.sa_mask, number);
  ::sigaddset(&action.sa_mask, SIGALRM);
  action.sa_handler = scarp_end_patience;
  ::sigaction(SIGALRM, &action, nullptr);
  action.sa_handler = scarp_note_signal;
  for (const int number : kEndings) {
    struct sigaction before {};
    ::sigaction(number, nullptr, &before);
    // Set by nohup, and by shells for background jobs.
    if (before.sa_handler != SIG_IGN) ::sigaction(number, &action, nullptr);
  }
  // A file size limit then has the effect of a full disk, which writers report.
  std::signal(SIGXFSZ, SIG_IGN);
}

int caught_signal() {
  stop_wanted();
  return signal_caught;
}

void stop_if_interrupted() {
  if (stop_wanted()) throw Interrupted();
}

Progress terminal_progress(std::string_view what) {
  if (silences > 0 || ::isatty(STDERR_FILENO) == 0) return [](double) { return !stop_wanted(); };
  // std::function copies its target: the count is shared.
  return [name = std::string(what), ticks = std::make_shared<int>(-1),
          begin = std::chrono::steady_clock::now()](double share) {
    if (*ticks < 0 && std::chrono::steady_clock::now() - begin < kUnnoticed) return !stop_wanted();
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
    return !stop_wanted();
  };
}

SilentProgress::SilentProgress() { ++silences; }
SilentProgress::~SilentProgress() { --silences; }

void end_progress_line() {
  if (!line_open) return;
  std::fputc('\n', stderr);
  line_open = false;
}

void print_notes(std::span<const std::string> notes) {
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
}

}  // namespace scarp::cli
