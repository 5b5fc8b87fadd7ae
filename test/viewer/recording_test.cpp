// SPDX-License-Identifier: MIT
// Recordings are read as written; errors name the line.
#include "app/viewer/recording.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

struct Recordings : testing::Test {
  std::string file = std::filesystem::temp_directory_path() / ("scarp-recording-" + std::to_string(::getpid()));
  ~Recordings() override { std::filesystem::remove(file); }

  std::string why_not(const std::string& text) const {
    std::ofstream(file) << text;
    try {
      read_recording(file);
    } catch (const Error& error) {
      return std::string(error.what()).substr(file.size() + 2);
    }
    return {};
  }
};

TEST_F(Recordings, RoundTrip) {
  Recording recording{640, 480, {}};
  recording.events.push_back({.seconds = 0.25, .kind = WindowEvent::Kind::move, .x = 12.5, .y = 300});
  recording.events.push_back(
      {.seconds = 0.5, .kind = WindowEvent::Kind::button, .code = 1, .down = true, .modifiers = 2});
  recording.events.push_back({.seconds = 0.5, .kind = WindowEvent::Kind::key, .code = 87, .down = false});
  recording.events.push_back({.seconds = 1, .kind = WindowEvent::Kind::key, .code = 59, .letter = 77, .down = true});
  recording.events.push_back({.seconds = 1, .kind = WindowEvent::Kind::text, .text = " 1,5"});
  recording.events.push_back({.seconds = 2, .kind = WindowEvent::Kind::wheel, .x = 0, .y = -1});
  recording.events.push_back({.seconds = 3, .kind = WindowEvent::Kind::option, .text = "--sun 300,20"});
  recording.events.push_back({.seconds = 3, .kind = WindowEvent::Kind::compare, .text = "march naive"});
  recording.events.push_back({.seconds = 3, .kind = WindowEvent::Kind::compare});
  write_recording(file, recording);
  const Recording read = read_recording(file);
  EXPECT_EQ(read.events.back().line, 10);
  EXPECT_EQ(read.width, 640);
  EXPECT_EQ(read.height, 480);
  ASSERT_EQ(read.events.size(), recording.events.size());
  for (std::size_t i = 0; i < read.events.size(); ++i) {
    const WindowEvent &a = read.events[i], &b = recording.events[i];
    EXPECT_TRUE(a.seconds == b.seconds && a.kind == b.kind && a.code == b.code && a.letter == b.letter &&
                a.down == b.down && a.modifiers == b.modifiers && a.x == b.x && a.y == b.y && a.text == b.text)
        << i;
  }
}

TEST_F(Recordings, DocumentedExampleIsValid) {
  std::ifstream in(std::filesystem::path(SCARP_SOURCE_DIR) / "doc" / "user" / "viewer.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}}, fence = "\n```\n";
  const std::size_t begin = page.find(fence, page.find("## Recordings")) + fence.size();
  EXPECT_EQ(why_not(page.substr(begin, page.find(fence, begin) + 1 - begin)), "");
  const Recording example = read_recording(file);
  EXPECT_GT(example.width, 1);
  for (int kind = 0; kind <= static_cast<int>(WindowEvent::Kind::compare); ++kind) {
    EXPECT_TRUE(std::any_of(example.events.begin(), example.events.end(), [&](const WindowEvent& event) {
      return event.kind == static_cast<WindowEvent::Kind>(kind);
    })) << kind;
  }
}

TEST_F(Recordings, ReportErrors) {
  EXPECT_EQ(why_not(""), ": is empty");
  EXPECT_EQ(why_not("png 3x3\n"), ", line 1: expected 'scarp-view WIDTHxHEIGHT'");
  EXPECT_EQ(why_not("scarp-view 0x3\n"), ", line 1: expected 'scarp-view WIDTHxHEIGHT'");
  EXPECT_EQ(why_not("scarp-view 9x9\n1 move 1 1\n0.5 move 1 1\n"),
            ", line 3: expected a time no earlier than the last, and an event");
  const char* kWords =
      ", line 2: expected 'move X Y', 'wheel X Y', 'button CODE DOWN MODIFIERS', 'key CODE DOWN MODIFIERS [LETTER]', "
      "'text TYPED', 'option "
      "--NAME [VALUE]' or 'compare [march NAME | look NAME]' after the time";
  EXPECT_EQ(why_not("scarp-view 9x9\n1 option water\n"), kWords);
  EXPECT_EQ(why_not("scarp-view 9x9\n1 compare foo bar\n"), kWords);
  EXPECT_EQ(why_not("scarp-view 9x9\n1 compare march\n"), kWords);
  EXPECT_EQ(why_not("scarp-view 9x9\n1 jump\n"), kWords);
  EXPECT_EQ(why_not("scarp-view 9x9\n1 move 3\n"), kWords);
  EXPECT_EQ(why_not("scarp-view 9x9\n1 key 3 7 0\n"), kWords);
  EXPECT_THROW(read_recording("/nowhere/at/all"), Error);
}

}  // namespace
}  // namespace scarp::viewer
