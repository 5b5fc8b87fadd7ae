// SPDX-License-Identifier: MIT
// A part of an opened raster has the heights and positions of the same samples in the whole raster.
#include "scarp/source/raster/opened_raster.h"

#include <cmath>
#include <numeric>
#include <random>

#include "source/files.h"

namespace scarp::test {
namespace {

constexpr int kCols = 70, kRows = 50;

class OpenedRasterTest : public Files {
 protected:
  // Distinct heights, some of them holes.
  std::vector<double> samples_;
  OpenedRasterTest() {
    samples_.resize(kCols * kRows);
    std::iota(samples_.begin(), samples_.end(), 1);
    for (std::size_t i = 0; i < samples_.size(); i += 13) samples_[i] = -7;
  }

  std::string tiff(const std::string& name, GDALDataType type, std::vector<double> map,
                   const std::function<void(GDALDataset&)>& edit = {}) {
    return write_tiff(name, type, kCols, kRows, samples_,
                      [&](GDALDataset& dataset) {
                        if (!map.empty()) dataset.SetGeoTransform(map.data());
                        dataset.GetRasterBand(1)->SetNoDataValue(-7);
                        if (edit) edit(dataset);
                      },
                      1, {"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=32"});
  }

  // Heights in metres; NaN at holes.
  static std::vector<double> heights(const Raster& raster) {
    std::vector<double> all = doubles(raster);
    for (double& sample : all)
      sample = raster.nodata && sample == *raster.nodata ? NAN : sample * raster.scale + raster.offset;
    return all;
  }

  void expect_parts_of_the_whole(const std::vector<std::string>& inputs, const RasterOptions& options = {}) {
    SCOPED_TRACE(inputs.front());
    const Raster whole = read_tiles(inputs, options);
    OpenedRaster opened(inputs, options);
    const Raster& header = opened.header();
    EXPECT_TRUE(doubles(header).empty());
    EXPECT_EQ(header.samples.index(), whole.samples.index());
    EXPECT_EQ(header.cols, whole.cols);
    EXPECT_EQ(header.rows, whole.rows);
    EXPECT_EQ(header.scale, whole.scale);
    EXPECT_EQ(header.offset, whole.offset);
    EXPECT_EQ(header.nodata, whole.nodata);
    EXPECT_EQ(header.files, whole.files);
    EXPECT_EQ(header.path, whole.path);
    EXPECT_EQ(header.file_type, whole.file_type);
    EXPECT_EQ(header.georeference.map_from_node, whole.georeference.map_from_node);
    EXPECT_EQ(header.georeference.cell_x_m, whole.georeference.cell_x_m);
    const std::vector<double> all = heights(whole);
    std::mt19937 random(3);
    for (int i = 0; i < 12; ++i) {
      const auto number = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
      RasterWindow part{number(0, whole.cols - 1), number(0, whole.rows - 1), 1, 1};
      part.cols = number(1, whole.cols - part.col);
      part.rows = number(1, whole.rows - part.row);
      if (i == 0) part = {0, 0, whole.cols, whole.rows};
      const Raster read = opened.read(part);
      ASSERT_EQ(read.cols, part.cols);
      ASSERT_EQ(read.rows, part.rows);
      EXPECT_EQ(read.georeference.cell_x_m, whole.georeference.cell_x_m);
      EXPECT_EQ(read.georeference.cell_y_m, whole.georeference.cell_y_m);
      EXPECT_EQ(read.georeference.grid_north_azimuth, whole.georeference.grid_north_azimuth);
      const auto &from = whole.georeference.map_from_node, &to = read.georeference.map_from_node;
      if (whole.georeference.present) {
        EXPECT_NEAR(to[0], from[0] + part.col * from[1], 1e-9);
        EXPECT_NEAR(to[3], from[3] + part.row * from[5], 1e-9);
      }
      const std::vector<double> here = heights(read);
      for (int row = 0; row < part.rows; ++row)
        for (int col = 0; col < part.cols; ++col) {
          const double a = here[static_cast<std::size_t>(row * part.cols + col)],
                       b = all[static_cast<std::size_t>((part.row + row) * whole.cols + part.col + col)];
          ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << a << " not " << b << " at " << col << ' ' << row;
        }
    }
  }
};

TEST_F(OpenedRasterTest, ReadsPartsOfEveryKindOfFile) {
  const std::vector<double> north_up{500000, 10, 0, 5000000, 0, -10};
  expect_parts_of_the_whole({tiff("a.tif", GDT_Int16, north_up)});
  expect_parts_of_the_whole({tiff("b.tif", GDT_Float64, {12, 0.001, 0, 46, 0, -0.001})});
  expect_parts_of_the_whole({tiff("south_up.tif", GDT_Float32, {500000, 10, 0, 4999000, 0, 10})});
  expect_parts_of_the_whole({tiff("turned.tif", GDT_Int16, {500700, -10, 0, 4999500, 0, 10})});
  expect_parts_of_the_whole({tiff("scaled.tif", GDT_Int16, north_up, [](GDALDataset& dataset) {
    dataset.GetRasterBand(1)->SetScale(-0.5);
    dataset.GetRasterBand(1)->SetOffset(100);
  })});
  expect_parts_of_the_whole(
      {tiff("feet.tif", GDT_Int16, {}, [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetUnitType("ft"); })});
  RasterOptions window;
  window.window = {5, 4, 50, 40};
  expect_parts_of_the_whole({tiff("turned.tif", GDT_Int16, {500700, -10, 0, 4999500, 0, 10})}, window);
  // Two tiles side by side, the second shifted by two rows.
  expect_parts_of_the_whole(
      {tiff("west.tif", GDT_Int16, north_up), tiff("east.tif", GDT_Int16, {500700, 10, 0, 4999980, 0, -10})});
  std::string raw(kCols * kRows * 2, '\0');
  for (std::size_t i = 0; i < raw.size(); ++i) raw[i] = static_cast<char>(i % 251);
  RasterOptions layout;
  layout.raw = parse_raw_format("70x50:u16le");
  expect_parts_of_the_whole({write("a.raw", raw)}, layout);
}

TEST_F(OpenedRasterTest, PartsOfPicturesHaveTheScaleOfTheWhole) {
  std::vector<double> steep(kCols * kRows);
  std::iota(steep.begin(), steep.end(), 10);
  const std::string source = write_tiff("steep.tif", GDT_UInt16, kCols, kRows, steep);
  GDALDatasetUniquePtr from(GDALDataset::Open(source.c_str(), GDAL_OF_RASTER));
  const GDALDatasetUniquePtr png(GetGDALDriverManager()->GetDriverByName("PNG")->CreateCopy(
      path("steep.png").c_str(), from.get(), FALSE, nullptr, nullptr, nullptr));
  png->FlushCache(false);
  const Raster whole = read_raster(path("steep.png"), {});
  ASSERT_NE(whole.scale, 1) << "no default scale";
  expect_parts_of_the_whole({path("steep.png")});
}

TEST_F(OpenedRasterTest, ReadsNoSamplesBeforeTheyAreWanted) {
  // An infinite height in the last sample.
  samples_.back() = HUGE_VAL;
  const std::string file = tiff("infinite.tif", GDT_Float32, {500000, 10, 0, 5000000, 0, -10});
  expect_says(read_error(file), "infinite");
  OpenedRaster opened({file}, {});
  EXPECT_EQ(opened.header().cols, kCols);
  EXPECT_EQ(opened.read({0, 0, 60, 40}).cols, 60);
  expect_says(error_of([&] { opened.read({60, 40, 10, 10}); }), "infinite");
}

TEST_F(OpenedRasterTest, AcceptsPartsOfHolesAlone) {
  OpenedRaster opened({tiff("a.tif", GDT_Int16, {500000, 10, 0, 5000000, 0, -10})}, {});
  const Raster hole = opened.read({0, 0, 1, 1});
  EXPECT_EQ(doubles(hole), std::vector<double>{-7});
  EXPECT_EQ(hole.nodata, -7);
}

TEST_F(OpenedRasterTest, StatesTheExtremesThatTheFileStates) {
  const std::string file = tiff("a.tif", GDT_Int16, {500000, 10, 0, 5000000, 0, -10}, [](GDALDataset& dataset) {
    dataset.GetRasterBand(1)->SetStatistics(1, 3499, 1500, 900);
  });
  const OpenedRaster opened({file}, {});
  EXPECT_EQ(opened.stated().low, 1);
  EXPECT_EQ(opened.stated().high, 3499);
  RasterOptions window;
  window.window = {0, 0, 5, 5};
  const SampleEnds of_window = OpenedRaster({file}, window).stated();
  EXPECT_GT(of_window.low, of_window.high) << "statistics are those of the whole file";
}

}  // namespace
}  // namespace scarp::test
