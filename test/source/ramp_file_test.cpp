// SPDX-License-Identifier: MIT
#include "scarp/source/table/ramp_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "scarp/base/error.h"

namespace scarp {
namespace {

class CptFile {
 public:
  explicit CptFile(const std::string& text) : path_("ramp_file_test." + std::to_string(::getpid()) + ".cpt") {
    std::ofstream(path_) << text;
  }
  ~CptFile() { std::remove(path_.c_str()); }
  RampStops read() const { return read_cpt(path_); }
  std::string refusal() const {
    try {
      read();
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  }

 private:
  std::string path_;
};

TEST(RampFile, ReadsAllColourNotations) {
  const RampStops stops =
      CptFile(
          "# COLOR_MODEL = RGB\n-100 0 0 255\t0 0 0 128\n"
          "0\t0/255/0\t50\t255/255/255 L ; a label\n\n50 255 100 0\nB 0 0 0\nF 255 255 255\nN 128\n")
          .read();
  ASSERT_EQ(stops.slices.size(), 3u);
  EXPECT_FALSE(stops.stretched);
  EXPECT_EQ(stops.slices[1].low, 0);
  EXPECT_EQ(stops.slices[1].srgb_low, vec3(0, 1, 0));
  EXPECT_EQ(stops.slices[2].srgb_low, vec3(1, 1, 1)) << "a grey";
  EXPECT_EQ(stops.slices[2].high, 100);
}

TEST(RampFile, DetectsStretchedRamps) {
  EXPECT_TRUE(CptFile("0 0 0 0 0.5 9 9 9\n0.5 9 9 9 1 255 255 255\n").read().stretched);
  const RampStops hinged = CptFile("# HINGE = 0\n-1 0 0 0 0 9 9 9\n0 9 9 9 1 255 255 255\n").read();
  EXPECT_TRUE(hinged.stretched && hinged.hinged);
  EXPECT_FALSE(CptFile("-1 0 0 0 1 9 9 9\n").read().stretched);
}

TEST(RampFile, ReportsErrorsInOneLine) {
  EXPECT_NE(CptFile("").refusal().find("no line"), std::string::npos);
  EXPECT_NE(CptFile("0 0 0 0 1 2 3 999\n").refusal().find("line 1: 999 is not a colour component"), std::string::npos);
  EXPECT_NE(CptFile("0 0 0 0 1\n").refusal().find("line 1"), std::string::npos);
  EXPECT_NE(CptFile("0 0 0 0 1 2 3 4 5\n").refusal().find("unexpected '5'"), std::string::npos);
  EXPECT_NE(CptFile("0 red 1 blue\n").refusal().find("'red' is not a number"), std::string::npos);
  EXPECT_NE(CptFile("0 1/2 1 3/4\n").refusal().find("expected R/G/B"), std::string::npos);
  EXPECT_NE(CptFile("# COLOR_MODEL = HSV\n0 0 0 0 1 2 3 4\n").refusal().find("must be RGB"), std::string::npos);
  EXPECT_NE(CptFile("0 0 0 0 5 1 1 1\n4 0 0 0 9 1 1 1\n").refusal().find("line 2: begins at 4"), std::string::npos);
  EXPECT_NE(CptFile("version https://git-lfs.github.com/spec/v1\n").refusal().find("git lfs pull"), std::string::npos);
}

TEST(RampFile, SpacesARowEvenly) {
  const std::uint8_t three[] = {0, 0, 0, 255, 0, 0, 255, 255, 255}, one[] = {9, 9, 9};
  const RampStops stops = ramp_of_row(three);
  ASSERT_EQ(stops.slices.size(), 2u);
  EXPECT_TRUE(stops.stretched);
  EXPECT_EQ(stops.slices[0].high, 0.5);
  EXPECT_EQ(stops.slices[0].srgb_high, vec3(1, 0, 0));
  EXPECT_EQ(stops.slices[1].high, 1);
  EXPECT_EQ(ramp_of_row(one).slices.size(), 1u);
}

}  // namespace
}  // namespace scarp
