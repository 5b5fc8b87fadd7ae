// SPDX-License-Identifier: MIT
#include "scarp/source/raster/mirrored.h"

#include <gtest/gtest.h>

#include "scarp/base/error.h"

namespace scarp {
namespace {

TEST(Mirrored, RepeatsWithoutASeam) {
  Raster raster;
  raster.cols = 3;
  raster.rows = 2;
  raster.samples = std::vector<std::int16_t>{1, 2, 3, 4, 5, 6};
  const Raster all = mirrored(raster);
  EXPECT_EQ(all.cols, 4);
  EXPECT_EQ(all.rows, 2);
  EXPECT_EQ(std::get<std::vector<std::int16_t>>(all.samples), (std::vector<std::int16_t>{1, 2, 3, 2, 4, 5, 6, 5}));

  raster.cols = 2;
  raster.rows = 3;
  const Raster high = mirrored(raster);
  EXPECT_EQ(high.rows, 4);
  // The raster's own rows come last, so that its south-west sample stays in the corner.
  EXPECT_EQ(std::get<std::vector<std::int16_t>>(high.samples), (std::vector<std::int16_t>{3, 4, 1, 2, 3, 4, 5, 6}));
  raster.rows = 1;
  EXPECT_THROW(mirrored(raster), Error);
}

}  // namespace
}  // namespace scarp
