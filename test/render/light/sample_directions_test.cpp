// SPDX-License-Identifier: MIT
#include "scarp/render/light/sample_directions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scarp {
namespace {

// A mean over the middles of side x side squares is off by about 1 / side if the integrand has an edge.
constexpr int kSide = 400;

template <class F>
double mean_over_square(F&& f) {
  double sum = 0;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) sum += f(dvec2((i + 0.5) / kSide, (j + 0.5) / kSide));
  }
  return sum / (double{kSide} * kSide);
}

TEST(SampleDirections, DiscIsUniform) {
  for (const double radius : {0.25, 0.5, 0.9}) {
    const double share = mean_over_square([&](dvec2 s) { return length(on_disc(s)) < radius ? 1.0 : 0.0; });
    EXPECT_NEAR(share, radius * radius, 1.0 / kSide) << radius;
  }
  // Each quarter between the diagonals, and each half of a quarter, has its fraction of the samples.
  for (int part = 0; part < 8; ++part) {
    const double share = mean_over_square([&](dvec2 s) {
      const dvec2 p = on_disc(s);
      const double turn = (std::atan2(p.y, p.x) / std::numbers::pi + 1) / 2;
      return std::floor(turn * 8) == part ? 1.0 : 0.0;
    });
    EXPECT_NEAR(share, 1.0 / 8, 1.0 / kSide) << part;
  }
  EXPECT_EQ(on_disc({0.5, 0.5}), dvec2(0, 0));
}

TEST(SampleDirections, FrameIsOrthonormalAndRightHanded) {
  for (const dvec3& towards : {dvec3(0, 0, 1), dvec3(0, 0, -1), dvec3(1, 0, 0), dvec3(0, -1, 0), dvec3(1, 2, 3),
                               dvec3(1e-9, -1e-8, -1), dvec3(-3, 1, -1e-12)}) {
    const Frame frame(normalize(towards));
    // Some ten roundings of numbers up to 1.
    constexpr double kRounding = 1e-15;
    EXPECT_NEAR(dot(frame.side, frame.axis), 0, kRounding);
    EXPECT_NEAR(dot(frame.other, frame.axis), 0, kRounding);
    EXPECT_NEAR(dot(frame.side, frame.other), 0, kRounding);
    EXPECT_NEAR(length(frame.side), 1, kRounding);
    EXPECT_NEAR(length(cross(frame.side, frame.other) - frame.axis), 0, kRounding);
    EXPECT_EQ(frame.to_world({0, 0, 1}), frame.axis);
  }
}

TEST(SampleDirections, HemisphereIsCosineWeighted) {
  // The fraction 1 - c^2 is below the angle z > c from the horizon.
  for (const double c : {0.1, 0.5, 0.9}) {
    const double share = mean_over_square([&](dvec2 s) { return cosine_weighted(s).z > c ? 1.0 : 0.0; });
    EXPECT_NEAR(share, 1 - c * c, 1.0 / kSide) << c;
  }
  mean_over_square([](dvec2 s) {
    EXPECT_NEAR(length(cosine_weighted(s)), 1, 1e-15);
    return 0.0;
  });
}

TEST(SampleDirections, CapIsUniformInSolidAngle) {
  for (const double radius : {0.00465, 0.3, std::numbers::pi / 2}) {
    for (const double part : {0.3, 0.7}) {
      const double share = mean_over_square([&](dvec2 s) {
        return std::atan2(std::hypot(in_cap(s, radius).x, in_cap(s, radius).y), in_cap(s, radius).z) < part * radius
                   ? 1.0
                   : 0.0;
      });
      const double expected = std::pow(std::sin(part * radius / 2) / std::sin(radius / 2), 2);
      EXPECT_NEAR(share, expected, 1.0 / kSide) << radius << ", " << part;
    }
  }
  // The corner of the square is on the rim.
  const dvec3 rim = in_cap({0, 0.5}, 0.3);
  EXPECT_NEAR(rim.z, std::cos(0.3), 1e-15);
  EXPECT_NEAR(length(rim), 1, 1e-15);
}

}  // namespace
}  // namespace scarp
