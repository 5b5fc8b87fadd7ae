// SPDX-License-Identifier: MIT
// The accelerators of voxel grids against their definitions by brute force, and after edits against a rebuild.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "cases.h"
#include "march/instruction_sets.h"
#include "march/voxel/spiteful_voxels.h"
#include "scarp/accel/brick_masks.h"
#include "scarp/accel/empty_cubes.h"
#include "scarp/accel/empty_spheres.h"
#include "scarp/accel/octant_cubes.h"
#include "scarp/base/error.h"

namespace scarp::test {
namespace {

std::vector<ivec3> solid_voxels(const VoxelGrid& grid) {
  std::vector<ivec3> voxels;
  for_each_voxel(grid.box(), [&](const ivec3& v) {
    if (grid.solid(v)) voxels.push_back(v);
  });
  return voxels;
}

int chebyshev(const ivec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

int cube_distance(const std::vector<ivec3>& solid, const ivec3& v) {
  int least = EmptyCubes::kFarthest;
  for (const ivec3& s : solid) least = std::min(least, chebyshev(s - v));
  return least;
}

int sphere_distance(const std::vector<ivec3>& solid, const ivec3& v) {
  std::int64_t least = std::int64_t{EmptySpheres::kFarthest} * EmptySpheres::kFarthest;
  for (const ivec3& s : solid) {
    if (s == v) return EmptySpheres::kSolid;
    const ivec3 gap = glm::max(glm::abs(s - v) - 1, 0);
    least = std::min<std::int64_t>(least, gap.x * gap.x + gap.y * gap.y + gap.z * gap.z);
  }
  int distance = 0;
  while ((distance + 1) * (distance + 1) <= least) ++distance;
  return distance;
}

int octant_side(const std::vector<ivec3>& solid, const ivec3& v, int octant) {
  int least = OctantCubes::kLargest;
  for (const ivec3& s : solid) {
    ivec3 ahead = s - v;
    for (int axis = 0; axis < 3; ++axis) {
      if (octant >> axis & 1) ahead[axis] = -ahead[axis];
    }
    if (ahead.x >= 0 && ahead.y >= 0 && ahead.z >= 0) least = std::min(least, chebyshev(ahead));
  }
  return least;
}

// Accelerators that are built with SIMD.
struct Built {
  EmptyCubes cubes;
  EmptySpheres spheres;
  OctantCubes octants;

  explicit Built(const VoxelGrid& grid) : cubes(grid), spheres(grid), octants(grid) {}
  void update(const VoxelGrid& grid, const VoxelBox& changed) {
    cubes.update(grid, changed);
    spheres.update(grid, changed);
    octants.update(grid, changed);
  }
  friend bool operator==(const Built&, const Built&) = default;
};

// Every seventh voxel in builds with assertions.
void expect_as_defined(const VoxelGrid& grid, const Built& built) {
  const int apart = cases(1, 1, 7);
  int index = 0;
  const std::vector<ivec3> solid = solid_voxels(grid);
  for_each_voxel(grid.box(), [&](const ivec3& v) {
    if (index++ % apart != 0) return;
    ASSERT_EQ(built.cubes.distance(v), cube_distance(solid, v));
    ASSERT_EQ(built.spheres.distance(v), sphere_distance(solid, v)) << v.x << " " << v.y << " " << v.z;
    for (int octant = 0; octant < 8; ++octant) ASSERT_EQ(built.octants.side(v, octant), octant_side(solid, v, octant));
  });
}

class VoxelAccelerators : public testing::TestWithParam<VoxelGridKind> {};

TEST_P(VoxelAccelerators, MatchTheirDefinitions) {
  Random random(11);
  for (int i = 0; i < 3; ++i) {
    VoxelGrid grid = GetParam().make(random);
    while (grid.size().x * grid.size().y * grid.size().z > 4000) grid = GetParam().make(random);
    const Built built(grid);
    const BrickMasks bricks(grid);
    expect_as_defined(grid, built);
    for_each_voxel(grid.box(), [&](const ivec3& v) {
      if (grid.solid(v)) {
        ASSERT_TRUE(bricks.sector(v >> 4) >> VoxelGrid::bit_of(v >> 2) & 1);
      }
    });
    for (const std::int64_t set : instruction_sets()) {
      const InstructionSet chosen(set);
      EXPECT_TRUE(built == Built(grid));
    }
  }
}

TEST_P(VoxelAccelerators, AllCubeBuildersAgree) {
  Random random(12);
  for (int i = 0; i < cases(4, 4, 1); ++i) {
    const VoxelGrid grid = GetParam().make(random);
    const EmptyCubes rows(grid, CubeBuilder::rows);
    EXPECT_TRUE(rows == EmptyCubes(grid, CubeBuilder::bit_parallel));
    EXPECT_TRUE(rows == EmptyCubes(grid, CubeBuilder::summed_area));
  }
}

TEST_P(VoxelAccelerators, MatchARebuildAfterEdits) {
  Random random(13);
  for (int i = 0; i < cases(3, 3, 1); ++i) {
    VoxelGrid grid = GetParam().make(random);
    Built built(grid);
    BrickMasks bricks(grid);
    for (int edit = 0; edit < 8; ++edit) {
      const VoxelBox changed = random_edit(grid, random);
      built.update(grid, changed);
      bricks.update(grid, changed);
      ASSERT_TRUE(built == Built(grid));
      ASSERT_TRUE(bricks == BrickMasks(grid));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, VoxelAccelerators, testing::ValuesIn(spiteful_voxel_grids()), [](const auto& kind) {
  std::string name(kind.param.name);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

// Rows shorter than a vector, as long as one or several vectors, and beyond the longest run that counts; along each
// axis; before and after edits.
TEST(VoxelAccelerators, MatchTheirDefinitionsForRowsOfAnyLength) {
  Random random(14);
  for (const ivec3& size : {ivec3(32, 9, 7), ivec3(31, 7, 9), ivec3(33, 6, 5), ivec3(64, 5, 5), ivec3(101, 6, 3),
                            ivec3(400, 3, 3), ivec3(3, 400, 3), ivec3(3, 3, 400), ivec3(32, 1, 1), ivec3(1, 1, 32)}) {
    VoxelGrid grid(size, 1);
    Built built(grid);
    for (int edit = 0; edit < 6; ++edit) {
      const ivec3 at = {uniform(random, 0, size.x), uniform(random, 0, size.y), uniform(random, 0, size.z)};
      const VoxelBox changed = edit == 4 ? grid.clear({ivec3(0), (size + 1) / 2}) : grid.fill({at, at + 1}, 1);
      const Built before = built;
      built.update(grid, changed);
      expect_as_defined(grid, built);
      for (const std::int64_t set : instruction_sets()) {
        const InstructionSet chosen(set);
        EXPECT_TRUE(built == Built(grid));
        Built updated = before;
        updated.update(grid, changed);
        EXPECT_TRUE(built == updated);
      }
    }
  }
}

// Edits may have effects far away, beyond another solid voxel, on all sides or on one side. These edits add and remove
// voxels at once, and report larger boxes than they change.
TEST(VoxelAccelerators, MatchARebuildAfterHostileEdits) {
  Random random(15);
  const std::array sizes{ivec3(70, 31, 43), ivec3(129, 23, 20), ivec3(31, 90, 24)};
  for (const ivec3& size : std::span(sizes).first(static_cast<std::size_t>(cases(3, 3, 1)))) {
    for (const int scene : {0, 1, 2, 3}) {
      VoxelGrid grid(size, 1);
      if (scene == 1) grid.set(size - 1, 1);
      if (scene == 2) grid.fill({ivec3(0), {size.x, size.y, 2}}, 1);
      if (scene == 3) {
        for (int i = 0; i < 40; ++i)
          grid.set(ivec3(uniform(random, 0, size.x), uniform(random, 0, size.y), uniform(random, 0, size.z)), 1);
      }
      Built built(grid);
      for (int edit = 0; edit < cases(8, 8, 4); ++edit) {
        const dvec3 at(uniform(random, -2, size.x + 2), uniform(random, -2, size.y + 2),
                       uniform(random, -2, size.z + 2));
        const double radius = uniform(random, 0, 9);
        const ivec3 low(at), high = low + ivec3(uniform(random, 1, 12), uniform(random, 1, 12), uniform(random, 1, 12));
        VoxelBox changed;
        if (edit % 4 == 0) changed = grid.fill_sphere(at, radius, 1);
        if (edit % 4 == 1) changed = grid.clear_sphere(at + 1.5, radius);
        if (edit % 4 == 2) {
          // Some voxels are added, some removed.
          changed = grid.edit({low, high}, [&](const ivec3&, const VoxelGrid::Voxel&) {
            return uniform(random, 0, 1) < 0.3 ? VoxelGrid::Voxel(1) : VoxelGrid::Voxel();
          });
        }
        if (edit % 4 == 3) {
          grid.clear(VoxelBox{low, high});
          changed = VoxelBox{low, high}.grown(3);
        }
        const Built before = built, anew(grid);
        for (const std::int64_t set : instruction_sets()) {
          const InstructionSet chosen(set);
          built = before;
          built.update(grid, changed);
          ASSERT_TRUE(built.cubes == anew.cubes) << scene << " " << edit;
          ASSERT_TRUE(built.spheres == anew.spheres) << scene << " " << edit;
          ASSERT_TRUE(built.octants == anew.octants) << scene << " " << edit;
        }
      }
    }
  }
}

TEST(VoxelAccelerators, SaturateAtOneByte) {
  VoxelGrid grid({400, 3, 3}, 1);
  EXPECT_EQ(EmptyCubes(grid).distance({200, 1, 1}), 255);
  EXPECT_EQ(EmptySpheres(grid).distance({200, 1, 1}), 254);
  grid.set({399, 1, 1}, 1);
  for (const CubeBuilder builder : {CubeBuilder::rows, CubeBuilder::bit_parallel, CubeBuilder::summed_area}) {
    const EmptyCubes cubes(grid, builder);
    EXPECT_EQ(cubes.distance({0, 1, 1}), 255);
    EXPECT_EQ(cubes.distance({145, 0, 0}), 254);
  }
  const EmptySpheres spheres(grid);
  EXPECT_EQ(spheres.distance({0, 1, 1}), 254);
  EXPECT_EQ(spheres.distance({200, 1, 1}), 198);
  EXPECT_EQ(OctantCubes(grid).side({200, 1, 1}, 0), 199);
  EXPECT_EQ(OctantCubes(grid).side({200, 1, 1}, 1), 255);
}

// Levels above sectors match the content of the cells below, before and after edits.
TEST(VoxelAccelerators, HaveLevelsForLargeGrids) {
  Random random(16);
  for (const ivec3& size : {ivec3(520, 7, 30), ivec3(3, 1100, 18), ivec3(600, 70, 4200)}) {
    VoxelGrid grid(size, 1);
    BrickMasks bricks(grid);
    EXPECT_GE(bricks.levels().size(), 3u);
    for (int edit = 0; edit < 12; ++edit) {
      const ivec3 at(uniform(random, 0, size.x), uniform(random, 0, size.y), uniform(random, 0, size.z));
      const VoxelBox box{at, at + whole(random, 1, 90)};
      bricks.update(grid, edit % 3 == 2 ? grid.clear(box) : grid.fill(box, 1));
      ASSERT_TRUE(bricks == BrickMasks(grid));
      int side = 4;  // voxels of the cells below
      for (const BrickMasks::Level& level : bricks.levels()) {
        for_each_voxel({ivec3(0), glm::min(level.size, 4)}, [&](const ivec3& cell) {
          for (int i = 0; i < 64; ++i) {
            const ivec3 child = 4 * cell + ivec3(i & 3, i >> 2 & 3, i >> 4);
            const VoxelBox voxels = intersection({side * child, side * child + side}, grid.box());
            if (voxels.empty() || side > 64) continue;
            bool any = false;
            for_each_voxel({voxels.low >> 2, (voxels.high + 3) >> 2},
                           [&](const ivec3& brick) { any = any || grid.mask(brick) != 0; });
            ASSERT_EQ(level.mask(cell) >> i & 1, any ? 1u : 0u);
          }
        });
        side *= 4;
      }
    }
  }
}

TEST(VoxelAccelerators, RejectOversizedGrids) {
  const VoxelGrid grid({513, 1, 1}, 1);
  EXPECT_THROW((EmptyCubes(grid)), Error);
  EXPECT_THROW((EmptySpheres(grid)), Error);
  try {
    OctantCubes{VoxelGrid({4096, 4096, 4096}, 1)};
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(
        std::string(error.what()),
        "octant cubes: 4096 x 4096 x 4096 voxels would take 549755813888 bytes (limited to 512 voxels per side; use "
        "voxel-bricks)");
  }
  EXPECT_NO_THROW((BrickMasks(grid)));
}

// Above the size at which another builder is used.
TEST(VoxelAccelerators, AllCubeBuildersAgreeOnALargeGrid) {
  VoxelGrid grid({100, 90, 70}, 1);
  grid.fill_sphere({20, 70, 30}, 9, 1);
  grid.fill({{90, 3, 60}, {95, 30, 61}}, 1);
  const EmptyCubes cubes(grid);
  EXPECT_TRUE(cubes == EmptyCubes(grid, CubeBuilder::bit_parallel));
  EXPECT_TRUE(cubes == EmptyCubes(grid, CubeBuilder::summed_area));
}

}  // namespace
}  // namespace scarp::test
