// SPDX-License-Identifier: MIT
#include "scarp/source/table/colour_relief_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <utility>

#include "base/refusal.h"
#include "scarp/base/error.h"

namespace scarp {
namespace {

// Reads a temporary file with this text.
RampStops read(const std::string& text) {
  const std::string path = "colour_relief_file_test." + std::to_string(::getpid()) + ".txt";
  std::ofstream(path) << text;
  try {
    RampStops stops = read_colour_relief(path);
    std::remove(path.c_str());
    return stops;
  } catch (...) {
    std::remove(path.c_str());
    throw;
  }
}

std::string complaint(const std::string& text) {
  return test::refusal([&] { read(text); });
}

TEST(ColourReliefFile, ReadsAllSeparatorsNamesAndOrders) {
  const RampStops stops = read(
      "# gdaldem\r\nINTERPOLATION:INTERPOLATED\n900,251,255,128,255,snow\r\n0 46:154:88\n\n1.5e3\tWhite\nnv 0 0 0 0\n"
      "default 1 2 3\n-10 aqua\n");
  EXPECT_FALSE(stops.stretched);
  ASSERT_EQ(stops.slices.size(), 3u);
  EXPECT_EQ(stops.slices[0].low, -10);
  EXPECT_EQ(stops.slices[0].srgb_low, vec3(0, 191, 191) / 255.0f);
  EXPECT_EQ(stops.slices[0].srgb_high, vec3(46, 154, 88) / 255.0f);
  EXPECT_EQ(stops.slices[1].high, 900);
  EXPECT_EQ(stops.slices[2].srgb_low, vec3(251, 255, 128) / 255.0f);
  EXPECT_EQ(stops.slices[2].high, 1500);
  EXPECT_EQ(stops.slices[2].srgb_high, vec3(1.0f));
}

TEST(ColourReliefFile, StretchesPercentagesAndKeepsSteps) {
  const RampStops percent = read("0% black\n25% 255 0 0\n100% white\n");
  EXPECT_TRUE(percent.stretched);
  EXPECT_EQ(percent.slices.at(0).high, 0.25);
  const RampStops step = read("0 black\n10 red\n10 blue\n20 white\n");
  ASSERT_EQ(step.slices.size(), 2u);
  EXPECT_EQ(step.slices[0].srgb_high, vec3(1, 0, 0));
  EXPECT_EQ(step.slices[1].srgb_low, vec3(0, 0, 1));
  EXPECT_EQ(read("5 red\n").slices.at(0).srgb_high, vec3(1, 0, 0)) << "one colour everywhere";
}

TEST(ColourReliefFile, ErrorNamesTheLine) {
  for (const auto& [text, says] : {std::pair{"\n# nothing\n", ": no line 'value R G B'"},
                                   {"0 1 2\n", "line 1: too short"},
                                   {"0 0 0 0\nx 1 2 3\n", "line 2: 'x' is not a number"},
                                   {"0 0 0 256\n", "256 is not a colour component"},
                                   {"0 -1 0 0\n", "-1 is not a colour component"},
                                   {"0 mauve\n", "unknown colour 'mauve'"},
                                   {"7\n", "'7' has no colour"},
                                   {"inf 1 2 3\n", "'inf' is not a number"},
                                   {"0 black\n50% white\n", "line 2: percent beside metres"},
                                   {"INTERPOLATION:DISCRETE\n", "unsupported interpolation 'DISCRETE'"},
                                   {"version https://git-lfs.github.com/spec/v1\n", "Git LFS pointer"}}) {
    EXPECT_NE(complaint(text).find(says), std::string::npos) << complaint(text);
  }
  EXPECT_THROW(read_colour_relief("none.txt"), Error);
}

}  // namespace
}  // namespace scarp
