// SPDX-License-Identifier: MIT
#include "scarp/march/height/wall.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "scarp/march/height/max_mip.h"

namespace scarp {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// 5 x 5 nodes, 1 m apart, 10 m high, solid, with a hole in the middle: the cells around the node (2, 2) are missing.
class Walls : public testing::Test {
 protected:
  Walls() : field_(make()), pyramid_(field_) {}

  void expect(dvec3 origin, dvec3 direction, dvec3 normal) const {
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    const Hit hit = march_max_mip({&field_, &pyramid_}, ray);
    ASSERT_TRUE(hit);
    ASSERT_TRUE(hit.wall);
    EXPECT_EQ(wall_normal(ray, hit), normal);
    EXPECT_LT(dot(wall_normal(ray, hit), direction), 0) << "towards the ray's side";
  }

 private:
  static HeightField make() {
    HeightFieldSettings settings;
    settings.solid = true;
    std::vector<float> samples(25, 10);
    samples[12] = kNaN;
    return HeightField::own(std::move(samples), 5, 5, settings);
  }

  HeightField field_;
  MaxPyramid pyramid_;
};

TEST_F(Walls, AtTheBorderFaceOutwards) {
  expect({-3, 1.3, 5}, {1, 0, 0}, {-1, 0, 0});
  expect({9, 1.3, 5}, {-2, 0, 0}, {1, 0, 0});
  expect({1.3, -3, 5}, {0, 1, 0}, {0, -1, 0});
  expect({1.3, 9, 5}, {0, -1, 0}, {0, 1, 0});
  expect({-3, 0.5, 7}, {1, 0.1, -0.5}, {-1, 0, 0});
  expect({0.5, -3, 7}, {0.1, 1, -0.5}, {0, -1, 0});
}

TEST_F(Walls, AroundHolesFaceTheHole) {
  expect({2, 2.3, 5}, {1, 0, 0}, {-1, 0, 0});
  expect({2, 2.3, 5}, {-1, 0.2, 0}, {1, 0, 0});
  expect({1.7, 2, 5}, {0, 1, 0}, {0, -1, 0});
  expect({1.7, 2, 5}, {0.2, -1, -0.1}, {0, 1, 0});
}

}  // namespace
}  // namespace scarp
