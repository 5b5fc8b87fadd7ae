// SPDX-License-Identifier: MIT
#include "scarp/render/film.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "scarp/base/error.h"

namespace scarp {
namespace {

TEST(Film, EveryPixelIsVisitedOnce) {
  for (const auto& [width, height] : {std::pair(1, 1), {16, 16}, {17, 33}, {5, 100}}) {
    std::vector<std::atomic<int>> visits(static_cast<std::size_t>(width * height));
    for_each_pixel(width, height, [&, w = width](int x, int y) { ++visits[static_cast<std::size_t>(y * w + x)]; }, {});
    for (const auto& count : visits) ASSERT_EQ(count, 1) << width << " x " << height;
  }
}

TEST(Film, SamplesAreMixedInLinearLight) {
  // The left half of each pixel is black, the right one white: half the light is 188 in sRGB, not 128.
  const Image image =
      develop(2, 1, 2, [](const PicturePoint& p) { return vec3(p.x - p.pixel_x < 0.5 ? 0.0f : 1.0f); }, {});
  EXPECT_EQ(int{image.pixel(0, 0)[0]}, 188);
  EXPECT_EQ(int{image.pixel(1, 0)[2]}, 188);
}

TEST(Film, OneSampleIsTheMiddleOfThePixel) {
  const Image image =
      develop(3, 2, 1,
              [](const PicturePoint& p) { return vec3(p.x == 2.5 ? 1.0f : 0.0f, p.y == 1.5 ? 1.0f : 0.0f, 0.0f); }, {});
  EXPECT_EQ(int{image.pixel(2, 0)[0]}, 255);
  EXPECT_EQ(int{image.pixel(1, 0)[0]}, 0);
  EXPECT_EQ(int{image.pixel(0, 1)[1]}, 255);
}

TEST(Film, StopsWhenItIsAskedTo) {
  std::atomic<int> pixels{0};
  const Progress stop = [](double) { return false; };
  EXPECT_THROW(for_each_pixel(
                   1600, 1600, [&](int, int) { ++pixels; }, stop),
               Interrupted);
  EXPECT_LT(pixels, 1600 * 1600);
}

}  // namespace
}  // namespace scarp
