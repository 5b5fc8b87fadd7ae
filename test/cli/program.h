// SPDX-License-Identifier: MIT
// Runs the built `scarp` as a user does.
#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace scarp::test {

/// A folder that goes away with the test.
class Scratch {
 public:
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "scarp-cli-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
    folder_ = name;
  }
  ~Scratch() { std::filesystem::remove_all(folder_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  std::filesystem::path folder_;
};

inline std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Whether signals that this process ignores are ignored by what it starts.
enum class Ignored : bool { reset, inherited };

/// A running `scarp`; its output goes into files of a folder of its own.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments, const char* out_path = nullptr,
                   const std::string& in_path = "/dev/null", Ignored ignored = Ignored::reset) {
    arguments.insert(arguments.begin(), SCARP_PROGRAM);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const std::string out = out_path != nullptr ? out_path : streams_.path("out"), err = streams_.path("err");
    ::posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, 0, in_path.c_str(), O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::posix_spawnattr_t attributes;
    ::posix_spawnattr_init(&attributes);
    if (ignored == Ignored::reset) {
      // The tests themselves may run under nohup.
      ::sigset_t signals;
      ::sigemptyset(&signals);
      for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXFSZ}) ::sigaddset(&signals, number);
      ::posix_spawnattr_setsigdefault(&attributes, &signals);
      ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    }
    const int error = ::posix_spawn(&pid_, SCARP_PROGRAM, &actions, &attributes, argv.data(), environ);
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error("cannot start " SCARP_PROGRAM);
  }

  ::pid_t pid() const { return pid_; }

  struct Result {
    int status;  ///< exit status, or 1000 + the signal that ended it
    std::string out, err;
  };
  /// Waits for its end.
  Result result() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), text_of(streams_.path("out")),
            text_of(streams_.path("err"))};
  }

 private:
  Scratch streams_;
  ::pid_t pid_ = 0;
};

inline Program::Result run(std::vector<std::string> arguments) { return Program(std::move(arguments)).result(); }

/// As run(), where `scarp` opens a Vulkan driver: what Mesa's lavapipe keeps when it is unloaded is no leak of Scarp's,
/// and the leak sanitizer cannot tell any more whose it is.
inline Program::Result run_on_device(std::vector<std::string> arguments) {
  ::setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
  Program::Result result = run(std::move(arguments));
  ::unsetenv("ASAN_OPTIONS");
  return result;
}

inline std::ptrdiff_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

}  // namespace scarp::test
