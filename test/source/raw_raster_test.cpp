// SPDX-License-Identifier: MIT
#include "scarp/source/raster/raw_raster.h"

#include <cmath>
#include <limits>

#include "source/files.h"
#include "source/npy_bytes.h"

namespace scarp {
namespace {

using namespace test;

const std::vector<double> kHeights{1, 2, 3, 4, 5, 100};

class RawRaster : public Files {
 protected:
  static RasterOptions as(const std::string& text) {
    RasterOptions options;
    options.raw = parse_raw_format(text);
    return options;
  }
};

TEST_F(RawRaster, ReadsAllTypesAndByteOrders) {
  const struct {
    const char* format;
    std::string samples;
  } cases[] = {
      {"3x2:u8", sample_bytes<std::uint8_t>(kHeights)},     {"3x2:i8", sample_bytes<std::int8_t>(kHeights)},
      {"3x2:u16le", sample_bytes<std::uint16_t>(kHeights)}, {"3x2:u16be", sample_bytes<std::uint16_t>(kHeights, true)},
      {"3x2:i16le", sample_bytes<std::int16_t>(kHeights)},  {"3x2:i16be", sample_bytes<std::int16_t>(kHeights, true)},
      {"3x2:u32le", sample_bytes<std::uint32_t>(kHeights)}, {"3x2:u32be", sample_bytes<std::uint32_t>(kHeights, true)},
      {"3x2:i32le", sample_bytes<std::int32_t>(kHeights)},  {"3x2:i32be", sample_bytes<std::int32_t>(kHeights, true)},
      {"3x2:f32le", sample_bytes<float>(kHeights)},         {"3x2:f32be", sample_bytes<float>(kHeights, true)},
      {"3x2:f64le", sample_bytes<double>(kHeights)},        {"3x2:f64be", sample_bytes<double>(kHeights, true)}};
  for (const auto& c : cases) {
    const Raster raster = read_raster(write("a.raw", c.samples), as(c.format));
    EXPECT_EQ(3, raster.cols) << c.format;
    EXPECT_EQ(2, raster.rows) << c.format;
    EXPECT_EQ(kHeights, doubles(raster)) << c.format;
    EXPECT_FALSE(raster.georeference.present);
  }
}

TEST_F(RawRaster, KeepsSigns) {
  EXPECT_EQ((std::vector<double>{-1, -128}),
            doubles(read_raster(write("a.r8", sample_bytes<std::int8_t>({-1, -128})), as("2x1:i8"))));
  EXPECT_EQ((std::vector<double>{-1, -32768}),
            doubles(read_raster(write("a.r16", sample_bytes<std::int16_t>({-1, -32768})), as("2x1:i16le"))));
}

TEST_F(RawRaster, SkipsAHeaderAndReportsTrailingBytes) {
  const std::string samples = sample_bytes<std::int16_t>(kHeights);
  EXPECT_EQ(kHeights, doubles(read_raster(write("a.raw", "12345" + samples), as("3x2:i16le+5"))));
  const Raster raster = read_raster(write("a.raw", "12345" + samples + "678"), as("3x2:i16le+5"));
  EXPECT_EQ(kHeights, doubles(raster));
  EXPECT_TRUE(has_note(raster, "ignored 3 bytes after the samples"));
}

TEST_F(RawRaster, LengthMustMatchTheSamples) {
  const std::string samples = sample_bytes<std::int16_t>(kHeights);
  const std::string file = write("a.raw", samples);
  const std::string shorter = read_error(file, as("3x3:i16le"));
  expect_says(shorter, "12 bytes, but --raw 3x3:i16le needs 18");
  expect_says(shorter, "truncated");
  const std::string longer = read_error(file, as("3x1:i16le"));
  expect_says(longer, "needs 6");
  expect_says(longer, "+0");
  expect_says(read_error(file, as("3x2:i16le+1")), "needs 13");
  expect_says(read_error(file, as("2147483647x2147483647:u8")), "truncated");
  expect_says(read_error(file, as("3x2:i16le+4611686018427387904")), "truncated");
}

TEST_F(RawRaster, NamesMissingFiles) {
  expect_says(read_error(path("none.raw"), as("3x2:u8")), "does not exist");
  expect_says(read_error(write("e.raw", ""), as("3x2:u8")), "0 bytes");
  expect_says(read_error(folder_.string(), as("3x2:u8")), "is a directory");
}

TEST_F(RawRaster, IgnoresTheExtension) {
  EXPECT_EQ(kHeights, doubles(read_raster(write("a.npy", sample_bytes<float>(kHeights)), as("3x2:f32le"))));
  EXPECT_EQ(kHeights, doubles(read_raster(write("a.exr", sample_bytes<float>(kHeights)), as("3x2:f32le"))));
}

TEST_F(RawRaster, RejectsOptionsOfOtherFormats) {
  const std::string file = write("a.raw", sample_bytes<std::int16_t>(kHeights));
  RasterOptions options = as("3x2:i16le");
  options.encoding = HeightEncoding::terrarium;
  expect_says(read_error(file, options), "--encoding");
  options = as("3x2:i16le");
  options.channel = "Y";
  expect_says(read_error(file, options), "--channel");
  options = as("3x2:i16le");
  options.key = "z";
  expect_says(read_error(file, options), "--key");
  options = as("3x2:i16le");
  options.band = 2;
  expect_says(read_error(file, options), "no band 2: the file has");
}

TEST_F(RawRaster, AppliesNodataWindowAndBounds) {
  const std::string file = write("a.raw", sample_bytes<std::int16_t>(kHeights));
  RasterOptions options = as("3x2:i16le");
  options.nodata = 5;
  options.window = {1, 1, 2, 1};
  options.bounds = {0, 0, 30, 40};
  const Raster raster = read_raster(file, options);
  EXPECT_EQ((std::vector<double>{5, 100}), doubles(raster));
  EXPECT_EQ(5, raster.nodata);
  EXPECT_EQ(10, raster.georeference.cell_x_m);
  EXPECT_EQ(20, raster.georeference.cell_y_m);
}

TEST_F(RawRaster, NanIsAHoleAndInfinityIsRejected) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Raster raster = read_raster(write("a.raw", sample_bytes<float>({1, nan})), as("2x1:f32le"));
  EXPECT_TRUE(std::isnan(doubles(raster)[1]));
  EXPECT_TRUE(has_note(raster, "NaN"));
  expect_says(read_error(write("b.raw", sample_bytes<double>({1, inf})), as("2x1:f64le")), "infinite");
}

}  // namespace
}  // namespace scarp
