// SPDX-License-Identifier: MIT
// Rays in vectors against the scalar marches, on every instruction set that this machine has: the same hits, voxels,
// faces, t and steps, to the bit.
#include "scarp/march/voxel/voxel_packet.h"

#include <gtest/gtest.h>

#include <bit>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "march/instruction_sets.h"
#include "march/voxel/spiteful_voxels.h"
#include "scarp/accel/brick_masks.h"
#include "scarp/accel/empty_cubes.h"
#include "scarp/accel/empty_spheres.h"
#include "scarp/accel/octant_cubes.h"
#include "scarp/march/usual_ray.h"
#include "scarp/march/voxel/voxel_table.h"

namespace scarp::test {
namespace {

#ifdef NDEBUG
constexpr int kPackets = 12;
#else
constexpr int kPackets = 1;
#endif

double uniform(Random& random) { return std::uniform_real_distribution<double>(0, 1)(random); }

class VoxelPacketOf : public testing::TestWithParam<VoxelGridKind> {};

TEST_P(VoxelPacketOf, MatchesSingleRays) {
  int hits = 0;
  for (const std::int64_t set : instruction_sets()) {
    const InstructionSet chosen(set);
    Random random(7);
    for (const VoxelRayKind& kind : spiteful_voxel_rays()) {
      for (int round = 0; round < kPackets; ++round) {
        const VoxelGrid grid = GetParam().make(random);
        const EmptySpheres spheres(grid);
        const EmptyCubes cubes(grid);
        const OctantCubes octants(grid);
        const BrickMasks bricks(grid);
        const VoxelTarget target{&grid, round % 2 ? grid.box() : grid.bounds(), &spheres, &cubes, &octants, &bricks};
        if (target.box.empty()) continue;
        VoxelStand stand;
        if (round % 3 == 2) {
          const glm::dmat3 turn(glm::rotate(glm::dmat4(1), 6 * uniform(random), dvec3(1, 2, -1)));
          stand = {glm::inverse(0.25 * turn), dvec3(3, -5, 7)};
        } else {
          stand.grid_from_world = transpose(random_orientation(random));
        }
        stand.ties = VoxelTies(stand.grid_from_world);
        stand.room = round % 2 ? 0 : kSceneRoom;
        // As in calls by a scene: some rays are masked out.
        VoxelPacket packet;
        std::vector<VoxelRay> rays(round % 4 == 0 ? 1 + random() % VoxelPacket::kRays : VoxelPacket::kRays);
        std::vector<Ray> in_world;
        for (VoxelRay& ray : rays) {
          ray = kind.make(grid, random);
          // Signed permutations keep the ray near the grid.
          if (round % 3 != 2) {
            ray.origin = transpose(stand.grid_from_world) * ray.origin;
            ray.direction = transpose(stand.grid_from_world) * ray.direction;
          }
          in_world.push_back({ray.origin + stand.origin, ray.direction, ray.t_min, ray.t_max});
        }
        const bool usual = std::all_of(in_world.begin(), in_world.end(),
                                       [](const Ray& ray) { return is_usual(longest_of(ray.direction)); });
        ASSERT_EQ(load_voxel_packet(packet, in_world), usual);
        ASSERT_EQ(packet.count, rays.size());
        const std::uint64_t all = ~std::uint64_t{0} >> (64 - packet.count), asked = round % 5 ? all : all & random();
        aim_voxel_packet(packet, stand.grid_from_world, stand.ties);
        for (const VoxelMarchEntry& march : voxel_marches()) {
          if (!march.simd) continue;
          packet.steps = 0;
          const std::uint64_t met = march.packet(target, stand, packet, asked);
          ASSERT_EQ(met & ~asked, 0u);
          std::vector<std::size_t> hit_of(VoxelPacket::kRays, packet.hits);
          for (std::size_t k = 0; k < packet.hits; ++k) {
            std::size_t& of = hit_of[static_cast<std::size_t>(packet.ray[k])];
            ASSERT_EQ(of, packet.hits);
            of = k;
          }
          std::uint64_t steps = 0;
          for (std::size_t i = 0; i < packet.count; ++i) {
            if (!(asked >> i & 1)) continue;
            VoxelRay local = rays[i];
            local.start_voxel.reset();
            local.room = stand.room;
            const dvec3 world(packet.origin[0][i], packet.origin[1][i], packet.origin[2][i]);
            local.origin = stand.grid_from_world * (world - stand.origin);
            local.direction = stand.grid_from_world * local.direction;
            const auto quantised = quantise(local, VoxelDirection(local.direction, stand.ties), target.box);
            ASSERT_EQ(met >> i & 1, quantised ? 1u : 0u) << march.name << ", " << kind.name;
            if (!quantised) continue;
            MarchStats stats;
            const VoxelHit hit = march.cpu(target, *quantised, &stats);
            const std::size_t k = hit_of[i];
            ASSERT_EQ(k < packet.hits, static_cast<bool>(hit)) << march.name << ", " << kind.name;
            steps += stats.steps;
            if (!hit) continue;
            ++hits;
            ASSERT_EQ(std::bit_cast<std::uint64_t>(packet.t[k]), std::bit_cast<std::uint64_t>(hit.t)) << march.name;
            ASSERT_EQ(ivec3(packet.voxel[0][k], packet.voxel[1][k], packet.voxel[2][k]), hit.voxel) << march.name;
            ASSERT_EQ(packet.face[k], static_cast<std::int64_t>(hit.face)) << march.name;
          }
          ASSERT_EQ(packet.steps, steps) << march.name << ", " << kind.name;
        }
      }
    }
  }
  if (GetParam().name != "empty or full") {
    EXPECT_GT(hits, 8 * kPackets) << "rays are aimed at something";
  }
}

INSTANTIATE_TEST_SUITE_P(All, VoxelPacketOf, testing::ValuesIn(spiteful_voxel_grids()), [](const auto& kind) {
  std::string name(kind.param.name);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

}  // namespace
}  // namespace scarp::test
