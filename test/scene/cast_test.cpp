// SPDX-License-Identifier: MIT
// cast() and occluded() of scarp.h: answers of the scene, rays from surfaces, and rejected rays.
#include "scarp/scene/cast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/refusal.h"
#include "scarp/scarp.h"
#include "scarp/scene/ray_arrays.h"

namespace scarp {
namespace {

using test::refusal;

// A roof: 10 m high along the middle column.
Terrain roof(Wrap wrap = Wrap::none) {
  std::vector<float> samples;
  for (int i = 0; i < 25; ++i) samples.push_back(static_cast<float>(10 - 5 * std::abs(i % 5 - 2)));
  return Terrain::own(std::move(samples), 5, 5, {.cell_x = 10, .cell_y = 10, .wrap = wrap});
}

Ray down(double x) { return {.origin = {x, 20, 30}, .direction = {0, 0, -1}}; }

TEST(Cast, MatchesTheScene) {
  const Terrain terrain = roof();
  const Scene scene = combine({{terrain}, {terrain, {.origin = {100, 0, 0}}}});
  std::vector<Ray> rays;
  for (int i = 0; i < 3000; ++i) rays.push_back({.origin = {0.05 * i, 1 + 0.01 * i, 20}, .direction = {0.1, 0, -0.4}});
  for (const Scene* of : {&terrain.scene(), &scene}) {
    std::vector<Hit> hits(rays.size()), expected(rays.size());
    std::vector<std::uint8_t> blocked(rays.size());
    cast(*of, rays, hits);
    occluded(*of, rays, blocked);
    of->closest_hits(rays, expected);
    EXPECT_EQ(hits, expected);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(cast(*of, rays[i]), hits[i]);
      EXPECT_EQ(occluded(*of, rays[i]), blocked[i] != 0);
      EXPECT_EQ(static_cast<bool>(hits[i]), blocked[i] != 0);
    }
  }
}

TEST(Cast, StartsOnTheSurfaceOfAHit) {
  const Terrain terrain = roof();
  const Ray ray = down(15);
  const Hit hit = cast(terrain, ray);
  ASSERT_TRUE(hit);
  // Along the slope and up; through the roof; the same in a batch.
  const std::vector<Ray> from_there{{.origin = ray.at(hit.t), .direction = {2, 0, 1}},
                                    {.origin = ray.at(hit.t), .direction = {1, 0, 0}}};
  EXPECT_FALSE(occluded(terrain, from_there[0], &hit));
  EXPECT_TRUE(occluded(terrain, {.origin = ray.at(hit.t), .direction = {1, 0, -1}}, &hit));
  std::vector<Hit> hits(2);
  const std::vector<const Hit*> from{&hit, nullptr};
  cast(terrain, from_there, hits, from);
  EXPECT_EQ(hits[0], cast(terrain, from_there[0], &hit));
  EXPECT_EQ(hits[1], cast(terrain, from_there[1]));
}

TEST(Cast, RejectsInvalidRays) {
  const Terrain terrain = roof();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal([&] { cast(terrain, {.origin = {NAN, 0, 0}}); }), "ray: its origin is not finite");
  EXPECT_EQ(refusal([&] { cast(terrain, {.direction = {0, kInfinity, 0}}); }), "ray: its direction is not finite");
  EXPECT_EQ(refusal([&] { cast(terrain, {.direction = {0, 0, 0}}); }), "ray: its direction is zero");
  EXPECT_EQ(refusal([&] { occluded(terrain, {.t_min = 2, .t_max = 1}); }),
            "ray: its range is 2 to 1; t_min must be finite and t_max no less");
  EXPECT_NE(refusal([&] { cast(terrain, {.start = RayStart::on_surface, .start_cell = {9, 0}}); }), "");
  EXPECT_NE(refusal([&] { cast(roof(Wrap::periodic), down(1)); }), "");
  const Hit miss;
  EXPECT_NE(refusal([&] { cast(terrain, down(1), &miss); }), "");
  Hit of_another = cast(terrain, down(15));
  of_another.object = 1;
  EXPECT_NE(refusal([&] { occluded(terrain, down(1), &of_another); }), "");
}

TEST(Cast, NamesTheFirstBadRayOfABatch) {
  const Terrain terrain = roof();
  std::vector<Ray> rays(20000, down(15));
  rays[17].origin.x = NAN;
  rays[19000].direction = dvec3(0.0);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  EXPECT_EQ(refusal([&] { cast(terrain, rays, hits); }), "ray 17 of 20000: its origin is not finite");
  rays[17] = rays[0];
  EXPECT_EQ(refusal([&] { occluded(terrain, rays, blocked); }), "ray 19000 of 20000: its direction is zero");
}

TEST(Cast, RejectsSpansOfDifferentLengths) {
  const Terrain terrain = roof();
  const std::vector<Ray> rays(3, down(15));
  std::vector<Hit> hits(2);
  std::vector<std::uint8_t> blocked(4);
  const std::vector<const Hit*> from(1);
  EXPECT_EQ(refusal([&] { cast(terrain, rays, hits); }), "batch: 3 rays, room for 2 answers");
  EXPECT_EQ(refusal([&] { occluded(terrain, rays, blocked); }), "batch: 3 rays, room for 4 answers");
  hits.resize(3);
  EXPECT_EQ(refusal([&] { cast(terrain, rays, hits, from); }), "batch: 3 rays, 1 hits to start from");
}

TEST(Cast, AcceptsEmptyBatches) {
  const Terrain terrain = roof();
  cast(terrain, std::span<const Ray>(), std::span<Hit>());
  occluded(terrain, std::span<const Ray>(), std::span<std::uint8_t>());
}

// One bad ray among good ones, in batches that are traced one by one and in larger ones.
TEST(Cast, AnswersBadRaysInvalid) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Terrain terrain = roof(), wrapped = roof(Wrap::periodic);
  const Scene scene = combine({{terrain}, {terrain, {.origin = {100, 0, 0}}}});
  const Hit no_hit;
  for (const Scene* of : {&terrain.scene(), &wrapped.scene(), &scene}) {
    for (const std::size_t count : {std::size_t{5}, std::size_t{16}, std::size_t{300}}) {
      std::vector<Ray> rays;
      for (std::size_t i = 0; i < count; ++i) {
        rays.push_back(down(5 + 0.1 * static_cast<double>(i)));
        rays.back().t_max = 100;
      }
      const std::vector<Ray> good = rays;
      std::vector<const Hit*> from(count, nullptr);
      rays[0].origin.x = nan, rays[1].direction = dvec3(0.0), rays[2].t_min = 200;
      rays[3].direction.z = -inf, from[4] = &no_hit;
      if (of->wraps()) rays.back().t_max = inf;
      std::vector<Hit> hits(count);
      std::vector<std::uint8_t> blocked(count);
      EXPECT_NE(refusal([&] { cast(*of, rays, hits, from); }), "");
      cast(*of, rays, hits, from, BadRays::answer_invalid);
      occluded(*of, rays, blocked, from, BadRays::answer_invalid);
      for (std::size_t i = 0; i < count; ++i) {
        const bool bad = i < 5 || (of->wraps() && i + 1 == count);
        Hit expected = bad ? Hit{} : cast(*of, good[i]);
        if (bad) expected.status = HitStatus::invalid;
        EXPECT_EQ(hits[i], expected) << i;
        EXPECT_EQ(blocked[i], bad ? kInvalidRay : std::uint8_t{occluded(*of, good[i])}) << i;
      }
      EXPECT_NE(refusal([&] { cast(*of, rays, std::span(hits).subspan(1), from, BadRays::answer_invalid); }), "");
      EXPECT_NE(refusal([&] { cast(*of, rays, hits, std::span(from).subspan(1), BadRays::answer_invalid); }), "");
    }
  }
}

// The same in arrays of components.
TEST(Cast, AnswersBadRaysInArraysInvalid) {
  const Terrain terrain = roof();
  const std::vector<float> ox{15, NAN, 15}, oy{20, 20, 20}, oz{30, 30, 30}, dx{0, 0, 0}, dz{-1, -1, 0};
  const RayArrays rays{
      .origin_x = ox, .origin_y = oy, .origin_z = oz, .direction_x = dx, .direction_y = dx, .direction_z = dz};
  std::vector<HitStatus> status(3);
  std::vector<float> t(3);
  std::vector<std::uint8_t> blocked(3);
  EXPECT_NE(refusal([&] { cast(terrain, rays, {.t = t}); }), "");
  cast(terrain, rays, {.t = t, .status = status}, BadRays::answer_invalid);
  occluded(terrain, rays, blocked, BadRays::answer_invalid);
  EXPECT_EQ(status, (std::vector{HitStatus::hit, HitStatus::invalid, HitStatus::invalid}));
  EXPECT_EQ(blocked, (std::vector<std::uint8_t>{1, kInvalidRay, kInvalidRay}));
  EXPECT_TRUE(std::isinf(t[1]));
}

}  // namespace
}  // namespace scarp
