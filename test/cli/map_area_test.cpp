// SPDX-License-Identifier: MIT
// Parts of maps: --area.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/program.h"
#include "output/read_png.h"

namespace scarp {
namespace {

using test::Names;

// 65 x 65 samples of 32 m.
class MapArea : public testing::Test {
 protected:
  MapArea() {
    const auto result =
        test::run({"generate", "--size", "65", "--cell", "32", "--seed", "3", "-o", scratch_.path("dem.tif")});
    EXPECT_EQ(result.status, 0) << result.err;
  }
  test::Rgb map(const Names& options) {
    Names arguments{"render", scratch_.path("dem.tif"), "-o", scratch_.path("map.png"), "--top", "--look", "height"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = test::run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return test::read_png(scratch_.path("map.png"));
  }
  void refused(const Names& options, const std::string& fragment) {
    Names arguments{"render", scratch_.path("dem.tif"), "-o", scratch_.path("map.png")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = test::run(arguments);
    EXPECT_NE(result.status, 0);
    EXPECT_NE(result.err.find(fragment), std::string::npos) << result.err;
  }
  test::Scratch scratch_;
};

TEST_F(MapArea, MatchesThatPartOfTheWholeMap) {
  const test::Rgb whole = map({"--size", "128x128"});
  // Its south-western part: columns from 16 to 80, rows from 32 on, at 16 m per pixel.
  const test::Rgb part = map({"--size", "64x96", "--area", "256,0,1280,1536"});
  ASSERT_EQ(part.width, 64);
  ASSERT_EQ(part.height, 96);
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 64; ++x) {
      const std::size_t at = 3 * static_cast<std::size_t>(64 * y + x),
                        there = 3 * static_cast<std::size_t>(128 * (y + 32) + x + 16);
      ASSERT_EQ(part.bytes[at], whole.bytes[there]) << x << ' ' << y;
    }
  }
  // The raster's middle is at (0, 0) of its CRS.
  const test::Rgb placed = map({"--size", "64x96", "--coords", "map", "--area", "-768,-1024,256,512"});
  EXPECT_TRUE(placed.bytes == part.bytes);
  // Without --size the picture has the shape of the area.
  const test::Rgb shaped = map({"--area", "256,0,1280,1536"});
  EXPECT_EQ(shaped.height, 1280);
  EXPECT_EQ(shaped.width, 853);  // two thirds
}

TEST_F(MapArea, RejectsInvalidAreas) {
  refused({"--area", "0,0,10,10"}, "--area has no effect without --top");
  refused({"--top", "--area", "10,0,0,10"}, "--area '10,0,0,10': expected W below E, and S below N");
  refused({"--top", "--area", "10,0,0"}, "--area '10,0,0': expected W,S,E,N");
}

}  // namespace
}  // namespace scarp
