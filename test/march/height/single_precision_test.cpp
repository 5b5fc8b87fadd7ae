// SPDX-License-Identifier: MIT
// The shader text of max-mip, compiled as C++ with floats, on the oracle's fields and rays: no GPU is needed to verify
// its decisions. RoundingJudge decides which answers are valid.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "cases.h"
#include "march/glsl_host.h"
#include "march/height/rounding_judge.h"
#include "march/height/shader_ray.h"
#include "march/height/spiteful.h"
#include "march/height/spiteful_text.h"
#include "scarp/march/height/device_ray.h"
#include "scarp/march/height/float_ray.glsl.h"
#include "scarp/march/height/max_mip.glsl.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/max_mip_lean.glsl.h"

namespace scarp::test {
namespace {

const int kRaysPerPair = cases(2'500, 500, 40);
const int kWideRays = cases(500, 100, 20);
constexpr int kRaysPerField = 250;

// Number of rays that the lean pass has left to the exact text.
std::size_t lean_rays = 0, doubtful_rays = 0;

// Both passes of a device.
glsl::ScarpHit march_lean(const glsl::ScarpField& ground, const glsl::ScarpRay& ray, bool any) {
  const glsl::ScarpLeanCodes codes = device_codes(*glsl::host_field, *glsl::host_pyramid);
  glsl::ScarpField field = ground;
  field.flags |= glsl::kScarpStarts;
  glsl::ScarpHit hit = glsl::scarp_no_hit();
  glsl::ScarpLean at = glsl::scarp_lean_begin();
  while (!glsl::scarp_lean_on(field, codes, ray, any, at, hit)) {
  }
  ++lean_rays;
  if (hit.status != glsl::kScarpDoubtful) return hit;
  ++doubtful_rays;
  return glsl::scarp_max_mip(ground, ray, any);
}

// Casts rays of a kind over fields of a kind; returns the number of those whose status differs from that in double.
int check(const FieldKind& fields, const RayKind& kind, std::size_t seed, int rays, bool lean) {
  Random random(seed);
  int other_status = 0, bad = 0;
  for (int done = 0; done < rays && bad < 3; done += kRaysPerField) {
    const HeightField field = fields.make(random);
    const MaxPyramid pyramid(field);
    glsl::host_field = &field;
    glsl::host_pyramid = &pyramid;
    glsl::host_quads.emplace(field, pyramid);
    for (int i = 0; i < std::min(rays, kRaysPerField) && bad < 3; ++i) {
      const Ray ray = kind.make(field, random);
      const DeviceRay prepared = device_ray(field, ray);
      glsl::ScarpHit answer{}, any{};
      if (prepared.marches) {
        const glsl::ScarpField ground = device_field(field, &pyramid);
        answer = lean ? march_lean(ground, prepared.ray, false) : glsl::scarp_max_mip(ground, prepared.ray, false);
        any = lean ? march_lean(ground, prepared.ray, true) : glsl::scarp_max_mip(ground, prepared.ray, true);
      }
      const Hit hit = hit_from_device(ray, prepared, answer);
      const bool blocked = prepared.marches && (any.status == glsl::kScarpHit || any.status == glsl::kScarpWall);
      const RoundingJudge judge(field, ray);
      const Hit exact = march_max_mip({&field, &pyramid}, ray);
      other_status += exact.status != hit.status;
      std::string objection = judge.objection(hit);
      if (objection.empty() && blocked != static_cast<bool>(hit)) objection = "any-hit contradicts closest-hit";
      // The judge must not be stricter than double precision.
      const std::string self = judge.objection(exact);
      if (!self.empty()) objection += " / the march in double: " + self;
      if (objection.empty()) continue;
      ++bad;
      ADD_FAILURE() << objection << "\n  on " << fields.name << ", ray " << kind.name << ": " << text(ray)
                    << "\n  in double " << text(exact) << "\n  in single " << text(hit);
    }
  }
  return other_status;
}

class SinglePrecision : public testing::TestWithParam<Pair> {};

TEST_P(SinglePrecision, MaxMipMatchesTheSurface) {
  const auto [field, ray] = GetParam();
  const RayKind& kind = spiteful_rays()[ray];
  const int others = check(spiteful_fields()[field], kind, 1000 * field + ray, kRaysPerPair, false);
  // Rays that are not aimed at anything rarely meet a rounding tie.
  if (kind.name == "random" || kind.name == "from above") {
    EXPECT_LE(others, std::max(1, kRaysPerPair / 1000));
  }
}

TEST_P(SinglePrecision, BothPassesMatchTheSurface) {
  const auto [field, ray] = GetParam();
  check(spiteful_fields()[field], spiteful_rays()[ray], 1000 * field + ray, kRaysPerPair, true);
  RecordProperty("doubtful", std::to_string(doubtful_rays) + " of " + std::to_string(lean_rays));
}

INSTANTIATE_TEST_SUITE_P(Spiteful, SinglePrecision, testing::ValuesIn(pairs()), name_of_pair);

// Rays computed by a shader: start and direction in floats, clipped to the field in floats.
TEST(SinglePrecisionFromFloats, MaxMipMatchesTheSurface) {
  for (const FieldKind& fields : spiteful_fields()) {
    for (const std::size_t kind : {0, 1, 2, 3}) {
      Random random(kind);
      const HeightField field = fields.make(random);
      const MaxPyramid pyramid(field);
      if (!field.has_cells() || field.all_nodata()) continue;
      glsl::host_field = &field;
      glsl::host_pyramid = &pyramid;
      const glsl::ScarpField ground = device_field(field, &pyramid);
      for (int i = 0; i < 100; ++i) {
        const auto made = shader_ray(field, spiteful_rays()[kind].make(field, random));
        if (!made) continue;
        const Ray& ray = made->ray;
        DeviceRay prepared;
        prepared.marches = glsl::scarp_ray_from(ground, made->origin, made->direction, made->end, prepared.ray);
        prepared.begin = double{prepared.ray.travelled};
        prepared.per_time = 1 / made->speed;
        glsl::ScarpHit answer{};
        if (prepared.marches) answer = glsl::scarp_max_mip(ground, prepared.ray, false);
        const Hit hit = hit_from_device(ray, prepared, answer);
        ASSERT_EQ(RoundingJudge(field, ray, 1024, 0x1p-24).objection(hit), "")
            << fields.name << ", " << spiteful_rays()[kind].name << ": " << text(ray) << "\n  " << text(hit);
      }
    }
  }
}

TEST(SinglePrecisionAcrossTiles, MaxMipMatchesTheSurface) {
  for (std::size_t field = 0; field < wide_fields().size(); ++field) {
    for (std::size_t ray = 0; ray < rays_across_tiles().size(); ++ray) {
      for (const bool lean : {false, true})
        check(wide_fields()[field], rays_across_tiles()[ray], 100 * field + ray, kWideRays, lean);
    }
  }
}

// Any-hit looks ahead: it agrees with closest-hit all the same, and reads less. Levels and rising rays have no other
// early answer.
TEST(SinglePrecisionLookingAhead, AnyHitAgreesWithClosestHit) {
  const int kRays = cases(50'000, 10'000, 500);
  for (const Surface surface : {Surface::bilinear, Surface::triangles}) {
    const HeightField field = hills(2100, 900, surface);
    const MaxPyramid pyramid(field);
    glsl::host_field = &field;
    glsl::host_pyramid = &pyramid;
    const glsl::ScarpField ground = device_field(field, &pyramid);
    Random random(32);
    std::uint64_t hits = 0, closest_fetches = 0, any_fetches = 0;
    for (int i = 0; i < kRays; ++i) {
      Ray ray = along_hills(field, random, i % 2);
      // Some rays end just in front of their hit, or just behind it.
      const Hit first = march_max_mip({&field, &pyramid}, ray);
      if (first && i % 3 == 0) ray.t_max = first.t * uniform(random, 0.98, 1.02);
      const DeviceRay prepared = device_ray(field, ray);
      if (!prepared.marches) continue;
      const glsl::ScarpHit closest = glsl::scarp_max_mip(ground, prepared.ray, false);
      const glsl::ScarpHit any = glsl::scarp_max_mip(ground, prepared.ray, true);
      ASSERT_EQ(any.status == glsl::kScarpHit, closest.status == glsl::kScarpHit) << text(ray);
      if (closest.status != glsl::kScarpHit || ray.direction.z < 0) continue;
      ++hits;
      closest_fetches += closest.fetches;
      any_fetches += any.fetches;
    }
    EXPECT_GT(hits, static_cast<std::uint64_t>(kRays / 5));
    EXPECT_LT(any_fetches, closest_fetches);
  }
}

// Level ground as high as every block's minimum: a ray along it from its surface is not below it.
TEST(SinglePrecisionLookingAhead, IgnoresGroundThatARayRunsAlong) {
  constexpr int kCols = 2100, kRows = 900;
  std::vector<std::int16_t> samples(std::size_t{kCols} * kRows, 100);
  samples.back() = 200;
  const HeightField field = HeightField::own(std::move(samples), kCols, kRows);
  const MaxPyramid pyramid(field);
  glsl::host_field = &field;
  glsl::host_pyramid = &pyramid;
  const glsl::ScarpField ground = device_field(field, &pyramid);
  Random random(33);
  for (int i = 0; i < 1000; ++i) {
    Ray ray = along_hills(field, random, true);
    ray.direction.z = 0;
    const DeviceRay prepared = device_ray(field, ray);
    EXPECT_EQ(glsl::scarp_max_mip(ground, prepared.ray, true).status,
              glsl::scarp_max_mip(ground, prepared.ray, false).status)
        << text(ray);
  }
}

}  // namespace
}  // namespace scarp::test
