// SPDX-License-Identifier: MIT
// Terrain of scarp.h: the same answers as its field and pyramid, edits, and errors.
#include "scarp/scene/terrain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/refusal.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/queries.h"
#include "scarp/scarp.h"

namespace scarp {
namespace {

using test::refusal;

constexpr int kSide = 33;

std::vector<float> waves() {
  std::vector<float> samples;
  for (int i = 0; i < kSide * kSide; ++i)
    samples.push_back(static_cast<float>(4 * std::sin(0.4 * (i % kSide)) * std::cos(0.3 * (i / kSide))));
  return samples;
}

Ray down(double x, double y) { return {.origin = {x, y, 100}, .direction = {0, 0, -1}}; }

TEST(Terrain, ReadsCallerOwnedMemoryWithoutCopyingIt) {
  std::vector<float> samples(4, 1.0f);
  Terrain terrain = Terrain::view(samples.data(), 2, 2, {.cell_x = 10, .cell_y = 10});
  EXPECT_EQ(cast(terrain, down(5, 5)).t, 99);
  samples.assign(4, 3.0f);
  terrain.samples_changed({0, 0, 2, 2});
  EXPECT_EQ(cast(terrain, down(5, 5)).t, 97);
  EXPECT_EQ(terrain.height(5, 5), 3);
  EXPECT_FALSE(terrain.height(11, 5));
}

TEST(Terrain, AcceptsStridesInEitherDirection) {
  // 3 x 2 samples in rows of 5.
  const std::vector<std::int16_t> samples{1, 2, 3, 99, 99, 4, 5, 6, 99, 99};
  const Terrain from_north = Terrain::view(samples.data(), 3, 2, {}, 5);
  EXPECT_EQ(from_north.height(0, 1), 1);
  EXPECT_EQ(from_north.height(2, 0), 6);
  const Terrain from_south = Terrain::view(samples.data() + 5, 3, 2, {}, -5);
  EXPECT_EQ(from_south.height(0, 0), 1);
  EXPECT_EQ(from_south.height(2, 1), 6);
}

TEST(Terrain, MatchesItsFieldAndPyramid) {
  const Terrain terrain = Terrain::own(waves(), kSide, kSide);
  std::vector<Ray> rays;
  for (int i = 0; i < 5000; ++i)
    rays.push_back({.origin = {0.007 * i, 31 - 0.005 * i, 5}, .direction = {0.3, -0.1 + 0.0001 * i, -0.2}});
  std::vector<Hit> hits(rays.size()), of_field(rays.size());
  cast(terrain, rays, hits);
  closest_hits(terrain.target(), rays, of_field);
  EXPECT_EQ(hits, of_field);
  EXPECT_EQ(hits[0], march_max_mip(terrain.target(), rays[0]));
}

TEST(Terrain, IsASceneOfOneField) {
  const Terrain terrain = Terrain::own(waves(), kSide, kSide);
  const Scene& scene = terrain;
  EXPECT_EQ(&scene, &terrain.scene());
  EXPECT_EQ(scene.only_heights()->cols(), kSide);
  EXPECT_EQ(scene.marches(), "max-mip");
}

TEST(Terrain, MatchesAFreshTerrainAfterEdits) {
  std::vector<float> samples = waves();
  Terrain terrain = Terrain::own(samples, kSide, kSide);
  const Terrain copy = terrain;
  const std::vector<float> tower{50, 60, 70, 80};
  terrain.set_samples({8, 9, 2, 2}, tower.data());
  for (int i = 0; i < 4; ++i)
    samples[static_cast<std::size_t>((9 + i / 2) * kSide + 8 + i % 2)] = tower[static_cast<std::size_t>(i)];
  const Terrain fresh = Terrain::own(samples, kSide, kSide);
  for (int i = 0; i < 400; ++i) {
    const Ray ray{.origin = {0.1 * i, 0, 65}, .direction = {0.02 * (50 - i), 23, 0}};
    EXPECT_EQ(cast(terrain, ray), cast(fresh, ray)) << i;
    EXPECT_EQ(cast(copy, ray), cast(fresh, ray)) << i;
  }
  EXPECT_EQ(terrain.scene().box().high.z, 80);
  EXPECT_EQ(copy.scene().box().high.z, 80);
}

TEST(Terrain, AcceptsEditsWithAStride) {
  Terrain terrain = Terrain::own(std::vector<std::int16_t>(9, 0), 3, 3);
  const std::vector<std::int16_t> samples{1, 2, 7, 3, 4, 7};
  terrain.set_samples({1, 1, 2, 2}, samples.data(), 3);
  EXPECT_EQ(terrain.height(1, 0), 3);
  EXPECT_EQ(terrain.height(2, 0), 4);
  EXPECT_EQ(terrain.height(0, 0), 0);
}

TEST(Terrain, WithoutCellsMissesEveryRay) {
  const float sample = 1;
  const Terrain terrain = Terrain::view(&sample, 1, 1);
  EXPECT_EQ(cast(terrain, down(0, 0)).status, HitStatus::miss);
  EXPECT_FALSE(occluded(terrain, down(0, 0)));
  std::vector<Ray> rays(100, down(0, 0));
  std::vector<Hit> hits(rays.size());
  cast(terrain, rays, hits);
  EXPECT_EQ(hits[99].status, HitStatus::miss);
}

TEST(Terrain, TreatsNanAsHoles) {
  std::vector<float> samples(16, 1.0f);
  samples[5] = NAN;
  const Terrain terrain = Terrain::view(samples.data(), 4, 4);
  EXPECT_FALSE(cast(terrain, down(1.5, 1.5)));
  EXPECT_TRUE(cast(terrain, down(2.5, 0.5)));
}

TEST(Terrain, RejectsBadMemory) {
  const std::vector<float> samples(12, 0.0f);
  const float* none = nullptr;
  EXPECT_EQ(refusal([&] { Terrain::view(none, 3, 4); }), "height field: the pointer to the samples is null");
  EXPECT_EQ(refusal([&] { Terrain::view(samples.data(), 3, 4, {}, 2); }),
            "height field: rows of 3 samples are 2 samples apart and overlap (the stride counts samples, not bytes)");
  EXPECT_NE(refusal([&] { Terrain::view(samples.data(), 3, 4, {}, -2); }), "");
  EXPECT_EQ(refusal([&] { Terrain::view(samples.data(), 0, 4); }),
            "height field: 0 x 4 samples (at least 1 x 1 required)");
  EXPECT_NE(refusal([&] { Terrain::view(samples.data(), 3, 4, {.cell_x = 0}); }), "");
  EXPECT_NE(refusal([&] { Terrain::own(samples, 3, 5); }), "");
  const float infinite = std::numeric_limits<float>::infinity();
  EXPECT_NE(refusal([&] { Terrain::view(&infinite, 1, 1); }), "");
}

TEST(Terrain, RejectsBadEditsWithoutChanges) {
  Terrain owned = Terrain::own(std::vector<float>(9, 1.0f), 3, 3);
  const std::vector<float> samples(9, 5.0f);
  const std::vector<std::int16_t> others(9, 5);
  const float* none = nullptr;
  EXPECT_NE(refusal([&] { owned.set_samples({2, 2, 2, 2}, samples.data()); }), "");
  EXPECT_NE(refusal([&] { owned.set_samples({0, 0, 2, 2}, samples.data(), 1); }), "");
  EXPECT_NE(refusal([&] { owned.set_samples({0, 0, 2, 2}, none); }), "");
  EXPECT_NE(refusal([&] { owned.set_samples({0, 0, 2, 2}, others.data()); }), "");
  EXPECT_EQ(owned.height(0.5, 1.5), 1);
  Terrain seen = Terrain::view(samples.data(), 3, 3);
  EXPECT_NE(refusal([&] { seen.set_samples({0, 0, 2, 2}, samples.data()); }), "");
}

}  // namespace
}  // namespace scarp
