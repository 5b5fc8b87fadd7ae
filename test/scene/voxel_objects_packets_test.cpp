// SPDX-License-Identifier: MIT
// Batches of rays at voxel objects equal the same rays one by one, to the bit.
#include <gtest/gtest.h>

#include <bit>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "scarp/base/error.h"
#include "scarp/scene/voxel/voxel_objects.h"

namespace scarp {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

dvec3 point(Random& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

std::shared_ptr<const VoxelModel> model(int size, double share, std::string_view march, Random& random) {
  VoxelGrid grid(ivec3(size), 8);
  grid.edit(grid.box(), [&](const ivec3&, const VoxelGrid::Voxel&) {
    return uniform(random, 0, 1) < share ? VoxelGrid::Voxel(1 + random() % 255) : VoxelGrid::Voxel();
  });
  return std::make_shared<const VoxelModel>(std::move(grid), find_voxel_march(march));
}

// Objects of all marches, rotated, overlapping, some of them twice at the same position.
VoxelObjects crowd(Random& random, int count) {
  const std::vector models = {model(8, 0.2, "voxel-bricks", random),  model(5, 0.5, "voxel-cubes", random),
                              model(9, 0.1, "voxel-octants", random), model(6, 0.3, "voxel-spheres", random),
                              model(3, 0.9, "voxel-planes", random),  model(1, 0.0, "voxel-planes", random)};
  std::vector<VoxelPlace> places;
  for (int i = 0; i < count; ++i) {
    glm::dmat3 turn(1.0);
    if (i % 4 == 0) turn = glm::dmat3(glm::rotate(glm::dmat4(1), uniform(random, 0, 6), dvec3(1, 2, 3)));
    places.push_back({static_cast<std::uint32_t>(i % 6), turn * uniform(random, 0.5, 2), point(random, 40)});
    if (i % 10 == 0) places.push_back(places.back());
  }
  return VoxelObjects({models, places});
}

// A camera's rays, in blocks of 8 x 8 pixels; with spread 1 they go in any direction.
std::vector<Ray> rays_from(const dvec3& eye, const dvec3& towards, double spread, std::size_t count, Random& random) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    Ray ray;
    ray.origin = eye;
    ray.direction = towards + spread * point(random, length(towards));
    ray.t_min = random() % 8 ? 0 : uniform(random, 0, 0.5);
    ray.t_max = random() % 8 ? ray.t_max : uniform(random, 0.5, 2);
    rays.push_back(ray);
  }
  return rays;
}

bool same(const Hit& a, const Hit& b) {
  return a == b && std::bit_cast<std::uint64_t>(a.t) == std::bit_cast<std::uint64_t>(b.t);
}

TEST(VoxelObjectsPackets, MatchSingleRays) {
  Random random(1);
  int hits = 0, again = 0;
  for (int round = 0; round < 60; ++round) {
    const VoxelObjects scene = crowd(random, 1 + round * 4);
    const dvec3 eye = point(random, round % 3 ? 90 : 30);
    dvec3 towards = -eye;
    // Along an axis, or in a plane of two: slopes around 0.
    if (round % 4 == 1) towards[round % 3] = 0;
    if (round % 8 == 2) towards = dvec3(0), towards[round % 3] = 50;
    const double spread = round % 5 == 4 ? 1 : std::ldexp(1.0, -3 - round % 7);
    const std::vector<Ray> rays = rays_from(eye, towards, spread, 64 * 3 + static_cast<std::size_t>(round), random);
    std::vector<Hit> answers(rays.size());
    std::vector<std::uint8_t> blocked(rays.size(), 7);
    scene.closest_hits(rays, answers);
    scene.occluded(rays, blocked);
    std::vector<Ray> onwards(rays.size());
    std::vector<const Hit*> from(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      MarchStats stats;
      const Hit expected = scene.closest_hit(rays[i], &stats);
      EXPECT_GE(stats.boxes, expected ? 1u : 0u);
      ASSERT_TRUE(same(answers[i], expected)) << "round " << round << ", ray " << i;
      ASSERT_EQ(blocked[i], expected ? 1 : 0) << "round " << round << ", ray " << i;
      hits += expected ? 1 : 0;
      onwards[i] = {rays[i].at(expected ? expected.t : 0), dvec3(1, 2, 3) + point(random, 0.2)};
      if (expected) from[i] = &answers[i];
    }
    // From the hit faces to a light.
    std::vector<Hit> second(rays.size());
    scene.closest_hits(onwards, second, from);
    scene.occluded(onwards, blocked, from);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit expected = scene.closest_hit(onwards[i], from[i], nullptr);
      ASSERT_TRUE(same(second[i], expected)) << "round " << round << ", ray " << i;
      ASSERT_EQ(blocked[i], expected ? 1 : 0) << "round " << round << ", ray " << i;
      again += expected ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(again, 300);
}

TEST(VoxelObjectsPackets, RejectSpansOfDifferentLengths) {
  Random random(2);
  const VoxelObjects scene = crowd(random, 3);
  const std::vector<Ray> rays(5);
  std::vector<Hit> answers(4);
  EXPECT_THROW(scene.closest_hits(rays, answers), Error);
  answers.resize(5);
  const std::vector<const Hit*> from(6);
  EXPECT_THROW(scene.closest_hits(rays, answers, from), Error);
  VoxelObjects(PlacedVoxels{}).closest_hits(rays, answers);
  EXPECT_FALSE(answers[0]);
}

}  // namespace
}  // namespace scarp
