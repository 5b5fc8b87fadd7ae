// SPDX-License-Identifier: MIT
// The window on a display without a screen: recordings are played, the picture of the window is looked at, and that
// which P saves is, byte for byte, what `scarp render` makes of the command that it prints.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "cases.h"
#include "output/read_png.h"

namespace scarp::test {
namespace {

namespace fs = std::filesystem;

// An X server without a screen, for all tests of the process.
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
      ::execl(XVFB, XVFB, "-displayfd", to.c_str(), "-screen", "0", "640x480x24", "-nolisten", "tcp", nullptr);
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
    folder_ =
        fs::path(SCARP_WORK) / ("window-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    if (run(std::string(SCARP_PROGRAM) + " generate --size 129 -o dem.tif") != 0) FAIL() << output_;
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Runs a command in the folder; its output is in output_.
  int run(const std::string& command) {
    const fs::path out = folder_ / "out.txt";
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
  // Opens the window, waits for its picture, and runs xdotool's commands on it; $window is its number.
  int use(const std::string& arguments, const std::string& commands) {
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
    return run("timeout 60 bash use.sh");
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

  fs::path folder_;
  std::string output_;
};

// The panel, which hides most of so small a window, is hidden by the key Tab.
constexpr const char* kDrag =
    "0.05 key 258 1 0\n0.1 move 200 120\n0.2 button 0 1 0\n0.3 move 230 130\n0.4 move 260 125\n0.5 button 0 0 0\n0.6 "
    "wheel 0 2\n";
constexpr const char* kSave = "1.0 key 80 1 0\n1.1 key 80 0 0\n";

TEST_F(Window, SavesWhatRenderMakes) {
  ASSERT_EQ(view(std::string(kDrag) + kSave, "dem.tif --exaggeration 2 --samples 2"), 0) << output_;
  ASSERT_TRUE(output_.starts_with("scarp-view-1.png: scarp render dem.tif --exaggeration=2 ")) << output_;
  expect_saved_again(1);
}

TEST_F(Window, SavesWhatRenderMakesOfItsSettings) {
  // Water, fog and colours; ground that is opened again; a look with its scale; a part of a map; the sun, dragged.
  const std::string kSettings[] = {
      "0.7 option --water 300\n0.7 option --fog height\n0.7 option --visibility 9000\n0.7 option --ramp viridis\n",
      "0.7 option --exaggeration 3\n0.7 option --no-plinth true\n0.7 option --haze 0.3\n",
      "0.7 option --look steps\n0.7 option --steps-range 2,30\n0.7 option --march naive\n"
      "0.7 option --naive-step-factor 0.3\n",
      "0.7 key 84 1 0\n0.72 wheel 0 5\n0.74 button 1 1 0\n0.76 move 100 180\n0.78 button 1 0 0\n",
      "0.7 button 0 1 2\n0.72 move 200 150\n0.74 button 0 0 2\n"};
  for (const std::string& settings : kSettings) {
    ASSERT_EQ(view(kDrag + settings + kSave, "dem.tif"), 0) << output_;
    expect_saved_again(1);
    std::istringstream lines(settings);
    for (std::string word; lines >> word;) {
      if (!word.starts_with("--")) continue;
      EXPECT_NE(output_.find(word), std::string::npos) << word << ": " << output_;
    }
    fs::remove(folder_ / "scarp-view-1.png");
  }
  EXPECT_NE(output_.find("--sun="), std::string::npos) << output_;
}

TEST_F(Window, SavesBothSides) {
  ASSERT_EQ(view(std::string(kDrag) + "0.7 compare march fixed-step\n0.8 key 67 1 0\n" + kSave, "dem.tif"), 0)
      << output_;
  EXPECT_TRUE(output_.starts_with("scarp render dem.tif -o left.png ")) << output_;
  EXPECT_NE(output_.find("\nscarp render dem.tif --march=fixed-step -o right.png "), std::string::npos) << output_;
  expect_saved_again(1);
  expect_saved_again(2);
  EXPECT_FALSE(bytes_of("scarp-view-1.png") == bytes_of("scarp-view-2.png"));
}

// Whether two pictures are the same where neither the line between two sides nor their names are drawn.
bool same_beside_line(const Rgb& a, const Rgb& b) {
  for (int y = 0; y < 200; ++y) {
    for (int x = 5; x < 315; ++x) {
      for (int c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(3 * (y * 320 + x) + c);
        if (a.bytes.at(at) != b.bytes.at(at)) return false;
      }
    }
  }
  return true;
}

TEST_F(Window, TheLineBetweenTwoSidesIsDragged) {
  // To the edges of the window, so that one side alone is seen.
  for (const int side : {1, 2}) {
    ASSERT_EQ(view(std::string(kDrag) + "0.7 compare look height\n0.8 move 160 30\n0.9 button 0 1 0\n1.0 move " +
                       (side == 1 ? "500" : "-50") + " 30\n1.1 button 0 0 0\n1.2 key 80 1 0\n",
                   "dem.tif --screenshot window.png"),
              0)
        << output_;
    const auto picture = [&](const char* name) { return read_png((folder_ / name).string()); };
    const Rgb window = picture("window.png");
    EXPECT_EQ(same_beside_line(window, picture("scarp-view-1.png")), side == 1);
    EXPECT_EQ(same_beside_line(window, picture("scarp-view-2.png")), side == 2);
    for (const char* name : {"window.png", "scarp-view-1.png", "scarp-view-2.png"}) fs::remove(folder_ / name);
  }
}

TEST_F(Window, GoesOnAfterAWrongOption) {
  ASSERT_EQ(view("0.1 option --samples -1\n0.2 option --waves 0.1\n0.3 option --nothing 1\n0.4 compare march none\n" +
                     std::string(kSave),
                 "dem.tif"),
            0)
      << output_;
  expect_saved_again(1);
}

TEST_F(Window, RecordingsEndAtTheSamePicture) {
  const char* kFlight = "0.7 key 70 1 0\n0.8 key 87 1 0\n1.0 key 87 0 0\n1.1 key 84 1 0\n1.2 wheel 0 1\n";
  for (const char* name : {"one.png", "two.png"}) {
    ASSERT_EQ(view(std::string(kDrag) + kFlight, std::string("dem.tif --screenshot ") + name), 0) << output_;
  }
  EXPECT_GT(bytes_of("one.png").size(), 1000u);
  EXPECT_TRUE(bytes_of("one.png") == bytes_of("two.png"));
}

TEST_F(Window, ShowsWhatItRenders) {
  // Without the panel, the window shows the film, and nothing else.
  ASSERT_EQ(view(std::string(kDrag) + kSave, "dem.tif --screenshot window.png"), 0) << output_;
  ASSERT_TRUE(fs::exists(folder_ / "scarp-view-1.png"));
  EXPECT_TRUE(bytes_of("window.png") == bytes_of("scarp-view-1.png"));
  // The panel is on top of it.
  ASSERT_EQ(view(std::string(kDrag) + "0.7 key 258 1 0\n", "dem.tif --screenshot panel.png"), 0) << output_;
  EXPECT_FALSE(bytes_of("panel.png") == bytes_of("window.png"));
}

TEST_F(Window, SaysWhatIsWrong) {
  EXPECT_EQ(view("", "nothing.tif"), 1);
  EXPECT_NE(output_.find("scarp: error: nothing.tif: "), std::string::npos) << output_;
  EXPECT_EQ(run("env -u DISPLAY -u WAYLAND_DISPLAY '" SCARP_VIEW "' dem.tif"), 1);
  EXPECT_NE(output_.find("there is no display"), std::string::npos) << output_;
  EXPECT_EQ(view("0.1 jump\n", "dem.tif"), 1);
  EXPECT_NE(output_.find("'events', line 2: expected"), std::string::npos) << output_;
  EXPECT_EQ(view("", "dem.tif --window-device nosuch"), 1);
  EXPECT_NE(output_.find("--window-device 'nosuch': no such device"), std::string::npos) << output_;
  EXPECT_EQ(view("", "dem.tif --screenshot /dev/full"), 1) << output_;
}

TEST_F(Window, TakesRealPressesAndDrags) {
  ASSERT_EQ(
      use("dem.tif --size 320x240 --record events",
          "xdotool mousemove 280 200 sleep 0.1 mousedown 1 sleep 0.1 mousemove_relative 30 5 sleep 0.1 mouseup 1\n"
          "xdotool click 4 sleep 0.1 keydown c sleep 0.1 keyup c sleep 0.1 key Escape"),
      0)
      << output_;
  EXPECT_TRUE(output_.starts_with("scarp render dem.tif -o picture.png --size 320x240 --eye=")) << output_;
  const std::string events = bytes_of("events");
  for (const char* event : {"button 0 1 0", "button 0 0 0", "wheel 0 1", "key 67 1 0", "key 256 1 0"})
    EXPECT_NE(events.find(event), std::string::npos) << event << '\n' << events;
}

TEST_F(Window, SurvivesChangesOfItsSize) {
  ASSERT_EQ(use("dem.tif --size 320x240",
                "for size in '400 300' '100 90' '1 1' '639 31' '320 400'; do xdotool windowsize $window $size; done\n"
                "xdotool windowunmap $window sleep 0.3 windowmap $window sleep 0.3 windowsize --sync $window 333 222\n"
                "xdotool mousemove 300 200\n"
                "until grep -q 'converged,333,222' times.csv; do kill -0 $pid || exit 9; sleep 0.05; done\n"
                "xdotool key Escape"),
            0)
      << output_;
  // The next window is as large.
  EXPECT_EQ(bytes_of("settings/scarp/view"), "size 333 222\npanel 1\n");
  ASSERT_EQ(use("dem.tif --record events", "xdotool mousemove 300 200 sleep 0.1 key Escape"), 0) << output_;
  EXPECT_TRUE(bytes_of("events").starts_with("scarp-view 333x222\n"));
}

TEST_F(Window, SaysWhatCannotBeSaved) {
  // A folder that is gone takes no files.
  std::ofstream(folder_ / "events") << "scarp-view 320x240\n" << kSave << "1.2 key 75 1 0\n";
  const std::string where = folder_.string();
  ASSERT_EQ(run("(mkdir gone && cd gone && rmdir ../gone && '" SCARP_VIEW "' '" + where + "/dem.tif' --play '" + where +
                "/events' --screenshot '" + where + "/window.png' --validation)"),
            0)
      << output_;
  EXPECT_EQ(output_, "");
  EXPECT_GT(bytes_of("window.png").size(), 1000u);
}

// Random mouse and keys, ten events per step of the clock, on the picture and on the panel.
std::string random_events(int count, unsigned seed) {
  std::mt19937 random(seed);
  const auto pick = [&](int least, int most) { return std::uniform_int_distribution<int>(least, most)(random); };
  std::string keys = "WASDQEOFGTHMKCP123456789";
  std::ostringstream text;
  for (int i = 0; i < count; ++i) {
    text << i / 600.0 << ' ';
    const int kind = pick(0, 9);
    if (kind < 4) {
      const bool outside = pick(0, 19) == 0;
      text << "move " << (outside ? pick(-100'000, 100'000) : pick(0, 320)) << ' '
           << (outside ? pick(-100'000, 100'000) : pick(0, 240)) << '\n';
    } else if (kind < 6) {
      text << "button " << pick(0, 9) % 4 << ' ' << pick(0, 1) << ' ' << pick(0, 15) << '\n';
    } else if (kind < 9) {
      constexpr int kOthers[] = {256, 257, 258, 259, 290, 340, 344, 32, 320};
      const int which = pick(0, static_cast<int>(keys.size() + std::size(kOthers)) - 1);
      const int code = which < static_cast<int>(keys.size()) ? keys[static_cast<std::size_t>(which)]
                                                             : kOthers[which - static_cast<int>(keys.size())];
      text << "key " << code << ' ' << pick(0, 1) << ' ' << pick(0, 15) << '\n';
    } else {
      text << "wheel 0 " << (pick(0, 9) == 0 ? pick(-1000, 1000) : pick(-3, 3)) << '\n';
    }
  }
  return text.str();
}

TEST_F(Window, RandomEventsEndWithoutACrash) {
  const int count = cases(100'000, 1'500, 500);
  ASSERT_EQ(view(random_events(count, 1), "dem.tif"), 0) << output_;
  // Their error look is judged by bisection: a picture takes seconds.
  ASSERT_EQ(view(random_events(cases(3'000, 500, 200), 2), "--function hills"), 0) << output_;
}

}  // namespace
}  // namespace scarp::test
