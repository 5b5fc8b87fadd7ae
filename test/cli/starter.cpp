// SPDX-License-Identifier: MIT
// The other side of starts.h. Before a fork it only loads libraries: the work of `scarp` and all its threads start in
// the process of the call.
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "app/cli/command_line.h"
#include "cli/starts.h"

namespace {

using scarp::test::Ended;
using scarp::test::kStarterSocket;
using scarp::test::Limits;
using scarp::test::peak_of;
using scarp::test::receive_bytes;
using scarp::test::receive_words;
using scarp::test::send_bytes;
using scarp::test::wait_for_child;

bool open_as(int stream, const std::string& path, int flags) {
  const int file = ::open(path.c_str(), flags, 0600);
  if (file < 0 || ::dup2(file, stream) < 0) return false;
  if (file != stream) ::close(file);
  return true;
}

void limit(decltype(RLIMIT_CPU) resource, std::uint64_t most) {
  ::rlimit known{};
  if (most == 0 || ::getrlimit(resource, &known) != 0) return;
  known.rlim_cur = std::min<::rlim_t>(most, known.rlim_max);
  ::setrlimit(resource, &known);
}

// In the new process.
int call(const std::vector<std::string>& streams, const std::vector<std::string>& settings,
         std::vector<std::string>& arguments, const Limits& limits) {
  ::close(kStarterSocket);
  constexpr int kWritten = O_WRONLY | O_CREAT | O_TRUNC;
  if (!open_as(STDIN_FILENO, streams[0], O_RDONLY) || !open_as(STDOUT_FILENO, streams[1], kWritten) ||
      !open_as(STDERR_FILENO, streams[2], kWritten)) {
    std::perror("starter");
    std::abort();
  }
  limit(RLIMIT_CPU, limits.seconds);
  limit(RLIMIT_DATA, limits.bytes);
  ::alarm(static_cast<unsigned>(10 * limits.seconds));
  ::clearenv();
  for (const std::string& setting : settings) {
    const std::size_t sign = setting.find('=');
    ::setenv(setting.substr(0, sign).c_str(), setting.substr(sign + 1).c_str(), 1);
  }
  std::string name = "scarp";
  std::vector<char*> argv{name.data()};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  return scarp::cli::run_command_line(static_cast<int>(argv.size()) - 1, argv.data());
}

}  // namespace

int main() {
  std::vector<std::string> streams, settings, arguments;
  Limits limits;
  while (receive_words(kStarterSocket, streams) && receive_words(kStarterSocket, settings) &&
         receive_words(kStarterSocket, arguments) && receive_bytes(kStarterSocket, &limits, sizeof limits)) {
    const ::pid_t pid = ::fork();
    if (pid < 0) return EXIT_FAILURE;
    // Ends like main() of a program, by exit(), where the leak check runs.
    if (pid == 0) return call(streams, settings, arguments, limits);
    Ended ended;
    ::rusage used{};
    ended.status = wait_for_child(pid, used);
    ended.peak = peak_of(used);
    if (!send_bytes(kStarterSocket, &ended, sizeof ended)) return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
