// SPDX-License-Identifier: MIT
// Single queries of every kind of field do not allocate, as doc/library/using.md says.
#include "allocations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "scarp/field/ground_points.h"
#include "scarp/scarp.h"
#include "scarp/scene/scene_query.h"
#include "scarp/scene/tiled_terrain.h"

namespace scarp::test {
namespace {

constexpr int kSide = 65;

template <class T>
std::vector<T> hills() {
  std::vector<T> samples;
  for (int i = 0; i < kSide * kSide; ++i)
    samples.push_back(static_cast<T>(20 + 8 * std::sin(i % kSide / 3.0) * std::cos(i / kSide / 4.0)));
  return samples;
}

template <class T>
Terrain terrain(const HeightFieldSettings& settings = {}) {
  return Terrain::own(hills<T>(), kSide, kSide, settings);
}

Voxels voxels() {
  std::vector<std::uint8_t> indices(32 * 32 * 32);
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = i * 2654435761u % 1000 < 40;
  return Voxels::copy(indices.data(), {32, 32, 32});
}

TiledTerrain& tiles() {
  static TiledTerrain tiled({.cols = 2, .rows = 2, .cell_cols = kSide - 1, .cell_rows = kSide - 1});
  static const bool filled = [] {
    const auto plain = HeightField::own(std::vector<float>(kSide * kSide, 20.0f), kSide, kSide);
    tiled.edit([&](TiledTerrain::Editor& editor) {
      for (int i = 0; i < 4; ++i) editor.put({i % 2, i / 2}, plain);
    });
    return true;
  }();
  EXPECT_TRUE(filled);
  return tiled;
}

// Calls query(i) for different places. When the thread has its working memory, none allocates.
template <class Query>
void expect_none(const std::string& what, const Query& query) {
  const auto all = [&] {
    for (int i = 0; i < 200; ++i) query(i);
  };
  all();
  EXPECT_EQ(allocations_of(all), 0) << what;
}

double place(int i) { return 1 + i * 7919 % 600 * 0.1; }

Ray ray_of(int i) {
  const double angle = i;
  return {.origin = {place(i), place(3 * i + 1), 45},
          .direction = {std::cos(angle), std::sin(angle), i % 3 == 0 ? -1 : -0.2}};
}

void expect_no_allocations(const std::string& name, const Scene& scene, double reach) {
  int hits = 0, touched = 0;
  expect_none(name + ": cast", [&](int i) {
    Ray ray = ray_of(i);
    ray.t_max = reach;
    const Hit hit = cast(scene, ray);
    hits += hit ? 1 : 0;
    if (hit) cast(scene, {.origin = ray.at(hit.t), .direction = {0.3, 0.1, 1}, .t_max = reach}, &hit);
  });
  EXPECT_GT(hits, 20) << name;
  expect_none(name + ": occluded", [&](int i) {
    Ray ray = ray_of(i);
    ray.t_max = reach;
    occluded(scene, ray);
  });
  expect_none(name + ": surface", [&](int i) {
    Ray ray = ray_of(i);
    ray.t_max = reach;
    if (const Hit hit = cast(scene, ray)) scene.surface(ray, hit);
  });
  expect_none(name + ": height", [&](int i) { scene.height(place(i), place(i + 1)); });
  if (std::isfinite(reach)) return;  // wrapped fields have no contacts
  const SceneQuery query = scene.query({});
  expect_none(name + ": query", [&](int) { scene.query({}); });
  expect_none(name + ": query with a mask", [&](int i) { scene.query({.mask = 1}).closest_hit(ray_of(i)); });
  expect_none(name + ": sweep", [&](int i) {
    const Ray ray = ray_of(i);
    touched += query.sweep({ray.origin, ray.origin, 0.5}, 30.0 * ray.direction) ? 1 : 0;
    touched += query.sweep({ray.origin, ray.origin - dvec3(0, 0, 1), 0.5}, {0, 0, -40}) ? 1 : 0;
  });
  EXPECT_GT(touched, 20) << name;
  expect_none(name + ": overlaps", [&](int i) { query.overlaps({{place(i), place(2 * i), 22}, {1, 1, 2}}); });
  expect_none(name + ": closest point", [&](int i) { query.closest_point({place(i), place(2 * i), 10.0 + i % 40}); });
}

TEST(Allocations, HeightFieldsDoNotAllocate) {
  const double far = std::numeric_limits<double>::infinity();
  expect_no_allocations("float", terrain<float>(), far);
  expect_no_allocations("int16", terrain<std::int16_t>(), far);
  expect_no_allocations("uint16", terrain<std::uint16_t>({.scale = 0.5}), far);
  expect_no_allocations("triangles", terrain<float>({.surface = Surface::triangles}), far);
  expect_no_allocations("solid", terrain<float>({.solid = true}), far);
  expect_no_allocations("wrapped", terrain<float>({.wrap = Wrap::periodic}), 100);
}

TEST(Allocations, TilesVoxelsAndScenesDoNotAllocate) {
  const double far = std::numeric_limits<double>::infinity();
  const Voxels solid = voxels();
  const TerrainTiles tiled = tiles().read();
  expect_no_allocations("tiles", tiled, far);
  expect_no_allocations("voxels", solid, far);
  expect_no_allocations("scene", combine({{terrain<float>()}, {solid, {.origin = {10, 20, 20}}}, {tiled}}), far);
}

TEST(Allocations, QueriesOfBothSidesDoNotAllocate) {
  const Terrain ground = terrain<float>();
  const SceneQuery both = ground.scene().query({.sides = Sides::both});
  expect_none("both sides", [&](int i) { both.closest_hit(ray_of(i)); });
  expect_none("both sides, occluded", [&](int i) { both.occluded(ray_of(i)); });
}

TEST(Allocations, PointsOfAFieldDoNotAllocate) {
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    const Terrain ground = terrain<float>({.surface = surface});
    const HeightField& field = ground.field();
    expect_none("height", [&](int i) { field.height(place(i), place(i + 1)); });
    expect_none("ground_point", [&](int i) { ground_point(field, place(i), place(i + 1)); });
    expect_none("normal", [&](int i) { field.normal({i % 60, i % 50}, 0.3, 0.6); });
  }
}

}  // namespace
}  // namespace scarp::test
