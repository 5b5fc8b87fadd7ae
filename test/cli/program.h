// SPDX-License-Identifier: MIT
// Runs `scarp` as a user does.
#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/starts.h"
#include "scratch.h"

namespace scarp::test {

/// Words of a command line, or names of files.
using Names = std::vector<std::string>;

inline Names operator+(Names a, const Names& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Whether child processes ignore the signals that this process ignores.
enum class Ignored : bool { reset, inherited };

/// How a process is started. The tests themselves may run under nohup.
class StartAttributes {
 public:
  explicit StartAttributes(Ignored ignored) {
    ::posix_spawnattr_init(&attributes_);
    if (ignored == Ignored::inherited) return;
    ::sigset_t signals;
    ::sigemptyset(&signals);
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXFSZ}) ::sigaddset(&signals, number);
    ::posix_spawnattr_setsigdefault(&attributes_, &signals);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF);
  }
  ~StartAttributes() { ::posix_spawnattr_destroy(&attributes_); }
  StartAttributes(const StartAttributes&) = delete;
  StartAttributes& operator=(const StartAttributes&) = delete;

  const ::posix_spawnattr_t* get() const { return &attributes_; }

 private:
  ::posix_spawnattr_t attributes_;
};

/// The result of a run of `scarp`.
struct Result {
  int status;  ///< exit status, or 1000 + the signal that ended it
  std::string out, err;
  std::uint64_t peak = 0;  ///< peak memory in bytes, including the loaded libraries
};

inline Result result_of(int status, const Streams& streams, std::uint64_t peak) {
  // A device such as /dev/full has no end.
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status),
          std::filesystem::is_regular_file(streams.out) ? text_of(streams.out) : "", text_of(streams.err), peak};
}

/// The running program; its output goes into files in a separate folder.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments, const char* out_path = nullptr,
                   const std::string& in_path = "/dev/null", Ignored ignored = Ignored::reset) {
    arguments.insert(arguments.begin(), SCARP_PROGRAM);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    streams_ = {in_path, out_path != nullptr ? out_path : folder_.path("out"), folder_.path("err")};
    ::posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, 0, streams_.in.c_str(), O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, 1, streams_.out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::posix_spawn_file_actions_addopen(&actions, 2, streams_.err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const StartAttributes attributes(ignored);
    const int error = ::posix_spawn(&pid_, SCARP_PROGRAM, &actions, attributes.get(), argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error("cannot start " SCARP_PROGRAM);
  }

  // A test that failed before result() leaves no program behind.
  ~Program() {
    if (pid_ > 0 && ::kill(pid_, SIGKILL) == 0) ::waitpid(pid_, nullptr, 0);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  ::pid_t pid() const { return pid_; }

  /// Waits until the program ends. One that takes longer than the patience is ended by SIGSEGV.
  Result result(std::chrono::seconds patience = kHangs) {
    ::rusage used{};
    const int status = wait_for_child(pid_, used, patience);
    pid_ = 0;
    return result_of(status, streams_, peak_of(used));
  }

 private:
  Scratch folder_;
  Streams streams_;
  ::pid_t pid_ = 0;
};

/// Whether the leak sanitizer checks the program.
enum class Leaks : bool { found, kept };

/// Runs `scarp`. SCARP_STARTER: forked by a process that has loaded it (starts.h); otherwise the built program without
/// limits, for tests about startup and exit.
inline Result run(const std::vector<std::string>& arguments, const std::string& in_path = "/dev/null",
                  Leaks leaks = Leaks::found, [[maybe_unused]] const Limits& limits = {}) {
  const bool kept = leaks == Leaks::kept;
  // The driver's compiler also keeps less freed memory, as in the tests that open a driver themselves
  // (test/CMakeLists.txt).
  if (kept) ::setenv("ASAN_OPTIONS", "detect_leaks=0:quarantine_size_mb=32", 1);
#ifdef SCARP_STARTER
  // A sanitizer reads its options once, at the start of the process.
  const auto start = [] {
    return std::make_unique<const Starter>(SCARP_STARTER, StartAttributes(Ignored::reset).get());
  };
  static std::unique_ptr<const Starter> starters[2];
  if (!starters[kept]) starters[kept] = start();
  const Scratch folder;
  const Streams streams{in_path, folder.path("out"), folder.path("err")};
  const Ended ended = starters[kept]->run(arguments, streams, limits);
  Result result = result_of(ended.status, streams, ended.peak);
#else
  Result result = Program(arguments, nullptr, in_path).result();
#endif
  if (kept) ::unsetenv("ASAN_OPTIONS");
  return result;
}

/// Like run(), for calls in which `scarp` opens a Vulkan driver: memory that Mesa's lavapipe keeps when it is unloaded
/// is not a leak in Scarp, but the leak sanitizer can no longer distinguish it.
inline Result run_on_device(const std::vector<std::string>& arguments) {
  return run(arguments, "/dev/null", Leaks::kept);
}

inline std::ptrdiff_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

}  // namespace scarp::test
