// SPDX-License-Identifier: MIT
#include "scarp/source/raster/terrain_rgb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace scarp {
namespace {

double height(HeightEncoding encoding, std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  const std::uint8_t pixel[] = {red, green, blue};
  float n = 0;
  decode_rgb(pixel, 1, 3, &n);
  return n * scale_of(encoding).scale + scale_of(encoding).offset;
}

TEST(TerrainRgb, DecodesTheMapboxFormula) {
  EXPECT_DOUBLE_EQ(height(HeightEncoding::terrain_rgb, 0, 0, 0), -10000);
  EXPECT_DOUBLE_EQ(height(HeightEncoding::terrain_rgb, 1, 134, 160), -10000 + (65536 + 134 * 256 + 160) * 0.1);
  EXPECT_DOUBLE_EQ(height(HeightEncoding::terrain_rgb, 255, 255, 255), 1667721.5);
}

TEST(TerrainRgb, DecodesTerrarium) {
  EXPECT_DOUBLE_EQ(height(HeightEncoding::terrarium, 128, 0, 0), 0);
  EXPECT_DOUBLE_EQ(height(HeightEncoding::terrarium, 128, 1, 128), 1.5);
  EXPECT_DOUBLE_EQ(height(HeightEncoding::terrarium, 0, 0, 1), -32768 + 1 / 256.0);
}

TEST(TerrainRgb, IsExactAtTheUpperEnd) {
  const std::uint8_t pixels[] = {255, 255, 254, 255, 255, 255};
  float n[2];
  decode_rgb(pixels, 2, 3, n);
  EXPECT_EQ(n[0], 16777214.0f);
  EXPECT_EQ(n[1], 16777215.0f);
}

TEST(TerrainRgb, OnlyAlphaZeroIsAHole) {
  const std::uint8_t pixels[] = {1, 2, 3, 0, 1, 2, 3, 1, 1, 2, 3, 255};
  float n[3];
  decode_rgb(pixels, 3, 4, n);
  EXPECT_TRUE(std::isnan(n[0]));
  EXPECT_EQ(n[1], 66051.0f);
  EXPECT_EQ(n[2], 66051.0f);
}

TEST(TerrainRgb, NamesRoundTrip) {
  for (const char* name : {"none", "terrain-rgb", "terrarium"}) EXPECT_EQ(name_of(height_encoding(name).value()), name);
  for (const char* name : {"", "Terrarium", "terrain_rgb", "rgb"}) EXPECT_FALSE(height_encoding(name)) << name;
}

}  // namespace
}  // namespace scarp
