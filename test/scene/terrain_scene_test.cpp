// SPDX-License-Identifier: MIT
#include "scarp/scene/terrain_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "scarp/base/error.h"

namespace scarp {
namespace {

HeightField waves(int side) {
  std::vector<float> samples;
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) {
      samples.push_back(static_cast<float>(4 * std::sin(0.4 * col) * std::cos(0.3 * row)));
    }
  }
  return HeightField::own(std::move(samples), side, side);
}

TEST(TerrainScene, OccludedIsWhetherThereIsAHitWithEveryMarch) {
  const HeightField field = waves(40);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(-5, 45), height(-6, 8), way(-1, 1);
  for (const HeightMarchEntry& march : height_marches()) {
    const TerrainScene scene(field, march);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
      Ray ray;
      ray.origin = {place(random), place(random), height(random)};
      ray.direction = {way(random), way(random), 0.3 * way(random)};
      const bool hit = static_cast<bool>(scene.closest_hit(ray));
      hits += hit;
      ASSERT_EQ(scene.occluded(ray), hit) << march.name << ", ray " << i;
    }
    EXPECT_GT(hits, 100) << march.name << ": the rays ask too little";
  }
}

TEST(TerrainScene, ABatchIsAnsweredAsItsRaysAre) {
  const TerrainScene scene(waves(40), find_height_march("max-mip"));
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> place(-5, 45), height(-6, 8), way(-1, 1);
  std::vector<Ray> rays(3000);
  for (Ray& ray : rays) {
    ray.origin = {place(random), place(random), height(random)};
    ray.direction = {way(random), way(random), 0.3 * way(random)};
  }
  std::vector<Hit> hits(rays.size()), counted(rays.size());
  std::vector<std::uint32_t> steps(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  scene.closest_hits(rays, hits);
  scene.closest_hits(rays, counted, steps);
  scene.occluded(rays, blocked);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    MarchStats stats;
    const Hit hit = scene.closest_hit(rays[i], &stats);
    ASSERT_EQ(hits[i].status, hit.status) << i;
    ASSERT_EQ(hits[i].t, hit.t) << i;
    ASSERT_EQ(counted[i].t, hit.t) << i;
    ASSERT_EQ(steps[i], stats.steps) << i;
    ASSERT_EQ(blocked[i] != 0, static_cast<bool>(hit)) << i;
  }
  hits.pop_back();
  steps.pop_back();
  EXPECT_THROW(scene.closest_hits(rays, hits), Error);
  EXPECT_THROW(scene.closest_hits(rays, counted, steps), Error);
}

TEST(TerrainScene, StatisticsAreThoseOfTheMarch) {
  const TerrainScene scene(waves(40), find_height_march("max-mip"));
  Ray down;
  down.origin = {10.3, 10.6, 50};
  down.direction = {0.1, 0.2, -1};
  MarchStats stats;
  ASSERT_TRUE(scene.closest_hit(down, &stats));
  EXPECT_GE(stats.cell_tests, 1u);
  EXPECT_GE(stats.steps, stats.cell_tests);
}

TEST(TerrainScene, SettingsOutOfRangeAreRefused) {
  MarchSettings settings;
  settings.naive.min_step = 0;
  EXPECT_THROW(TerrainScene(waves(4), find_height_march("naive"), settings), Error);
}

}  // namespace
}  // namespace scarp
