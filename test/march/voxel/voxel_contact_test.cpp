// SPDX-License-Identifier: MIT
// Sweeps of spheres and capsules against voxels, and overlaps of boxes, against all faces and all voxels.
#include "scarp/march/voxel/voxel_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/ext/matrix_transform.hpp>
#include <limits>
#include <span>
#include <vector>

#include "bench/sweep_judge.h"
#include "cases.h"
#include "march/height/spiteful.h"

namespace scarp::test {
namespace {

VoxelGrid random_grid(Random& random) {
  const ivec3 size(whole(random, 1, 10), whole(random, 1, 10), whole(random, 1, 10));
  const double share = uniform(random, 0, 1) * uniform(random, 0, 1);
  // Bricks are filled on all threads.
  const std::uint64_t seed = random();
  return VoxelGrid::built(size, 8, [&](const ivec3& brick, std::span<std::uint32_t, 64>) {
    Random own(seed + static_cast<std::uint64_t>(brick.x + 16 * brick.y + 256 * brick.z));
    std::uint64_t mask = 0;
    for (int i = 0; i < 64; ++i) mask |= std::uint64_t{uniform(own, 0, 1) < share} << i;
    return mask;
  });
}

std::vector<ivec3> solid_voxels(const VoxelGrid& grid) {
  std::vector<ivec3> all;
  for (int z = 0; z < grid.size().z; ++z) {
    for (int y = 0; y < grid.size().y; ++y) {
      for (int x = 0; x < grid.size().x; ++x) {
        if (grid.solid({x, y, z})) all.emplace_back(x, y, z);
      }
    }
  }
  return all;
}

std::vector<bench::JudgedTriangle> faces_of(const std::vector<ivec3>& voxels) {
  std::vector<bench::JudgedTriangle> all;
  for (const ivec3& voxel : voxels) {
    for (int face = 0; face < 6; ++face) {
      dvec3 corner(voxel), u(0.0), v(0.0);
      corner[face / 2] += face % 2;
      u[(face / 2 + 1) % 3] = 1, v[(face / 2 + 2) % 3] = 1;
      all.push_back({corner, corner + u, corner + v});
      all.push_back({corner + u + v, corner + u, corner + v});
    }
  }
  return all;
}

dvec3 about(const VoxelGrid& grid, Random& random) {
  return dvec3(uniform(random, -0.5, 1.5), uniform(random, -0.5, 1.5), uniform(random, -0.5, 1.5)) * dvec3(grid.size());
}

TEST(VoxelSweep, NeverTunnels) {
  Random random(21);
  int contacts = 0, inside = 0, misses = 0;
  for (int round = 0; round < cases(300, 40, 8); ++round) {
    const VoxelGrid grid = random_grid(random);
    const auto voxels = solid_voxels(grid);
    const auto faces = faces_of(voxels);
    for (int i = 0; i < 50; ++i) {
      Capsule capsule{about(grid, random), {}, std::pow(10, uniform(random, -4, 0.2))};
      capsule.b = capsule.a;
      if (whole(random, 0, 1)) capsule.b = 0.5 * (capsule.a + about(grid, random));
      // Some go to a corner or along an axis.
      dvec3 motion = about(grid, random) - capsule.a;
      if (whole(random, 0, 5) == 0) motion = floor(capsule.a + motion) - capsule.a;
      if (whole(random, 0, 5) == 0) motion.x = motion.y = 0;
      const auto found = sweep(grid, capsule, motion);
      const bench::JudgedSweep judged{capsule.a, capsule.b, capsule.radius, motion};
      if (found && found->normal == dvec3(0.0)) {
        const auto is_in = [&](const dvec3& p) {
          return std::any_of(voxels.begin(), voxels.end(), [&](const ivec3& v) { return ivec3(floor(p)) == v; });
        };
        ASSERT_EQ(found->t, 0);
        ASSERT_TRUE(is_in(capsule.a) || is_in(capsule.b));
        ++inside;
        continue;
      }
      const auto error = bench::judge_sweep(judged, faces, found.has_value(), found ? found->t : 0, 0);
      ASSERT_EQ(error.tunnelled, 0) << round << ", " << i;
      ASSERT_EQ(error.untouched, 0) << round << ", " << i;
      found ? ++contacts : ++misses;
      if (!found) continue;
      ASSERT_TRUE(grid.solid(found->voxel));
      ASSERT_NEAR(length(found->normal), 1, 0x1p-50);  // three products, a root, a quotient
      double away = found->t > 0 ? capsule.radius : std::numeric_limits<double>::infinity();
      for (const auto& face : faces) away = std::min(away, bench::to_triangle(capsule.a, capsule.b, face));
      if (found->t > 0 || away > judged.rounding()) {
        ASSERT_NEAR(found->depth, found->t > 0 ? 0 : capsule.radius - away, judged.rounding()) << round << ", " << i;
      } else {
        ASSERT_GE(found->depth, capsule.radius - judged.rounding()) << round << ", " << i;
      }
    }
  }
  EXPECT_GT(contacts, cases(3000, 300, 50));
  EXPECT_GT(misses, cases(3000, 100, 20));
  EXPECT_GT(inside, 0);
}

TEST(VoxelOverlap, MatchesATestOfAllVoxels) {
  Random random(22);
  int yes = 0, no = 0;
  for (int round = 0; round < cases(300, 40, 8); ++round) {
    const VoxelGrid grid = random_grid(random);
    const auto voxels = solid_voxels(grid);
    for (int i = 0; i < 100; ++i) {
      TurnedBox box{about(grid, random), {uniform(random, 0, 2), uniform(random, 0, 2), uniform(random, 0, 2)}};
      const dvec3 axis(uniform(random, 0.1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
      box.turn = glm::dmat3(glm::rotate(glm::dmat4(1), uniform(random, 0, 6), axis));
      const bool found = overlaps(grid, box);
      bool some = false;
      for (const ivec3& v : voxels) some = some || overlaps(box, dvec3(v), dvec3(v) + 1.0);
      ASSERT_EQ(found, some);
      ++(found ? yes : no);
    }
  }
  EXPECT_GT(yes, 100);
  EXPECT_GT(no, 100);
}

// Against points of the box: if one is in a voxel, they overlap.
TEST(VoxelOverlap, AgreesWithPointsInTheBox) {
  Random random(23);
  int met = 0;
  for (int i = 0; i < cases(20'000, 2000, 200); ++i) {
    TurnedBox box{{uniform(random, -1, 2), uniform(random, -1, 2), uniform(random, -1, 2)},
                  {uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)}};
    const dvec3 axis(uniform(random, 0.1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
    box.turn = glm::dmat3(glm::rotate(glm::dmat4(1), uniform(random, 0, 6), axis));
    bool inside = false;
    for (int j = 0; j < 100; ++j) {
      const dvec3 p = box.centre + box.turn * (box.half * dvec3(uniform(random, -1, 1), uniform(random, -1, 1),
                                                                uniform(random, -1, 1)));
      inside = inside || (p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x <= 1 && p.y <= 1 && p.z <= 1);
    }
    if (!inside) continue;
    ASSERT_TRUE(overlaps(box, dvec3(0.0), dvec3(1.0)));
    ++met;
  }
  EXPECT_GT(met, 20);
}

}  // namespace
}  // namespace scarp::test
