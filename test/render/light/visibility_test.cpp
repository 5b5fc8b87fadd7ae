// SPDX-License-Identifier: MIT
#include "scarp/render/light/visibility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/trigonometric.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "scarp/scene/scene.h"

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// cols x rows nodes 1 m apart; height(col, row).
template <class F>
Scene scene_of(int cols, int rows, F&& height) {
  std::vector<float> samples;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) samples.push_back(static_cast<float>(height(col, row)));
  }
  return Scene(scene_heights(HeightField::own(std::move(samples), cols, rows)));
}

// Straight below (x, y).
LightPoint point_at(const Scene& scene, double x, double y) {
  Ray down;
  down.origin = {x, y, scene.box().high.z + 1};
  const Hit hit = scene.closest_hit(down);
  EXPECT_TRUE(hit) << x << ", " << y;
  return light_point(scene.surface(down, hit), hit);
}

std::vector<std::uint8_t> blocked(const Scene& scene, const std::vector<Ray>& rays) {
  std::vector<std::uint8_t> answers(rays.size());
  scene.occluded(rays, answers);
  return answers;
}

double sky_occlusion(const Scene& scene, const LightPoint& point, double distance, const PatternRange& range) {
  std::vector<Ray> rays;
  ask_sky(point, distance, range, rays);
  return scarp::sky_occlusion(blocked(scene, rays));
}

double sun_cosine(const Scene& scene, const LightPoint& point, const dvec3& to_sun, double radius,
                  const PatternRange& range) {
  std::vector<Ray> rays;
  ask_sun(point, to_sun, radius, range, rays);
  return scarp::sun_cosine(point, radius, range.count, rays, blocked(scene, rays));
}

// The mean of `f(range)` over pixels, each with `count` samples.
template <class F>
double mean_of_pixels(int pixels, std::uint32_t count, F&& f) {
  const SamplePattern pattern(1, count);
  double sum = 0;
  for (int i = 0; i < pixels; ++i) sum += f(PatternRange{pattern.pixel(i, 5, 0), 0, count});
  return sum / pixels;
}

// Four standard errors of the mean of n values of 0 or 1; the gain from stratification is ignored.
double four_sigma(int pixels, int count) { return 4 * 0.5 / std::sqrt(double{1} * pixels * count); }

TEST(SkyOcclusion, IsZeroOnAPlane) {
  for (const auto& [east, south] : {std::pair(0.0, 0.0), {0.5, -0.25}, {-3.0, 2.0}, {40.0, 0.0}}) {
    const Scene scene = scene_of(33, 33, [&, e = east, s = south](int c, int r) { return e * c + s * r; });
    for (const double x : {0.0, 3.3, 16.0, 31.99}) {
      for (const double y : {0.1, 16.5, 32.0}) {
        const LightPoint point = point_at(scene, x, y);
        EXPECT_EQ(mean_of_pixels(
                      4, 64, [&](const PatternRange& range) { return sky_occlusion(scene, point, kInfinity, range); }),
                  0.0)
            << east << ", " << south << " at " << x << ", " << y;
      }
    }
  }
}

TEST(SkyOcclusion, MatchesTheHorizonAtTheFootOfAWall) {
  // A wall along the grid's north, its crest at x = 33, seen from level ground at the distance d. A horizon at the
  // angle a on one side hides (1 - cos a) / 2 of the cosine-weighted sky over level ground: half of it for a = 90
  // degrees.
  constexpr int kLength = 4000, kPixels = 64, kCount = 256;
  for (const auto& [height, d] : {std::pair(2000.0, 1.25), {2.0, 1.5}, {8.0, 5.0}, {8.0, 20.0}}) {
    const Scene scene = scene_of(35, kLength + 1, [h = height](int col, int) { return col >= 33 ? h : 0; });
    // The wall's base starts one cell before its crest.
    const LightPoint point = point_at(scene, 33 - d, kLength / 2);
    const double hidden = mean_of_pixels(
        kPixels, kCount, [&](const PatternRange& range) { return sky_occlusion(scene, point, kInfinity, range); });
    // Azimuths within atan(d / half its length) of the wall's line look past its ends.
    const double past_the_ends = std::atan(d / (kLength / 2)) / std::numbers::pi;
    EXPECT_NEAR(hidden, (1 - std::cos(std::atan(height / d))) / 2, four_sigma(kPixels, kCount) + past_the_ends)
        << height << " m at " << d;
  }
}

TEST(SkyOcclusion, EndsAtTheGivenDistance) {
  const Scene scene = scene_of(40, 41, [](int col, int) { return col >= 33 ? 50 : 0; });
  const LightPoint point = point_at(scene, 22, 20);
  const auto within = [&](double distance) {
    return mean_of_pixels(16, 64,
                          [&](const PatternRange& range) { return sky_occlusion(scene, point, distance, range); });
  };
  EXPECT_EQ(within(9.9), 0.0) << "the wall begins at 10 m";
  EXPECT_GT(within(20), 0.1);
  EXPECT_GT(within(kInfinity), within(20) + 0.05);
}

TEST(SkyOcclusion, IsZeroOnARidge) {
  // The shading normal at the ridge is upright, but the slope's normal is not: the visible sky is that over the slope.
  const Scene scene = scene_of(33, 33, [](int col, int) { return -2 * std::abs(col - 16); });
  const LightPoint point = point_at(scene, 16.125, 16.5);
  ASSERT_GT(length(point.normal - point.shading_normal), 0.5);
  EXPECT_EQ(
      mean_of_pixels(4, 256, [&](const PatternRange& range) { return sky_occlusion(scene, point, kInfinity, range); }),
      0.0);
}

// A cliff 64 m high whose edge is at x = 16, the sun in the west at 30 degrees.
class Cliff : public testing::Test {
 protected:
  double sun_at(double beyond_edge, double radius) const {
    const LightPoint point = point_at(scene_, kEdge + beyond_edge, 8);
    return mean_of_pixels(kPixels, kCount,
                          [&](const PatternRange& range) { return sun_cosine(scene_, point, to_sun_, radius, range); });
  }

  static constexpr int kEdge = 16, kPixels = 16, kCount = 64;
  const double height_ = 64, altitude_ = glm::radians(30.0);
  const dvec3 to_sun_{-std::cos(altitude_), 0, std::sin(altitude_)};
  const Scene scene_ = scene_of(200, 17, [h = height_](int col, int) { return col <= kEdge ? h : 0; });
};

TEST_F(Cliff, PenumbraMatchesTheSunDisc) {
  const double radius = glm::radians(0.533 / 2);
  // The edge is at the angle atan(height / distance). A disc that it covers up to the fraction s of its radius from the
  // middle shows 1/2 + (asin s + s sqrt(1 - s^2)) / pi: a formula for a flat disc, which is off by radius^2 for a cap.
  for (const double s : {-0.95, -0.6, -0.3, 0.0, 0.4, 0.7, 0.95}) {
    const double shown = 0.5 + (std::asin(s) + s * std::sqrt(1 - s * s)) / std::numbers::pi;
    const double distance = height_ / std::tan(altitude_ - s * radius);
    // Over the disc the cosine differs by its radius.
    EXPECT_NEAR(sun_at(distance, radius), shown * std::sin(altitude_), four_sigma(kPixels, kCount) + radius) << s;
  }
  // Beyond its two ends the sun is completely hidden or completely visible.
  EXPECT_EQ(sun_at(height_ / std::tan(altitude_ + 1.01 * radius), radius), 0.0);
  EXPECT_NEAR(sun_at(height_ / std::tan(altitude_ - 1.01 * radius), radius), std::sin(altitude_),
              radius * radius + 1e-5)
      << "the mean over a stratified disc is nearly its middle's";
}

TEST_F(Cliff, PointSunCastsAHardShadow) {
  const double end = height_ / std::tan(altitude_);
  EXPECT_EQ(sun_at(end * 0.999, 0), 0.0);
  EXPECT_DOUBLE_EQ(sun_at(end * 1.001, 0), std::sin(altitude_));
}

TEST_F(Cliff, SurfacesFacingAwayGetNoSun) {
  const LightPoint flank = point_at(scene_, kEdge + 0.5, 8);
  EXPECT_EQ(sun_cosine(scene_, flank, to_sun_, 0.005, {SamplePattern(0, 8).pixel(0, 0, 0), 0, 8}), 0.0);
}

}  // namespace
}  // namespace scarp
