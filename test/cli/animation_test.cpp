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

namespace scarp {
namespace {

using Names = std::vector<std::string>;

class Animate : public testing::Test {
 protected:
  Animate() {
    std::string text = "ncols 9\nnrows 9\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
    for (int i = 0; i < 81; ++i) text += std::to_string(i * 7919 % 23) + " ";
    dem_ = scratch_.write("dem.asc", text);
  }
  ~Animate() override { ::setenv("PATH", path_.c_str(), 1); }

  Names arguments(const std::string& to, const Names& options) const {
    Names all{"render", dem_, "-o", scratch_.path(to), "--size", "40x30"};
    all.insert(all.end(), options.begin(), options.end());
    return all;
  }
  std::string picture(const Names& options) const {
    const auto result = test::run(arguments("one.png", options));
    EXPECT_EQ(result.status, 0) << result.err;
    return test::text_of(scratch_.path("one.png"));
  }
  // The frames are the pictures of these options.
  void expect_frames(const Names& animation, const std::vector<Names>& frames) const {
    Names options = animation;
    options.insert(options.end(), {"--frames", std::to_string(frames.size()), "--overwrite"});
    const auto result = test::run(arguments("f-##.png", options));
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
  const Names before = scratch_.files();
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
  for (const auto& c : cases) {
    const auto result = test::run(arguments(c.to, c.options));
    EXPECT_NE(result.status, 0) << c.fragment;
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(c.fragment), std::string::npos) << result.err;
    EXPECT_EQ(scratch_.files(), before) << c.fragment;
  }
}

TEST_F(Animate, MakesFilms) {
  // Writes its arguments and the number of frames to the last argument.
  set_ffmpeg(
      "for last; do :; done\n"
      "while [ $# -gt 1 ]; do words=\"$words $1\"; [ \"$1\" = -i ] && folder=${2%/*}; shift; done\n"
      "set -- \"$folder\"/frame-*.png\necho \"$# frames,$words\" > \"$last\"\n");
  for (const std::string film : {"film.gif", "film.mp4"}) {
    const Names turn{"--turntable", "--frames", "4"}, change{"--animate", "fov=20..30", "--frames", "3", "--fps", "12"};
    for (const Names& options : {turn, change}) {
      const auto result = test::Program(arguments(film, options)).result();
      ASSERT_EQ(result.status, 0) << result.err;
      EXPECT_EQ(test::lines(result.out), 1) << result.out;
      const std::string text = test::text_of(scratch_.path(film));
      EXPECT_EQ(text.find(options == turn ? "4 frames, " : "3 frames, "), 0u) << text;
      EXPECT_NE(text.find(options == turn ? "-framerate 25 " : "-framerate 12 "), std::string::npos) << text;
      EXPECT_NE(text.find(film == "film.gif" ? "palettegen" : "yuv420p"), std::string::npos) << text;
    }
  }
}

TEST_F(Animate, ReportsFilmsThatFail) {
  std::filesystem::create_directory(scratch_.path("tmp"));
  std::filesystem::create_directory(scratch_.path("bin"));
  ::setenv("TMPDIR", scratch_.path("tmp").c_str(), 1);
  const Names options{"--animate", "fov=20..30", "--frames", "2"};
  const auto expect_error = [&](const std::string& fragment) {
    const Names before = scratch_.files();
    const auto result = test::Program(arguments("film.gif", options)).result();
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(fragment), std::string::npos) << result.err;
    EXPECT_EQ(scratch_.files(), before);
  };
  set_ffmpeg("");
  expect_error("films need the program ffmpeg, which is not installed");
  set_ffmpeg("echo one >&2\necho 'no such encoder' >&2\nexit 3\n");
  expect_error("film.gif': ffmpeg failed (no such encoder)");
  // Interrupted while ffmpeg writes.
  set_ffmpeg("for last; do :; done\necho part > \"$last\"\n: > \"${0%/*}/started\"\nwhile :; do :; done\n");
  test::Program program(arguments("film.gif", options));
  while (!std::filesystem::exists(scratch_.path("bin/started")))
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ::kill(program.pid(), SIGINT);
  const auto result = program.result();
  EXPECT_EQ(result.status, 128 + SIGINT) << result.err;
  EXPECT_FALSE(std::filesystem::exists(scratch_.path("film.gif")));
  for (const auto& left : std::filesystem::recursive_directory_iterator(scratch_.path(".")))
    EXPECT_EQ(left.path().filename().string().find("film"), std::string::npos) << left.path();
  ::unsetenv("TMPDIR");
}

}  // namespace
}  // namespace scarp
