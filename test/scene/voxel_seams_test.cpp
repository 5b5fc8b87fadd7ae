// SPDX-License-Identifier: MIT
// Voxel objects that touch, in all orientations: no ray passes between them, and all agree with one grid into which
// the objects were written.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <string>
#include <vector>

#include "bench/voxel_scene_judge.h"
#include "cases.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/scene_field.h"
#include "scarp/scene/voxel/voxel_objects.h"

namespace scarp {
namespace {

const std::int64_t kScenes = test::cases(20'000, 1'000, 200);
constexpr int kRaysPerScene = 256;

// All 48 signed permutations.
std::vector<glm::dmat3> orientations() {
  std::vector<glm::dmat3> all;
  for (const auto& axis : {std::array{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}) {
    for (int signs = 0; signs < 8; ++signs) {
      glm::dmat3 turn(0.0);
      for (int k = 0; k < 3; ++k) turn[k][axis[static_cast<std::size_t>(k)]] = signs >> k & 1 ? -1 : 1;
      all.push_back(turn);
    }
  }
  return all;
}

std::shared_ptr<const VoxelModel> solid_model(const ivec3& size, std::string_view march) {
  VoxelGrid grid(size, 8);
  grid.fill(grid.box(), 1);
  return std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march(march));
}

// A model whose rotated grid starts at `low`.
VoxelPlace place_at(const dvec3& low, const glm::dmat3& turn, const ivec3& size) {
  const dvec3 far = turn * dvec3(size);
  return {0, turn, low - glm::min(far, dvec3(0.0))};
}

// Tested by every query.
bool blocks(const VoxelObjects& objects, const Ray& ray) {
  const bool blocked = static_cast<bool>(objects.closest_hit(ray));
  EXPECT_EQ(blocked, objects.occluded(ray));
  // Batches are tested in turn: vectors are a hundred times slower with sanitizers.
  static int asked = 0;
  if (++asked % test::cases(1, 1, 32) != 0) return blocked;
  const std::vector<Ray> rays(64, ray);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> any(rays.size());
  objects.closest_hits(rays, hits);
  objects.occluded(rays, any);
  for (std::size_t i = 0; i < rays.size(); ++i)
    EXPECT_TRUE((any[i] != 0) == blocked && static_cast<bool>(hits[i]) == blocked);
  return blocked;
}

TEST(VoxelSeams, BlockRaysInTheSharedPlane) {
  for (const VoxelMarchEntry& march : voxel_marches()) {
    const auto cube = solid_model(ivec3(4), march.name);
    for (const glm::dmat3& turn_a : {glm::dmat3(1.0), orientations()[13]}) {
      for (const glm::dmat3& turn : orientations()) {
        for (int across = 0; across < 3; ++across) {
          dvec3 low_a(0.0);
          low_a[across] = -4;
          const VoxelObjects objects(
              {{cube}, {place_at(low_a, turn_a, ivec3(4)), place_at(dvec3(0.0), turn, ivec3(4))}});
          for (const int along : {(across + 1) % 3, (across + 2) % 3}) {
            for (const double side : {0.0, 1.5, 2.0}) {
              for (const double way : {1.0, -1.0}) {
                // In the plane, between two rows of voxels or through them.
                Ray ray;
                ray.origin = dvec3(side);
                ray.origin[across] = 0;
                ray.origin[along] = -10 * way;
                ray.direction = dvec3(0.0);
                ray.direction[along] = way;
                ASSERT_TRUE(blocks(objects, ray)) << march.name << ' ' << across << along << ' ' << side;
                EXPECT_EQ(objects.closest_hit(ray).t, way > 0 ? 10 : 6);
                // From the plane.
                ray.origin[along] = 2;
                ASSERT_TRUE(blocks(objects, ray));
                EXPECT_EQ(objects.closest_hit(ray).t, 0);
              }
            }
          }
        }
      }
    }
  }
}

TEST(VoxelSeams, BlockRaysNearlyInTheSharedPlane) {
  const auto cube = solid_model(ivec3(4), "voxel-bricks");
  for (const glm::dmat3& turn : orientations()) {
    const VoxelObjects objects(
        {{cube}, {place_at({-4, 0, 0}, glm::dmat3(1.0), ivec3(4)), place_at({0, 0, 0}, turn, ivec3(4))}});
    for (int power = 10; power < 1000; power += power < 60 ? 1 : 37) {
      for (const double way : {1.0, -1.0}) {
        for (const double from : {-3.0, 0.0, 0.5, 7.0, 9.5, 12.0, 1e6}) {
          Ray ray;
          ray.direction = {way * std::ldexp(1.0, -power), 0, -1};
          ray.origin = dvec3(-from * ray.direction.x, 1.5, 10);
          if (std::abs(ray.origin.x) > 3) continue;
          ASSERT_TRUE(blocks(objects, ray)) << power << ' ' << way << ' ' << from;
          // The hit is at the top, and not inside after the ray has passed the top.
          EXPECT_NEAR(objects.closest_hit(ray).t, 6, 1) << power << ' ' << way << ' ' << from;
        }
      }
    }
  }
}

// Voxels whose sides and positions are rounded, on and next to the planes between them: the ground is closed for each
// ray.
TEST(VoxelSeams, HaveNoGapWhereSidesAreRounded) {
  bench::Random random(3, 1);
  const auto cube = solid_model(ivec3(4), "voxel-octants");
  for (int round = 0; round < 400; ++round) {
    constexpr std::array<double, 5> kSides = {0.1, 0.3, 1.0 / 3, 1, 30.7};
    const double side = kSides[static_cast<std::size_t>(round % 5)];
    const double east = round % 3 ? 0 : side * (random.below(1'000'000) - 500'000);
    const auto all = orientations();
    std::vector<VoxelPlace> places;
    for (int x = -4; x < 4; ++x) {
      const glm::dmat3& turn = all[round % 2 ? 0 : static_cast<std::size_t>(random.below(48))];
      const VoxelPlace on_lattice = place_at({4.0 * x, 0, 0}, turn, ivec3(4));
      places.push_back({0, side * turn, side * on_lattice.origin + dvec3(east, 0, 0)});
    }
    const VoxelObjects objects({{cube}, places});
    for (int i = 0; i < 200; ++i) {
      const int seam = 4 * (random.below(7) - 3);
      double x = seam * side + east;
      for (int k = random.below(4); k > 0; --k) x = std::nextafter(x, i % 2 ? 1e9 : -1e9);
      if (i % 11 == 0) x += std::ldexp(random.uniform(-1, 1), -20 - random.below(300));
      Ray ray;
      ray.origin = {x, 1.5 * side, 10 * side};
      if (i % 3 == 1) ray.direction.x = std::ldexp(random.uniform(-1, 1), -15 - random.below(300));
      if (i % 3 == 2) ray.direction.x = std::ldexp(random.uniform(-1, 1), -10) * 1e-9;
      ASSERT_TRUE(blocks(objects, ray)) << round << ' ' << i << ' ' << side;
      EXPECT_NEAR(objects.closest_hit(ray).t, 6 * side, side) << round << ' ' << i;
    }
  }
}

TEST(VoxelSeams, ClosedFloorOfTurnedTilesHasNoGap) {
  const auto tile = solid_model(ivec3(8, 8, 2), "voxel-bricks");
  std::vector<glm::dmat3> flat;
  for (const glm::dmat3& turn : orientations()) {
    if (turn[2].z != 0) flat.push_back(turn);
  }
  ASSERT_EQ(flat.size(), 16u);
  std::vector<VoxelPlace> places;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x)
      places.push_back(place_at({8.0 * x, 8.0 * y, 0}, flat[static_cast<std::size_t>(x * 5 + y * 3) % 16], {8, 8, 2}));
  }
  const VoxelObjects floor({{tile}, places});
  // The floor's own far sides belong to the space beyond.
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      Ray ray;
      ray.origin = {0.5 * x, 0.5 * y, 9};
      ASSERT_TRUE(blocks(floor, ray)) << ray.origin.x << ' ' << ray.origin.y;
    }
  }
}

// Two cubes side by side, placed as fields of a scene or in one field, and rays within some hundred units of rounding
// of the plane between them: however the positions are rounded, one of the cubes blocks the ray.
TEST(VoxelSeams, HaveNoGapBetweenPlacedFields) {
  bench::Random random(7, 1);
  std::uint8_t voxel = 1;
  VoxelGrid grid(ivec3(1), 8);
  grid.fill(grid.box(), voxel);
  const auto one = std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-octants"));
  const auto all = orientations();
  for (int round = 0; round < test::cases(4000, 2000, 500); ++round) {
    constexpr std::array<double, 6> kSides = {0.1, 0.3, 1.0 / 3, 7.7, 0.01, 1};
    const double side = kSides[static_cast<std::size_t>(random.below(6))];
    const int across = random.below(3), along = (across + 1 + random.below(2)) % 3, other = 3 - across - along;
    dvec3 at(0.0);
    for (int i = 0; i < 3; ++i) at[i] = round % 2 ? random.uniform(-1e4, 1e4) : 0.1 * (random.below(20'001) - 10'000);
    PlacedVoxels placed{.models = {one}};
    std::vector<SceneFieldPtr> fields;
    std::vector<SceneObject> objects;
    for (const int which : {0, 1}) {
      dvec3 low(0.0);
      low[across] = which;
      VoxelPlace place = place_at(low, all[static_cast<std::size_t>(random.below(48))], ivec3(1));
      if (determinant(place.world_from_grid) < 0) place = place_at(low, -place.world_from_grid, ivec3(1));
      SceneObject object;
      object.field = static_cast<std::uint32_t>(which);
      object.placement = {place.world_from_grid, side, at + side * place.origin};
      fields.push_back(scene_voxels({.models = {one}, .places = {{}}}));
      objects.push_back(object);
      placed.places.push_back({0, side * place.world_from_grid, object.placement.origin});
    }
    const Scene scene(fields, objects);
    const VoxelObjects in_one(placed);
    std::vector<Ray> rays;
    for (int i = 0; i < 128; ++i) {
      Ray ray;
      ray.direction = dvec3(0.0);
      ray.direction[along] = random.below(2) ? 1 : -1;
      if (i % 4 == 3) ray.direction[other] = ray.direction[along] / 64;
      if (i % 4 == 2) ray.direction[across] = std::ldexp(random.uniform(-1, 1), -60 - random.below(900));
      ray.origin = at + side * (dvec3(0.25) - 3.0 * dvec3(ray.direction));
      ray.origin[across] = at[across] + side;
      const double step = std::ldexp(std::max(std::abs(ray.origin[across]), side), -53);
      ray.origin[across] += (random.below(2001) - 1000) * step;
      rays.push_back(ray);
    }
    std::vector<Hit> together(rays.size());
    scene.closest_hits(rays, together);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit hit = scene.closest_hit(rays[i]);
      ASSERT_TRUE(hit) << "scene " << round << ", ray " << i << ", side " << side;
      ASSERT_EQ(hit, together[i]);
      ASSERT_TRUE(scene.occluded(rays[i]));
      ASSERT_TRUE(blocks(in_one, rays[i])) << "one field " << round << ", ray " << i << ", side " << side;
    }
  }
}

// Direction components that rounding affects differently.
double any_component(bench::Random& random) {
  constexpr std::array<double, 6> kTiny = {6.123233995736766e-17, 0x1p-30, 3 * 0x1p-29, 0x1p-52, 0x1p-1000, 5e-324};
  switch (random.below(5)) {
    case 0:
      return std::ldexp(1.0, -random.below(19));
    case 1:
      return 1 + random.below(7);
    case 2:
      return std::ldexp(random.uniform(0.5, 1), -14 - random.below(40));
    case 3:
      return kTiny[static_cast<std::size_t>(random.below(6))];
    default:
      return random.uniform(0.05, 1);
  }
}

// Two objects that touch along an edge: rays in any direction through points of the edge. One of the boxes is entered
// there: that of a single solid block, or both boxes if they touch in a plane and reach beyond the edge there.
TEST(VoxelSeams, BlockRaysThroughSharedEdges) {
  bench::Random random(5, 1);
  const std::vector<glm::dmat3> all = orientations();
  std::int64_t rays = 0;
  for (int round = 0; round < test::cases(4000, 2000, 250); ++round) {
    const int across = random.below(3), up = (across + 1 + random.below(2)) % 3, along = 3 - across - up;
    const double side = std::array{1.0, 0.1, 0.25, 7.7}[static_cast<std::size_t>(random.below(4))];
    const dvec3 base = random.below(2) ? dvec3(0.0) : side * dvec3(random.below(2001) - 1000, 17.5, random.uniform());
    // Voxels beyond the edge: of both boxes on each side of the plane, of one box all around the edge, or of none.
    const int beyond = random.below(3), wide = random.below(2);
    PlacedVoxels placed;
    for (const int which : {0, 1}) {
      const glm::dmat3& turn = all[static_cast<std::size_t>(random.below(48))];
      const double sign = which ? 1 : -1;
      dvec3 near(0.0), far(0.0);  // of the solid block
      far[across] = sign * (1 + random.below(8)), far[up] = sign * (1 + random.below(8)), far[along] = 8;
      dvec3 low = glm::min(near, far), high = glm::max(near, far);
      const dvec3 solid_low = low, solid_high = high;
      if (beyond == 0 || (beyond == 1 && which == wide)) low[up] = -9, high[up] = 9;
      if (beyond == 1 && which == wide) low[across] = -9, high[across] = 9;
      const dvec3 size = glm::abs(transpose(turn) * (high - low));
      VoxelGrid grid(ivec3(size), 8);
      VoxelPlace place = place_at(low, turn, ivec3(size));
      // Voxels at its ends keep the box as large as it is.
      for_each_voxel(grid.box(), [&](const ivec3& v) {
        const dvec3 p = turn * (dvec3(v) + 0.5) + place.origin;
        bool block = true, end = false;
        for (int axis = 0; axis < 3; ++axis) {
          block = block && p[axis] > solid_low[axis] && p[axis] < solid_high[axis];
          end = end || (axis != along && (p[axis] < low[axis] + 1 || p[axis] > high[axis] - 1));
        }
        if (block || (end && (p[along] < 1 || p[along] > 7))) grid.set(v, 1);
      });
      place.model = static_cast<std::uint32_t>(which);
      place.world_from_grid *= side;
      place.origin = side * place.origin + base;
      placed.models.push_back(std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-planes")));
      placed.places.push_back(place);
    }
    const VoxelObjects objects(placed);
    for (int i = 0; i < 64; ++i) {
      dvec3 p(0.0), d;
      p[along] = random.below(2) ? random.uniform(2, 6) : 2 + 0.5 * random.below(9);
      // Between the two, from outside.
      d[across] = any_component(random), d[up] = -any_component(random);
      if (std::max(d[across], -d[up]) < 0.05) (random.below(2) ? d[across] = 1 : d[up] = -1);
      const double longest = std::max(d[across], -d[up]);
      d[along] = random.below(3) ? 0.1 * (random.below(2) ? 1 : -1) * std::min(any_component(random), longest) : 0.0;
      if (i % 2) d = -d;
      const double voxels = random.below(2) ? 1 + random.below(30) : random.uniform(1, 30);
      Ray ray;
      ray.origin = base + side * (p - voxels / longest * d);
      ray.direction = side * d;
      ++rays;
      ASSERT_TRUE(blocks(objects, ray)) << fmt::format("round {}, ray {}, side {}, beyond {}, direction {} {} {}",
                                                       round, i, side, beyond, d.x, d.y, d.z);
    }
  }
  EXPECT_GT(rays, 10'000);
}

// Rays through a corner of the smaller of two objects, where only its voxel beyond two of the three planes blocks them:
// one plane ends its box, the other does not.
TEST(VoxelSeams, BlockRaysThroughCorners) {
  bench::Random random(5, 2);
  VoxelGrid large(ivec3(6), 8), small(ivec3(2, 1, 2), 8);
  for (const ivec3& v : {ivec3(3, 3, 3), ivec3(2, 3, 2), ivec3(3, 3, 2), ivec3(0), ivec3(5)}) large.set(v, 1);
  for (const ivec3& v : {ivec3(0), ivec3(1, 0, 1)}) small.set(v, 1);
  const auto model = [](VoxelGrid grid) {
    return std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-planes"));
  };
  const std::vector models{model(large), model(small)};
  for (const glm::dmat3& turn : orientations()) {
    for (const double side : {1.0, 0.1}) {
      const VoxelObjects objects(
          {models, {{0, side * turn, side * (turn * dvec3(-3))}, {1, side * turn, side * (turn * dvec3(-2, -1, -1))}}});
      for (int i = 0; i < test::cases(1000, 100, 10); ++i) {
        const dvec3 d(-random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1));
        Ray ray;
        ray.direction = side * (turn * d);
        ray.origin = -random.uniform(0.1, 1) * ray.direction;
        ASSERT_TRUE(blocks(objects, ray)) << i << ", side " << side;
      }
    }
  }
}

std::string told(const bench::LatticeAnswer& expected) {
  if (expected.entries.empty()) return "none";
  const bench::LatticeAnswer::Entry& first = expected.entries.front();
  return fmt::format("one of {}, the first at {} / {}{}", expected.entries.size(), first.t_num, first.t_den,
                     expected.certain ? "" : ", or none");
}

TEST(VoxelSeams, MatchOneGrid) {
  std::int64_t hits = 0, ties = 0;
  for (std::int64_t s = 0; s < kScenes; ++s) {
    bench::Random random(48, static_cast<std::uint64_t>(s));
    const bench::VoxelSceneJudge judge(random, {});
    const VoxelObjects objects(judge.placed());
    std::vector<Ray> rays;
    std::vector<Hit> together(kRaysPerScene);
    std::vector<std::uint8_t> blocked(kRaysPerScene);
    std::vector<bench::LatticeRay> lattice;
    for (int i = 0; i < kRaysPerScene; ++i) {
      lattice.push_back(bench::VoxelSceneJudge::random_ray(random));
      rays.push_back(judge.world_ray(lattice.back()));
    }
    objects.closest_hits(rays, together);
    objects.occluded(rays, blocked);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit hit = objects.closest_hit(rays[i]);
      const bench::LatticeAnswer expected = judge.answer(lattice[i]);
      hits += hit ? 1 : 0;
      ties += expected.entries.size() > 1 ? 1 : 0;
      ASSERT_EQ(hit, together[i]) << "scene " << s << ", ray " << i;
      ASSERT_EQ(static_cast<bool>(hit), blocked[i] != 0) << "scene " << s << ", ray " << i;
      ASSERT_EQ(static_cast<bool>(hit), objects.occluded(rays[i])) << "scene " << s << ", ray " << i;
      ASSERT_TRUE(judge.agrees(lattice[i], expected, hit))
          << fmt::format("scene {}, ray {} of ({}, {}, {}) along ({}, {}, {}): t = {}, expected {}", s, i,
                         lattice[i].origin[0], lattice[i].origin[1], lattice[i].origin[2], lattice[i].direction[0],
                         lattice[i].direction[1], lattice[i].direction[2], hit.t, told(expected));
    }
  }
  EXPECT_GT(hits, kScenes * kRaysPerScene / 10);
  EXPECT_GT(ties, kScenes);
}

// Separate fields of a scene, each with a placement.
TEST(VoxelSeams, PlacedFieldsMatchOneGrid) {
  for (std::int64_t s = 0; s < kScenes / 4; ++s) {
    bench::Random random(49, static_cast<std::uint64_t>(s));
    const bench::VoxelSceneJudge judge(random, {});
    const Scene scene = judge.as_fields();
    std::vector<Ray> rays;
    std::vector<Hit> together(kRaysPerScene);
    std::vector<bench::LatticeRay> lattice;
    for (int i = 0; i < kRaysPerScene; ++i) {
      lattice.push_back(bench::VoxelSceneJudge::random_ray(random));
      rays.push_back(judge.world_ray(lattice.back()));
    }
    scene.closest_hits(rays, together);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      Hit hit = scene.closest_hit(rays[i]);
      ASSERT_EQ(hit, together[i]) << "scene " << s << ", ray " << i;
      ASSERT_EQ(static_cast<bool>(hit), scene.occluded(rays[i])) << "scene " << s << ", ray " << i;
      hit.part = hit.object;
      ASSERT_TRUE(judge.agrees(lattice[i], judge.answer(lattice[i]), hit)) << "scene " << s << ", ray " << i;
    }
  }
}

}  // namespace
}  // namespace scarp
