// SPDX-License-Identifier: MIT
// `scarp render --animate` and films, judged by the pictures of the values typed one by one. A shell script stands in
// for ffmpeg.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "cli/program.h"
#include "cli/refused.h"

namespace scarp {
namespace {

using test::Names;
using test::operator+;

class Animate : public testing::Test {
 protected:
  Animate() {
    std::string text = "ncols 9\nnrows 9\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
    for (int i = 0; i < 81; ++i) text += std::to_string(i * 7919 % 23) + " ";
    dem_ = scratch_.write("dem.asc", text);
  }
  ~Animate() override { ::setenv("PATH", path_.c_str(), 1); }

  Names arguments(const std::string& to, const Names& options) const {
    return Names{"render", dem_, "-o", scratch_.path(to), "--size", "40x30"} + options;
  }
  std::string picture(const Names& options) const {
    const auto result = test::run(arguments("one.png", options));
    EXPECT_EQ(result.status, 0) << result.err;
    return test::text_of(scratch_.path("one.png"));
  }
  // The frames are the pictures of these options.
  void expect_frames(const Names& animation, const std::vector<Names>& frames) const {
    const Names options{"--frames", std::to_string(frames.size()), "--overwrite"};
    const auto result = test::run(arguments("f-##.png", animation + options));
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find(": " + std::to_string(frames.size()) + " frames, "), std::string::npos) << result.out;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_TRUE(test::text_of(scratch_.path("f-0" + std::to_string(i) + ".png")) == picture(frames[i]))
          << animation.back() << ", frame " << i;
    }
  }
  // Programs that are started from now on find only this ffmpeg.
  void set_ffmpeg(const std::string& script) const {
    std::filesystem::create_directory(scratch_.path("bin"));
    if (!script.empty()) ::chmod(scratch_.write("bin/ffmpeg", "#!/bin/sh\n" + script).c_str(), 0700);
    ::setenv("PATH", scratch_.path("bin").c_str(), 1);
  }

  test::Scratch scratch_;
  std::string dem_;
  const std::string path_ = std::getenv("PATH");
};

TEST_F(Animate, SetsAnOptionOfEachFrame) {
  expect_frames({"--march", "lipschitz", "--animate", "shrink=1..0.5"}, {{"--march", "lipschitz", "--shrink", "1"},
                                                                         {"--march", "lipschitz", "--shrink", "0.75"},
                                                                         {"--march", "lipschitz", "--shrink", "0.5"}});
  expect_frames({"--animate", "sun=90..270,30"}, {{"--sun", "90,30"}, {"--sun", "180,30"}, {"--sun", "270,30"}});
  expect_frames({"--animate", "exaggeration=1..3", "--animate", "--view=190..-10,35..20"},
                {{"--exaggeration", "1", "--view", "190,35"}, {"--exaggeration", "3", "--view", "-10,20"}});
  // Options of whole numbers get rounded ones.
  expect_frames({"--animate", "aa=1..4"}, {{"--aa", "1"}, {"--aa", "3"}, {"--aa", "4"}});
  expect_frames({"--animate", "look=level:0..2"},
                {{"--look", "level:0"}, {"--look", "level:1"}, {"--look", "level:2"}});
  // A single frame is the first.
  expect_frames({"--animate", "contours=2..9"}, {{"--contours", "2"}});
}

TEST_F(Animate, KeepsFramesThatExist) {
  const Names options{"--animate", "fov=20..40", "--frames", "2"};
  EXPECT_NE(test::run(arguments("k-#.png", options)).out.find("2 frames, 2 made now"), std::string::npos);
  std::filesystem::remove(scratch_.path("k-1.png"));
  EXPECT_NE(test::run(arguments("k-#.png", options)).out.find("2 frames, 1 made now, 1 kept"), std::string::npos);
}

TEST_F(Animate, RejectsWhatCannotChange) {
  const struct {
    Names options;
    std::string fragment, to = "f-##.png";
  } cases[] = {
      {{"--animate", "shrnk=1..0.2"}, "there is no option --shrnk"},
      {{"--animate", "shrink=1..0.2"}, "--shrink needs --march lipschitz"},
      {{"--animate", "shrink"}, "expected NAME=VALUE"},
      {{"--animate", "fov=30"}, "has no range FROM..TO"},
      {{"--animate", "fov=30.."}, "expected a number before and after '..'"},
      {{"--animate", "fov=a..3"}, "expected a number before and after '..'"},
      {{"--animate", "fov=nan..3"}, "expected a number before and after '..'"},
      {{"--animate", "march=1..2"}, "--march takes no numbers"},
      {{"--animate", "no-shadows=0..1"}, "--no-shadows takes no numbers"},
      {{"--animate", "frames=1..9"}, "--frames takes no numbers for a picture"},
      {{"--animate", "output=1..2"}, "--output takes no numbers"},
      // Only the last frame is wrong.
      {{"--animate", "fov=100..151", "--frames", "2"}, "--fov '151': expected a number from 1 to 150"},
      {{"--animate", "view=1..2,3", "--eye", "1,2,300"}, "--view cannot be combined with --eye"},
      {{"--animate", "fov=20..30", "--turntable"}, "--animate cannot be combined with --turntable"},
      {{"--animate", "fov=20..30", "--json"}, "--json describes one picture"},
      {{"--animate", "fov=20..30", "--fps", "5"}, "--fps applies to .gif and .mp4 files only"},
      {{"--animate", "fov=20..30"}, "name it frame-####.png", "f.png"},
      {{}, "a film needs frames", "f.gif"},
  };
  for (const auto& c : cases) test::expect_refused(scratch_, arguments(c.to, c.options), c.fragment);
}

TEST_F(Animate, MakesFilms) {
  // Writes its arguments and its input to the last argument.
  set_ffmpeg("for last; do :; done\necho \"$*\" > \"$last\"\n/bin/cat >> \"$last\"\n");
  const Names turn{"--turntable", "--frames", "2", "--view", "10,40"},
      change{"--animate", "fov=20..30", "--frames", "3", "--fps", "12"};
  const std::string turned = picture({"--view", "10,40"}) + picture({"--view", "190,40"}),
                    changed = picture({"--fov", "20"}) + picture({"--fov", "25"}) + picture({"--fov", "30"});
  for (const std::string film : {"film.gif", "film.mp4"}) {
    for (const Names& options : {turn, change}) {
      const Names before = scratch_.files();
      const auto result = test::Program(arguments(film, options)).result();
      ASSERT_EQ(result.status, 0) << result.err;
      EXPECT_EQ(test::lines(result.out), 1) << result.out;
      const std::string text = test::text_of(scratch_.path(film)), words = text.substr(0, text.find('\n'));
      EXPECT_NE(words.find(options == turn ? "-framerate 25 " : "-framerate 12 "), std::string::npos) << words;
      EXPECT_NE(words.find(film == "film.gif" ? "palettegen" : "yuv420p"), std::string::npos) << words;
      EXPECT_TRUE(text.substr(words.size() + 1) == (options == turn ? turned : changed)) << film;
      std::filesystem::remove(scratch_.path(film));
      EXPECT_EQ(scratch_.files(), before);
    }
  }
}

TEST_F(Animate, ReportsFilmsThatFail) {
  std::filesystem::create_directory(scratch_.path("tmp"));
  std::filesystem::create_directory(scratch_.path("bin"));
  ::setenv("TMPDIR", scratch_.path("tmp").c_str(), 1);
  const auto expect_nothing_left = [&] {
    for (const auto& left : std::filesystem::recursive_directory_iterator(scratch_.path(".")))
      EXPECT_EQ(left.path().filename().string().find("film"), std::string::npos) << left.path();
  };
  const Names options{"--animate", "fov=20..30", "--frames", "2"};
  const auto expect_error = [&](const std::string& fragment) {
    const Names before = scratch_.files();
    test::expect_refused(test::Program(arguments("film.gif", options)).result(), fragment);
    EXPECT_EQ(scratch_.files(), before);
  };
  set_ffmpeg("");
  expect_error("films need the program ffmpeg, which is not installed");
  set_ffmpeg("echo one >&2\necho 'no such encoder' >&2\nexit 3\n");
  expect_error("film.gif': ffmpeg failed (no such encoder)");
  // It fails after it has read all frames.
  set_ffmpeg("/bin/cat > /dev/null\necho 'disk full' >&2\nexit 3\n");
  expect_error("film.gif': ffmpeg failed (disk full)");
  // Interrupted while ffmpeg writes and ignores that it is to end, by one signal and by two.
  set_ffmpeg(
      "trap '' TERM\nfor last; do :; done\necho part > \"$last\"\n: > \"${0%/*}/started\"\n"
      "while :; do :; done\n");
  for (const int signals : {1, 2}) {
    test::Program program(arguments("film.gif", options));
    while (!std::filesystem::exists(scratch_.path("bin/started")))
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    for (int i = 0; i < signals; ++i) {
      ::kill(program.pid(), SIGINT);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    const auto result = program.result();
    EXPECT_EQ(result.status, 128 + SIGINT) << result.err;
    expect_nothing_left();
    std::filesystem::remove(scratch_.path("bin/started"));
  }
  ::unsetenv("TMPDIR");
}

}  // namespace
}  // namespace scarp
