// SPDX-License-Identifier: MIT
// Windows on a display without a screen, for tests.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace scarp::test {

/// An X server without a screen, for all tests of the process.
class Display {
 public:
  Display() {
    int pipe_ends[2];
    if (::pipe(pipe_ends) != 0) return;
    pid_ = ::fork();
    if (pid_ == 0) {
      const std::string to = std::to_string(pipe_ends[1]);
      ::close(pipe_ends[0]);
      if (std::freopen("/dev/null", "w", stderr) == nullptr) ::_exit(1);
      ::execl(XVFB, XVFB, "-displayfd", to.c_str(), "-screen", "0", "1024x768x24", "-nolisten", "tcp", nullptr);
      ::_exit(1);
    }
    ::close(pipe_ends[1]);
    std::string number;
    for (char c = 0; ::read(pipe_ends[0], &c, 1) == 1 && c != '\n';) number += c;
    ::close(pipe_ends[0]);
    if (!number.empty()) ::setenv("DISPLAY", (":" + number).c_str(), 1);
    starts = !number.empty();
  }
  ~Display() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
  }
  bool starts = false;

 private:
  pid_t pid_ = -1;
};

class Window : public testing::Test {
 protected:
  void SetUp() override {
    static const Display display;
    ASSERT_TRUE(display.starts) << "Xvfb does not start";
    std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(name.begin(), name.end(), '/', '-');
    folder_ = std::filesystem::path(SCARP_WORK) / ("window-" + name);
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    if (run("'" SCARP_PROGRAM "' generate --size 129 -o dem.tif") != 0) FAIL() << output_;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Runs a command in the folder; its output is in output_.
  int run(const std::string& command) {
    const std::filesystem::path out = folder_ / "out.txt";
    const std::string whole = "cd '" + folder_.string() + "' && " + command + " >out.txt 2>&1";
    const int status = std::system(whole.c_str());
    std::ifstream in(out);
    std::stringstream text;
    text << in.rdbuf();
    output_ = text.str();
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  int view(const std::string& events, const std::string& arguments) {
    std::ofstream(folder_ / "events") << "scarp-view 320x240\n" << events;
    return run("'" SCARP_VIEW "' " + arguments + " --play events --validation");
  }
  // Opens the window, waits for its picture, and runs xdotool's commands on it; $window is its ID. `script` is run: it
  // may prepare the display for use.sh.
  int use(const std::string& arguments, const std::string& commands, const std::string& script = "use.sh") {
    std::ofstream(folder_ / "use.sh")
        << "export XDG_CONFIG_HOME=$PWD/settings\n"
           "rm -f times.csv\n"
           "'" SCARP_VIEW "' "
        << arguments
        << " --timings times.csv --validation &\n"
           "pid=$!\n"
           "until grep -qs converged times.csv; do kill -0 $pid || exit 9; sleep 0.05; done\n"
           "window=$(xdotool search --name Scarp)\n"
        << commands << "\nwait $pid\n";
    return run("timeout 60 bash " + script);
  }
  // The command in output_, `scarp render ... -o FILE ...`, with another FILE.
  std::string printed_command(const std::string& file) const {
    const std::size_t begin = output_.find("scarp render ");
    std::string command = output_.substr(begin, output_.find('\n', begin) - begin);
    command.replace(0, std::string("scarp").size(), "'" SCARP_PROGRAM "'");
    const std::size_t place = command.find(" -o ") + 4;
    return command.replace(place, command.find(' ', place) - place, file);
  }
  // Runs the command that P has printed in output_ for a picture: it makes the same file.
  void expect_saved_again(int number) {
    const std::string name = "scarp-view-" + std::to_string(number) + ".png", begin = name + ": scarp ";
    const std::size_t at = output_.find(begin);
    ASSERT_NE(at, std::string::npos) << output_;
    std::string command = output_.substr(at + begin.size());
    command.erase(command.find('\n'));
    command.replace(command.find("-o " + name), 3 + name.size(), "-o again.png");
    const std::string printed = output_;
    ASSERT_EQ(run(SCARP_PROGRAM " " + command), 0) << output_;
    EXPECT_TRUE(bytes_of(name) == bytes_of("again.png")) << command;
    output_ = printed;
  }
  std::string bytes_of(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  }

  std::filesystem::path folder_;
  std::string output_;
};

}  // namespace scarp::test
