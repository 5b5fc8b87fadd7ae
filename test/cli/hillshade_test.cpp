// SPDX-License-Identifier: MIT
// The look hillshade against gdaldem's output for the same file.
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "cli/program.h"
#include "output/read_png.h"

namespace scarp {
namespace {

// Grey levels of gdaldem with its default sun, which is also Scarp's: from the north-west, 45 degrees high.
std::vector<std::uint8_t> gdaldem(const std::string& path, int* side) {
  GDALAllRegister();
  const std::unique_ptr<GDALDataset> dem(GDALDataset::Open(path.c_str()));
  if (!dem) return {};
  const char* const format[] = {"-of", "MEM", nullptr};
  GDALDEMProcessingOptions* options = GDALDEMProcessingOptionsNew(const_cast<char**>(format), nullptr);
  const std::unique_ptr<GDALDataset> shaded(GDALDataset::FromHandle(
      GDALDEMProcessing("", GDALDataset::ToHandle(dem.get()), "hillshade", nullptr, options, nullptr)));
  GDALDEMProcessingOptionsFree(options);
  if (!shaded) return {};
  *side = shaded->GetRasterXSize();
  std::vector<std::uint8_t> grey(static_cast<std::size_t>(*side) * static_cast<std::size_t>(*side));
  const CPLErr error = shaded->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, *side, *side, grey.data(), *side, *side,
                                                          GDT_Byte, 0, 0, nullptr);
  return error == CE_None ? grey : std::vector<std::uint8_t>();
}

TEST(Hillshade, MatchesGdaldem) {
  const test::Scratch scratch;
  const std::string dem = scratch.path("dem.tif"), picture = scratch.path("hillshade.png");
  ASSERT_EQ(test::run({"generate", "--size", "257", "--seed", "3", "--feature-size", "40", "-o", dem}).status, 0);
  int side = 0;
  const std::vector<std::uint8_t> expected = gdaldem(dem, &side);
  ASSERT_EQ(side, 257);
  const auto result = test::run({"render", dem, "-o", picture, "--top", "--size", "257x257", "--look", "hillshade"});
  ASSERT_EQ(result.status, 0) << result.err;
  const test::Rgb ours = test::read_png(picture);
  // A map spans from the first sample to the last, so pixels are slightly closer together than samples. gdaldem writes
  // nodata (0) along the border.
  const auto gdal_at = [&](int x, int y) {
    const auto at = [&](int col, int row) {
      return static_cast<double>(expected[static_cast<std::size_t>(row * side + col)]);
    };
    const double col = (x + 0.5) * (side - 1) / side, row = (y + 0.5) * (side - 1) / side;
    const int i = static_cast<int>(col), j = static_cast<int>(row);
    return std::lerp(std::lerp(at(i, j), at(i + 1, j), col - i), std::lerp(at(i, j + 1), at(i + 1, j + 1), col - i),
                     row - j);
  };
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (int y = 1; y + 2 < side; ++y) {
    for (int x = 1; x + 2 < side; ++x) {
      const double p = gdal_at(x, y), q = ours.pixel(x, y)[0];
      n += 1, a += p, b += q, aa += p * p, bb += q * q, ab += p * q;
    }
  }
  EXPECT_GT((n * ab - a * b) / std::sqrt((n * aa - a * a) * (n * bb - b * b)), 0.99);
  EXPECT_NEAR(a / n, b / n, 1);
}

}  // namespace
}  // namespace scarp
