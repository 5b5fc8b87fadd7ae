// SPDX-License-Identifier: MIT
#include "bench/program_run.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

namespace fs = std::filesystem;

constexpr double kMicroseconds = 1e6;  // in a second

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / kMicroseconds;
}

// Starts a program as the leader of its own process group, so that it can be stopped with its children.
pid_t start(const std::vector<std::string>& words, const std::string& folder) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_t actions;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t pid = 0;
  const int failed = posix_spawnp(&pid, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (failed != 0) throw Error(fmt::format("{}: cannot be started: {}", words[0], std::strerror(failed)));
  return pid;
}

}  // namespace

std::optional<ProgramRun> run_program(std::vector<std::string> words, const std::string& folder, double limit_s) {
  // The peak that wait4() reports starts from that of the parent process, which is large here; GNU time therefore
  // starts the program.
  const std::string peak_file = (fs::path(folder) / "peak").string();
  const bool has_peak = is_installed("time");
  if (has_peak) words.insert(words.begin(), {"time", "-f", "%M", "-o", peak_file});
  using Clock = std::chrono::steady_clock;
  constexpr auto kPause = std::chrono::microseconds(500);  // far below the run times compared
  const auto begin = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  const pid_t pid = start(words, folder);
  int status = 0;
  rusage usage{};
  pid_t ended = 0;
  bool late = false;
  while ((ended = wait4(pid, &status, late ? 0 : WNOHANG, &usage)) == 0) {
    late = elapsed() > limit_s;
    if (late) {
      kill(-pid, SIGKILL);
    } else {
      std::this_thread::sleep_for(kPause);
    }
  }
  if (late) return std::nullopt;
  ProgramRun run;
  run.wall_s = elapsed();
  if (ended != pid || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Error(fmt::format("'{}' failed", fmt::join(words, " ")));
  run.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  double peak_kib = 0;
  if (has_peak && std::ifstream(peak_file) >> peak_kib) run.peak_mb = peak_kib * 1024e-6;
  return run;
}

bool is_installed(const std::string& program) {
  if (program.find('/') != std::string::npos) return access(program.c_str(), X_OK) == 0;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((fs::path(folder) / program).c_str(), X_OK) == 0) return true;
  return false;
}

ScratchFolder::ScratchFolder() {
  std::string name = (fs::temp_directory_path() / "scarp-bench-XXXXXX").string();
  if (!mkdtemp(name.data())) throw Error(fmt::format("'{}': cannot be made: {}", name, std::strerror(errno)));
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace scarp::bench
