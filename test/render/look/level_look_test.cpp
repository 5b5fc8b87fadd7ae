// SPDX-License-Identifier: MIT
#include "scarp/render/look/level_look.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "render/map.h"
#include "render/terrain.h"
#include "scarp/base/error.h"
#include "scarp/render/frame/picture.h"
#include "scarp/scene/plinth.h"

namespace scarp::test {
namespace {

// 7 x 5 cells: level 1 has 4 x 3 nodes, the last of which are narrower.
TEST(LevelLook, ShowsTheMaximaOfTheirNodes) {
  std::vector<float> samples;
  for (int i = 0; i < 8 * 6; ++i) samples.push_back(static_cast<float>(i * 29 % 48));
  const HeightField field = HeightField::own(std::move(samples), 8, 6);
  PictureSettings settings = map_settings(field);
  settings.look = Look::level;
  for (settings.level = 0; settings.level <= 3; ++settings.level) {
    const Image image = map_of(field, settings).image;
    for (int row = 0; row < 5; ++row) {
      for (int col = 0; col < 7; ++col) {
        const int side = 1 << settings.level, c0 = col / side * side, r0 = row / side * side;
        double most = 0;
        for (int r = r0; r <= std::min(r0 + side, 5); ++r) {
          for (int c = c0; c <= std::min(c0 + side, 7); ++c) most = std::max(most, (r * 8 + c) * 29 % 48 * 1.0);
        }
        // A step of the pyramid's code is 1/65535 of the range.
        EXPECT_NEAR(red(image, 10 * col + 4, 10 * row + 6), 1 + 254 * most / 47, 0.51) << col << " " << row;
      }
    }
  }
  settings.level = 4;
  EXPECT_THROW(map_of(field, settings), Error);
  settings.level = -1;
  EXPECT_THROW(map_of(field, settings), Error);
}

// Boxes cover the holes of their blocks, and are opaque there.
TEST(LevelLook, IsOpaqueWhereItHasBoxes) {
  std::vector<float> samples(9 * 9, 5.0f);
  samples[0] = samples[20] = 9;
  samples[2 * 9 + 5] = std::numeric_limits<float>::quiet_NaN();
  const HeightField field = HeightField::own(std::move(samples), 9, 9);
  PictureSettings settings = map_settings(field);
  settings.look = Look::level;
  settings.alpha = true;
  for (settings.level = 0; settings.level <= 1; ++settings.level) {
    const Image image = map_of(field, settings).image;
    int clear = 0;
    for (int row = 0; row < 8; ++row) {
      for (int col = 0; col < 8; ++col) {
        const int x = 10 * col + 4, y = 10 * row + 6, at = y * image.width + x;
        const bool hole = (col == 4 || col == 5) && (row == 1 || row == 2), covered = settings.level == 1 || !hole;
        EXPECT_EQ(image.alpha[static_cast<std::size_t>(at)], covered ? 255 : 0) << col << ", " << row;
        EXPECT_EQ(red(image, x, y) > 0, covered) << col << ", " << row;
        clear += !covered;
      }
    }
    EXPECT_EQ(clear, settings.level == 0 ? 4 : 0);
  }
}

// In perspective, the nearest of all boxes, each tested on its own.
TEST(LevelLook, ShowsBoxesInPerspective) {
  constexpr int kCols = 8, kRows = 6, kSide = 64;
  std::vector<float> samples;
  for (int i = 0; i < kCols * kRows; ++i) samples.push_back(static_cast<float>(i * 29 % 48) / 8);
  const HeightField field = HeightField::own(samples, kCols, kRows);
  const Scene scene = terrain_on_plinth(field);
  PictureSettings settings;
  settings.width = settings.height = kSide;
  settings.look = Look::level;
  for (const dvec3& eye : {dvec3(-6, -8, 9), dvec3(12, 9, 8), dvec3(4.3, 2.7, 30)}) {
    const Camera camera = Camera::look_at(eye, {3.6, 2.4, 2}, 45, kSide, kSide);
    for (settings.level = 0; settings.level <= 3; ++settings.level) {
      const Image image = render_picture(scene, camera, settings).image;
      const int side = 1 << settings.level;
      int sides = 0, tops = 0;
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
          const Ray ray = camera.ray(x + 0.5, y + 0.5);
          double nearest = std::numeric_limits<double>::infinity(), second = nearest, grey = 0;
          // Maxima are rounded up by less than two codes, of which the range has 65533.
          const double tie = 2 * 47.0 / 8 / 65533 / std::abs(ray.direction.z);
          bool top = false;
          for (int r0 = 0; r0 < kRows - 1; r0 += side) {
            for (int c0 = 0; c0 < kCols - 1; c0 += side) {
              const int r1 = std::min(r0 + side, kRows - 1), c1 = std::min(c0 + side, kCols - 1);
              double most = 0;
              for (int r = r0; r <= r1; ++r) {
                for (int c = c0; c <= c1; ++c)
                  most = std::max<double>(most, samples[static_cast<std::size_t>(r * kCols + c)]);
              }
              // The field's rows run south from its northern border. Boxes stand deep below the ground.
              const dvec3 low(c0, kRows - 1 - r1, -100), high(c1, kRows - 1 - r0, most);
              double in = 0, out = std::numeric_limits<double>::infinity();
              int axis = 0;
              double edge = std::numeric_limits<double>::infinity();  // how far the ray enters from an edge
              for (int k = 0; k < 3; ++k) {
                const double a = (low[k] - ray.origin[k]) / ray.direction[k],
                             b = (high[k] - ray.origin[k]) / ray.direction[k];
                edge = std::min(edge, std::abs(std::min(a, b) - in));
                if (std::min(a, b) > in) in = std::min(a, b), axis = k;
                out = std::min(out, std::max(a, b));
              }
              if (in > out || ray.at(in).z < plinth_base(field)) continue;
              if (in < nearest) {
                second = edge < tie ? in : nearest;
                nearest = in, top = axis == 2;
                grey = (1 + 254 * most / (47.0 / 8)) * (axis == 0 ? 0.7 : axis == 1 ? 0.5 : 1);
              } else {
                second = std::min(second, in);
              }
            }
          }
          if (second - nearest < tie) continue;  // on an edge
          (top ? tops : sides) += std::isfinite(nearest);
          // Half a level for each of two roundings, and a step of the pyramid's code.
          EXPECT_NEAR(red(image, x, y), std::isfinite(nearest) ? grey : 0, 1.01)
              << settings.level << ": " << x << ", " << y;
        }
      }
      EXPECT_GT(tops, 100) << settings.level << ": " << eye.x;
      EXPECT_GT(sides, eye.z > 20 ? -1 : 100) << settings.level << ": " << eye.x;
    }
  }
}

}  // namespace
}  // namespace scarp::test
