// SPDX-License-Identifier: MIT
// Tiles that act as one field: against one large field, across seams between levels, while tiles are loaded and
// unloaded; and errors. Also run under the thread sanitizer.
#include "scarp/scene/tiled_terrain.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <map>
#include <thread>
#include <vector>

#include "base/refusal.h"
#include "march/height/spiteful.h"
#include "scarp/scarp.h"

namespace scarp {
namespace {

using test::Random;
using test::refusal;
using test::uniform;
using test::whole;

constexpr int kCells = 16, kTiles = 3, kSide = kCells * kTiles + 1;

// Hills with noise, as samples of a whole tiled terrain.
std::vector<float> samples(Random& random, double hole_share) {
  std::vector<float> all;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      all.push_back(static_cast<float>(4 * std::sin(0.31 * col) * std::cos(0.23 * row) + uniform(random, 0, 2)));
      if (uniform(random, 0, 1) < hole_share) all.back() = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return all;
}

// A tile of this terrain, at a level.
HeightField tile(const std::vector<float>& all, TilePlace place, HeightFieldSettings settings, int level = 0) {
  std::vector<float> own;
  const int step = 1 << level, side = (kCells >> level) + 1;
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col)
      own.push_back(
          all[static_cast<std::size_t>((place.row * kCells + row * step) * kSide + place.col * kCells + col * step)]);
  }
  settings.cell_x *= step, settings.cell_y *= step;
  return HeightField::own(std::move(own), side, side, settings);
}

Ray ray_through(Random& random, const dvec3& box, const std::vector<float>& all, const HeightFieldSettings& settings) {
  Ray ray;
  dvec3 aim(uniform(random, 0, box.x), uniform(random, 0, box.y), uniform(random, -4, 6));
  // At lines where tiles meet, at their corners and at other nodes, often on the ground.
  const int col = whole(random, 0, 2) ? kCells * whole(random, 0, kTiles) : whole(random, 0, kSide - 1);
  const int row = whole(random, 0, 2) ? kCells * whole(random, 0, kTiles) : whole(random, 0, kSide - 1);
  if (whole(random, 0, 3)) aim.x = col * settings.cell_x;
  if (whole(random, 0, 2)) aim.y = (kSide - 1 - row) * settings.cell_y;
  const float height = all[static_cast<std::size_t>(row * kSide + col)];
  if (whole(random, 0, 1) && height == height) aim.z = height;
  ray.origin = {uniform(random, -10, box.x + 10), uniform(random, -10, box.y + 10), uniform(random, 2, 40)};
  if (whole(random, 0, 9) == 0) ray.origin.x = aim.x;
  if (whole(random, 0, 9) == 0) ray.origin.y = aim.y;
  ray.direction = aim - ray.origin;
  if (whole(random, 0, 4) == 0) ray.t_max = uniform(random, 0.2, 2);
  return ray;
}

// A distance in metres far larger than rounding and seams, and far smaller than a cell.
constexpr double kFar = 0x1p-20;

// Whether neighbouring rays on all sides have the same answer: then every engine must have it. Other rays touch the
// ground, or a rim, within rounding.
bool is_certain(const HeightField& field, const Ray& ray, const Hit& answer) {
  for (const dvec3 shift :
       {dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(0, 1, 0), dvec3(0, -1, 0), dvec3(0, 0, 1), dvec3(0, 0, -1)}) {
    Ray beside = ray;
    beside.origin += kFar * shift;
    const Hit hit = find_height_march("exhaustive").cpu({&field}, beside, {}, nullptr);
    if (hit.status != answer.status) return false;
    if (hit && std::abs(hit.t - answer.t) * glm::length(ray.direction) > 1000 * kFar) return false;
  }
  return true;
}

TEST(TiledTerrain, MatchesOneField) {
  int hits = 0;
  for (int round = 0; round < 12; ++round) {
    Random random(static_cast<unsigned>(round));
    HeightFieldSettings settings{.cell_x = round % 3 ? 0.3 : 1, .cell_y = round % 2 ? 0.7 : 0.3};
    if (round % 4 == 1) settings.surface = Surface::triangles;
    std::vector<float> all = samples(random, round % 2 ? 0.02 : 0);
    TiledTerrain terrain({kTiles, kTiles, kCells, kCells, settings});
    terrain.edit([&](auto& editor) {
      for (int i = 0; i < kTiles * kTiles; ++i) {
        const TilePlace place{i % kTiles, i / kTiles};
        if (round % 3 == 2 && i == 4) {
          // A missing tile is a hole, as are the cells of a tile without inner samples.
          for (int row = 1; row < kCells; ++row)
            for (int col = 1; col < kCells; ++col)
              all[static_cast<std::size_t>((kCells + row) * kSide + kCells + col)] =
                  std::numeric_limits<float>::quiet_NaN();
          continue;
        }
        editor.put(place, tile(all, place, settings));
      }
    });
    const HeightField field = HeightField::own(all, kSide, kSide, settings);
    const Terrain one(field);
    const TerrainTiles tiles = terrain.read();
    const dvec3 box(field.width(), field.depth(), 0);
    for (int i = 0; i < 6000; ++i) {
      Ray ray = ray_through(random, box, all, settings);
      const Hit expected = cast(one, ray), hit = cast(tiles, ray);
      hits += expected.status == HitStatus::hit;
      ASSERT_EQ(static_cast<bool>(hit), occluded(tiles, ray));
      const bool same =
          hit.status == expected.status && (!hit || std::abs(hit.t - expected.t) < 1e-9 * (1 + expected.t));
      if (!same) {
        const Hit& nearer = hit && !(expected.t < hit.t) ? hit : expected;
        EXPECT_FALSE(is_certain(field, ray, nearer))
            << "round " << round << " ray " << i << ": " << hit.t << " instead of " << expected.t;
      }
      if (!hit) continue;
      const dvec3 p = ray.at(hit.t);
      // The hit's cell is at the hit, and has its ground there.
      const TilePlace place = tiles.place(hit);
      const HeightField& own = *tiles.tile(place);
      const dvec3 in_tile = own.world_from_grid(hit.cell.col + hit.u, hit.cell.row + hit.v, 0);
      EXPECT_NEAR(in_tile.x + place.col * own.width(), p.x, kFar);
      EXPECT_NEAR(in_tile.y + (kTiles - 1 - place.row) * own.depth(), p.y, kFar);
      const auto corners = own.cell_heights(hit.cell);
      ASSERT_TRUE(corners);
      EXPECT_NEAR(height_in_cell(settings.surface, *corners, hit.u, hit.v), p.z, 100 * kFar);
    }
  }
  EXPECT_GT(hits, 30'000);
}

// A ray from above all ground to below it, within the terrain, hits. Samples near 1000 are rounded to 2^-14, so
// stitched samples are slightly off their line.
TEST(TiledTerrain, LosesNoRayAtSeamsBetweenLevels) {
  for (const auto surface : {Surface::bilinear, Surface::triangles}) {
    Random random(5);
    const HeightFieldSettings settings{.cell_x = 0.3, .cell_y = 0.3, .surface = surface};
    std::vector<float> all = samples(random, 0);
    for (float& sample : all) sample += 1000;
    TiledTerrain terrain({kTiles, kTiles, kCells, kCells, settings});
    terrain.edit([&](auto& editor) {
      for (int i = 0; i < kTiles * kTiles; ++i) {
        const TilePlace place{i % kTiles, i / kTiles};
        editor.put(place, tile(all, place, settings, i % 4));
      }
    });
    const TerrainTiles tiles = terrain.read();
    const double width = kCells * 0.3;
    const auto inside = [&](const dvec3& p) { return std::min(p.x, p.y) > 0 && std::max(p.x, p.y) < kTiles * width; };
    int lost = 0, rays = 0;
    while (rays < 100'000) {
      // Rays through a seam, near the ground there.
      double x = width * whole(random, 1, kTiles - 1), y = uniform(random, 0, kTiles * width);
      if (rays % 2) std::swap(x, y);
      const double off = rays % 3 ? 0x1p-14 : 0.5;
      const dvec3 aim(x, y, tiles.height(x, y).value() + uniform(random, -off, off));
      const dvec3 direction(uniform(random, -1, 1), uniform(random, -1, 1), -1);
      const Ray ray{.origin = aim + (aim.z - 1007) * direction, .direction = direction};
      if (!inside(ray.origin) || !inside(ray.at(1007 - 995))) continue;
      ++rays;
      lost += !cast(tiles, ray) || !occluded(tiles, ray);
    }
    EXPECT_EQ(lost, 0);
  }
}

// Rays that start on the ground at a seam start on all tiles there.
TEST(TiledTerrain, SurfaceStartsAtSeamsAreNotBlockedByTheNeighbour) {
  const HeightFieldSettings settings{.cell_x = 0.3, .cell_y = 0.3};
  const std::vector<float> all(kSide * kSide, 5);
  TiledTerrain terrain({kTiles, kTiles, kCells, kCells, settings});
  terrain.edit([&](auto& editor) {
    for (int i = 0; i < kTiles * kTiles; ++i) {
      const TilePlace place{i % kTiles, i / kTiles};
      editor.put(place, tile(all, place, settings));
    }
  });
  const TerrainTiles tiles = terrain.read();
  Random random(3);
  const double width = kCells * 0.3;
  for (int i = 0; i < 2000; ++i) {
    const Ray down{{width * whole(random, 1, 2), i % 4 ? uniform(random, 0, 3 * width) : width, 9}};
    const Hit hit = cast(tiles, down);
    ASSERT_TRUE(hit);
    Ray up{.origin = down.at(hit.t), .direction = {uniform(random, -1, 1), uniform(random, -1, 1), 1e-9}};
    EXPECT_FALSE(tiles.scene().occluded(up, &hit)) << i;
    up.start = RayStart::on_surface, up.start_cell = hit.cell;
    EXPECT_FALSE(tiles.scene().occluded(up)) << i;
    EXPECT_EQ(tiles.scene().closest_hit(up).status, HitStatus::miss) << i;
  }
}

TEST(TiledTerrain, ShadingNormalsMatchOneField) {
  Random random(9);
  const HeightFieldSettings settings{.cell_x = 0.5, .cell_y = 0.25};
  const std::vector<float> all = samples(random, 0);
  TiledTerrain terrain({kTiles, kTiles, kCells, kCells, settings});
  terrain.edit([&](auto& editor) {
    for (int i = 0; i < kTiles * kTiles; ++i) {
      const TilePlace place{i % kTiles, i / kTiles};
      editor.put(place, tile(all, place, settings));
    }
  });
  const TerrainTiles tiles = terrain.read();
  const Terrain one(HeightField::own(all, kSide, kSide, settings));
  for (int i = 0; i < 3000; ++i) {
    const Ray down{{uniform(random, 0, 24), uniform(random, 0, 12), 50}};
    const SceneSurface here = tiles.scene().surface(down, cast(tiles, down)),
                       there = one.scene().surface(down, cast(one, down));
    EXPECT_LT(glm::length(here.shading_normal - there.shading_normal), 1e-9);
    EXPECT_LT(glm::length(here.normal - there.normal), 1e-9);
  }
}

TEST(TiledTerrain, TilesCanChangeDuringQueries) {
  const HeightFieldSettings settings{};
  constexpr int kSteps = 40;
  TiledTerrain terrain({kTiles, 1, kCells, kCells, settings});
  const auto level = [&](float height) {
    return HeightField::own(std::vector<float>((kCells + 1) * (kCells + 1), height), kCells + 1, kCells + 1, settings);
  };
  std::atomic<bool> done = false;
  std::atomic<int> wrong = 0;
  std::atomic<std::int64_t> asked = 0;
  std::vector<std::thread> readers;
  for (int i = 0; i < 3; ++i) {
    readers.emplace_back([&] {
      std::uint64_t last = 0;
      do {
        const TerrainTiles tiles = terrain.read();
        // Epoch e: ground at height e, without the tile e % 3.
        const auto epoch = tiles.epoch();
        if (epoch < last) ++wrong;
        last = epoch;
        for (int col = 0; col < kTiles; ++col) {
          const Hit hit = cast(tiles, Ray{{kCells * (col + 0.5), 3, 1000}});
          const bool expected = epoch > 0 && col != static_cast<int>(epoch % kTiles);
          if (static_cast<bool>(hit) != expected || (expected && hit.height != static_cast<double>(epoch))) ++wrong;
        }
        ++asked;
      } while (!done);
    });
  }
  for (int step = 1; step <= kSteps; ++step) {
    terrain.edit([&](auto& editor) {
      for (int col = 0; col < kTiles; ++col) {
        if (terrain.read().tile({col, 0})) editor.remove({col, 0});
        if (col != step % kTiles) editor.put({col, 0}, level(static_cast<float>(step)));
      }
    });
  }
  done = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(asked, 0);
}

TEST(TiledTerrain, KeepsMemoryOfViewsAlive) {
  auto owner = std::make_shared<std::vector<float>>((kCells + 1) * (kCells + 1), 3.0f);
  TiledTerrain terrain({1, 1, kCells, kCells, {}});
  terrain.edit([&](auto& editor) {
    editor.put({0, 0}, HeightField::view(owner->data(), kCells + 1, kCells + 1, {}, 0, owner));
  });
  std::weak_ptr<const void> memory = owner;
  owner.reset();
  const Ray down{{3, 3, 9}};
  std::optional<TerrainTiles> tiles = terrain.read();
  EXPECT_TRUE(cast(*tiles, down));
  terrain.edit([](auto& editor) { editor.remove({0, 0}); });
  EXPECT_TRUE(cast(*tiles, down));
  EXPECT_FALSE(cast(terrain.read(), down));
  tiles.reset();
  EXPECT_TRUE(memory.expired());
}

TEST(TiledTerrain, RejectsMismatchedTilesWithoutChanges) {
  Random random(1);
  const HeightFieldSettings settings{.cell_x = 2, .cell_y = 2};
  std::vector<float> all = samples(random, 0);
  TiledTerrain terrain({kTiles, kTiles, kCells, kCells, settings});
  const auto put = [&](TilePlace place, const HeightField& field) {
    return refusal([&] { terrain.edit([&](auto& editor) { editor.put(place, field); }); });
  };
  EXPECT_EQ(put({1, 1}, tile(all, {1, 1}, settings)), "");
  EXPECT_EQ(put({1, 1}, tile(all, {1, 1}, settings)), "tiles: (1, 1): there is a tile already (remove it first)");
  EXPECT_EQ(put({3, 0}, tile(all, {0, 0}, settings)), "tiles: (3, 0): outside the grid of 3 x 3 tiles");
  EXPECT_EQ(put({0, 1}, tile(all, {0, 1}, {.cell_x = 2, .cell_y = 3})),
            "tiles: (0, 1): cells of 2 x 3 m; with this many samples they are 2 x 2 m");
  EXPECT_EQ(put({0, 1}, HeightField::own(std::vector<float>(30), 6, 5, settings)),
            "tiles: (0, 1): 6 x 5 samples; a tile has 17 x 17, or its cells are 2, 4, 8, ... times as long");
  HeightFieldSettings other = settings;
  other.offset = 1;
  EXPECT_EQ(put({0, 1}, tile(all, {0, 1}, other)), "tiles: (0, 1): its setting 'offset' is not that of the layout");
  // A different sample at the shared border, at its corner, and where the coarser tile has samples.
  const auto at = static_cast<std::size_t>((kCells + 4) * kSide + kCells);
  const float right = std::exchange(all[at], 77.0f);
  EXPECT_NE(put({0, 1}, tile(all, {0, 1}, settings)).find("(0, 1) and (1, 1) differ at a sample of their border: "),
            std::string::npos);
  EXPECT_NE(put({0, 1}, tile(all, {0, 1}, settings, 2)).find("differ at a sample of their border: "),
            std::string::npos);
  EXPECT_EQ(put({0, 1}, tile(all, {0, 1}, settings, 3)), "");
  all[at] = right;
  all[static_cast<std::size_t>(kCells * kSide + kCells)] = 77;
  EXPECT_NE(put({0, 0}, tile(all, {0, 0}, settings)).find("differ"), std::string::npos);
  EXPECT_EQ(refusal([&] { terrain.edit([](auto& editor) {
                            editor.remove({2, 2});
                          }); }),
            "tiles: (2, 2): there is no tile to remove");
  EXPECT_EQ(terrain.read().epoch(), 2u);
  EXPECT_FALSE(terrain.read().tile({0, 0}));
  EXPECT_EQ(refusal([] { TiledTerrain({.cols = 0}); }),
            "tiles: the number of columns of tiles is 0; it must be 1 to 65536");
  EXPECT_NE(refusal([] { TiledTerrain({.cols = 60000, .cell_cols = 1000}); }), "");
  EXPECT_NE(refusal([] { TiledTerrain({.ground = {.wrap = Wrap::periodic}}); }), "");
  EXPECT_NE(refusal([] { TiledTerrain({.ground = {.solid = true}}); }), "");
}

}  // namespace
}  // namespace scarp
