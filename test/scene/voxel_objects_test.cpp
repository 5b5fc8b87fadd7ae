// SPDX-License-Identifier: MIT
#include "scarp/scene/voxel/voxel_objects.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "base/refusal.h"
#include "scarp/base/error.h"
#include "scarp/scene/file/from_vox.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/voxel_entry.h"

namespace scarp {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

dvec3 direction(Random& random) {
  for (;;) {
    const dvec3 d(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
    if (dot(d, d) > 0.01 && dot(d, d) < 1) return normalize(d);
  }
}

std::shared_ptr<const VoxelModel> model(int size, double share, std::string_view march, Random& random) {
  VoxelGrid grid(ivec3(size), 8);
  grid.edit(grid.box(), [&](const ivec3&, const VoxelGrid::Voxel&) {
    return uniform(random, 0, 1) < share ? VoxelGrid::Voxel(1 + random() % 255) : VoxelGrid::Voxel();
  });
  return std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march(march));
}

glm::dmat3 turned(Random& random, double scale) {
  return glm::dmat3(glm::rotate(glm::dmat4(1), uniform(random, 0, 6), direction(random))) * scale;
}

// Each object separately, by the march that tests every voxel along the ray.
Hit one_by_one(std::vector<std::shared_ptr<const VoxelModel>> models, const std::vector<VoxelPlace>& places,
               const Ray& ray) {
  for (auto& model : models)
    model = std::make_shared<const VoxelModel>(model->grid(), find_voxel_march("voxel-exhaustive"));
  Hit best;
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    const VoxelObjects alone({models, {places[i]}});
    const Hit hit = alone.closest_hit(ray);
    if (hit && (!best || hit.t < best.t)) best = hit, best.part = i;
  }
  return best;
}

// A hundred thousand objects with a thousand grids, rotated and scaled: those near each ray are tested one by one.
TEST(VoxelObjects, FindsTheNearestOfAHundredThousand) {
  constexpr int kModels = 1000, kObjects = 100'000, kRays = 100;
  constexpr double kSide = 300;              // of the cube that contains them
  constexpr double kRounding = 1 + 0x1p-30;  // of a distance, generously
  Random random(4);
  std::vector<std::shared_ptr<const VoxelModel>> models;
  for (int i = 0; i < kModels; ++i) models.push_back(model(2 + i % 4, 0.5, "voxel-bricks", random));
  std::vector<VoxelPlace> places;
  std::vector<double> radii;
  for (int i = 0; i < kObjects; ++i) {
    const double scale = uniform(random, 0.1, 1.5);
    places.push_back({static_cast<std::uint32_t>(i % kModels),
                      turned(random, scale),
                      {uniform(random, 0, kSide), uniform(random, 0, kSide), uniform(random, 0, kSide)}});
    radii.push_back(scale * length(dvec3(models[places.back().model]->grid().size())));
  }
  const VoxelObjects scene({models, places});
  std::vector<Ray> rays(kRays);
  for (Ray& ray : rays) {
    ray.origin = {uniform(random, 0, kSide), uniform(random, 0, kSide), uniform(random, 0, kSide)};
    ray.direction = direction(random);
  }
  std::vector<Hit> found(kRays);
  scene.closest_hits(rays, found);
  int hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    std::vector<VoxelPlace> near;
    std::vector<std::shared_ptr<const VoxelModel>> of_near;
    std::vector<std::uint32_t> index;
    for (std::uint32_t k = 0; k < kObjects; ++k) {
      const dvec3 to = places[k].origin - ray.origin;
      if (length(to - std::max(0.0, dot(to, ray.direction)) * ray.direction) > kRounding * radii[k]) continue;
      near.push_back(places[k]);
      near.back().model = static_cast<std::uint32_t>(of_near.size());
      of_near.push_back(models[places[k].model]);
      index.push_back(k);
    }
    const Hit expected = one_by_one(of_near, near, ray);
    ASSERT_EQ(static_cast<bool>(found[i]), static_cast<bool>(expected));
    ASSERT_EQ(scene.occluded(ray), static_cast<bool>(expected));
    if (!expected) continue;
    ++hits;
    EXPECT_EQ(found[i].part, index[expected.part]);
    EXPECT_EQ(found[i].voxel, expected.voxel);
    EXPECT_EQ(scene.closest_hit(ray), found[i]);
  }
  EXPECT_GT(hits, kRays / 2);
}

// Lengths are powers of two and components eighths of them, so that nothing is rounded for any length of the direction.
TEST(VoxelObjects, AcceptsDirectionsOfAnyLength) {
  Random random(3);
  const auto models = std::vector{model(8, 0.2, "voxel-bricks", random), model(5, 0.5, "voxel-cubes", random)};
  const VoxelObjects scene({models, {VoxelPlace{0, turned(random, 0.5), {2, 1, 0}}, VoxelPlace{1}}});
  const auto eighths = [&] { return static_cast<double>(static_cast<int>(random() % 17) - 8) / 8; };
  int hits = 0;
  for (const int exponent : {-1071, -1030, -1015, -600, -450, 450, 600, 1000, 1023}) {
    std::vector<Ray> usual(100), extreme;
    for (Ray& ray : usual) {
      const dvec3 at(uniform(random, 0, 5), uniform(random, 0, 5), uniform(random, 0, 5));
      ray.direction = {eighths(), eighths(), eighths()};
      if (ray.direction == dvec3(0.0)) ray.direction.x = -0.125;
      ray.origin = at - 32.0 * ray.direction;
      extreme.push_back(ray);
      for (int axis = 0; axis < 3; ++axis) extreme.back().direction[axis] = std::ldexp(ray.direction[axis], exponent);
    }
    std::vector<Hit> found(usual.size());
    std::vector<std::uint8_t> blocked(usual.size());
    scene.closest_hits(extreme, found);
    scene.occluded(extreme, blocked);
    for (std::size_t i = 0; i < usual.size(); ++i) {
      Hit expected = scene.closest_hit(usual[i]);
      expected.t = std::ldexp(expected.t, -exponent);
      if (std::isinf(expected.t)) expected = {};  // farther than doubles reach
      for (const Hit& hit : {scene.closest_hit(extreme[i]), found[i]}) {
        EXPECT_EQ(hit, expected) << exponent;
      }
      EXPECT_EQ(blocked[i], static_cast<bool>(expected));
      EXPECT_EQ(scene.occluded(extreme[i]), static_cast<bool>(expected));
      hits += expected ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 300);
  Ray none;
  none.direction = dvec3(0.0);
  EXPECT_FALSE(scene.closest_hit(none));
  EXPECT_FALSE(scene.occluded(none));
}

TEST(VoxelObjects, FindsTheNearestOfRotatedOverlappingObjects) {
  Random random(1);
  int hits = 0;
  for (int round = 0; round < 20; ++round) {
    const std::vector models = {model(8, 0.2, "voxel-bricks", random), model(5, 0.5, "voxel-cubes", random),
                                model(3, 0.9, "voxel-octants", random)};
    std::vector<VoxelPlace> places;
    for (int i = 0; i < 25; ++i) {
      const double scale = round % 2 ? 1 : uniform(random, 0.1, 3);
      const dvec3 at(uniform(random, -20, 20), uniform(random, -20, 20), uniform(random, -20, 20));
      places.push_back({static_cast<std::uint32_t>(i % 3), i % 4 ? turned(random, scale) : glm::dmat3(1.0), at});
    }
    const VoxelObjects scene({models, places});
    for (int i = 0; i < 40; ++i) {
      Ray ray;
      ray.direction = direction(random) * uniform(random, 0.1, 10);
      ray.origin = dvec3(uniform(random, -30, 30), uniform(random, -30, 30), uniform(random, -30, 30));
      const Hit expected = one_by_one(models, places, ray), hit = scene.closest_hit(ray);
      ASSERT_EQ(static_cast<bool>(hit), static_cast<bool>(expected));
      ASSERT_EQ(scene.occluded(ray), static_cast<bool>(expected));
      if (!hit) continue;
      ++hits;
      // The object is the same; t up to that of a ray quantised at its entry, regardless of the rest of the scene.
      ASSERT_EQ(hit, expected);
      EXPECT_NEAR(length(scene.normal(ray, hit)), hit.face == VoxelFace::inside ? 0 : 1, 1e-12);
      EXPECT_LE(dot(scene.normal(ray, hit), ray.direction), hit.face == VoxelFace::inside ? 0.0 : 1e-12);
    }
  }
  EXPECT_GT(hits, 100);
}

TEST(VoxelObjects, HitsObjectsAMillionMetresAway) {
  Random random(2);
  VoxelPlace place{0, turned(random, 0.25), dvec3(1e6, -2e6, 3e6)};
  VoxelGrid grid(ivec3(9), 1);
  grid.fill(grid.box(), 1);
  const VoxelObjects scene({{std::make_shared<const VoxelModel>(grid, find_voxel_march("voxel-bricks"))}, {place}});
  Ray ray;
  ray.direction = place.world_from_grid * dvec3(4.5) + place.origin;
  const Hit hit = scene.closest_hit(ray);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit.t, 1, 1e-5);
}

// A shadow ray starts in the empty voxel in front of the face, given by index, and is not blocked by the voxel that it
// leaves.
TEST(VoxelObjects, ShadowRaysDoNotHitTheirStart) {
  Random random(3);
  VoxelGrid grid(ivec3(40), 1);
  grid.fill_sphere(dvec3(20), 19.5, 1);
  const VoxelObjects scene({{std::make_shared<const VoxelModel>(grid, find_voxel_march("voxel-bricks"))},
                            {VoxelPlace{0, turned(random, 0.1), dvec3(100)}}});
  const dvec3 middle = 0.5 * (scene.box().low + scene.box().high);
  int free = 0;
  for (int i = 0; i < 2000; ++i) {
    Ray ray;
    ray.direction = direction(random);
    ray.origin = middle - 10.0 * ray.direction;
    const Hit hit = scene.closest_hit(ray);
    ASSERT_TRUE(hit);
    // Straight out of the ball: nothing blocks the ray.
    Ray out;
    out.origin = ray.at(hit.t);
    out.direction = scene.normal(ray, hit);
    free += scene.occluded_from(hit, out) ? 0 : 1;
  }
  EXPECT_EQ(free, 2000);
}

// Both cubes and rounded voxels: a ray into the solid hits at once, also by any-hit; one by one and in batches.
TEST(VoxelObjects, RaysIntoTheirSurfaceHitAtOnce) {
  // Shallower rays, as quantised, may leave a cube's face across an edge: those that do not reach its plane within the
  // displacement of 2^-17 voxel (voxel_ray.h).
  constexpr double kSteep = 0.01, kOffRay = 0x1p-17 / kSteep;
  Random random(5);
  VoxelGrid grid(ivec3(12), 4);
  grid.edit(grid.box(), [&](const ivec3&, const VoxelGrid::Voxel&) {
    return uniform(random, 0, 1) < 0.3 ? VoxelGrid::Voxel(1 + random() % 15) : VoxelGrid::Voxel();
  });
  const std::vector places = {VoxelPlace{0, turned(random, 0.5), dvec3(3)}};
  const std::vector models = {std::make_shared<const VoxelModel>(grid, find_voxel_march("voxel-bricks"))};
  for (const VoxelRounding& rounding : std::vector<VoxelRounding>{{}, {0.1, false}, {0.5, false}, {0.3, true}}) {
    const VoxelObjects scene({models, places, rounding});
    const dvec3 middle = 0.5 * (scene.box().low + scene.box().high);
    std::vector<Hit> first;
    std::vector<Ray> rays;
    std::vector<dvec3> normals;
    for (int i = 0; i < 2000; ++i) {
      Ray ray;
      ray.direction = direction(random);
      ray.origin = middle + direction(random) - 10.0 * ray.direction;
      const Hit hit = scene.closest_hit(ray);
      if (!hit) continue;
      Ray on;
      on.origin = ray.at(hit.t);
      on.direction = direction(random);
      first.push_back(hit), rays.push_back(on), normals.push_back(scene.normal(on.origin, hit));
    }
    std::vector<const Hit*> from;
    for (const Hit& hit : first) from.push_back(&hit);
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> blocked(rays.size());
    scene.closest_hits(rays, hits, from);
    scene.occluded(rays, blocked, from);
    int into = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit hit = scene.closest_hit(rays[i], from[i], nullptr);
      EXPECT_EQ(hit, hits[i]);
      EXPECT_EQ(static_cast<bool>(hit), scene.occluded_from(first[i], rays[i])) << rounding.radius << ' ' << i;
      EXPECT_EQ(static_cast<bool>(hit), blocked[i] != 0);
      if (!(dot(normals[i], rays[i].direction) < -kSteep)) continue;
      ++into;
      ASSERT_TRUE(hit) << rounding.radius << ' ' << i;
      EXPECT_LE(hit.t, kOffRay);
      if (!rounding) continue;
      EXPECT_EQ(hit.t, 0);
      EXPECT_EQ(hit.voxel, first[i].voxel);
    }
    EXPECT_GT(into, 500);
    // A ray that ends before its start hits nothing.
    Ray none = rays[0];
    none.direction = -normals[0];
    none.t_max = -1;
    EXPECT_FALSE(scene.closest_hit(none, from[0], nullptr));
    EXPECT_FALSE(scene.occluded_from(first[0], none));
  }
}

TEST(VoxelObjects, RejectsInvalidPlaces) {
  Random random(4);
  const std::vector models = {model(3, 0.5, "voxel-planes", random)};
  const auto refused = [&](const VoxelPlace& place) { EXPECT_THROW(VoxelObjects({models, {place}}), Error); };
  refused({1, glm::dmat3(1.0), dvec3(0)});
  refused({0, glm::dmat3(0.0), dvec3(0)});
  refused({0, glm::dmat3(1, 0, 0, 0, 2, 0, 0, 0, 1), dvec3(0)});
  refused({0, glm::dmat3(1, 0, 0, 1, 1, 0, 0, 0, 1), dvec3(0)});
  refused({0, glm::dmat3(1.0), dvec3(std::nan(""))});
  EXPECT_EQ(test::refusal([&] { VoxelObjects({{models[0], nullptr}, {}}); }), "voxels: model 1 is null");
  EXPECT_FALSE(VoxelObjects(PlacedVoxels{}).closest_hit(Ray{}));
}

TEST(VoxelModel, FollowsEdits) {
  for (const VoxelMarchEntry& march : voxel_marches()) {
    VoxelModel model(VoxelGrid(ivec3(20), 8), march);
    EXPECT_TRUE(model.box().empty());
    model.edit([](VoxelGrid& grid) { return grid.fill({{5, 5, 5}, {9, 9, 9}}, 3); });
    model.edit([](VoxelGrid& grid) { return grid.clear(VoxelBox{{5, 5, 8}, {9, 9, 9}}); });
    VoxelRay ray;
    ray.origin = {6.5, 6.5, 30};
    const auto quantised = quantise(ray, model.box());
    ASSERT_TRUE(quantised);
    const VoxelHit hit = march.cpu(model.target(), *quantised, nullptr);
    ASSERT_TRUE(hit) << march.name;
    EXPECT_EQ(hit.voxel, ivec3(6, 6, 7));
    EXPECT_EQ(hit.t, 22);
    EXPECT_EQ(model.colour(hit.entry), (VoxelColour{3, 0, 0}));
  }
}

TEST(VoxelModel, MatchesItsGridAfterAThrowingEdit) {
  for (const VoxelMarchEntry& march : voxel_marches()) {
    VoxelModel model(VoxelGrid(ivec3(20), 8), march);
    EXPECT_THROW(model.edit([](VoxelGrid& grid) {
      grid.fill({{5, 5, 5}, {9, 9, 9}}, 3);
      return grid.set({0, 0, 0}, 256);
    }),
                 Error);
    VoxelRay ray;
    ray.origin = {6.5, 6.5, 30};
    const auto quantised = quantise(ray, model.box());
    ASSERT_TRUE(quantised) << march.name;
    EXPECT_EQ(march.cpu(model.target(), *quantised, nullptr).t, 21) << march.name;
  }
}

VoxFile two_cubes(int version) {
  VoxFile file;
  file.version = version;
  VoxModel red{{4, 4, 4}, {}}, green{{4, 4, 4}, {}};
  for (std::uint8_t i = 0; i < 64; ++i) {
    const auto x = static_cast<std::uint8_t>(i & 3), y = static_cast<std::uint8_t>(i >> 2 & 3),
               z = static_cast<std::uint8_t>(i >> 4);
    red.voxels.push_back({x, y, z, 1});
    green.voxels.push_back({x, y, z, 2});
  }
  file.models = {red, green};
  file.palette.emplace();
  (*file.palette)[0] = {255, 0, 0, 255};
  (*file.palette)[1] = {0, 255, 0, 255};
  file.nodes = {{0, {}, VoxGroup{{1, 3}}},
                {1, {}, VoxTransform{2, -1, -1, {{}}}},
                {2, {}, VoxShape{{{0, {}}}}},
                {3, {}, VoxTransform{4, -1, -1, {{{"_t", "2 0 0"}}}}},
                {4, {}, VoxShape{{{1, {}}}}}};
  return file;
}

TEST(FromVox, HitsHaveTheirPaletteEntry) {
  const Scene scene(scene_voxels(placed_voxels_from(two_cubes(200))));
  Ray down;
  down.origin = {-1.5, 0.5, 10}, down.direction = {0, 0, -1};
  const auto entry_at = [&](double x) {
    down.origin.x = x;
    return palette_entry(scene, scene.closest_hit(down));
  };
  EXPECT_EQ(entry_at(-1.5), 1u);
  EXPECT_EQ(entry_at(3.5), 2u);
  EXPECT_EQ(entry_at(50), std::nullopt);
  // Entries without a palette are colours.
  VoxelGrid grid({1, 1, 1}, 24);
  grid.set({0, 0, 0}, 0x0a0b0c);
  const auto coloured = std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-planes"));
  const Scene plain(scene_voxels(PlacedVoxels{.models = {coloured}, .places = {VoxelPlace{}}}));
  down.origin = {0.5, 0.5, 10};
  ASSERT_TRUE(plain.closest_hit(down));
  EXPECT_EQ(palette_entry(plain, plain.closest_hit(down)), std::nullopt);
}

// From version 200 on, the first of two overlapping voxels is visible; in earlier versions, the last.
TEST(FromVox, ShowsOneVoxelWhereTwoOverlap) {
  for (const int version : {150, 200}) {
    const VoxelObjects scene(placed_voxels_from(two_cubes(version)));
    EXPECT_EQ(scene.box().low, dvec3(-2)) << version;
    const auto colour_at = [&](double x) {
      Ray ray;
      ray.origin = {x, 0.5, 10};
      const Hit hit = scene.closest_hit(ray);
      EXPECT_TRUE(hit);
      EXPECT_EQ(hit.t, 8);
      return scene.colour(hit);
    };
    EXPECT_EQ(colour_at(-1.5), (VoxelColour{255, 0, 0}));
    EXPECT_EQ(colour_at(3.5), (VoxelColour{0, 255, 0}));
    EXPECT_EQ(colour_at(1.5), version == 200 ? (VoxelColour{255, 0, 0}) : (VoxelColour{0, 255, 0}));
  }
}

// All rotations of a model with odd and even sides: it stays within half a voxel of its pivot, voxel by voxel.
TEST(FromVox, PlacesRotatedVoxels) {
  for (int bits = 0; bits < 128; ++bits) {
    VoxFile file;
    file.version = 200;
    file.models = {{{3, 4, 2}, {{2, 0, 1, 9}}}};
    file.nodes = {{0, {}, VoxTransform{1, -1, -1, {{{"_t", "10 20 30"}, {"_r", std::to_string(bits)}}}}},
                  {1, {}, VoxShape{}}};
    std::vector<VoxInstance> instances;
    try {
      instances = vox_instances(file);
    } catch (const Error&) {
      continue;  // no rotation
    }
    const VoxelObjects scene(placed_voxels_from(file));
    const dvec3 middle = instances[0].turn(dvec3(2.5, 0.5, 1.5) - dvec3(1, 2, 1)) + dvec3(10, 20, 30);
    Ray ray;
    ray.origin = middle + dvec3(0, 0, 5);
    const Hit hit = scene.closest_hit(ray);
    ASSERT_TRUE(hit) << bits;
    EXPECT_EQ(hit.t, 4.5);
    EXPECT_EQ(hit.voxel, ivec3(0));  // of the only voxel
    EXPECT_EQ(scene.normal(ray, hit), dvec3(0, 0, 1));
  }
}

// This many models with the largest canvas, in a row, each with these voxels.
VoxFile canvases(int models, const std::vector<VoxVoxel>& voxels) {
  VoxFile file;
  file.version = 200;
  VoxGroup all;
  for (int i = 0; i < models; ++i) {
    file.models.push_back({ivec3(256), voxels});
    file.nodes.push_back({2 * i + 1, {}, VoxTransform{2 * i + 2, -1, -1, {{{"_t", fmt::format("{} 0 0", 300 * i)}}}}});
    file.nodes.push_back({2 * i + 2, {}, VoxShape{{{i, {}}}}});
    all.children.push_back(2 * i + 1);
  }
  file.nodes.insert(file.nodes.begin(), {0, {}, all});
  return file;
}

// 256^3 voxels take 2 MiB of masks alone: all of them together take less than one full canvas.
TEST(FromVox, MemoryDependsOnVoxelsNotOnModelSize) {
  const VoxelObjects scene(placed_voxels_from(canvases(500, {{200, 100, 255, 7}})));
  EXPECT_EQ(scene.objects(), 500u);
  EXPECT_LT(scene.bytes(), std::size_t{1} << 21);
  Ray down;
  down.origin = {300 * 499 + 200.5 - 128, 100.5 - 128, 500};
  const Hit hit = scene.closest_hit(down);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.part, 499u);
  EXPECT_EQ(down.at(hit.t).z, 128);
}

// Small files that need much memory are rejected before it is allocated.
TEST(FromVox, RejectsExcessiveFilesEarly) {
  const VoxFile wide = canvases(1025, {{0, 0, 0, 1}, {255, 255, 255, 1}});
  std::size_t bytes = 0;
  for (const auto& model : placed_voxels_from(wide).models) bytes += model->bytes();
  EXPECT_LT(bytes, wide.models.size() * 60'000);
  const std::string refusal = test::refusal([&] { placed_voxels_from(wide, {.voxels = {.march = "voxel-octants"}}); });
  EXPECT_NE(refusal.find("more than 1.1 GB of memory (choose --march voxel-bricks)"), std::string::npos) << refusal;
  // 46^3 instances, all within a fifth of their side of one another: too many pairs.
  constexpr int kAlong = 46;
  VoxFile pile = canvases(1, {{0, 0, 0, 1}, {255, 255, 255, 1}});
  VoxGroup all;
  for (int i = 0; i < kAlong * kAlong * kAlong; ++i) {
    const std::string move = fmt::format("{} {} {}", i % kAlong, i / kAlong % kAlong, i / (kAlong * kAlong));
    pile.nodes.push_back({i + 3, {}, VoxTransform{2, -1, -1, {{{"_t", move}}}}});
    all.children.push_back(i + 3);
  }
  pile.nodes.front().content = all;
  EXPECT_NE(test::refusal([&] { placed_voxels_from(pile); }).find("models overlap too much"), std::string::npos);
  // 2^18 instances of a voxel at one position, each group containing the next twice: one remains.
  constexpr int kGroups = 18;
  VoxFile heap = canvases(1, {{0, 0, 0, 1}});
  heap.nodes.clear();
  for (int i = 0; i < kGroups; ++i) heap.nodes.push_back({i, {}, VoxGroup{{i + 1, i + 1}}});
  heap.nodes.push_back({kGroups, {}, VoxShape{{{0, {}}}}});
  EXPECT_EQ(placed_voxels_from(heap).places.size(), 1u);
}

// Instances of one voxel side by side, in planes across each axis. By some axes alone there are more pairs than are
// examined. A plane has 2^kDoublings instances along either axis. In debug builds they are so few that no axis would be
// rejected: these builds only check memory accesses.
#ifdef NDEBUG
constexpr int kDoublings = 9;
#else
constexpr int kDoublings = 6;
#endif

TEST(FromVox, PlacesPlanesOfInstances) {
  for (int axis = 0; axis < 3; ++axis) {
    VoxFile file = canvases(1, {{0, 0, 0, 1}});
    file.nodes.clear();
    for (int i = 0; i < 2 * kDoublings; ++i) {
      ivec3 move(0);
      move[(axis + 1 + i / kDoublings) % 3] = 1 << (i % kDoublings);
      file.nodes.push_back({3 * i, {}, VoxGroup{{3 * i + 1, 3 * i + 2}}});
      file.nodes.push_back({3 * i + 1, {}, VoxTransform{3 * i + 3, -1, -1, {{}}}});
      file.nodes.push_back(
          {3 * i + 2,
           {},
           VoxTransform{3 * i + 3, -1, -1, {{{"_t", fmt::format("{} {} {}", move.x, move.y, move.z)}}}}});
    }
    file.nodes.push_back({2 * kDoublings * 3, {}, VoxShape{{{0, {}}}}});
    const VoxelObjects scene(placed_voxels_from(file));
    EXPECT_EQ(scene.objects(), std::size_t{1} << (2 * kDoublings));
    ivec3 size(1 << kDoublings);
    size[axis] = 1;
    EXPECT_EQ(scene.box().high - scene.box().low, dvec3(size));
  }
}

}  // namespace
}  // namespace scarp
