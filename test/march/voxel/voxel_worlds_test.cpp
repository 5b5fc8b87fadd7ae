// SPDX-License-Identifier: MIT
// The marches for large grids against the exhaustive one in boxes of 16,384 voxels per side: long rays whose planes are
// crossed at once, or nearly so, at the far end; and the same rays in vectors.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "cases.h"
#include "march/instruction_sets.h"
#include "march/voxel/spiteful_voxels.h"
#include "scarp/accel/brick_masks.h"
#include "scarp/march/voxel/voxel_packet.h"
#include "scarp/march/voxel/voxel_table.h"

namespace scarp::test {
namespace {

constexpr int kSide = VoxelGrid::kMaxSide;

// Nearly empty except for the last layers along the long axis, so that rays are long and hit something.
VoxelGrid needle(int axis, Random& random) {
  ivec3 size(9 + whole(random, 0, 8), 6 + whole(random, 0, 9), 7 + whole(random, 0, 7));
  size[axis] = kSide;
  VoxelGrid grid(size, 8);
  const auto place = [&](int low, int high) {
    ivec3 v(whole(random, 0, size.x - 1), whole(random, 0, size.y - 1), whole(random, 0, size.z - 1));
    v[axis] = whole(random, low, high);
    return v;
  };
  for (const int end : {0, kSide - 60}) {
    for (int i = 0; i < 150; ++i) grid.set(place(end, end + 59), static_cast<std::uint32_t>(1 + i));
  }
  for (int i = 0; i < 20; ++i) grid.set(place(0, kSide - 1), 200);
  return grid;
}

// Towards a lattice point at the far end, from a lattice point or one beside it: crossings coincide there, or differ as
// little as directions can represent.
VoxelRay long_ray(const VoxelGrid& grid, int axis, Random& random) {
  const ivec3& size = grid.size();
  dvec3 from, to;
  for (int i = 0; i < 3; ++i) {
    from[i] = whole(random, 0, size[i]), to[i] = whole(random, 0, size[i]);
    if (whole(random, 0, 2) == 0) from[i] += std::ldexp(uniform(random, -1, 1), -whole(random, 10, 40));
    if (whole(random, 0, 2) == 0) to[i] += std::ldexp(uniform(random, -1, 1), -whole(random, 5, 40));
    if (whole(random, 0, 6) == 0) from[i] = to[i];
  }
  const bool up = whole(random, 0, 1) == 1;
  from[axis] = up ? -whole(random, 0, 3) : kSide + whole(random, 0, 3);
  to[axis] = up ? kSide - whole(random, 0, 60) : whole(random, 0, 60);
  VoxelRay ray;
  ray.origin = from;
  ray.direction = (to - from) * std::ldexp(1.0, whole(random, -20, 3));
  return ray;
}

struct World {
  VoxelGrid grid;
  BrickMasks bricks{grid};
  VoxelTarget target;

  explicit World(VoxelGrid of) : grid(std::move(of)), target{&grid, grid.box()} { target.bricks = &bricks; }
};

bool suits(const VoxelMarchEntry& march) {
  return march.accelerator == VoxelAccelerator::none || march.accelerator == VoxelAccelerator::bricks;
}

// Rays of thousands of steps take seconds under sanitizers.
const int kAxes = cases(3, 3, 1);

TEST(VoxelWorlds, LongRaysMatchExhaustive) {
  Random random(21);
  int hits = 0, far = 0;
  for (int axis = 0; axis < kAxes; ++axis) {
    for (int round = 0; round < cases(4, 2, 1); ++round) {
      const World world(needle(axis, random));
      for (int i = 0; i < cases(2000, 150, 20); ++i) {
        const VoxelRay ray =
            i % 4 == 0 ? spiteful_voxel_rays()[static_cast<std::size_t>(i / 4) % spiteful_voxel_rays().size()].make(
                             world.grid, random)
                       : long_ray(world.grid, axis, random);
        const auto quantised = quantise(ray, world.target.box);
        if (!quantised) continue;
        const VoxelHit expected = voxel_marches().front().cpu(world.target, *quantised, nullptr);
        if (expected) ++hits;
        if (expected && std::abs(expected.voxel[axis] - quantised->voxel[axis]) > 12000) ++far;
        for (const VoxelMarchEntry& march : voxel_marches().subspan(1)) {
          if (!suits(march)) continue;
          ASSERT_TRUE(march.cpu(world.target, *quantised, nullptr) == expected)
              << march.name << " " << axis << " " << i;
          ASSERT_EQ(march.occluded(world.target, *quantised), static_cast<bool>(expected)) << march.name;
        }
      }
    }
  }
  EXPECT_GT(hits, cases(20, 20, 4));
  EXPECT_GT(far, cases(10, 10, 0)) << "rays are long";
}

TEST(VoxelWorlds, SimdMatchesSingleLongRays) {
  Random random(22);
  int hits = 0;
  for (int axis = 0; axis < kAxes; ++axis) {
    const World world(needle(axis, random));
    for (int round = 0; round < cases(12, 4, 1); ++round) {
      std::vector<Ray> rays;
      for (std::size_t i = 0; i < VoxelPacket::kRays; ++i) {
        const VoxelRay ray = long_ray(world.grid, axis, random);
        rays.push_back({ray.origin, ray.direction, ray.t_min, ray.t_max});
      }
      for (const std::int64_t set : instruction_sets()) {
        const InstructionSet chosen(set);
        for (const VoxelMarchEntry& march : voxel_marches()) {
          if (!march.simd || !suits(march)) continue;
          VoxelPacket packet;
          ASSERT_TRUE(load_voxel_packet(packet, rays));
          aim_voxel_packet(packet, glm::dmat3(1.0));
          march.packet(world.target, {}, packet, ~std::uint64_t{0});
          std::vector<std::size_t> hit_of(rays.size(), packet.hits);
          for (std::size_t k = 0; k < packet.hits; ++k) hit_of[static_cast<std::size_t>(packet.ray[k])] = k;
          std::uint64_t steps = 0;
          for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto quantised =
                quantise({rays[i].origin, rays[i].direction, rays[i].t_min, rays[i].t_max}, world.target.box);
            VoxelHit hit;
            MarchStats stats;
            if (quantised) hit = march.cpu(world.target, *quantised, &stats);
            steps += quantised ? stats.steps : 0;
            const std::size_t k = hit_of[i];
            ASSERT_EQ(k < packet.hits, static_cast<bool>(hit)) << march.name;
            if (!hit) continue;
            ++hits;
            ASSERT_EQ(std::bit_cast<std::uint64_t>(packet.t[k]), std::bit_cast<std::uint64_t>(hit.t)) << march.name;
            ASSERT_EQ(ivec3(packet.voxel[0][k], packet.voxel[1][k], packet.voxel[2][k]), hit.voxel) << march.name;
            ASSERT_EQ(packet.face[k], static_cast<std::int64_t>(hit.face)) << march.name;
          }
          ASSERT_EQ(packet.steps, steps) << march.name;
        }
      }
    }
  }
  EXPECT_GT(hits, cases(50, 50, 10));
}

// A cube of 2^42 voxels: only solid voxels take memory, and rays across all of it take few steps.
TEST(VoxelWorlds, AtTheLargestSizeAreSparse) {
  VoxelGrid grid(ivec3(kSide), 8);
  const ivec3 corner(kSide - 1), middle(kSide / 2 + 1, kSide / 2 - 7, 12'345);
  grid.set(corner, 7);
  grid.fill(VoxelBox{middle, middle + 9}, 3);
  EXPECT_EQ(grid.solid_count(), 730);
  EXPECT_EQ(grid.bounds(), (VoxelBox{middle, corner + 1}));
  EXPECT_EQ(grid.entry(corner), 7u);
  World world(std::move(grid));
  EXPECT_LT(world.grid.bytes() + world.bricks.bytes(), std::size_t{16} << 20);
  for (const ivec3& aim : {corner, middle, ivec3(5)}) {
    VoxelRay ray;
    ray.origin = dvec3(-10, -20, -5);
    ray.direction = dvec3(aim) + 0.5 - ray.origin;
    const auto quantised = quantise(ray, world.target.box);
    ASSERT_TRUE(quantised);
    MarchStats stats;
    const VoxelHit expected = find_voxel_march("voxel-planes").cpu(world.target, *quantised, nullptr);
    EXPECT_EQ(find_voxel_march("voxel-bricks").cpu(world.target, *quantised, &stats), expected);
    EXPECT_LT(stats.steps, 200u);
    std::vector<Ray> rays(8, Ray{ray.origin, ray.direction, 0, 1e300});
    VoxelPacket packet;
    ASSERT_TRUE(load_voxel_packet(packet, rays));
    aim_voxel_packet(packet, glm::dmat3(1.0));
    find_voxel_march("voxel-bricks").packet(world.target, {}, packet, 255);
    ASSERT_EQ(packet.hits, expected ? 8u : 0u);
    if (expected) {
      EXPECT_EQ(ivec3(packet.voxel[0][3], packet.voxel[1][3], packet.voxel[2][3]), expected.voxel);
    }
  }
  // Edits in place.
  world.bricks.update(world.grid, world.grid.clear(VoxelBox{middle, middle + 9}));
  world.bricks.update(world.grid, world.grid.fill_sphere(dvec3(corner) - 40.0, 12, 5));
  EXPECT_TRUE(world.bricks == BrickMasks(world.grid));
  EXPECT_EQ(world.grid.bounds().high, corner + 1);
}

}  // namespace
}  // namespace scarp::test
