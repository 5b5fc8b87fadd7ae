// SPDX-License-Identifier: MIT
// Heights in the colours of images, and ranges of heights for plain samples.
#include <array>
#include <cmath>

#include "source/files.h"

namespace scarp {
namespace {

using namespace test;

class EncodedRaster : public Files {
 protected:
  using Pixel = std::array<std::uint8_t, 4>;

  // A PNG, or a file of another driver, with the given pixels; without alpha, their last byte is omitted.
  std::string write_image(const std::string& name, int cols, int rows, const std::vector<Pixel>& pixels, bool alpha,
                          const char* driver = "PNG") {
    GDALDatasetUniquePtr memory(
        GetGDALDriverManager()->GetDriverByName("MEM")->Create("", cols, rows, alpha ? 4 : 3, GDT_Byte, nullptr));
    std::vector<std::uint8_t> bytes;
    for (const Pixel& pixel : pixels) bytes.insert(bytes.end(), pixel.begin(), pixel.begin() + (alpha ? 4 : 3));
    const int bands = alpha ? 4 : 3;
    EXPECT_EQ(CE_None, memory->RasterIO(GF_Write, 0, 0, cols, rows, bytes.data(), cols, rows, GDT_Byte, bands, nullptr,
                                        bands, static_cast<GSpacing>(cols) * bands, 1, nullptr));
    constexpr GDALColorInterp kMeanings[] = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand};
    for (int b = 1; b <= bands; ++b) memory->GetRasterBand(b)->SetColorInterpretation(kMeanings[b - 1]);
    const GDALDatasetUniquePtr copy(GetGDALDriverManager()->GetDriverByName(driver)->CreateCopy(
        path(name).c_str(), memory.get(), FALSE, nullptr, nullptr, nullptr));
    EXPECT_TRUE(copy);
    return path(name);
  }

  static RasterOptions as(HeightEncoding encoding) {
    RasterOptions options;
    options.encoding = encoding;
    return options;
  }
  static std::vector<double> heights(const Raster& raster) {
    std::vector<double> result = doubles(raster);
    for (double& sample : result) sample = sample * raster.scale + raster.offset;
    return result;
  }
};

TEST_F(EncodedRaster, DecodesBothEncodings) {
  const std::string file = write_image("a.png", 2, 1, {{1, 134, 160, 0}, {128, 1, 128, 0}}, false);
  const Raster rgb = read_raster(file, as(HeightEncoding::terrain_rgb));
  EXPECT_TRUE(holds<float>(rgb));
  EXPECT_EQ("terrain-rgb", rgb.file_type);
  EXPECT_DOUBLE_EQ(0, heights(rgb)[0]);
  EXPECT_DOUBLE_EQ((128 * 65536 + 256 + 128) * 0.1 - 10000, heights(rgb)[1]);
  const Raster terrarium = read_raster(file, as(HeightEncoding::terrarium));
  EXPECT_DOUBLE_EQ(256 + 134 + 160 / 256.0 - 32768, heights(terrarium)[0]);
  EXPECT_DOUBLE_EQ(1.5, heights(terrarium)[1]);
}

TEST_F(EncodedRaster, TransparentPixelsAreHoles) {
  const std::string file =
      write_image("a.png", 2, 2, {{1, 2, 3, 255}, {1, 2, 3, 0}, {0, 0, 0, 255}, {9, 9, 9, 1}}, true);
  const std::vector<double> n = doubles(read_raster(file, as(HeightEncoding::terrarium)));
  EXPECT_EQ(66051, n[0]);
  EXPECT_TRUE(std::isnan(n[1]));
  EXPECT_EQ(0, n[2]);
  EXPECT_EQ(592137, n[3]);
}

TEST_F(EncodedRaster, BlocksAndWindowsKeepTheirPosition) {
  // Tiles of 16 x 16 over 40 x 35 samples: the last ones are only partly used.
  const int cols = 40, rows = 35;
  std::vector<Pixel> pixels;
  for (int i = 0; i < cols * rows; ++i)
    pixels.push_back({0, static_cast<std::uint8_t>(i / 256), static_cast<std::uint8_t>(i % 256), 255});
  const std::string png = write_image("a.png", cols, rows, pixels, true);
  {
    const GDALDatasetUniquePtr source(GDALDataset::Open(png.c_str()));
    const char* const tiled[] = {"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16", nullptr};
    const GDALDatasetUniquePtr copy(GetGDALDriverManager()->GetDriverByName("GTiff")->CreateCopy(
        path("a.tif").c_str(), source.get(), FALSE, const_cast<char**>(tiled), nullptr, nullptr));
  }
  for (const char* name : {"a.png", "a.tif"}) {
    const std::vector<double> all = doubles(read_raster(path(name), as(HeightEncoding::terrarium)));
    for (int i = 0; i < cols * rows; ++i) ASSERT_EQ(i, all[static_cast<std::size_t>(i)]) << name;
    RasterOptions options = as(HeightEncoding::terrarium);
    options.window = {33, 31, 7, 4};
    const std::vector<double> part = doubles(read_raster(path(name), options));
    EXPECT_EQ(31 * cols + 33, part.front()) << name;
    EXPECT_EQ(cols * rows - 1, part.back()) << name;
  }
}

TEST_F(EncodedRaster, CallersScaleAndNodataTakePrecedence) {
  const std::string file = write_image("a.png", 2, 1, {{0, 0, 0, 0}, {0, 0, 200, 0}}, false);
  RasterOptions options = as(HeightEncoding::terrain_rgb);
  options.scale = 0.5;
  options.offset = 7;
  options.nodata = 0;
  const Raster raster = read_raster(file, options);
  EXPECT_EQ(107, heights(raster)[1]);
  EXPECT_EQ(0, raster.nodata);
}

TEST_F(EncodedRaster, RejectsOtherBandLayouts) {
  const RasterOptions options = as(HeightEncoding::terrain_rgb);
  expect_says(read_error(write_tiff("g.tif", GDT_Byte, 2, 1, {1, 2}), options), "it has 1 band");
  expect_says(read_error(write_tiff("w.tif", GDT_UInt16, 2, 1, {1, 2}, {}, 3, {"PHOTOMETRIC=RGB"}), options),
              "of UInt16");
  expect_says(read_error(write_tiff("f.tif", GDT_Byte, 2, 1, {1, 2}, {}, 5), options), "it has 5 bands");
  RasterOptions band = options;
  band.band = 1;
  expect_says(read_error(write_image("a.png", 1, 1, {{1, 2, 3, 0}}, false), band), "--band");
}

TEST_F(EncodedRaster, RejectsAPalette) {
  GDALColorTable colours;
  const GDALColorEntry red{255, 0, 0, 255};
  colours.SetColorEntry(1, &red);
  const std::string tiff =
      write_tiff("p.tif", GDT_Byte, 2, 1, {0, 1}, [&](GDALDataset& d) { d.GetRasterBand(1)->SetColorTable(&colours); });
  {
    const GDALDatasetUniquePtr source(GDALDataset::Open(tiff.c_str()));
    const GDALDatasetUniquePtr copy(GetGDALDriverManager()->GetDriverByName("PNG")->CreateCopy(
        path("p.png").c_str(), source.get(), FALSE, nullptr, nullptr, nullptr));
  }
  expect_says(read_error(path("p.png"), as(HeightEncoding::terrain_rgb)), "palette");
  expect_says(read_error(path("p.png")), "palette");
}

TEST_F(EncodedRaster, RejectsAPhotographAndListsTheEncodings) {
  const std::string text = read_error(write_image("a.png", 1, 1, {{1, 2, 3, 0}}, false));
  expect_says(text, "photograph");
  expect_says(text, "--encoding terrain-rgb or terrarium");
}

TEST_F(EncodedRaster, RejectsATruncatedImage) {
  std::vector<Pixel> pixels(200 * 200);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::size_t noise = i * i * 7919;
    pixels[i] = {static_cast<std::uint8_t>(noise), static_cast<std::uint8_t>(noise >> 8), static_cast<std::uint8_t>(i),
                 0};
  }
  const std::string bytes = bytes_of(write_image("a.png", 200, 200, pixels, false));
  for (const double share : {0.0, 0.1, 0.5, 0.97}) {
    write("cut.png", bytes.substr(0, static_cast<std::size_t>(static_cast<double>(bytes.size()) * share)));
    read_error(path("cut.png"), as(HeightEncoding::terrarium));
  }
}

// The heights of a real elevation model, encoded by Mapbox's formula, are decoded to within half a step.
TEST_F(EncodedRaster, RoundTripsARealModel) {
  const std::filesystem::path dem =
      std::filesystem::path(SCARP_SOURCE_DIR) / ".." / "shared" / "data" / "dem" / "rgbify_elev.tif";
  if (!std::filesystem::exists(dem)) GTEST_SKIP() << "no shared data beside the checkout (../shared/data/dem)";
  const Raster plain = read_raster(dem.string(), {});
  std::vector<Pixel> pixels;
  for (const double height : doubles(plain)) {
    const long n = std::lround((height + 10000) * 10);
    pixels.push_back(
        {static_cast<std::uint8_t>(n >> 16), static_cast<std::uint8_t>(n >> 8), static_cast<std::uint8_t>(n), 0});
  }
  const Raster read =
      read_raster(write_image("a.png", plain.cols, plain.rows, pixels, false), as(HeightEncoding::terrain_rgb));
  const std::vector<double> before = doubles(plain), after = heights(read);
  for (std::size_t i = 0; i < before.size(); ++i) ASSERT_NEAR(before[i], after[i], 0.05 + 1e-9) << i;
}

class HeightRanges : public EncodedRaster {
 protected:
  static RasterOptions range(double low, double high) {
    RasterOptions options;
    options.height_range = {low, high};
    return options;
  }
};

TEST_F(HeightRanges, MapsTheFullUnsignedRange) {
  const std::string tiff = write_tiff("a.tif", GDT_UInt16, 3, 1, {0, 65535, 13107});
  {
    const GDALDatasetUniquePtr source(GDALDataset::Open(tiff.c_str()));
    const GDALDatasetUniquePtr copy(GetGDALDriverManager()->GetDriverByName("PNG")->CreateCopy(
        path("a.png").c_str(), source.get(), FALSE, nullptr, nullptr, nullptr));
  }
  const Raster png = read_raster(path("a.png"), range(-100, 400));
  EXPECT_TRUE(holds<std::uint16_t>(png));
  EXPECT_DOUBLE_EQ(-100, heights(png)[0]);
  EXPECT_DOUBLE_EQ(400, heights(png)[1]);
  EXPECT_DOUBLE_EQ(0, heights(png)[2]);
  EXPECT_DOUBLE_EQ(400, heights(read_raster(write_tiff("b.tif", GDT_Byte, 2, 1, {0, 255}), range(-100, 400)))[1]);
  EXPECT_DOUBLE_EQ(150, heights(read_raster(write_tiff("c.tif", GDT_Float32, 2, 1, {0, 0.5}), range(-100, 400)))[1]);
}

TEST_F(HeightRanges, UsesTheVerticalUnit) {
  RasterOptions options = range(0, 1000);
  options.unit = "ft";
  EXPECT_NEAR(304.8, heights(read_raster(write_tiff("a.tif", GDT_UInt16, 2, 1, {0, 65535}), options))[1], 1e-9);
}

TEST_F(HeightRanges, RejectsUnusableRanges) {
  const std::string file = write_tiff("a.tif", GDT_UInt16, 2, 1, {0, 65535});
  expect_says(read_error(write_tiff("s.tif", GDT_Int16, 2, 1, {1, 2}), range(0, 1)), "signed (Int16)");
  expect_says(read_error(file, range(5, 5)), "LOW < HIGH");
  expect_says(read_error(file, range(5, 4)), "LOW < HIGH");
  expect_says(read_error(file, range(0, INFINITY)), "LOW < HIGH");
  RasterOptions twice = range(0, 1);
  twice.scale = 2;
  expect_says(read_error(file, twice), "cannot be combined");
  RasterOptions encoded = range(0, 1);
  encoded.encoding = HeightEncoding::terrarium;
  expect_says(read_error(write_image("a.png", 1, 1, {{1, 2, 3, 0}}, false), encoded), "--encoding");
}

}  // namespace
}  // namespace scarp
