// SPDX-License-Identifier: MIT
// max-mip with known answers: touches, leaks, starts, ends; and the symmetries that any march must have.
#include "scarp/march/height/max_mip.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "march/height/spiteful.h"
#include "scarp/march/height/exhaustive.h"

namespace scarp::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct Terrain {
  HeightField field;
  MaxPyramid pyramid{field};

  Hit cast(const Ray& ray, MarchStats* stats = nullptr) const {
    return march_max_mip({&field, &pyramid}, ray, {}, stats);
  }
  Hit cast(dvec3 origin, dvec3 direction, double t_min = 0, double t_max = HUGE_VAL) const {
    return cast(Ray{origin, direction, t_min, t_max});
  }
};

Terrain flat(float height = 2) { return {HeightField::own(std::vector<float>(64, height), 8, 8)}; }

// Hills and valleys on 257 x 193 samples.
Terrain hills() {
  std::vector<float> samples;
  for (int row = 0; row < 193; ++row) {
    for (int col = 0; col < 257; ++col) {
      samples.push_back(
          static_cast<float>(12 * std::sin(0.11 * col) * std::cos(0.07 * row) + 3 * std::sin(0.9 * col + 0.4 * row)));
    }
  }
  return {HeightField::own(samples, 257, 193)};
}

TEST(MaxMip, HitsAPlane) {
  const Hit hit = flat().cast({1.25, 3.5, 10}, {0.5, 0.25, -2});
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit.t, 4);
  EXPECT_DOUBLE_EQ(hit.height, 2);
  EXPECT_EQ(hit.cell, (Cell{3, 2}));
  EXPECT_DOUBLE_EQ(hit.u, 0.25);
  EXPECT_DOUBLE_EQ(hit.v, 0.5);
}

TEST(MaxMip, MeasuresTInLengthsOfTheDirection) {
  EXPECT_DOUBLE_EQ(flat().cast({1, 1, 10}, {0, 1, -16}).t, 0.5);
  EXPECT_DOUBLE_EQ(flat().cast({1, 1, 10}, {0, 0x1p-900, -0x1p-896}).t, 0x1p899);
  EXPECT_DOUBLE_EQ(flat().cast({1, 1, 10}, {0, 0x1p900, -0x1p904}).t, 0x1p-901);
}

TEST(MaxMip, HitsEveryNodeFromAnyDirectionAbove) {
  // Rays aimed at nodes pass between the triangles in engines that test triangles one by one. Here each ray must hit,
  // at the node.
  const Terrain terrain = hills();
  Random random(3);
  for (int i = 0; i < 20'000; ++i) {
    const int col = whole(random, 1, 255), row = whole(random, 1, 191);
    const float z = terrain.field.visit([&](const auto& grid) { return static_cast<float>(grid.at(col, row)); });
    const dvec3 node = terrain.field.world_from_grid(col, row, z);
    const dvec3 offset{whole(random, -6, 6), whole(random, -6, 6), 60};
    const Hit hit = terrain.cast(node + offset, -offset, 0, 1.25);
    ASSERT_TRUE(hit) << col << ", " << row;
    // Clearances are off by 16 u times their inputs (numerics.md), and the ray approaches by at least 20 m per t.
    EXPECT_NEAR(hit.t, 1, 16 * 0x1p-53 * (2 * 75 + 2 * (257 + 193) * 30) / 20);
  }
}

TEST(MaxMip, ReportsATouchOfACrestAsAHit) {
  // A ridge along column 3; the ray is level with it and crosses it.
  std::vector<float> samples(64, 0);
  for (int row = 0; row < 8; ++row) samples[static_cast<std::size_t>(8 * row + 3)] = 5;
  const Terrain ridge{HeightField::own(samples, 8, 8)};
  for (const double from : {-1.0, 9.0}) {
    const Hit hit = ridge.cast({from, 2.5, 5}, {3 - from, 0, 0});
    ASSERT_TRUE(hit);
    EXPECT_DOUBLE_EQ(hit.t, 1);
  }
  EXPECT_EQ(ridge.cast({-1, 2.5, 5.000001}, {1, 0, 0}).status, HitStatus::miss);
}

TEST(MaxMip, FindsADipInsideASaddleCell) {
  // Heights 0 and 4 at diagonally opposite corners: along the high diagonal the surface is a valley of height 4 - 8 u
  // (1 - u), lowest 2; along the low diagonal a hill up to 2. A ray over the hill at 1.5 is above at both ends of the
  // cell and below in between.
  const Terrain saddle{HeightField::own<float>({4, 0, 0, 4}, 2, 2)};
  const Hit hit = saddle.cast({0, 0, 1.5}, {1, 1, 0});
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit.t, 0.25);
  EXPECT_DOUBLE_EQ(saddle.cast({0, 0, 2}, {1, 1, 0}).t, 0.5);
  EXPECT_FALSE(saddle.cast({0, 0, 2.0000001}, {1, 1, 0}));
  const HeightTarget target{&saddle.field, &saddle.pyramid};
  EXPECT_FALSE(march_max_mip_bisect(target, {{0, 0, 1.5}, {1, 1, 0}})) << "the paper's search looks at the ends alone";
}

TEST(MaxMip, IgnoresTheSurfaceFromBelow) {
  EXPECT_EQ(flat().cast({2, 2, -5}, {0.1, 0, 1}).status, HitStatus::below);
  EXPECT_EQ(flat().cast({2, 2, -5}, {0, 0, 1}).status, HitStatus::below);
}

TEST(MaxMip, HitsAfterEmergingFromTheGround) {
  // Out of a hill, over a valley, into the next hill.
  const Terrain terrain{HeightField::own<float>({5, 0, 0, 5, 5, 0, 0, 5}, 4, 2)};
  const Hit hit = terrain.cast({0, 0.5, 2.5}, {1, 0, 0});
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit.t, 2.5);
}

TEST(MaxMip, MissesOutsideTheRayRange) {
  EXPECT_EQ(flat().cast({1, 1, 10}, {0, 1, -4}, 0, 1.999).status, HitStatus::miss);
  EXPECT_TRUE(flat().cast({1, 1, 10}, {0, 1, -4}, 0, 2)) << "the range is closed";
  EXPECT_TRUE(flat().cast({1, 1, 10}, {0, 1, -4}, 2, 3)) << "the range is closed";
  EXPECT_EQ(flat().cast({1, 1, 10}, {0, 1, -4}, 2.001, 3).status, HitStatus::below);
  EXPECT_TRUE(flat().cast({1, 1, -2}, {0, -1, -2}, -4, 0)) << "t may be negative";
}

TEST(MaxMip, MatchesTheOracleForExtremeDirections) {
  const Terrain terrain = hills();
  const HeightTarget target{&terrain.field, &terrain.pyramid};
  Ray ray{{20.3, 30.7, 40}, {0.75, 0.5, -0.25}};
  const Hit usual = march_exhaustive(target, ray);
  ASSERT_TRUE(usual);
  for (const int exponent : {-900, -600, 600, 1000}) {
    for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = std::ldexp(dvec3(0.75, 0.5, -0.25)[axis], exponent);
    const Hit oracle = march_exhaustive(target, ray), walked = march_max_mip(target, ray);
    EXPECT_EQ(oracle.t, std::ldexp(usual.t, -exponent));
    EXPECT_EQ(walked.cell, oracle.cell);
    EXPECT_DOUBLE_EQ(walked.t, oracle.t);
  }
}

TEST(MaxMip, HitsTheBorderFromAboveForAnyCellSize) {
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    HeightFieldSettings settings;
    settings.cell_x = std::uniform_real_distribution(0.1, 100.0)(random);
    settings.cell_y = std::uniform_real_distribution(0.1, 100.0)(random);
    const int cols = 2 + static_cast<int>(random() % 40), rows = 2 + static_cast<int>(random() % 40);
    const HeightField field =
        HeightField::own(std::vector<float>(static_cast<std::size_t>(cols) * rows, 5.0f), cols, rows, settings);
    const MaxPyramid pyramid(field);
    for (const dvec3& corner : {field.world_from_grid(cols - 1, 0, 9), field.world_from_grid(cols - 1, rows - 1, 9),
                                field.world_from_grid(0, 0, 9)}) {
      Ray down;
      down.origin = corner;
      down.direction = {0, 0, -1};
      ASSERT_TRUE(march_max_mip({&field, &pyramid}, down)) << cols << " x " << rows << " cells of " << settings.cell_x;
      ASSERT_EQ(field.height(corner.x, corner.y), 5.0);
    }
  }
}

TEST(MaxMip, StopsAtTheBorder) {
  // 6 x 6 cells under blocks of 8: a ray that has left at the border runs on inside the block.
  std::vector<float> samples(49, 0);
  for (int row = 0; row < 7; ++row) samples[static_cast<std::size_t>(7 * row + 5)] = 100;
  const Terrain terrain{HeightField::own(samples, 7, 7)};
  EXPECT_EQ(terrain.cast({1, 0, 50}, {1, -0.1, 0}).status, HitStatus::miss);
  EXPECT_EQ(terrain.cast({0, 5.9, 50}, {0.1, 1, 0}).status, HitStatus::miss);
}

TEST(MaxMip, PassesThroughHoles) {
  const Terrain terrain{HeightField::own<float>({0, 0, kNaN, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 6, 2)};
  EXPECT_EQ(terrain.cast({2, 0.5, 1}, {0, 0, -1}).status, HitStatus::miss);
  EXPECT_EQ(terrain.cast({1.5, 0.5, 1}, {0, 0, -1}).status, HitStatus::miss);
  EXPECT_TRUE(terrain.cast({0.5, 0.5, 1}, {0, 0, -1}));
  const Hit behind = terrain.cast({-1, 0.5, 3}, {1.5, 0, -1});
  ASSERT_TRUE(behind);
  EXPECT_DOUBLE_EQ(behind.t, 3);
  EXPECT_FALSE(terrain.cast({1.25, 0.5, 1}, {1, 0, -2})) << "goes under the sheet through the hole";
}

TEST(MaxMip, DoesNotHitThePlaneARayStartsOn) {
  // Any direction within a tilted plane, from any of its points: rounding must not look like ground.
  std::vector<float> samples;
  for (int row = 0; row < 40; ++row) {
    for (int col = 0; col < 40; ++col) samples.push_back(static_cast<float>(0.5 * col + 0.25 * row));
  }
  const Terrain plane{HeightField::own(samples, 40, 40, {.cell_x = 7.3, .cell_y = 5.1, .scale = 0.3, .offset = 1e4})};
  Random random(4);
  for (int i = 0; i < 20'000; ++i) {
    const double x = uniform(random, 0.1, 0.9) * plane.field.width(),
                 y = uniform(random, 0.1, 0.9) * plane.field.depth();
    const auto place = plane.field.place(x, y).value();
    const dvec2 slope = plane.field.gradient(place.cell, place.u, place.v);
    const double azimuth = uniform(random, 0, 6.3);
    Ray ray{{x, y, plane.field.height(x, y).value()}, {std::cos(azimuth), std::sin(azimuth), 0}};
    ray.direction.z = slope.x * ray.direction.x + slope.y * ray.direction.y;
    ray.start = RayStart::on_surface;
    ray.start_cell = place.cell;
    EXPECT_EQ(plane.cast(ray).status, HitStatus::miss);
    ray.direction.z += 1e-6;
    EXPECT_EQ(plane.cast(ray).status, HitStatus::miss);
    ray.direction.z -= 2e-6;
    EXPECT_EQ(plane.cast(ray).status, HitStatus::hit);
    EXPECT_EQ(plane.cast(ray).t, 0);
  }
}

TEST(MaxMip, LocatesDescentFromAGridLineAccurately) {
  // The ray starts on a line between cells, has already left this line by rounding, and falls by 10^-9 per metre: a
  // height 10^-11 ahead of the clamped position would make the hit millimetres late. Found in the run of 10^9 rays.
  std::vector<float> samples;
  for (int row = 0; row < 48; ++row) {
    for (int col = 0; col < 64; ++col)
      samples.push_back(0.5f * static_cast<float>(col) + 0.25f * static_cast<float>(row));
  }
  HeightFieldSettings settings;
  settings.cell_x = 7.3, settings.cell_y = 5.1, settings.scale = 0.3;
  const Terrain plane{HeightField::own(samples, 64, 48, settings)};
  struct Start {
    Cell cell;
    dvec3 origin, direction;
  };
  for (const Start& start : {Start{{48, 42},
                                   {0x1.5e66666666666p+8, 0x1.4666666666666p+4, 0x1.4d99999999999p+3},
                                   {-0x1.adade719fed0bp-15, 0x1.fffffff4bb3ecp-1, -0x1.00f55b0930d3cp-6}},
                             Start{{44, 4},
                                   {0x1.4133333333333p+8, 0x1.ac66666666666p+7, 0x1.be66666666666p+2},
                                   {-0x1.2beef3523bd7ep-13, 0x1.ffffffa825fd2p-1, -0x1.e1fa8a7c9f455p-7}},
                             Start{{29, 23},
                                   {0x1.a766666666666p+7, 0x1.d533333333333p+6, 0x1.8999999999999p+2},
                                   {-0x1.b012b480ae73dp-16, 0x1.fffffffd26c0ep-1, -0x1.e1e6534882017p-7}}}) {
    Ray ray{start.origin, start.direction, 0, 102};
    ray.start = RayStart::on_surface;
    ray.start_cell = start.cell;
    const Hit hit = plane.cast(ray);
    ASSERT_TRUE(hit);
    // The root of a line that falls by 3 * 10^-9 sample units per t, its constant off by some roundings of 23.
    EXPECT_LT(hit.t, 8 * 0x1p-53 * 32 / 3e-9);
  }
}

TEST(MaxMip, HitsTheSecondRootOfTheStartCell) {
  // Along the low diagonal of the saddle f = 8 u (1 - u) - ...: a level ray from the flank leaves the ground where it
  // descends and meets it again in the same cell.
  const Terrain saddle{HeightField::own<float>({0, 4, 4, 0}, 2, 2)};
  Ray ray{{0.25, 0.25, saddle.field.height(0.25, 0.25).value()}, {1, 1, 0}};
  ray.start = RayStart::on_surface;
  ray.start_cell = {0, 0};
  const Hit hit = saddle.cast(ray);
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit.t, 0.5);
}

TEST(MaxMip, MissesAFieldWithoutCellsOrData) {
  EXPECT_EQ((Terrain{HeightField::own<float>({1, 2, 3}, 3, 1)}).cast({1, 0, 9}, {0, 0, -1}).status, HitStatus::miss);
  EXPECT_EQ((Terrain{HeightField::own<float>({kNaN, kNaN, kNaN, kNaN}, 2, 2)}).cast({0.5, 0.5, 9}, {0, 0, -1}).status,
            HitStatus::miss);
  EXPECT_EQ(flat().cast({1, 1, 9}, {0, 0, 0}).status, HitStatus::miss);
  EXPECT_EQ(flat().cast({1, 1, 9}, {std::nan(""), 0, -1}).status, HitStatus::miss);
  EXPECT_EQ(flat().cast({std::nan(""), 1, 9}, {0.1, 0, -1}).status, HitStatus::miss);
}

TEST(MaxMip, TakesFewStepsOverOpenGround) {
  const Terrain terrain = flat();
  MarchStats stats;
  terrain.cast(Ray{{-5, 3.3, 3}, {1, 0.01, 0}}, &stats);
  EXPECT_LE(stats.steps, 2u);
  EXPECT_EQ(stats.cell_tests, 0u);
}

Ray any_ray(const HeightField& field) {
  Random random(static_cast<std::uint64_t>(*rc::gen::inRange(0, 1 << 30)));
  const auto point = [&] {
    return dvec3(uniform(random, -0.2, 1.2) * field.width(), uniform(random, -0.2, 1.2) * field.depth(),
                 uniform(random, -10, 30));
  };
  const dvec3 from = point();
  return {from, point() - from};
}

RC_GTEST_PROP(MaxMip, LaterStartNeitherFindsEarlierHitsNorLosesAny, ()) {
  static const Terrain terrain = hills();
  Ray ray = any_ray(terrain.field);
  const Hit first = terrain.cast(ray);
  ray.t_min = *rc::gen::inRange(0, 1000) * 1e-3;
  const Hit later = terrain.cast(ray);
  // Rounding of a clearance (numerics.md), for rays of any_ray().
  const double rounding = 16 * 0x1p-53 * (2 * 60 + 4 * (257 + 193) * 30);
  if (first && first.t > ray.t_min) {
    // Whether the ray starts outside of the field, above the ground or below it (and rises before that hit), the hit is
    // still ahead. Only if it starts on the ground within the rounding of two clearances, the test's and the march's,
    // may it be on either side.
    const dvec3 start = ray.at(ray.t_min);
    const std::optional<double> ground = terrain.field.height(start.x, start.y);
    if (!ground || std::abs(start.z - *ground) > 2 * rounding) RC_ASSERT(later);
  }
  if (later) {
    RC_ASSERT(later.t >= ray.t_min);
    // Either root may be off by the rounding of a clearance over the speed at which the ray approaches.
    const dvec2 slope = terrain.field.gradient(later.cell, later.u, later.v);
    const double closing = std::abs(ray.direction.z - slope.x * ray.direction.x - slope.y * ray.direction.y);
    if (first) RC_ASSERT((first.t - later.t) * closing <= 2 * rounding);
    RC_ASSERT(first || first.status == HitStatus::below);
  }
}

TEST(MaxMip, CrossesAColumnLineAndTheSeamAtOnce) {
  // An odd number of rows: the last blocks are narrower than the others. Towards lower rows and through a node of the
  // seam, at which the ray also enters the next column. The cell behind it must not be skipped.
  constexpr int kSide = 7;
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    std::vector<float> samples(kSide * kSide, 0);
    samples[6 * kSide + 4] = samples[6 * kSide + 5] = 10;  // one wall, in row 6: right behind the seam
    const Terrain terrain{HeightField::own(samples, kSide, kSide, {.surface = surface, .wrap = Wrap::periodic})};
    // From (3, 1) through the node (4, 0) on to (5, -1), which is (5, 6).
    const dvec3 from = terrain.field.world_from_grid(3, 1, 5), to = terrain.field.world_from_grid(5, -1, 5);
    const Hit hit = terrain.cast(from, to - from, 0, 2);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit.cell, (Cell{4, 6}));
    EXPECT_DOUBLE_EQ(hit.t, 0.75);
  }
}

TEST(MaxMip, DoesNotReportAnExitAtANode) {
  // Through the ground and out again at a node, where the clearance is zero except for rounding: one hit each.
  Random random(5);
  std::vector<float> samples;
  for (int i = 0; i < 65 * 65; ++i) samples.push_back(static_cast<float>(uniform(random, 0, 6)));
  const Terrain terrain{HeightField::own(samples, 65, 65)};
  const HeightTarget target{&terrain.field, &terrain.pyramid};
  std::vector<Hit> hits;
  for (int i = 0; i < 20'000; ++i) {
    const int col = whole(random, 8, 56), row = whole(random, 8, 56);
    const float z = terrain.field.visit([&](const auto& grid) { return static_cast<float>(grid.at(col, row)); });
    Ray ray;
    ray.direction = {whole(random, -256, 256) / 64.0, whole(random, -256, 256) / 64.0, -8};
    ray.origin = terrain.field.world_from_grid(col, row, z) - ray.direction;
    ray.t_max = 2;
    ASSERT_EQ(all_hits_max_mip(target, ray, hits), HitStatus::hit);
    for (const Hit& hit : hits) {
      // Just before each hit the ray is above the ground, by more than its fall in that time.
      const dvec3 before = ray.at(hit.t - 0x1p-16);
      const auto ground = terrain.field.height(before.x, before.y);
      ASSERT_TRUE(!ground || before.z > *ground) << "hit at " << hit.t << " from below, at node " << col << ", " << row;
    }
  }
}

RC_GTEST_PROP(MaxMip, RespectsTMaxAroundTheHit, ()) {
  // A ray that is cut before the hit misses; a ray that is cut just after it hits at the same position.
  static const Terrain terrain = hills();
  Ray ray = any_ray(terrain.field);
  const Hit hit = terrain.cast(ray);
  if (!hit) return;
  const double nudge = 1e-9 * (1 + hit.t);
  ray.t_max = hit.t + nudge;
  RC_ASSERT(terrain.cast(ray).status == HitStatus::hit);
  ray.t_max = hit.t - nudge;
  RC_ASSERT(ray.t_max < 0 || terrain.cast(ray).status != HitStatus::hit);
}

RC_GTEST_PROP(MaxMip, MirrorsWithTheField, ()) {
  // West and east swapped. Coordinates are small multiples of 1/8 and directions powers of two: up to the last square
  // root all arithmetic is exact, touches included, and so must be the answer.
  Random random(static_cast<std::uint64_t>(*rc::gen::inRange(0, 1 << 30)));
  std::vector<float> samples, mirrored;
  for (int row = 0; row < 9; ++row) {
    std::vector<float> line;
    for (int col = 0; col < 13; ++col) line.push_back(static_cast<float>(whole(random, 0, 8)));
    samples.insert(samples.end(), line.begin(), line.end());
    mirrored.insert(mirrored.end(), line.rbegin(), line.rend());
  }
  const Terrain a{HeightField::own(samples, 13, 9)}, b{HeightField::own(mirrored, 13, 9)};
  const auto power = [&] { return std::ldexp(whole(random, 0, 1) ? 1 : -1, whole(random, -3, 1)); };
  const Ray ray{{whole(random, 0, 96) / 8.0, whole(random, 0, 64) / 8.0, 10 + whole(random, 0, 8) / 8.0},
                {power(), power(), -std::abs(power())}};
  Ray other = ray;
  other.origin.x = 12 - ray.origin.x;
  other.direction.x = -ray.direction.x;
  const Hit p = a.cast(ray), q = b.cast(other);
  RC_ASSERT(p.status == q.status);
  if (p) RC_ASSERT(std::abs(p.t - q.t) <= 16 * 0x1p-53 * p.t);
}

}  // namespace
}  // namespace scarp::test
