// SPDX-License-Identifier: MIT
// Scenes of one field at the origin: they accept the same rays as the field, and return the answers of its own batches,
// to the bit. Also heights above ground in scenes of several fields.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "base/refusal.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/base/error.h"
#include "scarp/march/height/queries.h"
#include "scarp/scene/scene.h"

namespace scarp {
namespace {

constexpr int kSide = 40;

// Waves with or without a hole, a sheet or solid, wrapped or not.
HeightField waves(const HeightFieldSettings& settings = {}, bool hole = true) {
  std::vector<float> samples;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col)
      samples.push_back(static_cast<float>(4 * std::sin(0.4 * col) * std::cos(0.3 * row)));
  }
  if (hole) samples[20 * kSide + 30] = NAN;
  return HeightField::own(std::move(samples), kSide, kSide, settings);
}

std::vector<Ray> rays_at_random(unsigned seed, std::size_t count, double t_max) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-5, 45), height(-6, 8), way(-1, 1);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.origin = {place(random), place(random), height(random)};
    ray.direction = {way(random), way(random), 0.3 * way(random)};
    ray.t_max = t_max;
  }
  return rays;
}

// Rays that a march accepts without a scene.
struct Alone {
  Alone(const HeightField& of, const HeightMarchEntry& by) : field(of), march(by) {
    if (by.needs_pyramid) pyramid.emplace(of);
    if (by.needs_slope) slope = slope_bound(of);
  }
  HeightTarget target() const { return {&field, pyramid ? &*pyramid : nullptr, slope}; }

  const HeightField& field;
  const HeightMarchEntry& march;
  std::optional<MaxPyramid> pyramid;
  double slope = 0;
};

class SceneOfOne : public testing::TestWithParam<HeightFieldSettings> {};

TEST_P(SceneOfOne, MatchesItsFieldsBatch) {
  // Few enough for the exhaustive march, enough for several pieces on several threads.
  constexpr std::size_t kRays = 1200;
  const std::vector<Ray> rays = rays_at_random(7, kRays, GetParam().wrap == Wrap::none ? INFINITY : 100);
  for (const HeightMarchEntry& march : height_marches()) {
    const HeightField field = waves(GetParam(), march.fields == HeightFields::all);
    if (!takes(march.fields, field)) {
      EXPECT_NE(test::refusal([&] { scene_heights(field, march); }).find(march.name), std::string::npos);
      continue;
    }
    const Scene scene(scene_heights(field, march));
    const Alone alone(field, march);
    ASSERT_EQ(scene.only_heights()->rows(), kSide);
    EXPECT_EQ(scene.marches(), march.name);
    std::vector<Hit> hits(kRays), counted(kRays), expected(kRays);
    std::vector<std::uint32_t> steps(kRays);
    std::vector<std::uint8_t> blocked(kRays), expected_blocked(kRays);
    scene.closest_hits(rays, hits);
    scene.closest_hits(rays, counted, steps);
    scene.occluded(rays, blocked);
    closest_hits(alone.target(), rays, expected, march);
    occluded(alone.target(), rays, expected_blocked, march);
    std::vector<Ray> onwards;
    std::vector<Hit> from;
    for (std::size_t i = 0; i < kRays; ++i) {
      MarchStats stats;
      ASSERT_EQ(hits[i], expected[i]) << march.name << ", ray " << i;
      ASSERT_EQ(counted[i], expected[i]) << march.name << ", ray " << i;
      ASSERT_EQ(scene.closest_hit(rays[i], nullptr, &stats), expected[i]) << march.name << ", ray " << i;
      ASSERT_EQ(steps[i], stats.steps) << march.name << ", ray " << i;
      ASSERT_EQ(blocked[i], expected_blocked[i]) << march.name << ", ray " << i;
      ASSERT_EQ(scene.occluded(rays[i]), blocked[i] != 0) << march.name << ", ray " << i;
      if (!hits[i]) continue;
      Ray ray = rays[i];
      ray.origin = ray.at(hits[i].t);
      ray.direction = {0.4, -0.3, 0.2};
      onwards.push_back(ray);
      from.push_back(hits[i]);
    }
    ASSERT_GT(onwards.size(), kRays / 10) << march.name << ": the rays ask too little";
    // From the surface: by the ray's own start, and by the hit on which it starts.
    std::vector<Ray> started = onwards;
    std::vector<const Hit*> begin;
    for (std::size_t i = 0; i < onwards.size(); ++i) {
      begin.push_back(i % 5 ? &from[i] : nullptr);
      if (!begin[i] || from[i].wall) continue;
      started[i].start = RayStart::on_surface;
      started[i].start_cell = from[i].cell;
    }
    std::vector<Hit> by_start(onwards.size()), by_hit(onwards.size()), again(onwards.size());
    std::vector<std::uint8_t> shaded_by_start(onwards.size()), shaded(onwards.size()), shaded_again(onwards.size());
    scene.closest_hits(started, by_start);
    scene.occluded(started, shaded_by_start);
    scene.closest_hits(onwards, by_hit, {}, begin);
    scene.occluded(onwards, shaded, begin);
    closest_hits(alone.target(), started, again, march);
    occluded(alone.target(), started, shaded_again, march);
    for (std::size_t i = 0; i < onwards.size(); ++i) {
      ASSERT_EQ(by_start[i], again[i]) << march.name << ", ray " << i;
      ASSERT_EQ(by_hit[i], again[i]) << march.name << ", ray " << i;
      ASSERT_EQ(shaded_by_start[i], shaded_again[i]) << march.name << ", ray " << i;
      ASSERT_EQ(shaded[i], shaded_again[i]) << march.name << ", ray " << i;
      if (begin[i]) {
        ASSERT_EQ(scene.closest_hit(onwards[i], begin[i]), again[i]) << march.name << ", ray " << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fields, SceneOfOne,
                         testing::Values(HeightFieldSettings{}, HeightFieldSettings{.solid = true},
                                         HeightFieldSettings{.wrap = Wrap::periodic}));

TEST(SceneOfOneField, MatchesItselfBesideAnEmptyField) {
  // An empty field beside it leads to the other code path of the scene.
  const SceneFieldPtr field = scene_heights(waves());
  const Scene one(field),
      two({field, scene_heights(HeightField::own(std::vector<float>(1), 1, 1))}, {SceneObject{0}, SceneObject{1}});
  EXPECT_EQ(two.only_heights(), nullptr);
  EXPECT_EQ(two.marches(), "max-mip");
  const std::vector<Ray> rays = rays_at_random(9, 3000, INFINITY);
  std::vector<Hit> of_one(rays.size()), of_two(rays.size());
  one.closest_hits(rays, of_one);
  two.closest_hits(rays, of_two);
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(of_one[i], of_two[i]) << i;
}

TEST(SceneOfOneField, ReportsStatisticsOfTheMarch) {
  const Scene scene(scene_heights(waves()));
  Ray down;
  down.origin = {10.3, 10.6, 50};
  down.direction = {0.1, 0.2, -1};
  MarchStats stats;
  ASSERT_TRUE(scene.closest_hit(down, nullptr, &stats));
  EXPECT_GE(stats.cell_tests, 1u);
  EXPECT_GE(stats.steps, stats.cell_tests);
}

TEST(SceneOfOneField, RejectsUnsupportedQueries) {
  MarchSettings settings;
  settings.naive.min_step = 0;
  EXPECT_THROW(scene_heights(waves(), find_height_march("naive"), settings), Error);
  const Scene scene(scene_heights(waves()));
  const std::vector<Ray> rays(5);
  std::vector<Hit> hits(4), all(5);
  std::vector<std::uint32_t> steps(4);
  const std::vector<const Hit*> from(6);
  EXPECT_THROW(scene.closest_hits(rays, hits), Error);
  EXPECT_THROW(scene.closest_hits(rays, all, steps), Error);
  EXPECT_THROW(scene.closest_hits(rays, all, {}, from), Error);
  const Scene for_device(scene_heights(waves(), find_height_march("max-mip"), {}, AnsweredBy::back_end));
  EXPECT_THROW(for_device.closest_hit(rays[0]), Error);
}

TEST(SceneOfOneField, ValidatesCallerRays) {
  const auto refused = [](const Scene& scene, const Ray& ray) { return test::refusal([&] { validate(ray, scene); }); };
  const Scene scene(scene_heights(waves())), endless(scene_heights(waves({.wrap = Wrap::periodic})));
  Ray ray;
  validate(ray, scene);
  EXPECT_NE(refused(endless, ray).find("t_max must be finite"), std::string::npos);
  ray.t_max = 10;
  validate(ray, endless);
  ray.start = RayStart::on_surface;
  EXPECT_NE(refused(scene, ray).find("cell (-1, -1), which does not exist"), std::string::npos);
  ray.start_cell = {3, 4};
  validate(ray, scene);
  ray.start_object = 1;
  EXPECT_NE(refused(scene, ray).find("object 1, which does not exist"), std::string::npos);
  ray.direction = dvec3(0.0);
  EXPECT_NE(refused(scene, ray).find("direction is zero"), std::string::npos);
}

// Flat ground 3 m high, at several positions; tilted ground does not count.
TEST(SceneOfMoreFields, ReportTheHighestGround) {
  const SceneFieldPtr flat = scene_heights(HeightField::own(std::vector<float>(25, 3.0f), 5, 5));
  glm::dmat3 quarter(0.0), tilt(1.0);
  quarter[0][1] = 1, quarter[1][0] = -1, quarter[2][2] = 1;
  tilt[0] = {0.8, 0, 0.6}, tilt[2] = {-0.6, 0, 0.8};
  const Scene scene({flat}, {{0, 0, {.scale = 2, .origin = {10, 0, 1}}},
                             {0, 0, {.turn = quarter, .origin = {14, 0, 9}}},
                             {0, 0, {.turn = tilt, .origin = {10, 0, 99}}}});
  EXPECT_EQ(scene.height(15, 5), 7);
  EXPECT_EQ(scene.height(12, 2), 12);
  EXPECT_FALSE(scene.height(0, 0));
  EXPECT_EQ(Scene(flat).height(0.5, 0.5), 3);
}

}  // namespace
}  // namespace scarp
