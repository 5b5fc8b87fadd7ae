// SPDX-License-Identifier: MIT
// Cases from the tests of the physics engine Jolt for its HeightFieldShape: planes, a plane near 0, random ground with
// holes, ground consisting of holes only, edits of parts, materials. Rays through every node and the centre of every
// cell must find the surface where there is ground, and nothing elsewhere.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "scarp/scarp.h"
#include "scarp/scene/scene_query.h"

namespace scarp::test {
namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

class HeightFieldShape : public testing::TestWithParam<Surface> {
 protected:
  HeightFieldSettings settings(double cell) const {
    return {.cell_x = cell, .cell_y = cell, .offset = 3, .surface = GetParam()};
  }
  float random(double low, double high) {
    return static_cast<float>(std::uniform_real_distribution<double>(low, high)(engine_));
  }
  std::vector<float> random_heights(int side, double hole_share) {
    std::vector<float> samples;
    for (int i = 0; i < side * side; ++i) samples.push_back(random(0, 1) < hole_share ? kHole : random(-5, 5));
    return samples;
  }

  // All queries at one position.
  void check_place(const Terrain& terrain, const Scene& judge, double x, double y) {
    const auto height = terrain.height(x, y);
    const Ray down{{x, y, 1000}, {0, 0, -1}}, up{{x, y, -1000}, {0, 0, 1}};
    const Ray slanted{{x + 0.7, y - 0.4, 1000}, {-0.7, 0.4, 3.0 - 1000}};
    const Hit hit = cast(terrain, down);
    ASSERT_EQ(hit.status == HitStatus::hit, height.has_value()) << x << ", " << y;
    ASSERT_EQ(occluded(terrain, down), height.has_value());
    const Scene& scene = terrain.scene();
    ASSERT_EQ(scene.query({.sides = Sides::both}).closest_hit(up).status == HitStatus::hit, height.has_value());
    ASSERT_FALSE(occluded(terrain, up));
    ASSERT_EQ(judge.closest_hit(slanted).status == HitStatus::hit, occluded(terrain, slanted));
    if (!height) return;
    ASSERT_NEAR(1000 - hit.t, *height, 1e-9);
    // The ground supports objects: a falling ball does not sink below its radius above the position.
    const auto contact = scene.query({}).sweep({{x, y, 100}, {x, y, 100}, 0.25}, {0, 0, -200});
    ASSERT_TRUE(contact);
    ASSERT_GE(100 - 200 * contact->t, *height + 0.25 - 1e-5);
  }
  void check(const Terrain& terrain) {
    const HeightField& field = terrain.field();
    const Scene judge = terrain.scene().judge();
    for (int row = 0; row < field.rows(); ++row) {
      for (int col = 0; col < field.cols(); ++col) {
        const dvec3 node = field.world_from_grid(col, row, 0), middle = field.world_from_grid(col + 0.5, row - 0.5, 0);
        check_place(terrain, judge, node.x, node.y);
        check_place(terrain, judge, middle.x, middle.y);
        if (HasFatalFailure()) return;
      }
    }
  }

 private:
  std::mt19937_64 engine_{4};
};

TEST_P(HeightFieldShape, MatchesAPlane) { check(Terrain::own(std::vector<float>(32 * 32, 7), 32, 32, settings(0.1))); }

TEST_P(HeightFieldShape, MatchesAPlaneNearZero) {
  HeightFieldSettings near_zero = settings(2);
  near_zero.offset = 0;
  std::vector<float> samples;
  for (int i = 0; i < 32 * 32; ++i) samples.push_back(random(-1e-6, 1e-6));
  check(Terrain::own(std::move(samples), 32, 32, near_zero));
}

TEST_P(HeightFieldShape, MatchesRandomGroundWithHoles) {
  for (const int side : {2, 5, 16, 33}) check(Terrain::own(random_heights(side, 0.1), side, side, settings(0.75)));
}

TEST_P(HeightFieldShape, MatchesASingleHole) {
  const Terrain terrain = Terrain::own(std::vector<float>(16 * 16, kHole), 16, 16, settings(1));
  check(terrain);
  EXPECT_FALSE(terrain.scene().query({}).closest_point({0, 0, 0}));
  EXPECT_FALSE(terrain.scene().query({}).overlaps({{8, 8, 0}, {100, 100, 100}}));
}

TEST_P(HeightFieldShape, MatchesAfterPartialEdits) {
  constexpr int kSide = 33;
  std::vector<float> samples = random_heights(kSide, 0.1);
  Terrain terrain = Terrain::own(samples, kSide, kSide, settings(0.5));
  for (int i = 0; i < 10; ++i) {
    const SampleRect rect{3 * i % 20, 5 * i % 17, 1 + i, 12 - i};
    std::vector<float> part = random_heights(16, 0.3);
    part.resize(static_cast<std::size_t>(rect.cols * rect.rows));
    terrain.set_samples(rect, part.data());
    for (int row = 0; row < rect.rows; ++row) {
      for (int col = 0; col < rect.cols; ++col)
        samples[static_cast<std::size_t>((rect.row + row) * kSide + rect.col + col)] =
            part[static_cast<std::size_t>(row * rect.cols + col)];
    }
  }
  check(terrain);
  // The same as after a rebuild.
  const Terrain anew = Terrain::own(std::move(samples), kSide, kSide, settings(0.5));
  for (int i = 0; i < 1000; ++i) {
    const Ray ray{{random(0, 16), random(0, 16), 12}, {random(-1, 1), random(-1, 1), -0.5}};
    ASSERT_EQ(cast(terrain, ray), cast(anew, ray));
  }
}

TEST_P(HeightFieldShape, HasAMaterialPerCell) {
  constexpr int kSide = 17;
  Terrain terrain = Terrain::own(random_heights(kSide, 0), kSide, kSide, settings(1));
  std::vector<std::uint8_t> materials;
  for (int i = 0; i < (kSide - 1) * (kSide - 1); ++i) materials.push_back(static_cast<std::uint8_t>(7 * i));
  terrain.set_materials(materials);
  for (int row = 0; row < kSide - 1; ++row) {
    for (int col = 0; col < kSide - 1; ++col) {
      const Ray ray{{col + 0.3, kSide - 1.6 - row, 100}, {0, 0, -1}};
      ASSERT_EQ(terrain.scene().material(ray, cast(terrain, ray)),
                materials[static_cast<std::size_t>(row * (kSide - 1) + col)]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, HeightFieldShape, testing::Values(Surface::bilinear, Surface::triangles),
                         [](const auto& param) { return param.param == Surface::bilinear ? "bilinear" : "triangles"; });

}  // namespace
}  // namespace scarp::test
