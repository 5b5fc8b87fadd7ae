// SPDX-License-Identifier: MIT
// Voxel objects of scenes on a Vulkan device: the CPU's answers, to the bit.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bench/voxel_scene_judge.h"
#include "cases.h"
#include "scarp/accel/voxel_buffers.glsl.h"
#include "scarp/base/error.h"
#include "scarp/scene/scene_vk.h"
#include "vk/device_under_test.h"

namespace scarp::test {
namespace {

const std::size_t kVoxelRays = static_cast<std::size_t>(cases(100'000, 10'000, 1'000));

class CrowdRandom {
 public:
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  dvec3 point(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
  int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(engine_); }

 private:
  std::mt19937_64 engine_{3};
};

std::shared_ptr<const VoxelModel> noise_model(int size, double share, const std::string& march, CrowdRandom& random) {
  VoxelGrid grid(ivec3(size, size + 2, size - 1 + size % 2), 8);
  grid.edit(grid.box(), [&](const ivec3&, const VoxelGrid::Voxel&) {
    return random.between(0, 1) < share ? VoxelGrid::Voxel(1 + static_cast<std::uint32_t>(random.below(255)))
                                        : VoxelGrid::Voxel();
  });
  return std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march(march));
}

// Objects of many marches or one, rotated, mirrored, overlapping, some of them twice at the same position.
PlacedVoxels crowd_of(CrowdRandom& random, int count, const std::string& march) {
  const auto of = [&](const char* own) { return march.empty() ? own : march; };
  PlacedVoxels placed;
  placed.models = {noise_model(8, 0.2, of("voxel-bricks"), random),  noise_model(5, 0.5, of("voxel-cubes"), random),
                   noise_model(9, 0.1, of("voxel-octants"), random), noise_model(6, 0.3, of("voxel-spheres"), random),
                   noise_model(3, 0.9, of("voxel-planes"), random),  noise_model(2, 0.0, of("voxel-planes"), random)};
  for (int i = 0; i < count; ++i) {
    glm::dmat3 turn(1.0);
    if (i % 3 == 0) turn = glm::dmat3(glm::rotate(glm::dmat4(1), random.between(0, 6), dvec3(1, 2, 3)));
    if (i % 5 == 1) turn[0] = -turn[0];
    const dvec3 origin = i % 2 ? random.point(30) : round(random.point(30));
    placed.places.push_back({static_cast<std::uint32_t>(i % 6), turn * (i % 4 ? 1.0 : random.between(0.5, 2)), origin});
    if (i % 10 == 0) placed.places.push_back(placed.places.back());
  }
  return placed;
}

Ray ray_at_crowd(CrowdRandom& random) {
  Ray ray;
  ray.origin = random.point(60);
  ray.direction = random.point(30) - ray.origin;
  switch (random.below(8)) {
    case 0:  // along an axis, between voxels
      ray.origin = round(ray.origin);
      ray.direction = dvec3(0.0);
      ray.direction[random.below(3)] = random.below(2) ? 1 : -3;
      break;
    case 1:
      ray.origin = round(random.point(30));
      ray.direction = round(random.point(3));
      if (ray.direction == dvec3(0.0)) ray.direction.x = 1;
      break;
    case 2:
      ray.t_min = random.between(-1, 1);
      ray.t_max = ray.t_min + random.between(0, 1);
      break;
    case 3:
      ray.direction *= std::ldexp(1.0, random.below(1800) - 900);
      break;
    case 4:
      ray.origin -= 1e6 * ray.direction;
      break;
    default:
      break;
  }
  return ray;
}

class SceneVoxelsOnDevice : public OnDevice {
 protected:
  void expect_same(const Scene& cpu) {
    const Scene there = scene_on(device(), cpu);
    std::vector<Ray> rays(kVoxelRays);
    for (Ray& ray : rays) ray = ray_at_crowd(random);
    expect_same(cpu, there, rays, {});
    if (HasFailure()) return;
    // Rays from the hits: away from the surface and into it.
    std::vector<Hit> hits(rays.size());
    cpu.closest_hits(rays, hits);
    std::vector<Ray> next;
    std::vector<const Hit*> from;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!hits[i]) continue;
      Ray ray = rays[i];
      ray.origin = ray.at(hits[i].t);
      ray.direction = random.point(1);
      ray.t_min = 0;
      ray.t_max = i % 3 ? ray.t_max : 20;
      next.push_back(ray);
      from.push_back(i % 5 ? &hits[i] : nullptr);
    }
    EXPECT_GT(next.size(), rays.size() / 500);
    expect_same(cpu, there, next, from);
  }

  CrowdRandom random;

 private:
  void expect_same(const Scene& cpu, const Scene& there, std::span<const Ray> rays, std::span<const Hit* const> from) {
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    std::vector<std::uint8_t> dark(rays.size()), blocked(rays.size());
    // One by one; batches have their own tests.
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit* begin = from.empty() ? nullptr : from[i];
      const SceneField& field = *cpu.fields()[0];
      expected[i] = field.closest_hit(rays[i], begin, nullptr);
      dark[i] = field.occluded(rays[i], begin);
    }
    there.closest_hits(rays, hits, {}, from);
    there.occluded(rays, blocked, from);
    int failures = 0;
    for (std::size_t i = 0; i < rays.size() && failures < 3; ++i) {
      if (hits[i] == expected[i] && blocked[i] == dark[i]) continue;
      ++failures;
      ADD_FAILURE() << "ray " << i << ": t " << hits[i].t << ", object " << hits[i].part << " instead of "
                    << expected[i].t << ", " << expected[i].part << "; blocked " << int{blocked[i]};
    }
  }
};

TEST_F(SceneVoxelsOnDevice, MatchTheCpu) {
  for (const int count : {1, 7, 300}) expect_same(Scene(scene_voxels(crowd_of(random, count, ""))));
  expect_same(Scene(scene_voxels(crowd_of(random, 40, "voxel-octants"))));
}

// Rotated and mirrored objects that touch, as one field and as separate fields.
TEST_F(SceneVoxelsOnDevice, MatchOneGridWhereObjectsMeet) {
  constexpr std::array<const char*, 5> kMarches = {"voxel-planes", "voxel-spheres", "voxel-cubes", "voxel-octants",
                                                   "voxel-bricks"};
  const int scenes = cases(400, 40, 10);
  int hits = 0;
  for (int s = 0; s < scenes; ++s) {
    bench::Random of_scene(50, static_cast<std::uint64_t>(s));
    const bench::VoxelSceneJudge judge(of_scene, kMarches[static_cast<std::size_t>(s % 5)]);
    std::vector<bench::LatticeRay> lattice(2048);
    std::vector<Ray> rays(lattice.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      lattice[i] = bench::VoxelSceneJudge::random_ray(of_scene);
      rays[i] = judge.world_ray(lattice[i]);
    }
    for (const bool fields : {false, true}) {
      const Scene there = scene_on(device(), fields ? judge.as_fields() : Scene(scene_voxels(judge.placed())));
      std::vector<Hit> found(rays.size());
      std::vector<std::uint8_t> blocked(rays.size());
      there.closest_hits(rays, found);
      there.occluded(rays, blocked);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        Hit hit = found[i];
        if (fields) hit.part = hit.object;
        hits += hit ? 1 : 0;
        ASSERT_TRUE(judge.agrees(lattice[i], judge.answer(lattice[i]), hit)) << s << ' ' << fields << ' ' << i;
        ASSERT_EQ(static_cast<bool>(hit), blocked[i] != 0) << s << ' ' << fields << ' ' << i;
      }
    }
  }
  EXPECT_GT(hits, scenes * 200);
}

TEST_F(SceneVoxelsOnDevice, SmoothNormalsOffsetShadowRays) {
  expect_same(Scene(scene_voxels(crowd_of(random, 40, "voxel-octants"), {.normals = VoxelNormals::smooth})));
}

TEST_F(SceneVoxelsOnDevice, EmptyModelsAreMissed) {
  const auto nothing = std::make_shared<const VoxelModel>(VoxelGrid(ivec3(3)), find_voxel_march("voxel-bricks"));
  for (const PlacedVoxels& placed : {PlacedVoxels{}, PlacedVoxels{.models = {nothing}, .places = {VoxelPlace{}}}}) {
    const Scene there = scene_on(device(), Scene(scene_voxels(placed)));
    const std::vector<Ray> rays(3);
    std::vector<Hit> hits(3);
    for (Hit& hit : hits) hit.status = HitStatus::hit;
    std::vector<std::uint8_t> blocked(3, 1);
    there.closest_hits(rays, hits);
    there.occluded(rays, blocked);
    for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_TRUE(!hits[i] && blocked[i] == 0);
  }
}

TEST_F(SceneVoxelsOnDevice, RejectOversizedGrids) {
  VoxelGrid grid({16384, 16384, 1028}, 1);
  grid.set({0, 0, 0}, 1);
  const auto model = std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march("voxel-bricks"));
  try {
    scene_on(device(), Scene(scene_voxels({{model}, {VoxelPlace{}}})));
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "scene: field 0 (voxels): voxels: 16384 x 16384 x 1028, limited to 2^38 voxels on Vulkan devices (use "
                 "the CPU)");
  }
}

TEST_F(SceneVoxelsOnDevice, RejectTheExhaustiveMarch) {
  try {
    scene_on(device(), Scene(scene_voxels(crowd_of(random, 3, "voxel-exhaustive"))));
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "scene: field 0 (voxels): march 'voxel-exhaustive': does not run on Vulkan devices (available: "
                 "voxel-planes, voxel-spheres, voxel-cubes, voxel-octants, voxel-bricks)");
  }
}

}  // namespace
}  // namespace scarp::test
