// SPDX-License-Identifier: MIT
// Scales of height in pictures: ramps from files and over ranges, contour lines, exaggeration.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cli/program.h"
#include "output/read_png.h"

namespace scarp::test {
namespace {

constexpr int kSlopeSide = 33;

class ColourScale : public testing::Test {
 protected:
  template <class Height>
  std::string dem(const char* name, const Height& height) const {
    std::string text = fmt::format("ncols {0}\nnrows {0}\nxllcorner 5000\nyllcorner 5000\ncellsize 10\n", kSlopeSide);
    for (int row = 0; row < kSlopeSide; ++row) {
      for (int col = 0; col < kSlopeSide; ++col) text += fmt::format("{} ", height(col, row));
      text += '\n';
    }
    return scratch_.write(name, text);
  }
  // Rises by 10 m per column, from 0 to 320 m.
  std::string slope() const {
    return dem("slope.asc", [](int col, int) { return 10.0 * col; });
  }
  Result render(const std::string& input, const Names& more) const {
    Names arguments{"render", input, "-o", out_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  // A map with one pixel in each cell.
  Rgb map(const std::string& input, Names more) const {
    more.insert(more.end(), {"--top", "--unlit", "--haze", "0", "--aa", "1", "--size", "32x32"});
    const auto result = render(input, more);
    EXPECT_EQ(result.status, 0) << result.err;
    return read_png(out_);
  }

  Scratch scratch_;
  const std::string out_ = scratch_.path("out.png");
};

// Colours of `gdaldem color-relief` (GDAL 3.6) for these heights: red to white by 255 / 320 per metre, rounded.
TEST_F(ColourScale, ColourFilesMatchGdaldem) {
  const std::string ramp = scratch_.write("ramp.txt", "320 white\n0 255:0:0\nnv 0 0 0\n");
  const Rgb picture = map(slope(), {"--ramp", ramp});
  for (int col = 0; col < 32; ++col) {
    const std::uint8_t* rgb = picture.pixel(col, 16);
    EXPECT_EQ(rgb[0], 255);
    // Within a slice, colours are mixed in linear light over steps that the eye cannot distinguish.
    EXPECT_NEAR(rgb[1], 255.0 / 320 * (10 * col + 5), 1.5) << col;
  }
  const auto wrong = render(slope(), {"--ramp", ramp, "--ramp-range", "0,10"});
  EXPECT_NE(wrong.err.find("ramp.txt has heights of its own"), std::string::npos) << wrong.err;
}

TEST_F(ColourScale, RampRangeMatchesTheLegend) {
  const std::string dem = slope();
  for (const std::string exaggeration : {"1", "3"}) {
    const Rgb picture = map(dem, {"--ramp", "grey", "--ramp-range", "100,200", "--exaggeration", exaggeration});
    EXPECT_EQ(picture.pixel(5, 16)[0], 0);
    EXPECT_EQ(picture.pixel(25, 16)[0], 255);
    EXPECT_NEAR(picture.pixel(15, 16)[0], 255 * 0.55, 3);
  }
  Names height{"--look", "height", "--top", "--size", "32x32", "--ramp-range", "100,200"};
  ASSERT_EQ(render(dem, height).status, 0);
  EXPECT_EQ(read_png(out_).pixel(5, 16)[0], 1);
  EXPECT_EQ(read_png(out_).pixel(25, 16)[0], 255);
  EXPECT_NE(render(dem, {"--ramp-range", "5,5"}).err.find("--ramp-range '5,5': expected LOW below HIGH"),
            std::string::npos);
}

TEST_F(ColourScale, LevelGroundAtAContourIsNotDrawn) {
  // A lake at 100 m, and its shore; contours at 80, 100 and 120 m. The second lake is rough by 1e-5 m, like rounded
  // floats.
  for (const double rounding : {0.0, 1e-5}) {
    const std::string lake = dem("lake.asc", [&](int col, int row) {
      const double away = std::max(std::abs(col - 16), std::abs(row - 16)) - 8;
      return away > 0 ? 100 + 4 * away : 100 + rounding * ((col * 7 + row * 3) % 2);
    });
    const Rgb plain = map(lake, {"--ramp", "grey"}), lined = map(lake, {"--ramp", "grey", "--contours", "20"});
    int painted = 0, lines = 0;
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        const bool differs = plain.pixel(x, y)[0] != lined.pixel(x, y)[0];
        const bool on_lake = x >= 8 && x < 24 && y >= 8 && y < 24;
        painted += on_lake && differs, lines += !on_lake && differs;
      }
    }
    EXPECT_EQ(painted, 0) << rounding;
    EXPECT_GT(lines, 20);
  }
}

TEST_F(ColourScale, WarnsAboutInvisibleContours) {
  const std::string dem = slope();
  const auto note = [&](const std::string& interval) {
    const auto result = render(dem, {"--size", "64x48", "--aa", "1", "--contours", interval});
    EXPECT_EQ(result.status, 0);
    return result.err;
  };
  const std::string merged = note("0.0001");
  ASSERT_NE(merged.find("left out nearly everywhere; --contours "), std::string::npos) << merged;
  const std::string better = merged.substr(merged.rfind("--contours ") + 11);
  EXPECT_EQ(note(better.substr(0, better.find(' '))).find("--contours"), std::string::npos) << better;
  const std::string high = this->dem("high.asc", [](int col, int) { return 1000 + 10 * col; });
  const std::string none = render(high, {"--size", "64x48", "--aa", "1", "--contours", "5000"}).err;
  EXPECT_NE(none.find("--contours 5000: no line lies between 1000 and 1320 m"), std::string::npos) << none;
}

TEST_F(ColourScale, ExaggerationFollowsTheRelief) {
  const std::string flat = dem("flat.asc", [](int col, int) { return 7 + 0.009 * col; }),
                    level = dem("level.asc", [](int, int) { return 7; });
  const Names small{"--size", "32x24", "--aa", "1"};
  const auto with = [&](const std::string& input, const std::string& factor) {
    Names options = small;
    if (!factor.empty()) options.insert(options.end(), {"--exaggeration", factor});
    const auto result = render(input, options);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.err;
  };
  // The relief is 0.288 m over 320 m; exaggerated 111 times, it would be a tenth of the width.
  EXPECT_NE(with(flat, "").find("hardly shows (--exaggeration auto, or a factor such as 100"), std::string::npos);
  EXPECT_NE(with(flat, "auto").find("--exaggeration auto is 100: the relief of 0.288 m over 320 m"), std::string::npos);
  const std::string chosen = text_of(out_);
  EXPECT_EQ(with(flat, "100").find("exaggeration"), std::string::npos);
  EXPECT_EQ(text_of(out_), chosen);
  EXPECT_NE(with(level, "").find("the ground is level"), std::string::npos);
  EXPECT_NE(with(level, "auto").find("auto is 1"), std::string::npos);
  EXPECT_NE(with(slope(), "auto").find("auto is 1"), std::string::npos) << "already steep";
  EXPECT_EQ(with(slope(), "").find("exaggeration"), std::string::npos);
  const auto cast = run({"cast", flat, "--rays", "-", "--exaggeration", "auto"});
  EXPECT_NE(cast.err.find("--exaggeration 'auto': applies to pictures only (give a number)"), std::string::npos);
}

}  // namespace
}  // namespace scarp::test
