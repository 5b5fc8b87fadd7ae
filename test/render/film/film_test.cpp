// SPDX-License-Identifier: MIT
#include "scarp/render/film/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace scarp {
namespace {

TEST(Film, TilesCoverEveryPixelOnceAndHaveFewPoints) {
  for (const int aa : {1, 2, 3, 5, 16}) {
    for (const auto& [width, height] : {std::pair(1, 1), {16, 16}, {17, 33}, {5, 100}}) {
      std::vector<int> visits(static_cast<std::size_t>(width * height));
      const PixelTiles tiles(width, height, aa);
      for (std::int64_t i = 0; i < tiles.count(); ++i) {
        const auto points = points_of(tiles[i], aa);
        EXPECT_LE(points.size(), kMostPointsOfTile);
        EXPECT_EQ(points.size(), tiles[i].pixels() * static_cast<std::size_t>(aa * aa));
        for (const PicturePoint& p : points) {
          EXPECT_EQ(p.pixel_x, std::floor(p.x));
          EXPECT_EQ(p.pixel_y, std::floor(p.y));
          visits.at(static_cast<std::size_t>(p.pixel_y * width + p.pixel_x)) += p.index + 1;
        }
      }
      const int all = aa * aa * (aa * aa + 1) / 2;
      for (const int count : visits) ASSERT_EQ(count, all) << width << " x " << height << ", aa " << aa;
    }
  }
}

TEST(Film, SamplesAreAveragedInLinearLight) {
  // Half the light is 188 in sRGB, not 128.
  const std::vector<vec3> points = {vec3(0.0f), vec3(1.0f), vec3(0.0f), vec3(1.0f)};
  Image image(1, 1);
  set_pixel(image, 0, 0, mean_colour(points));
  EXPECT_EQ(int{image.pixel(0, 0)[0]}, 188);
}

TEST(Film, SingleSampleIsThePixelCentre) {
  const auto points = points_of({0, 0, 3, 2}, 1);
  EXPECT_EQ(points[2].x, 2.5);
  EXPECT_EQ(points[5].y, 1.5);
}

}  // namespace
}  // namespace scarp
