// SPDX-License-Identifier: MIT
#include "scarp/render/surface/detail_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/render/surface/ground_paint.h"

namespace scarp {
namespace {

// Opaque grey pixels.
std::vector<std::uint8_t> greys(const std::vector<int>& values) {
  std::vector<std::uint8_t> rgba;
  for (const int value : values) {
    rgba.insert(rgba.end(), 3, static_cast<std::uint8_t>(value));
    rgba.push_back(255);
  }
  return rgba;
}

constexpr double kSharp = 1e-3;  // pixel size in metres

// 3 x 2 texels over 30 x 20 m; the mean is 85.
TEST(DetailTexture, RepeatsNorthUp) {
  const DetailTexture texture(3, 2, greys({0, 255, 0, 255, 0, 0}));
  const auto at = [&](double x, double y) { return texture.at({x, y}, 30, kSharp); };
  constexpr double kWhite = 2 * (1 - 85.0 / 255), kBlack = -2 * 85.0 / 255;
  EXPECT_NEAR(at(15, 15), kWhite, 1e-6) << "the middle of the northern row";
  EXPECT_NEAR(at(5, 5), kWhite, 1e-6) << "the western texel of the southern row";
  EXPECT_NEAR(at(5, 15), kBlack, 1e-6);
  for (const double x : {-600.0, -30.0, 30.0, 3000.0}) {
    for (const double y : {-20.0, 0.0, 20.0, 4000.0}) {
      EXPECT_NEAR(at(15 + x, 15 + y), kWhite, 1e-6);
      EXPECT_NEAR(at(10 + x, 20 + y), at(10, 20), 1e-6) << "between four texels, over the border";
    }
  }
  EXPECT_NEAR(at(10, 10), 0.5 * (kWhite + kBlack), 1e-6) << "between four texels";
}

TEST(DetailTexture, FadesAsPixelsGrow) {
  std::vector<int> values;
  for (int i = 0; i < 7 * 5; ++i) values.push_back(i * 97 % 256);
  const DetailTexture texture(7, 5, greys(values));
  const auto strength = [&](double footprint) {
    double most = 0;
    for (int i = 0; i < 400; ++i) most = std::max(most, std::abs(texture.at({0.7 * i, 0.31 * i}, 7, footprint)));
    return most;
  };
  EXPECT_GT(strength(1), 0.5);
  EXPECT_LT(strength(3), 0.7 * strength(1)) << "a pixel of three texels";
  EXPECT_LT(strength(100), 1e-6) << "the mean";
}

TEST(DetailTexture, ReplacesNoiseOnTheGround) {
  const auto texture = std::make_shared<DetailTexture>(2, 1, greys({0, 255}));
  const GroundPaintSettings settings{.detail = 0.5, .detail_size = 20, .detail_texture = texture};
  const GroundPaint paint(settings, {.low = 0, .high = 100, .cell = 10, .size = {100, 100}}, Ramp("grey", 0, 100),
                          {0, 0, 1});
  const auto factor = [&](double x) { return paint.over(vec3(1), {x, 3, 0}, 50, {0, 0, 1}, kSharp).x; };
  EXPECT_NEAR(factor(5), 0.5, 1e-6);
  EXPECT_NEAR(factor(15), 1.5, 1e-6);
}

TEST(DetailTexture, RejectsImagesOfAnotherSize) {
  EXPECT_THROW(DetailTexture(0, 1, {}), Error);
  EXPECT_THROW(DetailTexture(2, 1, greys({1})), Error);
  EXPECT_THROW(DetailTexture(DetailTexture::kMostSide + 1, 1, {}), Error);
}

}  // namespace
}  // namespace scarp
