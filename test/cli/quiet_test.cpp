// SPDX-License-Identifier: MIT
// What map subcommands print on a terminal: no progress of short tasks, and nothing with --quiet.
#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/maps_cli.h"

namespace scarp::test {
namespace {

// Stops a process for nine tenths of its first four seconds, so that a task of a third of a second takes three.
class Slowed {
 public:
  explicit Slowed(::pid_t pid)
      : thread_([this, pid] {
          using std::chrono::milliseconds;
          for (int i = 0; i < 20 && !ends_; ++i) {
            ::kill(pid, SIGSTOP);
            std::this_thread::sleep_for(milliseconds(180));
            ::kill(pid, SIGCONT);
            std::this_thread::sleep_for(milliseconds(20));
          }
        }) {}
  // Before the process is waited for: its number is then another's.
  ~Slowed() {
    ends_ = true;
    thread_.join();
  }
  Slowed(const Slowed&) = delete;
  Slowed& operator=(const Slowed&) = delete;

 private:
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

// Runs the program on a terminal, and returns what it prints there.
std::string on_terminal(Names arguments, bool slowly = false) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || ::grantpt(terminal) != 0 || ::unlockpt(terminal) != 0) return "no terminal";
  const std::string name = ::ptsname(terminal);
  arguments.insert(arguments.begin(), SCARP_PROGRAM);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ::posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 1, name.c_str(), O_WRONLY | O_NOCTTY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, 1, 2);
  ::pid_t pid = 0;
  const int error = ::posix_spawn(&pid, SCARP_PROGRAM, &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return "not started";
  std::optional<Slowed> slowed;
  if (slowly) slowed.emplace(pid);
  std::string text;
  // Ends when the program has closed the terminal.
  for (char bytes[4096];;) {
    const ::ssize_t count = ::read(terminal, bytes, sizeof bytes);
    if (count <= 0) break;
    text.append(bytes, static_cast<std::size_t>(count));
  }
  slowed.reset();
  int status = 0;
  ::waitpid(pid, &status, 0);
  ::close(terminal);
  return status == 0 ? text : "failed: " + text;
}

class Quiet : public MapsCli {};

TEST_F(Quiet, ShortTasksHaveNoProgress) {
  const std::string text =
      on_terminal(on_dem("viewshed") + Names{"--observer", "500105,5000105,2", "-o", path("a.tif")});
  EXPECT_EQ(text.find("...10"), std::string::npos) << text;
  EXPECT_NE(text.find("a.tif: 30 x 20 pixels"), std::string::npos) << text;
}

TEST_F(Quiet, LongTasksHaveProgress) {
  const std::string dem = path("large.tif");
  ASSERT_EQ(run({"generate", "--size", "800", "-o", dem}).status, 0);
  const Names words{"skyview", dem, "--azimuths", "24", "--threads", "1", "-o", path("a.tif")};
  const std::string text = on_terminal(words, true);
  EXPECT_NE(text.find("skyview 0...10...20...30...40...50...60...70...80...90...100\r\n"), std::string::npos) << text;
}

TEST_F(Quiet, QuietPicturesPrintNothing) {
  Names words = on_dem("render");
  words.insert(words.end(), {"--size", "40x30"});
  const Names orbit{"--turntable", "--frames", "2", "--overwrite", "-o", path("frame-#.png")},
      changes{"--animate", "exaggeration=1..2", "--frames", "2", "--overwrite", "-o", path("frame-#.png")};
  for (const Names& more : {Names{"-o", path("a.png")}, orbit, changes}) {
    EXPECT_NE(on_terminal(words + more), "");
    EXPECT_EQ(on_terminal(words + more + Names{"--quiet"}), "");
  }
}

TEST_F(Quiet, QuietMapsPrintNothing) {
  std::vector<Names> all = maps();
  all.push_back(on_dem("contours") + Names{"--interval", "10"});
  for (const Names& map : all) {
    const std::string output = path(map.front() == "contours" ? "a.gpkg" : "a.tif");
    EXPECT_EQ(on_terminal(map + Names{"--quiet", "-o", output}), "") << map.front();
    EXPECT_NE(on_terminal(map + Names{"-o", output}), "") << map.front();
  }
}

TEST_F(Quiet, DryRunsOfContoursWriteNothing) {
  const Result result = run(on_dem("contours") + Names{"--interval", "10", "--dry-run", "-o", path("a.gpkg")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("nothing written (--dry-run)"), std::string::npos) << result.out;
  EXPECT_EQ(scratch_.files(), Names{"dem.asc"});
}

}  // namespace
}  // namespace scarp::test
