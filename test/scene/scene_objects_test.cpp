// SPDX-License-Identifier: MIT
// Scenes of many fields: the nearest hit against each object queried alone, batches against single rays, starts on
// surfaces, placements.
#include "scarp/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "base/refusal.h"
#include "scarp/base/error.h"
#include "scarp/scene/scene_back_end.h"

namespace scarp {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double in(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }
  dvec3 direction() {
    while (true) {
      const dvec3 d(in(-1, 1), in(-1, 1), in(-1, 1));
      if (dot(d, d) > 0.01 && dot(d, d) < 1) return d;
    }
  }

 private:
  std::mt19937_64 engine_;
};

glm::dmat3 turned(const dvec3& axis, double angle) {
  const dvec3 n = normalize(axis);
  const double c = std::cos(angle), s = std::sin(angle);
  glm::dmat3 m;
  for (int i = 0; i < 3; ++i) {
    dvec3 e(0.0);
    e[i] = 1;
    m[i] = c * e + s * cross(n, e) + (1 - c) * dot(n, e) * n;
  }
  return m;
}

SceneFieldPtr hills(int side, double height, unsigned seed) {
  Random random(seed);
  std::vector<float> samples(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (float& sample : samples) sample = static_cast<float>(random.in(0, height));
  return scene_heights(HeightField::own(std::move(samples), side, side));
}

SceneFieldPtr voxel_block() {
  VoxelGrid grid(ivec3(4), 8);
  grid.edit(grid.box(), [](const ivec3& v, const VoxelGrid::Voxel&) {
    return (v.x + v.y + v.z) % 2 == 0 ? VoxelGrid::Voxel(1) : VoxelGrid::Voxel();
  });
  auto model = std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-bricks"));
  return scene_voxels({{model}, {VoxelPlace{}}});
}

SceneFieldPtr ball(double radius) { return scene_shape(DistanceField(make_shape(shape::Sphere{radius}))); }

// Some of each kind, randomly rotated, scaled and moved into a cube of 100 m.
Scene crowd(unsigned seed) {
  Random random(seed);
  std::vector<SceneFieldPtr> fields{
      hills(17, 6, seed), voxel_block(), ball(1),
      scene_function(HeightFunction(make_function(
          Sines{{{.amplitude = 2, .wavelength = 31}, {.amplitude = 1, .wavelength = 13, .towards = 1}}})))};
  std::vector<SceneObject> objects;
  const auto place = [&](std::uint32_t field, double scale) {
    objects.push_back({field,
                       static_cast<std::uint32_t>(objects.size()),
                       {turned(random.direction(), random.in(0, 6)),
                        scale,
                        {random.in(-50, 50), random.in(-50, 50), random.in(-50, 50)}}});
  };
  for (int i = 0; i < 9; ++i) place(0, random.in(0.5, 2));
  for (int i = 0; i < 30; ++i) place(1, random.in(0.5, 4));
  for (int i = 0; i < 20; ++i) place(2, random.in(0.5, 6));
  objects.push_back({3, static_cast<std::uint32_t>(objects.size()), {glm::dmat3(1.0), 1.0, {0, 0, -55}}});
  return Scene(std::move(fields), std::move(objects));
}

std::vector<Ray> rays_through(unsigned seed, int count) {
  Random random(seed);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    Ray ray;
    ray.origin = {random.in(-80, 80), random.in(-80, 80), random.in(-80, 80)};
    ray.direction = random.direction() * random.in(0.1, 10);
    if (i % 3 == 0) ray.t_max = random.in(1, 60);
    rays.push_back(ray);
  }
  return rays;
}

// Distance by which sphere-trace and lipschitz-local may stop early, per unit of distance: their tolerance, for each of
// two answers.
constexpr double kTolerance = 2e-6;

// A back end that calls the fields' own marches, ray by ray.
class Themselves final : public SceneBackEnd {
 public:
  explicit Themselves(std::vector<SceneFieldPtr> fields) : fields_(std::move(fields)) {}
  void closest_hits(std::uint32_t field, std::span<const Ray> rays, std::span<Hit> hits, std::span<std::uint32_t> steps,
                    std::span<const Hit* const> from) override {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      MarchStats stats;
      hits[i] = fields_[field]->closest_hit(rays[i], from.empty() ? nullptr : from[i], &stats);
      if (!steps.empty()) steps[i] = stats.steps;
    }
  }
  void occluded(std::uint32_t field, std::span<const Ray> rays, std::span<std::uint8_t> blocked,
                std::span<const Hit* const> from) override {
    for (std::size_t i = 0; i < rays.size(); ++i)
      blocked[i] = fields_[field]->occluded(rays[i], from.empty() ? nullptr : from[i]);
  }

 private:
  std::vector<SceneFieldPtr> fields_;
};

TEST(SceneOfManyFields, CanBeAnsweredFieldByField) {
  const Scene scene = crowd(5);
  const Scene elsewhere = scene.answered_by(std::make_shared<Themselves>(scene.fields()));
  EXPECT_TRUE(elsewhere.on_device());
  EXPECT_FALSE(scene.on_device());
  const std::vector<Ray> rays = rays_through(7, 700);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint32_t> steps(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  elsewhere.closest_hits(rays, hits, steps);
  elsewhere.occluded(rays, blocked);
  std::vector<Ray> onwards;
  std::vector<const Hit*> from;
  std::uint64_t cost = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit one = scene.closest_hit(rays[i]);
    EXPECT_EQ(hits[i].status, one.status);
    EXPECT_EQ(hits[i].t, one.t);
    EXPECT_EQ(hits[i].object, one.object);
    EXPECT_EQ(blocked[i], scene.occluded(rays[i]));
    cost += steps[i];
    if (!one) continue;
    Ray ray = rays[i];
    ray.origin = ray.at(one.t);
    ray.direction = dvec3(0.3, 0.4, 0.5);
    ray.t_min = 0;
    onwards.push_back(ray);
    from.push_back(&hits[i]);
  }
  EXPECT_GT(cost, rays.size());
  std::vector<std::uint8_t> shaded(onwards.size());
  elsewhere.occluded(onwards, shaded, from);
  for (std::size_t i = 0; i < onwards.size(); ++i) EXPECT_EQ(shaded[i], scene.occluded(onwards[i], from[i]));
  EXPECT_EQ(elsewhere.closest_hit(onwards[0], from[0]).t, scene.closest_hit(onwards[0], from[0]).t);
}

TEST(SceneOfManyFields, FindsTheNearestObject) {
  const Scene scene = crowd(5);
  int hits = 0;
  for (const Ray& ray : rays_through(6, 3000)) {
    const Hit hit = scene.closest_hit(ray);
    Hit nearest;
    for (std::uint32_t i = 0; i < scene.objects().size(); ++i) {
      const SceneObject& object = scene.objects()[i];
      const Hit alone =
          scene.fields()[object.field]->closest_hit(object.placement.field_from_world(ray), nullptr, nullptr);
      ASSERT_NE(alone.status, HitStatus::exhausted) << "object " << i;
      if (alone && (!nearest || alone.t < nearest.t)) nearest = alone, nearest.object = i;
    }
    ASSERT_EQ(bool(hit), bool(nearest));
    if (!hit) continue;
    ++hits;
    const double close = kTolerance * nearest.t;
    EXPECT_NEAR(hit.t, nearest.t, close);
    if (hit.object != nearest.object) {
      const Hit other = scene.fields()[scene.objects()[hit.object].field]->closest_hit(
          scene.objects()[hit.object].placement.field_from_world(ray), nullptr, nullptr);
      EXPECT_NEAR(other.t, nearest.t, 2 * close);
    }
    EXPECT_EQ(scene.surface(ray, hit).material, hit.object);
  }
  EXPECT_GT(hits, 1000);
}

// Several objects, rotated and above each other, that get hundreds of rays each, plus a few objects in the tree.
Scene layers() {
  return Scene({hills(65, 9, 3), hills(33, 20, 4), ball(8),
                scene_function(HeightFunction(make_function(Sines{{{.amplitude = 6, .wavelength = 40}}})))},
               {{0, 0, {glm::dmat3(1.0), 1.0, {-32, -32, 0}}},
                {1, 1, {turned({0, 1, 0}, 0.4), 2.0, {-30, -30, 10}}},
                {2, 2, {glm::dmat3(1.0), 1.0, {10, 5, 12}}},
                {3, 3, {turned({1, 0, 0}, -0.3), 1.0, {0, 0, 5}}}});
}

TEST(SceneOfManyFields, BatchesAndOcclusionMatchSingleRays) {
  for (const unsigned seed : {7u, 8u}) {
    const Scene scene = seed == 7 ? crowd(seed) : layers();
    const std::vector<Ray> rays = rays_through(seed, 2000);
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> blocked(rays.size());
    scene.closest_hits(rays, hits);
    scene.occluded(rays, blocked);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      MarchStats stats;
      const Hit one = scene.closest_hit(rays[i], nullptr, &stats);
      ASSERT_EQ(hits[i].status, one.status);
      ASSERT_EQ(blocked[i] != 0, bool(one));
      ASSERT_EQ(scene.occluded(rays[i]), bool(one));
      if (one) {
        ASSERT_EQ(hits[i].t, one.t);
        ASSERT_EQ(hits[i].object, one.object);
      }
    }
  }
}

// Tilted convex objects: no part is above the tangent plane of a point on them.
TEST(SceneOfManyFields, RaysFromASurfaceAreNotBlockedByIt) {
  VoxelGrid cube(ivec3(1), 8);
  cube.edit(cube.box(), [](const ivec3&, const VoxelGrid::Voxel&) { return VoxelGrid::Voxel(1); });
  auto model = std::make_shared<const VoxelModel>(std::move(cube), find_voxel_march("voxel-bricks"));
  std::vector<float> flat(25, 3.0f);
  const std::vector<SceneFieldPtr> fields{
      scene_heights(HeightField::own(std::move(flat), 5, 5, {.cell_x = 0.3, .cell_y = 0.3})),
      scene_voxels({{model}, {VoxelPlace{}}}),
      ball(0.7),
      scene_function(HeightFunction(make_function(Plane{.height = 0.1, .slope_x = 0.3, .slope_y = -0.7}))),
  };
  Random random(9);
  int tried = 0, blocked_when_free = 0;
  for (std::uint32_t field = 0; field < fields.size(); ++field) {
    const Placement placement{turned({0.3, -0.2, 1}, 0.7), 1.7, {1000.1, -200.7, 55.3}};
    const Scene scene(fields, {{field, 0, placement}});
    for (int i = 0; i < 400; ++i) {
      Ray seen;
      seen.origin = placement.world_from_field({0.6, 0.6, 9});
      const dvec3 towards = placement.world_from_field({random.in(0.05, 1.15), random.in(0.05, 1.15), 0.2});
      seen.direction = towards - seen.origin;
      const Hit hit = scene.closest_hit(seen);
      if (!hit) continue;
      const SceneSurface surface = scene.surface(seen, hit);
      Ray away;
      away.origin = surface.position;
      away.direction = random.direction();
      if (dot(away.direction, surface.normal) < 0) away.direction = -away.direction;
      ++tried;
      EXPECT_FALSE(scene.occluded(away, &hit)) << "field " << field;
      EXPECT_FALSE(scene.closest_hit(away, &hit)) << "field " << field;
      blocked_when_free += scene.occluded(away);
    }
  }
  EXPECT_GT(tried, 1000);
  // Without the start, rounding blocks many of these rays, which shows that the test can fail.
  EXPECT_GT(blocked_when_free, 100);
}

TEST(SceneOfManyFields, PlacementsPreserveT) {
  // A ball of 2 m, 3 m when scaled, 10 m ahead of a ray that counts in steps of 2 m.
  const Scene scene({ball(2)}, {{0, 42, {turned({1, 2, 3}, 1), 1.5, {10, 0, 0}}}});
  Ray ray;
  ray.direction = {2, 0, 0};
  const Hit hit = scene.closest_hit(ray);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit.t, 3.5, kTolerance * 3.5);
  const SceneSurface surface = scene.surface(ray, hit);
  EXPECT_NEAR(length(surface.normal - dvec3(-1, 0, 0)), 0, 1e-5);
  EXPECT_NEAR(length(surface.position - dvec3(7, 0, 0)), 0, 1e-5);
  EXPECT_EQ(surface.material, 42u);
  EXPECT_FALSE(scene.endless());
  EXPECT_NEAR(scene.box().high.x, 10 + 3 * std::sqrt(3.0), 3);
}

TEST(SceneOfManyFields, FindsOneOfThousands) {
  std::vector<SceneObject> objects;
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) objects.push_back({0, 0, {glm::dmat3(1.0), 1.0, {3.0 * x, 3.0 * y, 0}}});
  }
  const Scene scene({ball(1)}, objects);
  for (std::uint32_t i = 0; i < objects.size(); i += 37) {
    Ray down;
    down.origin = objects[i].placement.origin + dvec3(0.2, -0.1, 50);
    MarchStats stats;
    const Hit hit = scene.closest_hit(down, nullptr, &stats);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit.object, i);
    EXPECT_LE(stats.boxes, 4u);
  }
}

TEST(SceneOfManyFields, RejectsInvalidPlacements) {
  const auto refused = [](const Placement& placement, std::uint32_t field) {
    try {
      Scene({ball(1)}, {{field, 0, placement}});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  EXPECT_EQ(refused({}, 0), "taken");
  EXPECT_NE(refused({}, 1).find("object 0: its field 1"), std::string::npos);
  EXPECT_EQ(test::refusal([] { Scene({ball(1), nullptr}, {}); }), "scene: field 1 is null");
  EXPECT_NE(refused({.scale = 0}, 0).find("scale above 0"), std::string::npos);
  EXPECT_NE(refused({.turn = glm::dmat3(1.01)}, 0).find("rotation"), std::string::npos);
  EXPECT_NE(refused({.origin = {0, NAN, 0}}, 0).find("finite place"), std::string::npos);
}

}  // namespace
}  // namespace scarp
