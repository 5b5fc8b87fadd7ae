// SPDX-License-Identifier: MIT
#include "scarp/source/raster/tile_layout.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

namespace scarp {
namespace {

TEST(TileLayout, SingleTileIsTheWhole) {
  const TileRect all = bounding_rect({{-3, 4, 10, 20}});
  EXPECT_EQ(all.col, -3);
  EXPECT_EQ(all.row, 4);
  EXPECT_EQ(all.cols, 10);
  EXPECT_EQ(all.rows, 20);
  EXPECT_EQ(covered_samples({{-3, 4, 10, 20}}), 200);
}

TEST(TileLayout, JoinsTilesAcrossTheAntimeridian) {
  using Turns = std::vector<int>;
  const auto turns = [](const std::vector<TileSpan>& tiles) { return turns_side_by_side(tiles, 360, 0.01); };
  EXPECT_EQ(turns({{179, 180}, {-180, -179}}), (Turns{0, 1}));
  EXPECT_EQ(turns({{-180, -179}, {179, 180}, {-179, -170}}), (Turns{1, 0, 1}));
  EXPECT_EQ(turns({{-180, -170}, {170, 180}, {160, 170.000001}, {-180.000001, -170}}), (Turns{1, 0, 0, 1}));
  EXPECT_EQ(turns({{359, 360}, {0, 1}}), (Turns{0, 1}));
  // Two conventions for one position.
  EXPECT_EQ(turns({{200, 210}, {-150, -140}}), (Turns{0, 1}));
  // Nothing to gain: side by side already, far apart, the whole globe, more than the globe.
  EXPECT_EQ(turns({{5, 6}, {6, 7}}), (Turns{0, 0}));
  EXPECT_EQ(turns({{-80, -70}, {100, 110}}), (Turns{0, 0}));
  EXPECT_EQ(turns({{-180, 0}, {0, 180}}), (Turns{0, 0}));
  EXPECT_EQ(turns({{0, 180}, {180, 360}}), (Turns{0, 0}));
  EXPECT_EQ(turns({{-180.5, 180.5}}), (Turns{0}));
}

TEST(TileLayout, CountsOverlapsOnce) {
  EXPECT_EQ(covered_samples({{0, 0, 4, 4}, {0, 0, 4, 4}}), 16);
  EXPECT_EQ(covered_samples({{0, 0, 4, 4}, {3, 3, 4, 4}}), 31);
  EXPECT_EQ(covered_samples({{0, 0, 10, 10}, {2, 2, 3, 3}, {2, 6, 3, 3}}), 100);
}

TEST(TileLayout, LargeExtentsDoNotOverflow) {
  constexpr std::int64_t kSide = 2147483647;
  EXPECT_EQ(covered_samples({{0, 0, kSide, kSide}, {kSide, kSide, kSide, kSide}}), 2.0 * kSide * kSide);
}

RC_GTEST_PROP(TileLayout, MatchesACountOfSamples, ()) {
  std::vector<TileRect> tiles(*rc::gen::inRange<std::size_t>(1, 9));
  for (TileRect& tile : tiles) {
    tile = {*rc::gen::inRange(-9, 9), *rc::gen::inRange(-9, 9), *rc::gen::inRange(1, 8), *rc::gen::inRange(1, 8)};
  }
  int counted = 0;
  const TileRect all = bounding_rect(tiles);
  for (int row = -20; row < 20; ++row) {
    for (int col = -20; col < 20; ++col) {
      const auto inside = [&](const TileRect& t) {
        return col >= t.col && col < t.col + t.cols && row >= t.row && row < t.row + t.rows;
      };
      bool any = false;
      for (const TileRect& tile : tiles) any = any || inside(tile);
      counted += any;
      RC_ASSERT(!any || inside(all));
    }
  }
  RC_ASSERT(covered_samples(tiles) == counted);
}

}  // namespace
}  // namespace scarp
