// SPDX-License-Identifier: MIT
#include "scarp/source/raster/procedural_dem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"

namespace scarp {
namespace {

// FNV-1a over the bits of the heights.
std::uint64_t hash_of(const std::vector<float>& heights) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const float h : heights) {
    const auto bits = std::bit_cast<std::uint32_t>(h);
    for (int i = 0; i < 4; ++i) hash = (hash ^ (bits >> (8 * i) & 0xff)) * 0x100000001b3ULL;
  }
  return hash;
}

ProceduralDem terrain(int cols, int rows, std::uint64_t seed, TerrainKind kind) {
  ProceduralDem settings;
  settings.cols = cols;
  settings.rows = rows;
  settings.seed = seed;
  settings.kind = kind;
  return settings;
}

double mean_slope_deg(const std::vector<float>& h, int side, double cell_m) {
  double sum = 0;
  for (int row = 0; row + 1 < side; ++row) {
    for (int col = 0; col + 1 < side; ++col) {
      const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(side) + static_cast<std::size_t>(col);
      const double dx = (h[at + 1] - h[at]) / cell_m, dy = (h[at + static_cast<std::size_t>(side)] - h[at]) / cell_m;
      sum += std::atan(std::hypot(dx, dy)) * 57.29577951308232;
    }
  }
  return sum / (side - 1.0) / (side - 1.0);
}

// Frozen: a change would change every published result that names a seed.
TEST(ProceduralDemHeights, AreBitIdenticalEverywhere) {
  EXPECT_EQ(13571564658466880114u, hash_of(generate_dem(terrain(333, 257, 1, TerrainKind::fbm))));
  EXPECT_EQ(14448054023744193116u, hash_of(generate_dem(terrain(333, 257, 1, TerrainKind::ridged))));
}

TEST(ProceduralDemHeights, DoNotDependOnTilesAndThreads) {
  for (const TerrainKind kind : {TerrainKind::fbm, TerrainKind::ridged}) {
    const ProceduralDem settings = terrain(201, 150, 7, kind);
    const std::vector<float> whole = generate_dem(settings);
    {
      const ThreadLimit one(1);
      EXPECT_EQ(whole, generate_dem(settings));
    }
    std::vector<float> tiled(whole.size());
    // Tiles of an odd size, from the last to the first.
    for (int row = 150 / 37 * 37; row >= 0; row -= 37) {
      for (int col = 201 / 29 * 29; col >= 0; col -= 29) {
        fill_rectangle(settings, col, row, std::min(29, 201 - col), std::min(37, 150 - row),
                       tiled.data() + row * 201 + col, 201);
      }
    }
    EXPECT_EQ(whole, tiled);
  }
}

TEST(ProceduralDemHeights, KeepDetailFarFromTheOrigin) {
  ProceduralDem settings = terrain(65536, 65536, 3, TerrainKind::fbm);
  std::vector<float> corner(64 * 64);
  fill_rectangle(settings, 65536 - 64, 65536 - 64, 64, 64, corner.data(), 64);
  EXPECT_GT(mean_slope_deg(corner, 64, 30), 5);
  EXPECT_LT(mean_slope_deg(corner, 64, 30), 45);
}

TEST(ProceduralDemHeights, ResembleMountains) {
  for (const TerrainKind kind : {TerrainKind::fbm, TerrainKind::ridged}) {
    for (const int side : {257, 1025}) {
      for (const std::uint64_t seed : {1, 2, 3}) {
        const std::vector<float> h = generate_dem(terrain(side, side, seed, kind));
        const double slope = mean_slope_deg(h, side, 30);
        EXPECT_GT(slope, 15) << name_of(kind) << side;
        EXPECT_LT(slope, 25) << name_of(kind) << side;
      }
    }
  }
}

TEST(ProceduralDemHeights, DependOnSeedAndScaleWithTheCell) {
  ProceduralDem settings = terrain(65, 65, 1, TerrainKind::ridged);
  const std::vector<float> first = generate_dem(settings);
  settings.cell_m = 60;
  const std::vector<float> twice = generate_dem(settings);
  for (std::size_t i = 0; i < first.size(); ++i) ASSERT_EQ(2 * first[i], twice[i]);
  settings.cell_m = 30;
  settings.seed = 2;
  EXPECT_NE(first, generate_dem(settings));
}

TEST(ProceduralDemHeights, AreFiniteAtAnySize) {
  for (const auto& [cols, rows] : {std::pair(1, 1), {1, 7}, {2, 2}, {3, 1}, {17, 5}}) {
    for (const float h : generate_dem(terrain(cols, rows, 1, TerrainKind::fbm))) EXPECT_TRUE(std::isfinite(h));
  }
}

TEST(ProceduralDemHeights, RejectSettingsOutOfRange) {
  const auto broken = [](auto change) {
    ProceduralDem settings;
    change(settings);
    EXPECT_THROW(generate_dem(settings), Error);
  };
  broken([](ProceduralDem& s) { s.cols = 0; });
  broken([](ProceduralDem& s) { s.rows = 65537; });
  broken([](ProceduralDem& s) { s.cell_m = 0; });
  broken([](ProceduralDem& s) { s.cell_m = std::nan(""); });
  broken([](ProceduralDem& s) { s.cell_m = 1e300; });
  broken([](ProceduralDem& s) { s.feature_size = 1; });
  broken([](ProceduralDem& s) { s.feature_size = std::nan(""); });
}

TEST(ProceduralDemHeights, StopOnRequest) {
  EXPECT_THROW(generate_dem({}, [](double) { return false; }), Interrupted);
}

TEST(TerrainKindNames, RoundTrip) {
  for (const TerrainKind kind : {TerrainKind::fbm, TerrainKind::ridged}) EXPECT_EQ(kind, terrain_kind(name_of(kind)));
  EXPECT_FALSE(terrain_kind("FBM").has_value());
}

}  // namespace
}  // namespace scarp
