// SPDX-License-Identifier: MIT
// The other side of starts.h. It does nothing before it forks but load: what `scarp` does when it runs, and all its
// threads, begin in the process of the call.
#include <sys/wait.h>
#include <cstdio>
#include <cstdlib>

#include "app/cli/command_line.h"
#include "cli/starts.h"

namespace {

using scarp::test::kStarterSocket;
using scarp::test::receive_words;
using scarp::test::send_bytes;

bool open_as(int stream, const std::string& path, int flags) {
  const int file = ::open(path.c_str(), flags, 0600);
  if (file < 0 || ::dup2(file, stream) < 0) return false;
  if (file != stream) ::close(file);
  return true;
}

// In the new process.
int call(const std::vector<std::string>& streams, const std::vector<std::string>& settings,
         std::vector<std::string>& arguments) {
  ::close(kStarterSocket);
  constexpr int kWritten = O_WRONLY | O_CREAT | O_TRUNC;
  if (!open_as(STDIN_FILENO, streams[0], O_RDONLY) || !open_as(STDOUT_FILENO, streams[1], kWritten) ||
      !open_as(STDERR_FILENO, streams[2], kWritten)) {
    std::perror("starter");
    std::abort();
  }
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
  while (receive_words(kStarterSocket, streams) && receive_words(kStarterSocket, settings) &&
         receive_words(kStarterSocket, arguments)) {
    const ::pid_t pid = ::fork();
    if (pid < 0) return EXIT_FAILURE;
    // Ends as main() of a program does: by exit(), which is where leaks are looked for.
    if (pid == 0) return call(streams, settings, arguments);
    int status = 0;
    if (::waitpid(pid, &status, 0) != pid || !send_bytes(kStarterSocket, &status, sizeof status)) {
      return EXIT_FAILURE;
    }
  }
  return EXIT_SUCCESS;
}
