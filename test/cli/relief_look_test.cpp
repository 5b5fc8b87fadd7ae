// SPDX-License-Identifier: MIT
// The looks slope, aspect and multidirectional against gdaldem's numbers for the same file.
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cli/program.h"
#include "output/read_png.h"

namespace scarp::test {
namespace {

struct Band {
  int cols = 0, rows = 0;
  std::vector<float> pixels;
  double nodata = 0, transform[6]{};
  GDALDataType type = GDT_Unknown;
  bool hole(std::size_t i) const { return static_cast<double>(pixels[i]) == nodata; }
};

Band band_of(GDALDataset& dataset) {
  GDALRasterBand& from = *dataset.GetRasterBand(1);
  Band band{from.GetXSize(), from.GetYSize(), {}, from.GetNoDataValue(), {}, from.GetRasterDataType()};
  dataset.GetGeoTransform(band.transform);
  band.pixels.resize(static_cast<std::size_t>(band.cols) * static_cast<std::size_t>(band.rows));
  EXPECT_EQ(from.RasterIO(GF_Read, 0, 0, band.cols, band.rows, band.pixels.data(), band.cols, band.rows, GDT_Float32, 0,
                          0, nullptr),
            CE_None);
  return band;
}

class ReliefLook : public testing::Test {
 protected:
  // Cells of 30 m at the origin of a transverse Mercator projection, where its scale is 1; a hole, and a flat place.
  ReliefLook() : dem_(scratch_.path("dem.tif")) {
    GDALAllRegister();
    EXPECT_EQ(run({"generate", "--size", "64", "--seed", "3", "--feature-size", "20", "-o", dem_}).status, 0);
    const GDALDatasetUniquePtr file(GDALDataset::Open(dem_.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    GDALRasterBand& band = *file->GetRasterBand(1);
    band.SetNoDataValue(-1);
    float hole = -1;
    std::vector<float> flat(25, 120);
    EXPECT_EQ(band.RasterIO(GF_Write, 40, 20, 1, 1, &hole, 1, 1, GDT_Float32, 0, 0, nullptr), CE_None);
    EXPECT_EQ(band.RasterIO(GF_Write, 10, 10, 5, 5, flat.data(), 5, 5, GDT_Float32, 0, 0, nullptr), CE_None);
  }

  Band gdaldem(const char* what, std::vector<const char*> words) const {
    words.insert(words.begin(), {"-of", "MEM"});
    words.push_back(nullptr);
    const GDALDatasetUniquePtr dem(GDALDataset::Open(dem_.c_str(), GDAL_OF_RASTER));
    GDALDEMProcessingOptions* options = GDALDEMProcessingOptionsNew(const_cast<char**>(words.data()), nullptr);
    const GDALDatasetUniquePtr done(GDALDataset::FromHandle(
        GDALDEMProcessing("", GDALDataset::ToHandle(dem.get()), what, nullptr, options, nullptr)));
    GDALDEMProcessingOptionsFree(options);
    return band_of(*done);
  }
  Band look(const std::string& name) const {
    const std::string output = scratch_.path(name + ".tif");
    const Result result = run({"render", dem_, "--top", "--look", name, "-o", output});
    EXPECT_EQ(result.status, 0) << result.err;
    const GDALDatasetUniquePtr done(GDALDataset::Open(output.c_str(), GDAL_OF_RASTER));
    return done ? band_of(*done) : Band{};
  }
  // Rounding of gdaldem's gradients: each is the difference of two sums of four floats, by three additions, over 8
  // cells.
  static double gradient_error(const Band& dem) {
    const double highest = std::abs(*std::max_element(dem.pixels.begin(), dem.pixels.end()));
    return 2 * 3 * 4 * highest * 0x1p-24 / (8 * 30);
  }
  void expect_same_pixels(const Band& ours, const Band& expected) const {
    ASSERT_EQ(ours.pixels.size(), expected.pixels.size());
    EXPECT_EQ(ours.cols, expected.cols);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(ours.transform[i], expected.transform[i], 1e-6) << i;
    for (std::size_t i = 0; i < ours.pixels.size(); ++i) ASSERT_EQ(ours.hole(i), expected.hole(i)) << i;
  }

  Scratch scratch_;
  std::string dem_;
};

constexpr double kDegreesPerUnit = 57.29577951308232, kFloats = 360 * 0x1p-23;

TEST_F(ReliefLook, SlopeAndAspectAreThoseOfGdaldem) {
  const GDALDatasetUniquePtr file(GDALDataset::Open(dem_.c_str(), GDAL_OF_RASTER));
  const double error = gradient_error(band_of(*file));
  const Band slopes = gdaldem("slope", {}), aspects = gdaldem("aspect", {});
  const Band slope = look("slope"), aspect = look("aspect");
  expect_same_pixels(slope, slopes);
  expect_same_pixels(aspect, aspects);
  EXPECT_EQ(slope.type, GDT_Float32);
  double steepest = 0;
  for (std::size_t i = 0; i < slopes.pixels.size(); ++i) {
    if (slopes.hole(i)) continue;
    EXPECT_NEAR(slope.pixels[i], slopes.pixels[i], kDegreesPerUnit * 2 * error + kFloats) << i;
    steepest = std::max(steepest, static_cast<double>(slope.pixels[i]));
    if (aspects.hole(i)) continue;
    const double gradient = std::tan(slope.pixels[i] / kDegreesPerUnit);
    EXPECT_NEAR(std::remainder(aspect.pixels[i] - aspects.pixels[i], 360), 0,
                kDegreesPerUnit * 2 * error / gradient + kFloats)
        << i;
  }
  EXPECT_GT(steepest, 10);
  EXPECT_TRUE(aspect.hole(12 * 64 + 12)) << "flat";
  EXPECT_EQ(slope.pixels[12 * 64 + 12], 0);
}

TEST_F(ReliefLook, MultidirectionalShadingIsThatOfGdaldem) {
  const Band expected = gdaldem("hillshade", {"-multidirectional"}), ours = look("multidirectional");
  expect_same_pixels(ours, expected);
  EXPECT_EQ(ours.type, GDT_Byte);
  std::size_t different = 0;
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    // Values halfway between two greys may be rounded either way.
    ASSERT_NEAR(ours.pixels[i], expected.pixels[i], 1) << i;
    different += ours.pixels[i] != expected.pixels[i];
  }
  EXPECT_LE(different, expected.pixels.size() / 100);
}

TEST_F(ReliefLook, PicturesHaveColours) {
  for (const char* name : {"slope", "aspect", "multidirectional"}) {
    const std::string output = scratch_.path("a.png");
    const Result result = run({"render", dem_, "--size", "60x40", "--look", name, "-o", output});
    ASSERT_EQ(result.status, 0) << result.err;
    const Rgb picture = read_png(output);
    const auto* middle = picture.pixel(30, 20);
    EXPECT_GT(middle[0] + middle[1] + middle[2], 0) << name;
    EXPECT_EQ(middle[0] == middle[1] && middle[1] == middle[2], std::string(name) == "multidirectional");
  }
#ifdef SCARP_CAIRO
  const Result legend = run({"render", dem_, "--top", "--look", "slope", "--legend", "-o", scratch_.path("a.tif")});
  EXPECT_NE(legend.status, 0);
  EXPECT_NE(legend.err.find("holds numbers, not a picture (name it *.png)"), std::string::npos) << legend.err;
#endif
}

}  // namespace
}  // namespace scarp::test
