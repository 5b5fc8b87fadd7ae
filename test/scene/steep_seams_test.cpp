// SPDX-License-Identifier: MIT
// Nearly vertical rays where fields meet: tiles, combined fields, rotated and earth-centred placements.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "base/refusal.h"
#include "march/height/spiteful.h"
#include "scarp/scarp.h"
#include "scarp/scene/scene_query.h"
#include "scarp/scene/tiled_terrain.h"

namespace scarp::test {
namespace {

constexpr int kTileCells = 16, kAcross = 8;
const double kCosineOf90 = std::cos(std::numbers::pi / 2);
// Error of a hit on level ground: 16 roundings (numerics.md, "Rounding error of a clearance") of heights of up to 1,000
// m.
constexpr double kOff = 16 * 0x1p-53 * 1000;

TerrainTiles flat_tiles(double cell, int cols, int rows, int cells) {
  TiledTerrain terrain({cols, rows, cells, cells, {.cell_x = cell, .cell_y = cell}});
  const std::vector<float> samples(static_cast<std::size_t>((cells + 1) * (cells + 1)));
  terrain.edit([&](auto& editor) {
    for (int i = 0; i < cols * rows; ++i)
      editor.put({i % cols, i / cols},
                 HeightField::own(samples, cells + 1, cells + 1, {.cell_x = cell, .cell_y = cell}));
  });
  return terrain.read();
}

// All queries find the ground at t, also for a range that ends just behind it.
void expect_ground(const Scene& scene, const Ray& ray, double t) {
  const Hit hit = cast(scene, ray);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit.t, t, kOff);
  EXPECT_TRUE(occluded(scene, ray));
  Ray shorter = ray;
  shorter.t_max = t + 1;
  EXPECT_TRUE(cast(scene, shorter));
  EXPECT_TRUE(occluded(scene, shorter));
}

TEST(SteepSeams, BetweenTilesAreHitByNearlyVerticalRays) {
  const TerrainTiles tiles = flat_tiles(30.7, kAcross, 1, kTileCells);
  const Ray ray{{3438.4, 100, 1000}, {-6.12e-17, 0, -1}};
  expect_ground(tiles, ray, 1000);
  EXPECT_NEAR(cast(tiles, ray).height, 0, kOff);
}

TEST(SteepSeams, BetweenTilesOfAnySizeAreHit) {
  Random random(11);
  for (int i = 1; i <= 400; ++i) {
    const double cell = i / (i % 2 == 0 ? 10.0 : 100.0);
    const int cells = i % 3 == 0 ? 12 : kTileCells;
    const TerrainTiles tiles = flat_tiles(cell, 4, 2, cells);
    std::vector<Ray> rays;
    for (const double lean : {0.0, -kCosineOf90, kCosineOf90, -1e-20, 0x1p-200, -0x1p-60}) {
      for (int seam = 1; seam < 4; ++seam) {
        const double x = seam * (cells * cell);
        rays.push_back({{x, uniform(random, 0, 2 * cells * cell), 1000}, {lean, 0, -1}});
        rays.push_back({{uniform(random, 0, 4 * cells * cell), cells * cell, 1000}, {0, lean, -1}});
      }
    }
    std::vector<Hit> hits(rays.size());
    cast(tiles, rays, hits);
    int lost = 0;
    for (std::size_t k = 0; k < rays.size(); ++k) {
      Ray shorter = rays[k];
      shorter.t_max = 1001;
      lost += !hits[k] || std::abs(hits[k].t - 1000) > kOff || !cast(tiles, shorter) || !occluded(tiles, shorter);
    }
    EXPECT_EQ(lost, 0) << "cells of " << cell;
  }
}

// Two fields side by side, placed by `outer`.
Scene pair_of(double cell, int cells, const Placement& outer) {
  const std::vector<float> samples(static_cast<std::size_t>((cells + 1) * (cells + 1)));
  const Terrain tile = Terrain::own(samples, cells + 1, cells + 1, {.cell_x = cell, .cell_y = cell});
  const double width = cells * cell;
  return combine({{tile, placed(outer, {})}, {tile, placed(outer, {.origin = {width, 0, 0}})}});
}

TEST(SteepSeams, BetweenCombinedFieldsAreHitUnderAnyPlacement) {
  Random random(12);
  const auto turned = [](double degrees, dvec3 axis) {
    return glm::dmat3(glm::rotate(glm::dmat4(1), degrees * std::numbers::pi / 180, axis));
  };
  const std::vector<Placement> placements{
      {},
      {.origin = {123456.7, -7e5, 12}},
      {.turn = turned(33, {0, 0, 1}), .origin = {1000.1, 2000.2, 3}},
      {.turn = turned(90, {1, 0, 0})},
      {.turn = turned(51, {1, 2, 3}), .origin = {4.1e6, 3.2e6, -3.7e6}},
      {.turn = turned(120, {-2, 1, 1}), .origin = {-2.7e6, 4.9e6, 3.1e6}},
  };
  for (const Placement& outer : placements) {
    for (const double cell : {1.0, 0.5, 7.7, 30.7, 92.6}) {
      const int cells = 24;
      const Scene scene = pair_of(cell, cells, outer);
      const double width = cells * cell;
      // The gap between two fields at the seam of a scene, and 16 roundings of world coordinates below 2^23 m.
      const double off = 0x1p-26 * cell + 16 * 0x1p-53 * 0x1p23;
      std::vector<Ray> rays;
      for (int i = 0; i < 400; ++i) {
        // On the seam, or off it by the rounding of world coordinates.
        const double beside = i % 3 == 0 ? 0 : uniform(random, -1e-9, 1e-9) * cell;
        const dvec3 aim(width + beside, uniform(random, 0.1, 0.9) * width, 0);
        const double lean = i % 2 == 0 ? 0 : std::ldexp(uniform(random, -1, 1), -whole(random, 30, 200));
        const dvec3 d = outer.turn * dvec3(lean, i % 5 == 0 ? 1e-17 : 0.0, -1);
        rays.push_back({outer.world_from_field(aim) - 100.0 * d, d});
        rays.back().t_max = 200;
      }
      std::vector<Hit> hits(rays.size());
      std::vector<std::uint8_t> blocked(rays.size());
      cast(scene, rays, hits);
      occluded(scene, rays, blocked);
      int lost = 0;
      for (std::size_t i = 0; i < rays.size(); ++i)
        lost += !hits[i] || !blocked[i] || std::abs(hits[i].t - 100) > off || !cast(scene, rays[i]);
      EXPECT_EQ(lost, 0) << "cells of " << cell << " at " << outer.origin.x;
    }
  }
}

TEST(SteepSeams, QueriesTerminateForAnyNumbers) {
  const TerrainTiles tiles = flat_tiles(1, 4, 4, kTileCells);
  const Terrain flat(HeightField::own(std::vector<float>(81), 9, 9));
  constexpr double kInf = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> odd{kInf, -kInf, kNan, 1e300, 1.7e308, -1.7e308, 5e-324, -5e-324, 0, 1, -1};
  Random random(13);
  const auto any = [&] { return odd[static_cast<std::size_t>(whole(random, 0, static_cast<int>(odd.size()) - 1))]; };
  std::vector<Ray> rays{{{-kInf, -1, 1}, {1e300, -5e-324, kInf}}};
  for (int i = 0; i < 20000; ++i) {
    Ray ray{{any(), any(), any()}, {any(), any(), any()}};
    if (i % 3 == 0) ray.t_min = any(), ray.t_max = any();
    rays.push_back(ray);
  }
  const Scene scenes[] = {static_cast<const Scene&>(tiles), combine({{flat}}),
                          combine({{tiles, {.origin = {5, 5, 5}}}, {flat}})};
  for (const Scene& scene : scenes) {
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> blocked(rays.size());
    scene.closest_hits(rays, hits);
    scene.occluded(rays, blocked);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray& ray = rays[i];
      const Hit hit = scene.closest_hit(ray);
      EXPECT_EQ(static_cast<bool>(hit), scene.occluded(ray));
      EXPECT_EQ(hits[i].status, hit.status);
      EXPECT_EQ(blocked[i] != 0, static_cast<bool>(hit));
      EXPECT_TRUE(!hit || std::isfinite(hit.t + hit.height + hit.u + hit.v));
      bool refused = !(ray.t_min <= ray.t_max) || !std::isfinite(ray.t_min) || ray.direction == dvec3(0.0);
      for (int axis = 0; axis < 3; ++axis)
        refused = refused || !std::isfinite(ray.origin[axis]) || !std::isfinite(ray.direction[axis]);
      EXPECT_FALSE(refused && hit.status != HitStatus::miss) << static_cast<int>(hit.status);
      if (testing::Test::HasFailure()) {
        FAIL() << i << ": from " << ray.origin.x << " " << ray.origin.y << " " << ray.origin.z << " along "
               << ray.direction.x << " " << ray.direction.y << " " << ray.direction.z << ", t " << ray.t_min << " to "
               << ray.t_max;
      }
    }
  }
}

TEST(SteepSeams, LongDirectionsNeverReturnNan) {
  const std::vector<float> samples(17 * 17);
  Random random(14);
  for (const double cell : {0.1, 1.0, 30.7}) {
    const Terrain terrain = Terrain::own(samples, 17, 17, {.cell_x = cell, .cell_y = cell});
    const Scene turned =
        combine({{terrain, {.turn = glm::dmat3(glm::rotate(glm::dmat4(1), 0.6, dvec3(1, 2, 3))), .scale = 0.5}}});
    for (const Scene& scene : {terrain.scene(), turned}) {
      for (int i = 0; i < 300; ++i) {
        const auto far = [&] { return 1.79e308 * uniform(random, -1, 1); };
        const Ray ray{{uniform(random, 0, 8) * cell, uniform(random, 0, 8) * cell, uniform(random, -9, 9)},
                      {far(), far(), far()}};
        const Hit hit = cast(scene, ray);
        EXPECT_EQ(static_cast<bool>(hit), occluded(scene, ray));
        if (!hit) continue;
        EXPECT_TRUE(std::isfinite(hit.t) && std::isfinite(hit.u) && std::isfinite(hit.v) && std::isfinite(hit.height));
      }
    }
  }
}

TEST(SteepSeams, ClosestPointRejectsNonFinitePoints) {
  const Terrain terrain = Terrain::own(std::vector<float>(9), 3, 3);
  const Scene scene = terrain;
  const SceneQuery query = scene.query({});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal([&] { query.closest_point({nan, 0, 0}); }), "");
  EXPECT_NE(refusal([&] { query.closest_point({0, HUGE_VAL, 0}); }), "");
  EXPECT_NE(refusal([&] { query.closest_point({0, 0, 0}, nan); }), "");
}

// A query refers to its scene, so the scene must not be a temporary.
template <class S>
concept HasQuery = requires(S&& scene) {
  std::forward<S>(scene).query(SceneRules{});
};
static_assert(HasQuery<Scene&> && HasQuery<const Scene&> && !HasQuery<Scene>);

// Tiles with holes and flat parts and heights from 0 to 100, or flat at 0.
TerrainTiles tiles_with_holes(Random& random, double cell, int side) {
  const HeightFieldSettings ground{.cell_x = cell, .cell_y = cell, .nodata = -1};
  TiledTerrain terrain({2, 2, side, side, ground});
  const int most = whole(random, 0, 2) * 50, samples = 2 * side + 1;
  std::vector<std::int16_t> all(static_cast<std::size_t>(samples * samples));
  for (std::int16_t& sample : all)
    sample = static_cast<std::int16_t>(whole(random, 0, 4) == 0 ? -1 : whole(random, 0, most));
  terrain.edit([&](auto& editor) {
    for (int tile = 0; tile < 4; ++tile) {
      std::vector<std::int16_t> own;
      for (int row = 0; row <= side; ++row) {
        for (int col = 0; col <= side; ++col) {
          const int at = (tile / 2 * side + row) * samples + tile % 2 * side + col;
          own.push_back(all[static_cast<std::size_t>(at)]);
        }
      }
      editor.put({tile % 2, tile / 2}, HeightField::own(own, side + 1, side + 1, ground));
    }
  });
  return terrain.read();
}

// The end of the range changes no hit, in tiles and wherever they are placed: a hit at the end counts, and none comes
// before.
TEST(SteepSeams, HitTheSamePointWhereverTheRangeEnds) {
  Random random(13);
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    const double cells[] = {1, 0.1, 7.7, 30.7}, cell = cells[i % 4];
    const int side = whole(random, 1, 6);
    const TerrainTiles tiles = tiles_with_holes(random, cell, side);
    Placement outer;
    if (i % 3 == 1) outer.origin = {1000.1, -500.3, 20};
    if (i % 3 == 2) outer.turn = glm::dmat3(glm::rotate(glm::dmat4(1), uniform(random, 0, 6), dvec3(1, 2, 3)));
    const Scene scene = i % 3 == 0 ? tiles.scene() : combine({{tiles.scene(), outer}});
    for (int j = 0; j < 100; ++j) {
      const dvec3 node(whole(random, 0, 2 * side) * cell, whole(random, 0, 2 * side) * cell, whole(random, 0, 100));
      const auto lean = [&] { return std::ldexp(uniform(random, -1, 1), -whole(random, 0, 1074)); };
      dvec3 d(lean() * cell, lean() * cell, whole(random, 0, 4) == 0 ? 1 : -1);
      if (j % 3 == 0) d = {uniform(random, -1, 1) * cell, uniform(random, -1, 1) * cell, uniform(random, -50, 5)};
      if (j % 5 == 0) d[whole(random, 0, 1)] = cell, d.z = whole(random, 0, 1) ? 0 : -lean();
      const dvec3 from = node - uniform(random, 0, 20) * d;
      Ray ray{outer.world_from_field(from), outer.turn * d};
      const Hit hit = cast(scene, ray);
      if (!hit) continue;
      ++hits;
      for (const double t_max : {hit.t, std::nextafter(hit.t, 1e300), 2 * hit.t, hit.t + 1}) {
        ray.t_max = t_max;
        ASSERT_EQ(cast(scene, ray), hit) << i << " " << j << " " << t_max;
        ASSERT_TRUE(occluded(scene, ray)) << i << " " << j << " " << t_max;
      }
      ray.t_max = std::nextafter(hit.t, -1e300);
      ASSERT_FALSE(ray.t_max >= 0 && (cast(scene, ray) || occluded(scene, ray))) << i << " " << j;
    }
  }
  EXPECT_GT(hits, 10000);
}

}  // namespace
}  // namespace scarp::test
