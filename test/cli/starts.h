// SPDX-License-Identifier: MIT
// Calls `scarp` without starting it: a process that has loaded the command line and its libraries, and no more, forks
// itself for each call. Most calls of the tests take less time than loading GDAL's hundred libraries.
//
// The process (starter.cpp) communicates over a socket: a call is sent as lists of words and limits, and its answer is
// the exit state.
#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace scarp::test {

constexpr std::chrono::seconds kHangs{300};

/// Waits for a child; returns its status, of waitpid(). One that hangs is ended by SIGSEGV, for which sanitizers print
/// where the program was: the test fails with that, instead of all tests of its program by ctest's limit.
inline int wait_for_child(::pid_t pid, ::rusage& used, std::chrono::seconds patience = kHangs) {
  using namespace std::chrono_literals;
  constexpr auto kDying = 20s;
  const auto begin = std::chrono::steady_clock::now();
  for (int status = 0, signal = 0;;) {
    if (::wait4(pid, &status, WNOHANG, &used) == pid) return status;
    const auto waited = std::chrono::steady_clock::now() - begin;
    if (waited > patience && signal == 0) ::kill(pid, signal = SIGSEGV);
    if (waited > patience + kDying && signal == SIGSEGV) ::kill(pid, signal = SIGKILL);
    std::this_thread::sleep_for(waited < 50ms ? 200us : 2ms);
  }
}

/// The starter's end of the socket.
constexpr int kStarterSocket = 3;

/// Files for the standard streams.
struct Streams {
  std::string in, out, err;
};

/// Resources after which a signal ends a call or an allocation fails; 0: no limit. A call that only waits ends after
/// ten times the seconds.
struct Limits {
  std::uint64_t seconds = 0;  ///< of processor time
  std::uint64_t bytes = 0;    ///< of memory
};

/// The exit state of a call.
struct Ended {
  int status = 0;          ///< of waitpid()
  std::uint64_t peak = 0;  ///< peak memory in bytes, including the loaded libraries
};

inline std::uint64_t peak_of(const ::rusage& used) { return 1024 * static_cast<std::uint64_t>(used.ru_maxrss); }

inline bool send_bytes(int socket, const void* bytes, std::size_t size) {
  for (const char* at = static_cast<const char*>(bytes); size > 0;) {
    const ::ssize_t sent = ::send(socket, at, size, MSG_NOSIGNAL);
    if (sent <= 0) return false;
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

inline bool receive_bytes(int socket, void* bytes, std::size_t size) {
  return size == 0 || ::recv(socket, bytes, size, MSG_WAITALL) == static_cast<::ssize_t>(size);
}

inline bool send_words(int socket, const std::vector<std::string>& words) {
  const std::uint64_t count = words.size();
  if (!send_bytes(socket, &count, sizeof count)) return false;
  for (const std::string& word : words) {
    const std::uint64_t size = word.size();
    if (!send_bytes(socket, &size, sizeof size) || !send_bytes(socket, word.data(), size)) return false;
  }
  return true;
}

/// False if the other side is gone.
inline bool receive_words(int socket, std::vector<std::string>& words) {
  std::uint64_t count = 0;
  if (!receive_bytes(socket, &count, sizeof count)) return false;
  words.resize(count);
  for (std::string& word : words) {
    std::uint64_t size = 0;
    if (!receive_bytes(socket, &size, sizeof size)) return false;
    word.resize(size);
    if (!receive_bytes(socket, word.data(), size)) return false;
  }
  return true;
}

/// A starter, which ends with this object or this process.
class Starter {
 public:
  Starter(const char* program, const ::posix_spawnattr_t* attributes) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) throw std::runtime_error("no socket");
    ::posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], kStarterSocket);
    char* argv[] = {const_cast<char*>(program), nullptr};
    const int error = ::posix_spawn(&pid_, program, &actions, attributes, argv, environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    socket_ = ends[0];
    if (error != 0) throw std::runtime_error(std::string("cannot start ") + program);
  }
  ~Starter() {
    ::close(socket_);
    ::waitpid(pid_, nullptr, 0);
  }
  Starter(const Starter&) = delete;
  Starter& operator=(const Starter&) = delete;

  /// Runs `scarp` in the environment of this process.
  Ended run(const std::vector<std::string>& arguments, const Streams& streams, const Limits& limits = {}) const {
    std::vector<std::string> settings;
    for (char** setting = environ; *setting != nullptr; ++setting) settings.emplace_back(*setting);
    Ended ended;
    if (!send_words(socket_, {streams.in, streams.out, streams.err}) || !send_words(socket_, settings) ||
        !send_words(socket_, arguments) || !send_bytes(socket_, &limits, sizeof limits) ||
        !receive_bytes(socket_, &ended, sizeof ended)) {
      throw std::runtime_error("the starter of scarp is gone");
    }
    return ended;
  }

 private:
  int socket_ = -1;
  ::pid_t pid_ = 0;
};

}  // namespace scarp::test
