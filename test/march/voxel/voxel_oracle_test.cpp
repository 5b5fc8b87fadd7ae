// SPDX-License-Identifier: MIT
// Every voxel march of the table against the exhaustive one, on adversarial grids and rays: the same voxel, face, t and
// entry, to the bit. A quantised ray has one answer, so there is no tolerance.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "cases.h"
#include "march/voxel/spiteful_voxels.h"
#include "scarp/accel/brick_masks.h"
#include "scarp/accel/empty_cubes.h"
#include "scarp/accel/empty_spheres.h"
#include "scarp/accel/octant_cubes.h"
#include "scarp/march/voxel/voxel_table.h"

namespace scarp::test {
namespace {

// Few rays under the sanitizers, which check memory accesses.
const int kRaysPerPair = cases(100'000, 10'000, 500);
constexpr int kRaysPerGrid = 250;

std::string text(const VoxelHit& hit) {
  return fmt::format("{} voxel ({}, {}, {}) face {} t={:a} entry {}", hit ? "hit" : "miss", hit.voxel.x, hit.voxel.y,
                     hit.voxel.z, static_cast<int>(hit.face), hit.t, hit.entry);
}

std::string text(const VoxelRay& ray) {
  return fmt::format("origin ({:a}, {:a}, {:a}) direction ({:a}, {:a}, {:a}) t [{:a}, {:a}]", ray.origin.x,
                     ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, ray.t_min,
                     ray.t_max);
}

class VoxelOracle : public testing::TestWithParam<VoxelGridKind> {};

TEST_P(VoxelOracle, AllMarchesMatchExhaustive) {
  int hits = 0, failures = 0;
  for (const VoxelRayKind& rays : spiteful_voxel_rays()) {
    Random random(1);
    std::optional<VoxelGrid> grid;
    std::optional<EmptySpheres> spheres;
    std::optional<EmptyCubes> cubes;
    std::optional<OctantCubes> octants;
    std::optional<BrickMasks> bricks;
    VoxelTarget target;
    for (int i = 0; i < kRaysPerPair && failures < 5; ++i) {
      if (i % kRaysPerGrid == 0) {
        grid.emplace(GetParam().make(random));
        spheres.emplace(*grid);
        cubes.emplace(*grid);
        octants.emplace(*grid);
        bricks.emplace(*grid);
        target = {&*grid,  i % (2 * kRaysPerGrid) == 0 ? grid->box() : grid->bounds(), &*spheres, &*cubes, &*octants,
                  &*bricks};
      }
      const VoxelRay ray = rays.make(*grid, random);
      if (target.box.empty()) continue;
      const VoxelTies ties(random_orientation(random));
      const std::optional<QuantisedRay> quantised = quantise(ray, VoxelDirection(ray.direction, ties), target.box);
      if (!quantised) continue;
      const VoxelHit expected = voxel_marches().front().cpu(target, *quantised, nullptr);
      if (expected) ++hits;
      for (const VoxelMarchEntry& march : voxel_marches().subspan(1)) {
        const VoxelHit hit = march.cpu(target, *quantised, nullptr);
        const bool blocked = march.occluded(target, *quantised);
        if (hit == expected && blocked == static_cast<bool>(expected)) continue;
        ++failures;
        ADD_FAILURE() << march.name << " on " << GetParam().name << ", " << rays.name << ": " << text(hit)
                      << (blocked ? " blocked" : " free") << "\n  judge " << text(expected) << "\n  " << text(ray);
      }
    }
  }
  if (GetParam().name != "empty or full") {
    EXPECT_GT(hits, kRaysPerPair / 100) << "rays are aimed at something";
  }
}

INSTANTIATE_TEST_SUITE_P(All, VoxelOracle, testing::ValuesIn(spiteful_voxel_grids()), [](const auto& kind) {
  std::string name(kind.param.name);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

// The oracle itself, and the quantised ray, against the ray in double away from close decisions.
TEST(VoxelOracle, HitsLieOnTheUnquantisedRay) {
  Random random(5);
  for (int i = 0; i < 20'000; ++i) {
    const VoxelGrid grid =
        i % 50 == 0 ? spiteful_voxel_grids()[1].make(random) : spiteful_voxel_grids()[0].make(random);
    const VoxelRay ray = spiteful_voxel_rays()[0].make(grid, random);
    const VoxelTarget target{&grid, grid.box()};
    const auto quantised = quantise(ray, target.box);
    if (!quantised) continue;
    const VoxelHit hit = voxel_marches().front().cpu(target, *quantised, nullptr);
    if (!hit) continue;
    const dvec3 p = ray.origin + hit.t * ray.direction;
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(p[axis], hit.voxel[axis] - 0x1p-17);
      ASSERT_LE(p[axis], hit.voxel[axis] + 1 + 0x1p-17);
    }
    if (i > 2000 && i % 50 != 0) i += 49;
  }
}

}  // namespace
}  // namespace scarp::test
