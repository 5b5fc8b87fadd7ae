// SPDX-License-Identifier: MIT
#include "scarp/render/camera/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <limits>
#include <optional>

#include "scarp/base/error.h"
#include "scarp/render/camera/compass.h"

namespace scarp {
namespace {

const WorldBox kBox{{0, 0, 200}, {30000, 32000, 1900}};

void expect_round_trip(const Camera& camera, int width, int height) {
  for (const double x : {0.0, 0.3, 0.5, 0.99}) {
    for (const double y : {0.0, 0.21, 0.5, 1.0}) {
      const Ray ray = camera.ray(x * width, y * height);
      EXPECT_NEAR(length(ray.direction), 1, 1e-12);
      const auto pixel = camera.pixel(ray.at(12345));
      ASSERT_TRUE(pixel);
      EXPECT_NEAR(pixel->x, x * width, 1e-6);
      EXPECT_NEAR(pixel->y, y * height, 1e-6);
      const glm::dvec4 point(ray.at(12345), 1);
      const glm::dvec4 seen = camera.camera_from_world() * point, ndc = camera.ndc_from_world() * point;
      EXPECT_NEAR(seen.z, dot(ray.at(12345) - camera.eye(), camera.forward()), 1e-6);
      EXPECT_EQ(seen.w, 1);
      EXPECT_NEAR(ndc.x / ndc.w, 2 * x - 1, 1e-9);
      EXPECT_NEAR(ndc.y / ndc.w, 1 - 2 * y, 1e-9);
      EXPECT_NEAR(ndc.z / ndc.w, ndc.w == 1 ? seen.z : 1 - 1 / seen.z, 1e-6);
    }
  }
}

TEST(Camera, PointsOnAPixelsRayProjectToThatPixel) {
  expect_round_trip(Camera::look_at({100, -5000, 3000}, {15000, 15000, 0}, 40, 640, 480), 640, 480);
  expect_round_trip(Camera::framed(kBox, {.azimuth_deg = 77, .elevation_deg = 12}, 0.02, 1280, 720), 1280, 720);
  expect_round_trip(Camera::top(kBox, 500, 700), 500, 700);
}

TEST(Camera, TargetIsCentredAndUpIsUp) {
  const dvec3 target(1000, 2000, 300);
  const Camera camera = Camera::look_at({-4000, 500, 2500}, target, 35, 800, 600);
  const auto middle = camera.pixel(target), above = camera.pixel(target + dvec3(0, 0, 10));
  EXPECT_NEAR(middle->x, 400, 1e-6);
  EXPECT_NEAR(middle->y, 300, 1e-6);
  EXPECT_NEAR(above->x, 400, 1e-6);
  EXPECT_LT(above->y, 300);
}

TEST(Camera, AngleOfViewIsVertical) {
  const Camera camera = Camera::look_at({0, 0, 0}, {0, 1, 0}, 60, 300, 200);
  const auto edge = camera.pixel({0, 1, std::tan(glm::radians(30.0))});
  EXPECT_NEAR(edge->y, 0, 1e-9);
}

TEST(Camera, StraightDownHasNorthUp) {
  const Camera camera = Camera::look_at({0, 0, 100}, {0, 0, 0}, 60, 100, 100);
  EXPECT_LT(camera.pixel({0, 10, 0})->y, 50);
  EXPECT_GT(camera.pixel({10, 0, 0})->x, 50);
}

TEST(Camera, PointsBehindProjectNowhere) {
  const Camera camera = Camera::look_at({0, 0, 0}, {0, 1, 0}, 60, 100, 100);
  EXPECT_FALSE(camera.pixel({0, -1, 0}));
  EXPECT_FALSE(camera.pixel({3, 0, 2}));
}

TEST(Camera, FramingFitsAllCornersTightly) {
  const WorldBox boxes[] = {kBox, {{0, 0, 0}, {1, 1, 0}}, {{0, 0, -9000}, {10, 5000, 9000}}, {{0, 0, 5}, {4000, 3, 6}}};
  for (const WorldBox& box : boxes) {
    for (const auto& [width, height] : {std::pair(1280, 720), {720, 1280}, {500, 500}, {3000, 200}}) {
      for (const double azimuth : {0.0, 45.0, 190.0, 271.0}) {
        for (const double elevation : {0.0, 10.0, 35.0, 89.0, 90.0}) {
          const Camera camera =
              Camera::framed(box, {.azimuth_deg = azimuth, .elevation_deg = elevation}, 0.1, width, height);
          double left = 1, right = 1, above = 1, below = 1;  // free fractions of the picture
          double nearest = std::numeric_limits<double>::infinity();
          for (int i = 0; i < 8; ++i) {
            const auto pixel = camera.pixel(box.corner(i));
            ASSERT_TRUE(pixel) << azimuth << ", " << elevation;
            nearest = std::min(nearest, dot(box.corner(i) - camera.eye(), camera.forward()));
            left = std::min(left, pixel->x / width);
            right = std::min(right, 1 - pixel->x / width);
            above = std::min(above, pixel->y / height);
            below = std::min(below, 1 - pixel->y / height);
          }
          // The margin is at least 3 %; in one direction it is exactly that on both sides.
          constexpr double kMargin = 0.03, kRounding = 1e-6;
          EXPECT_GE(std::min({left, right, above, below}), kMargin - kRounding);
          // Unless the camera would be too close: never within 5 % of the diagonal.
          const double least_distance = 0.05 * length(box.high - box.low);
          EXPECT_GE(nearest, least_distance * (1 - kRounding));
          if (nearest < least_distance * (1 + kRounding)) continue;
          EXPECT_LE(std::min(std::max(left, right), std::max(above, below)), kMargin + kRounding)
              << width << " x " << height << " from " << azimuth << ", " << elevation;
        }
      }
    }
  }
}

TEST(Camera, IsAtTheAzimuthOfTheView) {
  // Grid north is at a compass azimuth of 10 degrees.
  const double grid_north = glm::radians(10.0);
  const Camera camera = Camera::framed(kBox, {.azimuth_deg = 100, .elevation_deg = 0}, grid_north, 400, 400);
  EXPECT_NEAR(camera.forward().x, -1, 1e-12) << "a view from the grid's east looks west";
  EXPECT_NEAR(camera.forward().y, 0, 1e-12);
  const Camera south = Camera::framed(kBox, {.azimuth_deg = 190, .elevation_deg = 35}, grid_north, 400, 400);
  EXPECT_NEAR(south.forward().y, std::cos(glm::radians(35.0)), 1e-12);
  EXPECT_NEAR(south.forward().z, -std::sin(glm::radians(35.0)), 1e-12);
}

TEST(Camera, DistanceIsRelativeToTheFramedView) {
  const ViewSettings near{.distance = 1}, far{.distance = 3};
  const dvec3 a = Camera::framed(kBox, near, 0, 400, 400).eye(), b = Camera::framed(kBox, far, 0, 400, 400).eye();
  const dvec3 forward = Camera::framed(kBox, near, 0, 400, 400).forward();
  // Both eyes are on one axis; along it, distances are measured from the point beside the box's middle.
  EXPECT_NEAR(length(cross(b - a, forward)), 0, 1e-6);
  EXPECT_NEAR(dot(kBox.middle() - b, forward) / dot(kBox.middle() - a, forward), 3, 1e-9);
}

// The focus stays at its position in the picture, and the eye approaches it.
TEST(Camera, NearerViewsApproachTheirFocus) {
  // Rounding of metres and pixels: some dozen roundings of coordinates below 2^17 m are 2^-53 * 2^17 * 2^6 or less than
  // 2^-30.
  constexpr double kRounding = 0x1p-30;
  const dvec3 other(12000, 20000, 1200);
  for (const std::optional<dvec3>& given : {std::optional<dvec3>(), std::optional(other)}) {
    const dvec3 focus = given.value_or(kBox.middle());
    const auto framed = [&](double distance) {
      return Camera::framed(kBox, {.elevation_deg = 10, .distance = distance}, 0.1, 640, 360, given);
    };
    const Camera whole = framed(1);
    EXPECT_EQ(whole.eye(), Camera::framed(kBox, {.elevation_deg = 10}, 0.1, 640, 360).eye()) << "is the whole box";
    for (const double distance : {0.9, 0.3, 0.01}) {
      const Camera near = framed(distance);
      EXPECT_EQ(near.forward(), whole.forward());
      EXPECT_NEAR(length(near.eye() - focus), distance * length(whole.eye() - focus), kRounding);
      EXPECT_NEAR(near.pixel(focus)->x, whole.pixel(focus)->x, kRounding);
      EXPECT_NEAR(near.pixel(focus)->y, whole.pixel(focus)->y, kRounding);
    }
  }
}

TEST(Camera, TopMapsNodesToPixels) {
  // 11 x 6 nodes 30 m apart on 200 x 100 pixels: 20 pixels per cell.
  const Camera camera = Camera::top({{0, 0, -50}, {300, 150, 90}}, 200, 100);
  for (int col = 0; col <= 10; ++col) {
    for (int row = 0; row <= 5; ++row) {
      const auto pixel = camera.pixel({30.0 * col, 150 - 30.0 * row, 17});
      EXPECT_NEAR(pixel->x, 20 * col, 1e-9);
      EXPECT_NEAR(pixel->y, 20 * row, 1e-9);
    }
  }
}

TEST(Camera, TopKeepsPixelsSquare) {
  const Camera camera = Camera::top({{0, 0, 0}, {300, 150, 0}}, 100, 100);
  const dvec2 origin = *camera.pixel({0, 0, 0}), corner = *camera.pixel({300, 150, 0});
  EXPECT_NEAR(corner.x - origin.x, 100, 1e-9);
  EXPECT_NEAR(origin.y - corner.y, 50, 1e-9);
  EXPECT_NEAR(origin.y + corner.y, 100, 1e-9) << "centred";
}

TEST(Camera, RejectsSettingsOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ViewSettings& bad : {ViewSettings{.azimuth_deg = nan},
                                  {.elevation_deg = 91},
                                  {.elevation_deg = nan},
                                  {.distance = 0},
                                  {.distance = nan},
                                  {.fov_deg = 0},
                                  {.fov_deg = 180},
                                  {.fov_deg = nan}}) {
    EXPECT_THROW(Camera::framed(kBox, bad, 0, 100, 100), Error);
  }
  EXPECT_THROW(Camera::look_at({1, 2, 3}, {1, 2, 3}, 30, 100, 100), Error);
  EXPECT_THROW(Camera::look_at({1, nan, 3}, {1, 2, 3}, 30, 100, 100), Error);
  EXPECT_THROW(Camera::look_at({1, 2, 4}, {1, 2, 3}, 0, 100, 100), Error);
}

TEST(Compass, AzimuthsAreClockwiseFromTrueNorth) {
  const auto near = [](const dvec3& a, const dvec3& b) { return length(a - b) < 1e-12; };
  const double quarter = glm::radians(90.0), turn = glm::radians(10.0);
  EXPECT_TRUE(near(towards(0, 0, 0), {0, 1, 0}));
  EXPECT_TRUE(near(towards(quarter, 0, 0), {1, 0, 0}));
  EXPECT_TRUE(near(towards(1, quarter, 0), {0, 0, 1}));
  EXPECT_TRUE(near(towards(turn, 0, turn), {0, 1, 0})) << "the grid's north lies where the compass says it does";
}

}  // namespace
}  // namespace scarp
