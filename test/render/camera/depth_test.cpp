// SPDX-License-Identifier: MIT
#include "scarp/render/camera/depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/trigonometric.hpp>
#include <optional>
#include <random>

#include "scarp/base/error.h"
#include "scarp/render/camera/camera.h"

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Depth, MatchesProjectedPoints) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  const DepthRange range{2, 3000, false}, reversed{2, 3000, true};
  const glm::dmat4 opengl = glm::perspectiveRH_NO(glm::radians(60.0), 4.0 / 3, 2.0, 3000.0);
  const glm::dmat4 vulkan = glm::perspectiveRH_ZO(glm::radians(60.0), 4.0 / 3, 2.0, 3000.0);
  const glm::dmat4 turned = glm::perspectiveRH_ZO(glm::radians(60.0), 4.0 / 3, 3000.0, 2.0);
  for (int i = 0; i < 1000; ++i) {
    const double z = 2 * std::pow(1500, share(random));
    const glm::dvec4 p(z * (share(random) - 0.5), z * (share(random) - 0.5), -z, 1);
    const auto depth = [&](const glm::dmat4& projection) {
      const glm::dvec4 clip = projection * p;
      return clip.z / clip.w;
    };
    // Numbers below 1, from differences of numbers no larger than 3: a few units of 2^-52.
    EXPECT_NEAR(device_depth(z, range), (depth(opengl) + 1) / 2, 1e-14);
    EXPECT_NEAR(device_depth(z, range), depth(vulkan), 1e-14);
    EXPECT_NEAR(device_depth(z, reversed), depth(turned), 1e-14);
    EXPECT_NEAR(view_depth_from_device(device_depth(z, reversed), reversed), z, 1e-12 * z);
    // The result 1 - depth, at least 2 / 3000, has lost 11 of 53 binary digits.
    EXPECT_NEAR(view_depth_from_device(device_depth(z, range), range), z, 1e-11 * z);
  }
  EXPECT_EQ(device_depth(2, range), 0);
  EXPECT_DOUBLE_EQ(device_depth(3000, range), 1);
  EXPECT_EQ(device_depth(kInfinity, range), 1);
  EXPECT_EQ(device_depth(kInfinity, reversed), 0);
  const DepthRange open{0.5, kInfinity, true};
  EXPECT_DOUBLE_EQ(device_depth(8, open), 0.0625);
  EXPECT_DOUBLE_EQ(view_depth_from_device(0.0625, open), 8);
  EXPECT_DOUBLE_EQ(device_depth(8, {0.5, kInfinity, false}), 1 - 0.0625);
}

TEST(Depth, RadialDepthIsExactOnlyOnTheAxis) {
  const Camera camera = Camera::look_at({0, 0, 0}, {0, 1, 0}, 60, 400, 300);
  const auto longer = [&](double x, double y) {
    const Ray ray = camera.ray(x, y);
    return 100 / view_depth(ray.direction, 100, camera.forward());
  };
  EXPECT_DOUBLE_EQ(longer(200, 150), 1);
  EXPECT_NEAR(longer(0, 0), 1.388, 0.001);
}

// A sphere that sticks out of a tilted plane: a depth buffer must show which of the two is nearer along a ray.
TEST(Depth, OrdersAnIntersectingSpherePixelByPixel) {
  const Camera camera = Camera::look_at({0, -8, 6}, {0, 0, 0}, 60, 80, 60);
  const dvec3 middle(0.5, 0, -0.8), normal = normalize(dvec3(0.2, -0.1, 1));
  for (const bool reversed : {false, true}) {
    const DepthRange range{0.1, 100, reversed};
    int sphere = 0, plane = 0;
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 80; ++x) {
        const Ray ray = camera.ray(x + 0.5, y + 0.5);
        const double t_plane = -dot(ray.origin, normal) / dot(ray.direction, normal);
        const dvec3 to = ray.origin - middle;
        const double b = dot(to, ray.direction), q = b * b - dot(to, to) + 4;
        if (q < 0 || t_plane < 0) continue;
        const double t_sphere = -b - std::sqrt(q);
        const double a = device_depth(view_depth(ray.direction, t_sphere, camera.forward()), range),
                     c = device_depth(view_depth(ray.direction, t_plane, camera.forward()), range);
        EXPECT_EQ(reversed ? a > c : a < c, t_sphere < t_plane);
        ++(t_sphere < t_plane ? sphere : plane);
      }
    }
    EXPECT_GT(sphere, 100);
    EXPECT_GT(plane, 50);
  }
}

TEST(Depth, RejectsPlanesInTheWrongOrder) {
  EXPECT_THROW(validate(DepthRange{0, 10}), Error);
  EXPECT_THROW(validate(DepthRange{10, 10}), Error);
  EXPECT_THROW(validate(DepthRange{kInfinity, kInfinity}), Error);
  validate(DepthRange{1, kInfinity});
}

}  // namespace
}  // namespace scarp
