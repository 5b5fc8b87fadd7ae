// SPDX-License-Identifier: MIT
// Batches of rays that stay on a Vulkan device: shaders specialised for one kind of field return the same answers as
// general ones, in one run or in many, also for rays through walls and over ground that is not solid.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "march/height/spiteful.h"
#include "march/height/spiteful_text.h"
#include "scarp/accel/device_ground.h"
#include "scarp/march/height/device_march_vk.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/vk/commands.h"
#include "scarp/vk/memory.h"
#include "vk/device_under_test.h"

namespace scarp::test {
namespace {

constexpr int kRaysOfAKind = 5;
constexpr std::size_t kKindsOfField = 4;

class BatchesOnDevice : public OnDevice {
 protected:
  // The answers to rays, in this many runs.
  struct Marched {
    std::vector<glsl::ScarpHit> hits;
    int runs = 0;
  };
  Marched march(DeviceHeightMarch& march, const DeviceGround& ground, const std::vector<glsl::ScarpRay>& rays,
                const DeviceRayQuery& query) {
    Marched marched;
    marched.hits.resize(rays.size());
    std::vector<glsl::RayBlock> ray_blocks(glsl::ray_blocks(rays.size()));
    std::vector<glsl::HitBlock> hit_blocks(ray_blocks.size());
    for (std::uint32_t i = 0; i < rays.size(); ++i)
      glsl::put_ray({ray_blocks[i / glsl::kRayBlock]}, i % glsl::kRayBlock, rays[i]);
    DeviceBuffer there(device(), ray_blocks.size() * sizeof(glsl::RayBlock), "rays"),
        hits(device(), hit_blocks.size() * sizeof(glsl::HitBlock), "hits");
    upload(there, 0, ray_blocks.data(), there.bytes());
    Commands commands(device());
    march.begin(commands, {ground.address(), there.address(), hits.address(), static_cast<std::uint32_t>(rays.size())},
                query);
    do {
      commands.run();
      ++marched.runs;
    } while (march.go_on(commands));
    download(hits, 0, hit_blocks.data(), hits.bytes());
    for (std::uint32_t i = 0; i < rays.size(); ++i)
      marched.hits[i] = glsl::hit_of_block({hit_blocks[i / glsl::kRayBlock]}, i % glsl::kRayBlock);
    return marched;
  }

  static std::vector<glsl::ScarpRay> rays_over(const FieldKind& fields, const HeightField& field, Random& random) {
    std::vector<glsl::ScarpRay> rays;
    for (const RayKind& kind : spiteful_rays()) {
      if ((fields.has & kind.aims_at) != kind.aims_at) continue;
      for (int i = 0; i < kRaysOfAKind; ++i) rays.push_back(device_ray(field, kind.make(field, random)).ray);
    }
    return rays;
  }
};

TEST_F(BatchesOnDevice, MatchWhenSpecialisedForTheField) {
  DeviceHeightMarch any_field(device(), "max-mip"), in_pieces(device(), "max-mip", 5);
  Random random(3);
  int runs = 0;
  // One field for each set of flags: compiling a march for lavapipe takes longer than running it.
  std::vector<std::uint32_t> seen;
  for (const FieldKind& fields : spiteful_fields()) {
    const HeightField field = fields.make(random);
    const std::uint32_t flags = device_field(field, nullptr).flags | glsl::kScarpStarts;
    if (seen.size() == kKindsOfField || std::ranges::find(seen, flags) != seen.end()) continue;
    seen.push_back(flags);
    const DeviceGround ground(device(), field);
    const std::vector<glsl::ScarpRay> rays = rays_over(fields, field, random);
    const Marched expected = march(any_field, ground, rays, {.statistics = true});
    EXPECT_LE(expected.runs, 2);
    const std::uint32_t kind = glsl::batch_ground_kind(flags, ground.layout().sample_type);
    const Marched found = march(in_pieces, ground, rays, {.statistics = true, .ground_kind = kind});
    runs = std::max(runs, found.runs);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(std::memcmp(&expected.hits[i], &found.hits[i], sizeof(glsl::ScarpHit)), 0)
          << fields.name << ", ray " << i << ": " << expected.hits[i].status << " and " << found.hits[i].status;
    }
  }
  EXPECT_EQ(seen.size(), kKindsOfField);
  EXPECT_GT(runs, 1);
}

TEST_F(BatchesOnDevice, CanPassThroughWalls) {
  DeviceHeightMarch max_mip(device(), "max-mip");
  Random random(4);
  int walls = 0;
  for (const FieldKind& fields : spiteful_fields()) {
    const HeightField field = fields.make(random);
    const DeviceGround ground(device(), field);
    const std::uint32_t flags = device_field(field, nullptr).flags;
    if (!field.has_cells() || field.all_nodata()) continue;
    // Limits of such marches differ.
    if ((flags & glsl::kScarpWraps) != 0 || (flags & glsl::kScarpTriangles) != 0) continue;
    std::vector<glsl::ScarpRay> rays = rays_over(fields, field, random);
    const std::uint32_t samples = ground.layout().sample_type, starts = flags | glsl::kScarpStarts;
    const std::uint32_t of_open = glsl::batch_ground_kind(starts & ~glsl::kScarpSolid, samples);
    const std::uint32_t of_solid = glsl::batch_ground_kind(starts | glsl::kScarpSolid, samples);
    const Marched open = march(max_mip, ground, rays, {.ground_kind = of_open});
    const Marched solid = march(max_mip, ground, rays, {.ground_kind = of_solid});
    for (const glsl::ScarpHit& hit : solid.hits) walls += hit.status == glsl::kScarpWall;
    for (glsl::ScarpRay& ray : rays) ray.flags |= glsl::kScarpThroughWalls;
    const Marched through = march(max_mip, ground, rays, {.ground_kind = of_solid});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(std::memcmp(&through.hits[i], &open.hits[i], sizeof(glsl::ScarpHit)), 0)
          << fields.name << ", ray " << i << ": " << open.hits[i].status << " and " << through.hits[i].status;
    }
  }
  EXPECT_GT(walls, 10);
}

}  // namespace
}  // namespace scarp::test
