// SPDX-License-Identifier: MIT
// Queries by rules: masks, sides, filters and materials of cells, over all kinds of objects.
#include "scarp/scene/scene_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/ext/matrix_transform.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/refusal.h"
#include "scarp/scarp.h"
#include "scarp/scene/live_scene.h"
#include "scarp/scene/tiled_terrain.h"

namespace scarp::test {
namespace {

constexpr std::uint32_t kGround = 1, kTower = 2;

HeightField flat(int cells, double height) {
  const auto side = static_cast<std::size_t>(cells + 1);
  return HeightField::own(std::vector<float>(side * side, static_cast<float>(height)), cells + 1, cells + 1);
}

// Voxels 4 x 4 x 4 on ground of 16 x 16 m at 0.
class TowerOnGround : public testing::Test {
 protected:
  static std::shared_ptr<const VoxelModel> model(std::string_view march,
                                                 const std::function<bool(const ivec3&)>& solid) {
    VoxelGrid grid = VoxelGrid::built({4, 4, 4}, 8, [&](const ivec3&, std::span<std::uint32_t, 64>) {
      std::uint64_t mask = 0;
      for (int i = 0; i < 64; ++i) {
        const ivec3 voxel(i % 4, i / 4 % 4, i / 16);
        if (solid(voxel)) mask |= std::uint64_t{1} << VoxelGrid::bit_of(voxel);
      }
      return mask;
    });
    return std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march(march));
  }
  static std::shared_ptr<const VoxelModel> cube() {
    return model("voxel-bricks", [](const ivec3&) { return true; });
  }
  const Scene scene_ = combine({{Terrain(flat(16, 0))}, {tower(), {.origin = {6, 6, 0}}, {}, kTower}});
  static Scene tower() { return Scene(scene_voxels({.models = {cube()}, .places = {{}}})); }
  const Ray down_{{8.5, 8.5, 10}, {0, 0, -1}};
};

TEST_F(TowerOnGround, IsVisibleOnlyThroughItsMask) {
  EXPECT_EQ(scene_.closest_hit(down_).t, 6);
  EXPECT_EQ(scene_.query({}).closest_hit(down_).t, 6);
  EXPECT_EQ(scene_.query({.mask = kGround}).closest_hit(down_).t, 10);
  EXPECT_EQ(scene_.query({.mask = kTower}).closest_hit(down_).object, 1u);
  const Ray beside{{1, 1, 10}, {0, 0, -1}};
  EXPECT_FALSE(scene_.query({.mask = kTower}).closest_hit(beside));
  EXPECT_FALSE(scene_.query({.mask = kTower}).occluded(beside));
  EXPECT_TRUE(scene_.query({.mask = kGround}).occluded(beside));
}

TEST_F(TowerOnGround, BatchesMatchSingleRays) {
  std::vector<Ray> rays;
  for (int i = 0; i < 3000; ++i)
    rays.push_back({{i % 55 * 0.3, i / 55 * 0.3, 9}, {0.01 * (i % 7), -0.02 * (i % 5), -1.0 + i % 3}});
  const auto odd = [](const Ray&, const Hit& hit) { return (hit.cell.col + hit.voxel.x + hit.voxel.z) % 2 != 0; };
  for (const SceneRules& rules : {SceneRules{}, SceneRules{.mask = kGround}, SceneRules{.mask = kTower},
                                  SceneRules{.sides = Sides::both}, SceneRules{.accept = odd}}) {
    const SceneQuery query = scene_.query(rules);
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> blocked(rays.size());
    query.closest_hits(rays, hits);
    query.occluded(rays, blocked);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(hits[i], query.closest_hit(rays[i]));
      ASSERT_EQ(blocked[i] != 0, hits[i].status == HitStatus::hit);
      ASSERT_EQ(query.occluded(rays[i]), blocked[i] != 0);
    }
  }
}

TEST_F(TowerOnGround, PassesVoxelsRejectedByTheFilter) {
  const auto layer = [](int lowest) {
    return [lowest](const Ray&, const Hit& hit) { return hit.object == 0 || hit.voxel.z < lowest; };
  };
  for (int lowest = 0; lowest <= 4; ++lowest) {
    const Hit hit = scene_.query({.accept = layer(lowest)}).closest_hit(down_);
    EXPECT_EQ(hit.t, 10 - lowest);
    EXPECT_EQ(hit.object, lowest > 0 ? 1u : 0u);
    if (lowest > 0) {
      EXPECT_EQ(hit.face, VoxelFace::high_z);
    }
  }
}

TEST_F(TowerOnGround, PassesRoundedVoxelsRejectedByTheFilter) {
  for (const bool each : {false, true}) {
    const Scene rounded(scene_voxels({.models = {cube()}, .places = {{}}, .rounding = {.radius = 0.25, .each = each}}));
    const auto low = [](const Ray&, const Hit& hit) { return hit.voxel.z < 2; };
    const Hit hit = rounded.query({.accept = low}).closest_hit({{1.5, 1.5, 10}, {0, 0, -1}});
    EXPECT_EQ(hit.t, 8);
    EXPECT_EQ(hit.voxel, ivec3(1, 1, 1));
  }
}

// The path through the voxels does not depend on the filter: rejected voxels count as empty.
TEST_F(TowerOnGround, TreatsRejectedVoxelsAsEmpty) {
  const auto counts = [](const ivec3& v) { return (v.x * 5 + v.y * 3 + v.z * 7) % 4 == 0; };
  const Scene expected(scene_voxels({.models = {model("voxel-planes", counts)}, .places = {{}}}));
  const Scene all = tower();
  const SceneQuery query = all.query({.accept = [&](const Ray&, const Hit& hit) { return counts(hit.voxel); }});
  int hits = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double a = 0.37 * i, b = 0.11 * i;
    const dvec3 from(2 + 6 * std::sin(a), 2 + 6 * std::cos(a), 2 + 5 * std::sin(b));
    const Ray ray{from, dvec3(2 + 2 * std::sin(1.7 * i), 2 + 2 * std::cos(2.3 * i), 2 + 2 * std::sin(3.1 * i)) - from};
    const Hit hit = query.closest_hit(ray), other = expected.closest_hit(ray);
    ASSERT_EQ(hit.status, other.status) << i;
    if (!hit) continue;
    ASSERT_EQ(hit.voxel, other.voxel) << i;
    ASSERT_EQ(hit.face, other.face) << i;
    ASSERT_NEAR(hit.t, other.t, 1e-5);  // quantised where it enters a box, which differs
    ++hits;
  }
  EXPECT_GT(hits, 5000);
}

TEST_F(TowerOnGround, OnlyTheGroundIsHitFromBelow) {
  const Ray up{{1.5, 1.5, -5}, {0, 0, 1}};
  EXPECT_FALSE(scene_.closest_hit(up));
  for (const Sides sides : {Sides::below, Sides::both}) {
    const Hit hit = scene_.query({.sides = sides}).closest_hit(up);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit.t, 5);
    EXPECT_TRUE(scene_.query({.sides = sides}).occluded(up));
  }
  const SceneQuery both = scene_.query({.sides = Sides::both});
  const Hit hit = both.closest_hit(up);
  EXPECT_FALSE(both.closest_hit({up.at(hit.t), up.direction}, &hit));
  const Scene judge = scene_.judge();
  EXPECT_EQ(judge.query({.sides = Sides::both}).closest_hit(up).t, 5);
}

TEST_F(TowerOnGround, RejectsRulesThatSelectNothing) {
  EXPECT_EQ(refusal([&] { scene_.query({.mask = 12}); }),
            "scene: mask 0xc is that of no object (together they have 0x3)");
  EXPECT_NE(refusal([&] { scene_.query({.mask = 0}); }), "");
  EXPECT_EQ(refusal([&] {
              combine({{Terrain(flat(2, 0)), {}, {}, 0}});
            }),
            "scene: object 0: its mask is 0, so no query would see it");
  const Scene nothing({}, {});
  EXPECT_EQ(refusal([&] { nothing.query({.mask = 1}); }), "");
}

TEST(SceneRules, RequireMarchesThatSupportThem) {
  const Scene naive(scene_heights(flat(4, 0), find_height_march("naive")));
  const Ray down{{2, 2, 1}, {0, 0, -1}};
  EXPECT_EQ(refusal([&] { naive.query({.sides = Sides::both}).closest_hit(down); }),
            "scene: the march naive has hits from above only, without a filter (use max-mip)");
  EXPECT_TRUE(naive.query({.mask = 1}).closest_hit(down));
}

TEST(SceneRules, ApplyAcrossTiles) {
  TiledTerrain terrain({.cols = 2, .rows = 1, .cell_cols = 8, .cell_rows = 8});
  terrain.edit([](TiledTerrain::Editor& editor) {
    editor.put({0, 0}, flat(8, 0), std::make_shared<const std::vector<std::uint8_t>>(64, std::uint8_t{7}));
    editor.put({1, 0}, flat(8, 0));
  });
  const TerrainTiles tiles = terrain.read();
  const Scene& scene = tiles.scene();
  // Through the seam from below, and from above.
  for (int i = 0; i < 1000; ++i) {
    const double x = 8 + 0.7 * std::sin(i), y = 4 + 3 * std::cos(i);
    const Ray up{{x, y, -2}, {8 - x, 0.01 * i, 2}}, down{{x, y, 2}, {8 - x, 0.01 * i, -2}};
    const bool inside = y + 0.01 * i <= 8;
    ASSERT_EQ(scene.query({.sides = Sides::both}).closest_hit(up).status == HitStatus::hit, inside) << i;
    ASSERT_EQ(scene.query({.sides = Sides::below}).closest_hit(up).status == HitStatus::hit, inside) << i;
    ASSERT_EQ(scene.query({.sides = Sides::both}).closest_hit(down).status == HitStatus::hit, inside) << i;
  }
  const Ray west{{4.5, 4.5, 1}, {0, 0, -1}}, east{{12.5, 4.5, 1}, {0, 0, -1}};
  EXPECT_EQ(scene.material(west, scene.closest_hit(west)), 7u);
  EXPECT_EQ(scene.material(east, scene.closest_hit(east)), 0u);
  const auto in_east = [](const Ray&, const Hit& hit) { return hit.part == 1; };
  EXPECT_FALSE(scene.query({.accept = in_east}).closest_hit(west));
  EXPECT_TRUE(scene.query({.accept = in_east}).closest_hit(east));
  EXPECT_EQ(refusal([&] {
              terrain.edit([](TiledTerrain::Editor& editor) {
                editor.remove({1, 0});
                editor.put({1, 0}, flat(8, 0), std::make_shared<const std::vector<std::uint8_t>>(63));
              });
            }),
            "heights: 63 materials for 8 x 8 cells (one for each cell)");
}

TEST(CellMaterials, BelongToHitsAndSurviveEdits) {
  Terrain terrain(flat(4, 0));
  std::vector<std::uint8_t> materials(16);
  for (std::size_t i = 0; i < materials.size(); ++i) materials[i] = static_cast<std::uint8_t>(200 + i);
  EXPECT_NE(refusal([&] { terrain.set_materials(std::vector<std::uint8_t>(15)); }), "");
  terrain.set_materials(materials);
  const auto material = [](const Scene& scene, int col, int row) {
    const Ray ray{{col + 0.5, 3.5 - row, 5}, {0, 0, -1}};
    const Hit hit = scene.closest_hit(ray);
    EXPECT_EQ(scene.surface(ray, hit).material, scene.material(ray, hit));
    return scene.material(ray, hit);
  };
  EXPECT_EQ(material(terrain, 0, 0), 200u);
  EXPECT_EQ(material(terrain, 3, 2), 211u);
  EXPECT_EQ(material(terrain.scene().judge(), 3, 2), 211u);
  const float high = 2;
  terrain.set_samples({1, 1, 1, 1}, &high);
  EXPECT_EQ(material(terrain, 3, 2), 211u);
  // A filter by material: a pond that rays pass through.
  const Scene& scene = terrain.scene();
  const SceneQuery dry =
      scene.query({.accept = [&](const Ray& ray, const Hit& hit) { return scene.material(ray, hit) != 211; }});
  EXPECT_FALSE(dry.closest_hit({{3.5, 1.5, 5}, {0, 0, -1}}));
  EXPECT_TRUE(dry.closest_hit({{3.5, 2.5, 5}, {0, 0, -1}}));
  terrain.set_materials({});
  EXPECT_EQ(material(terrain, 3, 2), 0u);
}

TEST(CellMaterials, PersistInALiveScene) {
  HeightField field = flat(4, 0);
  const auto seven = std::make_shared<const std::vector<std::uint8_t>>(16, std::uint8_t{7});
  LiveScene live{Scene(scene_heights(field, MaxPyramid(field), seven))};
  const Ray ray{{2.5, 2.5, 5}, {0, 0, -1}};
  const auto material = [&] {
    const auto reading = live.read();
    return reading.scene().material(ray, reading.scene().closest_hit(ray));
  };
  EXPECT_EQ(material(), 7u);
  const float high = 2;
  live.edit([&](LiveScene::Editor& editor) {
    field.set_samples({1, 1, 1, 1}, &high, 1);
    editor.set_mask(0, 4);
  });
  EXPECT_EQ(material(), 7u);
  const auto reading = live.read();
  EXPECT_TRUE(reading.scene().query({.mask = 4}).closest_hit(ray));
  EXPECT_NE(refusal([&] { reading.scene().query({.mask = 1}); }), "");
}

TEST_F(TowerOnGround, IsFoundBySweeps) {
  const SceneQuery all = scene_.query({});
  const Capsule ball{{8, 8, 10}, {8, 8, 10}, 0.5};
  const auto on_tower = all.sweep(ball, {0, 0, -10});
  ASSERT_TRUE(on_tower);
  EXPECT_DOUBLE_EQ(on_tower->t, 0.55);
  EXPECT_EQ(on_tower->object, 1u);
  EXPECT_EQ(on_tower->place.voxel.z, 3);
  EXPECT_EQ(on_tower->normal, dvec3(0, 0, 1));
  const auto on_ground = scene_.query({.mask = kGround}).sweep(ball, {0, 0, -10});
  ASSERT_TRUE(on_ground);
  EXPECT_DOUBLE_EQ(on_ground->t, 0.95);
  EXPECT_EQ(on_ground->object, 0u);
  EXPECT_FALSE(all.sweep(ball, {0, 0, -5}));
}

TEST_F(TowerOnGround, IsFoundByBoxesAndClosestPoints) {
  const SceneQuery all = scene_.query({});
  EXPECT_TRUE(all.overlaps({{8, 8, 4.5}, {1, 1, 1}}));
  EXPECT_FALSE(all.overlaps({{8, 8, 6}, {1, 1, 1}}));
  EXPECT_TRUE(scene_.query({.mask = kTower}).overlaps({{8, 8, 1}, {0.1, 0.1, 0.1}}));
  EXPECT_FALSE(scene_.query({.mask = kGround}).overlaps({{8, 8, 1}, {0.1, 0.1, 0.1}}));
  const auto top = all.closest_point({8.3, 8.4, 6});
  ASSERT_TRUE(top);
  EXPECT_EQ(top->distance, 2);
  EXPECT_EQ(top->point, dvec3(8.3, 8.4, 4));
  EXPECT_EQ(top->object, 1u);
  EXPECT_EQ(all.closest_point({1, 1, 0.5})->object, 0u);
  EXPECT_FALSE(all.closest_point({8.3, 8.4, 6}, 1.9));
  EXPECT_EQ(all.closest_point({8.3, 8.4, 2})->distance, 0);
}

// Contacts do not depend on the position of the whole scene.
TEST(Contacts, MoveWithTheScene) {
  const HeightField hills =
      HeightField::own(std::vector<float>{0, 1, 0, 2, 3, 1, 0, 0, 1}, 3, 3, {.surface = Surface::triangles});
  const Scene still{scene_heights(hills)};
  const Placement place{glm::dmat3(glm::rotate(glm::dmat4(1), 0.7, dvec3(1, 2, 3))), 2.5, {10, -20, 30}};
  const Scene moved = combine({{still, place}});
  int contacts = 0;
  for (int i = 0; i < 2000; ++i) {
    const dvec3 a(1 + 2 * std::sin(i), 1 + 2 * std::cos(2.3 * i), 3 + std::sin(3.1 * i)),
        to(1 + std::sin(1.7 * i), 1 + std::sin(0.3 * i), 0.5);
    const Capsule own{a, a + dvec3(0.3, 0.1, 0.2), 0.05 + 0.04 * std::sin(i)};
    const Capsule placed_capsule{place.world_from_field(own.a), place.world_from_field(own.b), 2.5 * own.radius};
    const auto expected = still.query({}).sweep(own, to - a);
    const auto found = moved.query({}).sweep(placed_capsule, place.world_from_field(to) - place.world_from_field(a));
    ASSERT_EQ(found.has_value(), expected.has_value()) << i;
    if (!found) continue;
    ++contacts;
    ASSERT_NEAR(found->t, expected->t, 1e-9);
    ASSERT_NEAR(length(found->point - place.world_from_field(expected->point)), 0, 1e-6);
    const TurnedBox box{a, {0.4, 0.3, 0.9}};
    ASSERT_EQ(moved.query({}).overlaps({place.world_from_field(a), 2.5 * box.half, place.turn}),
              still.query({}).overlaps(box));
  }
  EXPECT_GT(contacts, 300);
}

TEST(Contacts, OnTilesMatchOneField) {
  TiledTerrain terrain(
      {.cols = 3, .rows = 2, .cell_cols = 4, .cell_rows = 4, .ground = {.surface = Surface::triangles}});
  const auto height = [](int col, int row) { return static_cast<float>((col * 7 + row * 5) % 4); };
  const auto field_from = [&](int col, int row, int cols, int rows) {
    std::vector<float> samples;
    for (int r = row; r < row + rows; ++r) {
      for (int c = col; c < col + cols; ++c) samples.push_back(height(c, r));
    }
    return HeightField::own(std::move(samples), cols, rows, {.surface = Surface::triangles});
  };
  terrain.edit([&](TiledTerrain::Editor& editor) {
    for (int i = 0; i < 6; ++i) editor.put({i % 3, i / 3}, field_from(i % 3 * 4, i / 3 * 4, 5, 5));
  });
  const TerrainTiles tiles = terrain.read();
  const Scene whole{scene_heights(field_from(0, 0, 13, 9))};
  for (int i = 0; i < 2000; ++i) {
    const dvec3 a(6 + 5 * std::sin(i), 4 + 3 * std::cos(2.3 * i), 6),
        b(6 + 5 * std::sin(1.3 * i), 4 + 3 * std::cos(0.7 * i), 0);
    const Capsule ball{a, a, 0.3};
    const auto found = tiles.scene().query({}).sweep(ball, b - a), expected = whole.query({}).sweep(ball, b - a);
    ASSERT_EQ(found.has_value(), expected.has_value());
    if (found) {
      ASSERT_NEAR(found->t, expected->t, 1e-12);
    }
    ASSERT_NEAR(tiles.scene().query({}).closest_point(a)->distance, whole.query({}).closest_point(a)->distance, 1e-12);
    ASSERT_EQ(tiles.scene().query({}).overlaps({b, {0.5, 0.5, 1}}), whole.query({}).overlaps({b, {0.5, 0.5, 1}}));
  }
}

TEST(Contacts, AreRejectedForUnsupportedFields) {
  const Scene mixed = combine(
      {{Terrain(flat(4, 0))}, {Scene(scene_shape(DistanceField(make_shape(shape::Sphere{.radius = 9})))), {}, {}, 2}});
  const Capsule ball{{2, 2, 2}, {2, 2, 2}, 1};
  EXPECT_EQ(refusal([&] {
              mixed.query({}).sweep(ball, {0, 0, -3});
            }),
            "scene: contacts support height fields, tiles and voxels, not a shape (exclude it by its mask)");
  EXPECT_TRUE(mixed.query({.mask = 1}).sweep(ball, {0, 0, -3}));
  EXPECT_NE(refusal([&] { mixed.query({.mask = 1}).overlaps({{}, {-1, 1, 1}}); }), "");
}

}  // namespace
}  // namespace scarp::test
