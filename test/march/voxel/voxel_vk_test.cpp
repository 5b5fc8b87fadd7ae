// SPDX-License-Identifier: MIT
// Voxel marches on a Vulkan device: adversarial grids and rays have the answers of the CPU, to the bit, with 64-bit
// integers and with words; edits arrive; and validation is silent.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "cases.h"
#include "march/voxel/spiteful_voxels.h"
#include "scarp/base/error.h"
#include "scarp/march/usual_ray.h"
#include "scarp/march/voxel/voxel_batch.glsl.h"
#include "scarp/march/voxel/voxel_proxies.glsl.h"
#include "scarp/march/voxel/voxel_queries_vk.h"
#include "vk/device_under_test.h"
#include "vk/spirv_layout.h"

namespace scarp::test {
namespace {

const int kGrids = cases(40, 8, 2);          // of a kind
const int kRaysOfKind = cases(200, 40, 10);  // per grid

// A grid with all accelerators; each march uses one of them.
struct Model {
  VoxelGrid grid;
  VoxelBox box;
  EmptySpheres spheres{grid};
  EmptyCubes cubes{grid};
  OctantCubes octants{grid};
  BrickMasks bricks{grid};

  explicit Model(VoxelGrid made, bool tight) : grid(std::move(made)), box(tight ? grid.bounds() : grid.box()) {}

  VoxelTarget target() const { return {&grid, box, &spheres, &cubes, &octants, &bricks}; }
  MarchedGrid parts(const VoxelMarchEntry& march) const {
    MarchedGrid parts{&grid, box};
    if (march.accelerator == VoxelAccelerator::spheres) parts.spheres = &spheres;
    if (march.accelerator == VoxelAccelerator::cubes) parts.cubes = &cubes;
    if (march.accelerator == VoxelAccelerator::octants) parts.octants = &octants;
    if (march.accelerator == VoxelAccelerator::bricks) parts.bricks = &bricks;
    return parts;
  }
  void edit(Random& random) {
    const VoxelBox changed = random_edit(grid, random);
    box = grid.bounds();
    spheres.update(grid, changed);
    cubes.update(grid, changed);
    octants.update(grid, changed);
    bricks.update(grid, changed);
  }
};

// Rays with the answers of the CPU.
struct Asked {
  std::vector<Ray> rays;
  std::vector<Hit> starts;
  std::vector<const Hit*> from;
  std::vector<VoxelHit> expected;
  int hits = 0;

  Asked(const Model& model, Random& random) {
    for (const VoxelRayKind& kind : spiteful_voxel_rays()) {
      for (int i = 0; i < kRaysOfKind; ++i) add(kind.make(model.grid, random), model.target(), "voxel-planes");
    }
    for (std::size_t i = 0; i < rays.size(); ++i) from.push_back(starts[i] ? &starts[i] : nullptr);
  }
  Asked(const std::vector<VoxelRay>& given, const VoxelTarget& target) : from(given.size()) {
    for (const VoxelRay& ray : given) add(ray, target, "voxel-bricks");
  }

 private:
  void add(const VoxelRay& given, const VoxelTarget& target, const char* march) {
    const Ray ray{.origin = given.origin, .direction = given.direction, .t_min = given.t_min, .t_max = given.t_max};
    const double longest = longest_of(ray.direction);
    const int exponent = is_usual(longest) ? 0 : std::ilogb(longest);
    const Ray usual = exponent == 0 ? ray : scaled_down(ray, exponent);
    VoxelHit hit;
    const auto quantised =
        quantise(VoxelRay{usual.origin, usual.direction, usual.t_min, usual.t_max, given.start_voxel}, target.box);
    if (quantised && is_direction(longest)) hit = find_voxel_march(march).cpu(target, *quantised, nullptr);
    if (hit) hit.t = std::ldexp(hit.t, -exponent);
    rays.push_back(ray);
    Hit start;
    if (given.start_voxel) start.status = HitStatus::hit, start.voxel = *given.start_voxel;
    starts.push_back(start);
    expected.push_back(hit);
    hits += static_cast<bool>(hit);
  }
};

// The number of reported failures is limited: one mistake can cause thousands.
int judge(DeviceVoxelQueries& queries, const DeviceVoxelObjects& objects, const Asked& asked, bool any,
          const std::string& what) {
  std::vector<Hit> hits(asked.rays.size());
  std::vector<std::uint32_t> entries(any ? 0 : hits.size());
  std::vector<std::uint8_t> blocked(hits.size());
  const std::vector<std::size_t> left =
      any ? queries.occluded(objects, asked.rays, asked.from, blocked)
          : queries.closest_hits(objects, asked.rays, asked.from, hits, {{}, entries});
  EXPECT_LT(left.size(), hits.size() / 20) << what;
  int failures = 0;
  std::size_t next_left = 0;
  for (std::size_t i = 0; i < hits.size() && failures < 3; ++i) {
    if (next_left < left.size() && left[next_left] == i) {
      ++next_left;
      continue;
    }
    const VoxelHit& expected = asked.expected[i];
    bool same = blocked[i] == static_cast<bool>(expected);
    if (!any) {
      same = static_cast<bool>(hits[i]) == static_cast<bool>(expected) &&
             (!expected || (hits[i].voxel == expected.voxel && hits[i].face == expected.face &&
                            hits[i].t == expected.t && entries[i] == expected.entry));
    }
    if (same) continue;
    ++failures;
    const Ray& ray = asked.rays[i];
    ADD_FAILURE() << fmt::format(
        "{}, ray {}: {} voxel ({}, {}, {}) face {} t={:a} instead of {} voxel ({}, {}, {}) face {} t={:a}, origin "
        "({:a}, {:a}, {:a}) direction ({:a}, {:a}, {:a}) t [{:a}, {:a}]",
        what, i, hits[i] ? "hit" : "miss", hits[i].voxel.x, hits[i].voxel.y, hits[i].voxel.z,
        static_cast<int>(hits[i].face), hits[i].t, expected ? "hit" : "miss", expected.voxel.x, expected.voxel.y,
        expected.voxel.z, static_cast<int>(expected.face), expected.t, ray.origin.x, ray.origin.y, ray.origin.z,
        ray.direction.x, ray.direction.y, ray.direction.z, ray.t_min, ray.t_max);
  }
  return failures;
}

class VoxelsOnDevice : public OnDevice {};

TEST_F(VoxelsOnDevice, MatchTheCpu) {
  DeviceVoxelQueries queries(device(), {.rays_at_once = 4096}), words(device(), {.rays_at_once = 4096, .words = true});
  int hits = 0, failures = 0;
  for (const VoxelGridKind& kind : spiteful_voxel_grids()) {
    Random random(7);
    std::vector<std::unique_ptr<Model>> models;
    std::vector<Asked> asked;
    for (int i = 0; i < kGrids; ++i) {
      models.push_back(std::make_unique<Model>(kind.make(random), i % 2 == 1));
      asked.emplace_back(*models.back(), random);
      hits += asked.back().hits;
    }
    for (const VoxelMarchEntry& march : voxel_marches()) {
      if (!march.gpu) continue;
      std::vector<MarchedGrid> parts;
      for (const auto& model : models) parts.push_back(model->parts(march));
      const DeviceVoxels grids(device(), parts);
      for (std::uint32_t i = 0; i < parts.size() && failures < 6; ++i) {
        const DeviceVoxelObjects objects(device(), grids, i);
        const std::string what = fmt::format("{}, {}, grid {}", march.name, kind.name, i);
        failures += judge(queries, objects, asked[i], false, what);
        if (i % 2 == 0) failures += judge(queries, objects, asked[i], true, what + ", any");
        if (i % 2 == 1) failures += judge(words, objects, asked[i], false, what + ", words");
      }
    }
  }
  EXPECT_GT(hits, kGrids * kRaysOfKind);
}

TEST_F(VoxelsOnDevice, ApplyEdits) {
  DeviceVoxelQueries queries(device(), {.rays_at_once = 4096});
  Random random(8);
  for (const char* name : {"voxel-spheres", "voxel-octants", "voxel-bricks"}) {
    const VoxelMarchEntry& march = find_voxel_march(name);
    // The second is next to it, and does not change.
    Model model(VoxelGrid({70, 40, 90}, 8), true), other(VoxelGrid({9, 9, 9}, 8), true);
    other.edit(random);
    other.grid.fill({ivec3(1), ivec3(3)}, 9);
    Model still(other.grid, true);
    DeviceVoxels grids(device(), std::vector{model.parts(march), still.parts(march)});
    for (int i = 0; i < 30 && !HasFailure(); ++i) {
      const VoxelBox before = model.grid.box();
      VoxelBox changed;
      for (int k = 0; k < (i < 5 ? 8 : 1); ++k) {
        VoxelGrid copy = model.grid;
        model.edit(random);
      }
      if (i % 7 == 3) model.grid.drop_hidden_entries();
      changed = before;
      grids.update(0, model.parts(march), changed, before);
      if (model.box.empty()) continue;
      const Asked asked(model, random);
      judge(queries, DeviceVoxelObjects(device(), grids, 0), asked, false, fmt::format("{}, edit {}", name, i));
    }
    judge(queries, DeviceVoxelObjects(device(), grids, 1), Asked(still, random), false, name);
  }
}

// Boxes of 2^34 voxels, whose tables are in chunks on the CPU; rays from one end to the other.
TEST_F(VoxelsOnDevice, MatchInLargeGrids) {
  constexpr int kSide = VoxelGrid::kMaxSide, kHeight = 64;
  constexpr int kRays = 200;
  VoxelGrid grid({kSide, kSide, kHeight}, 4);
  BrickMasks bricks(grid);
  const auto build = [&](const VoxelBox& box, std::uint32_t entry) {
    const VoxelBox changed = grid.fill(box, entry);
    bricks.update(grid, changed);
    return changed;
  };
  build({{kSide - 40, kSide - 40, 0}, {kSide, kSide, kHeight}}, 3);
  build({{0, 0, 8}, {40, 40, kHeight - 8}}, 5);
  VoxelTarget target{&grid, grid.box()};
  target.bricks = &bricks;
  Random random(9);
  std::vector<VoxelRay> rays;
  for (int i = 0; i < kRays; ++i) {
    const dvec3 to(uniform(random, kSide - 48, kSide), uniform(random, kSide - 48, kSide), uniform(random, 0, kHeight));
    const dvec3 from(uniform(random, -50, 10), uniform(random, -50, 10),
                     to.z + std::ldexp(uniform(random, -1, 1), -i % 24));
    rays.push_back(i % 2 ? VoxelRay{from, to - from} : VoxelRay{to, from - to});
  }
  DeviceVoxelQueries queries(device(), {.rays_at_once = 4096}), words(device(), {.rays_at_once = 4096, .words = true});
  for (const char* name : {"voxel-bricks", "voxel-planes"}) {
    MarchedGrid parts{&grid, grid.box()};
    if (find_voxel_march(name).accelerator == VoxelAccelerator::bricks) parts.bricks = &bricks;
    DeviceVoxels grids(device(), std::vector{parts});
    const DeviceVoxelObjects objects(device(), grids, 0);
    const Asked asked(rays, target);
    EXPECT_GT(asked.hits, kRays / 2);
    judge(queries, objects, asked, false, name);
    judge(words, objects, asked, false, fmt::format("{}, words", name));
    // A wall across the middle, then a gap in it.
    const VoxelBox wall = build({{8000, 0, 0}, {8001, kSide, kHeight}}, 7);
    grids.update(0, parts, wall, wall);
    judge(queries, objects, Asked(rays, target), false, fmt::format("{}, wall", name));
    const VoxelBox gap = grid.clear(wall);
    bricks.update(grid, gap);
    grids.update(0, parts, gap, gap);
    judge(queries, objects, asked, false, fmt::format("{}, no wall", name));
  }
}

constexpr std::uint32_t kVoxelShader[] = {
#include "scarp/march/voxel/voxel_marches.comp.inc"
};

constexpr std::uint32_t kBoxShader[] = {
#include "scarp/march/voxel/voxel_proxies.vert.inc"
};

TEST(VoxelProxiesLayout, MatchesTheShaders) {
  using glsl::ScarpVoxelView, glsl::VoxelProxies;
  EXPECT_TRUE(has_struct(
      kBoxShader,
      {offsetof(ScarpVoxelView, origin), offsetof(ScarpVoxelView, x), offsetof(ScarpVoxelView, y),
       offsetof(ScarpVoxelView, w), offsetof(ScarpVoxelView, depth), offsetof(ScarpVoxelView, direction),
       offsetof(ScarpVoxelView, margin), offsetof(ScarpVoxelView, parallel), offsetof(ScarpVoxelView, none)}));
  EXPECT_TRUE(has_struct(kBoxShader,
                         {offsetof(VoxelProxies, objects), offsetof(VoxelProxies, rays), offsetof(VoxelProxies, view),
                          offsetof(VoxelProxies, first), offsetof(VoxelProxies, second), offsetof(VoxelProxies, hits),
                          offsetof(VoxelProxies, width), offsetof(VoxelProxies, count), offsetof(VoxelProxies, turns),
                          offsetof(VoxelProxies, room)}));
}

TEST(VoxelBatchLayout, MatchesTheShaders) {
  using glsl::ScarpVoxelRay, glsl::ScarpVoxelHit, glsl::ScarpVoxelGrid, glsl::ScarpVoxelObject;
  EXPECT_TRUE(has_struct(
      kVoxelShader, {offsetof(ScarpVoxelRay, origin), offsetof(ScarpVoxelRay, direction),
                     offsetof(ScarpVoxelRay, t_min), offsetof(ScarpVoxelRay, t_max), offsetof(ScarpVoxelRay, part),
                     offsetof(ScarpVoxelRay, start), offsetof(ScarpVoxelRay, frame), offsetof(ScarpVoxelRay, room)}));
  EXPECT_TRUE(has_struct(
      kVoxelShader, {offsetof(ScarpVoxelHit, t), offsetof(ScarpVoxelHit, voxel), offsetof(ScarpVoxelHit, part),
                     offsetof(ScarpVoxelHit, face), offsetof(ScarpVoxelHit, status), offsetof(ScarpVoxelHit, steps),
                     offsetof(ScarpVoxelHit, entry)}));
  using glsl::ScarpVoxelScratch;
  EXPECT_TRUE(has_struct(kVoxelShader, {offsetof(ScarpVoxelScratch, given), offsetof(ScarpVoxelScratch, inverse),
                                        offsetof(ScarpVoxelScratch, origin), offsetof(ScarpVoxelScratch, t_per_s),
                                        offsetof(ScarpVoxelScratch, t), offsetof(ScarpVoxelScratch, t_in),
                                        offsetof(ScarpVoxelScratch, speed), offsetof(ScarpVoxelScratch, back),
                                        offsetof(ScarpVoxelScratch, entered), offsetof(ScarpVoxelScratch, longest)}));
  EXPECT_TRUE(has_struct(
      kVoxelShader,
      {offsetof(ScarpVoxelGrid, first_masks), offsetof(ScarpVoxelGrid, masks), offsetof(ScarpVoxelGrid, coloured),
       offsetof(ScarpVoxelGrid, pages), offsetof(ScarpVoxelGrid, entries), offsetof(ScarpVoxelGrid, marks),
       offsetof(ScarpVoxelGrid, bricks), offsetof(ScarpVoxelGrid, size), offsetof(ScarpVoxelGrid, low),
       offsetof(ScarpVoxelGrid, high), offsetof(ScarpVoxelGrid, entry_bits), offsetof(ScarpVoxelGrid, march),
       offsetof(ScarpVoxelGrid, octant_bytes), offsetof(ScarpVoxelGrid, none)}));
  EXPECT_TRUE(has_struct(kVoxelShader, {offsetof(ScarpVoxelObject, origin), offsetof(ScarpVoxelObject, grid),
                                        offsetof(ScarpVoxelObject, turn), offsetof(ScarpVoxelObject, part),
                                        offsetof(ScarpVoxelObject, none)}));
  for (const std::size_t stride : {sizeof(ScarpVoxelRay), sizeof(ScarpVoxelHit), sizeof(ScarpVoxelGrid),
                                   sizeof(ScarpVoxelScratch), sizeof(ScarpVoxelObject), sizeof(glsl::ScarpVoxelTurn),
                                   sizeof(glsl::ScarpBoxNode), sizeof(glsl::ScarpVoxelPage)})
    EXPECT_TRUE(has_array_stride(kVoxelShader, static_cast<std::uint32_t>(stride))) << stride;
}

}  // namespace
}  // namespace scarp::test
