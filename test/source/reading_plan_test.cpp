// SPDX-License-Identifier: MIT
// Large rasters read with fewer samples, from any file.
#include <cmath>
#include <numeric>

#include "source/files.h"
#include "source/npy_bytes.h"

namespace scarp {
namespace {

using namespace test;

// 20 x 12 samples, 10 x 6 of which are enough: blocks of 2 x 2.
constexpr int kManyCols = 20, kManyRows = 12;

RasterOptions reduced() {
  RasterOptions options;
  options.decimation = Decimation{.above = 100, .samples = 60};
  return options;
}

double height(int col, int row) { return 10 * row + 2 * col; }

std::vector<double> slope() {
  std::vector<double> samples;
  for (int row = 0; row < kManyRows; ++row) {
    for (int col = 0; col < kManyCols; ++col) samples.push_back(height(col, row));
  }
  return samples;
}

// The averages: the slope between the samples, except at the corners with its lowest and highest sample, which are
// kept.
std::vector<double> averages(int cols = kManyCols, int rows = kManyRows) {
  std::vector<double> samples;
  for (int row = 0; row < rows; row += 2) {
    for (int col = 0; col < cols; col += 2) samples.push_back(height(col, row) + 6);
  }
  samples.front() = height(0, 0);
  samples.back() = height(cols - 1, rows - 1);
  return samples;
}

void place(GDALDataset& dataset) {
  double map[] = {1000, 10, 0, 5000, 0, -10};
  dataset.SetGeoTransform(map);
}

class ReadingPlan : public Files {};

TEST_F(ReadingPlan, ReducesAndGeoreferencesEverySampleType) {
  for (const GDALDataType type : {GDT_Byte, GDT_Int16, GDT_UInt16, GDT_Int32, GDT_Float32, GDT_Float64}) {
    const std::string file = write_tiff("a.tif", type, kManyCols, kManyRows, slope(), place);
    const Raster raster = read_raster(file, reduced());
    EXPECT_EQ(10, raster.cols);
    EXPECT_EQ(6, raster.rows);
    EXPECT_EQ(averages(), doubles(raster)) << GDALGetDataTypeName(type);
    EXPECT_TRUE(has_note(raster, "20 x 12 samples, rendered from 10 x 6 (average of 2 x 2; --full reads all)"));
    const auto& geo = raster.georeference;
    EXPECT_EQ(20, geo.cell_x_m);
    EXPECT_EQ((std::array<double, 6>{1010, 20, 0, 4990, 0, -20}), geo.map_from_node);
    EXPECT_EQ(kManyCols, read_raster(file, {}).cols) << "only where asked for";
  }
}

TEST_F(ReadingPlan, ReadsSmallRastersCompletely) {
  RasterOptions options = reduced();
  options.decimation->above = kManyCols * kManyRows;
  EXPECT_EQ(slope(), doubles(read_raster(write_tiff("a.tif", GDT_Int16, kManyCols, kManyRows, slope()), options)));
}

TEST_F(ReadingPlan, ReducesOnlyTheWindow) {
  RasterOptions options = reduced();
  options.window = RasterWindow{4, 2, 14, 8};
  const Raster raster = read_raster(write_tiff("a.tif", GDT_Int16, kManyCols, kManyRows, slope(), place), options);
  EXPECT_EQ(7, raster.cols);
  EXPECT_EQ(4, raster.rows);
  EXPECT_EQ(height(4, 2), doubles(raster).front());
  EXPECT_EQ(height(17, 9), doubles(raster).back());
  EXPECT_EQ(1050, raster.georeference.map_from_node[0]);
}

TEST_F(ReadingPlan, FlipsSouthUpRasters) {
  const std::string file = write_tiff("a.tif", GDT_Int16, kManyCols, kManyRows, slope(), [](GDALDataset& dataset) {
    double map[] = {1000, 10, 0, 5000, 0, 10};
    dataset.SetGeoTransform(map);
  });
  const Raster raster = read_raster(file, reduced());
  EXPECT_EQ(height(0, 10) + 6, doubles(raster).front());
  EXPECT_EQ(5000 + 12 * 10 - 10, raster.georeference.map_from_node[3]);
}

TEST_F(ReadingPlan, KeepsHolesByValueAndByMask) {
  const auto with_holes = [](double hole) {
    std::vector<double> samples = slope();
    for (const int at : {0, 1, kManyCols}) samples[static_cast<std::size_t>(at)] = hole;
    return samples;
  };
  const Raster value = read_raster(write_tiff("a.tif", GDT_Int16, kManyCols, kManyRows, with_holes(-9),
                                              [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(-9); }),
                                   reduced());
  ASSERT_TRUE(value.nodata);
  EXPECT_EQ(-9, doubles(value)[0]);
  EXPECT_EQ(4, doubles(value)[1]) << "the lowest";

  const GdalOption inside("GDAL_TIFF_INTERNAL_MASK", "YES");
  const Raster mask =
      read_raster(write_tiff("b.tif", GDT_Int16, kManyCols, kManyRows, slope(),
                             [](GDALDataset& dataset) {
                               dataset.CreateMaskBand(GMF_PER_DATASET);
                               std::vector<std::uint8_t> opaque(kManyCols * kManyRows, 255);
                               opaque[0] = opaque[1] = opaque[kManyCols] = 0;
                               EXPECT_EQ(CE_None, dataset.GetRasterBand(1)->GetMaskBand()->RasterIO(
                                                      GF_Write, 0, 0, kManyCols, kManyRows, opaque.data(), kManyCols,
                                                      kManyRows, GDT_Byte, 0, 0, nullptr));
                             }),
                  reduced());
  EXPECT_TRUE(std::isnan(doubles(mask)[0]));
  EXPECT_EQ(4, doubles(mask)[1]);
  EXPECT_TRUE(has_note(mask, "3 samples are holes by the file's mask"));
}

TEST_F(ReadingPlan, ReadsBlocksOfEveryShape) {
  for (const std::vector<const char*>& options : std::vector<std::vector<const char*>>{
           {"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"}, {"BLOCKYSIZE=5", "COMPRESS=DEFLATE"}, {"BLOCKYSIZE=1"}}) {
    EXPECT_EQ(averages(),
              doubles(read_raster(write_tiff("a.tif", GDT_Float32, kManyCols, kManyRows, slope(), {}, 1, options),
                                  reduced())));
  }
}

TEST_F(ReadingPlan, ReducesArraysTilesAndEncodedHeights) {
  const std::string array = write("a.npy", npy_bytes(npy_dictionary("<f4", "(12, 20)"), sample_bytes<float>(slope())));
  EXPECT_EQ(averages(), doubles(read_raster(array, reduced())));

  const auto half = [&](const std::string& name, int first) {
    std::vector<double> samples;
    for (int row = 0; row < kManyRows; ++row) {
      for (int col = first; col < first + kManyCols / 2; ++col) samples.push_back(height(col, row));
    }
    return write_tiff(name, GDT_Int16, kManyCols / 2, kManyRows, samples, [first](GDALDataset& dataset) {
      double map[] = {1000.0 + 10 * first, 10, 0, 5000, 0, -10};
      dataset.SetGeoTransform(map);
    });
  };
  EXPECT_EQ(averages(), doubles(read_tiles({half("w.tif", 0), half("e.tif", kManyCols / 2)}, reduced())));

  // The blue channel counts: n = height, and the red and green channels add a constant.
  RasterOptions encoded = reduced();
  encoded.encoding = HeightEncoding::terrarium;
  const std::vector<double> n =
      doubles(read_raster(write_tiff("c.tif", GDT_Byte, kManyCols, kManyRows, slope(), {}, 3), encoded));
  EXPECT_EQ((height(0, 2) + 6) * 65793, n[10]);
}

TEST_F(ReadingPlan, ReadsAnOverviewInsteadOfSamples) {
  // 40 x 24 samples of 7; the overview holds the slope, so that the test can tell them apart.
  const auto write = [&](bool statistics) {
    const std::string file = path(statistics ? "s.tif" : "o.tif");
    write_tiff(std::filesystem::path(file).filename(), GDT_Int16, 2 * kManyCols, 2 * kManyRows,
               std::vector<double>(4 * kManyCols * kManyRows, 7), place);
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    int factors[] = {2, 8};
    EXPECT_EQ(CE_None, dataset->BuildOverviews("NEAREST", 2, factors, 0, nullptr, nullptr, nullptr));
    std::vector<double> samples = slope();
    GDALRasterBand& band = *dataset->GetRasterBand(1);
    EXPECT_EQ(CE_None, band.GetOverview(0)->RasterIO(GF_Write, 0, 0, kManyCols, kManyRows, samples.data(), kManyCols,
                                                     kManyRows, GDT_Float64, 0, 0, nullptr));
    if (statistics) band.SetStatistics(-5, 500, 7, 1);
    return file;
  };
  RasterOptions options;
  options.decimation = Decimation{.above = 900, .samples = 240};
  const Raster plain = read_raster(write(false), options);
  EXPECT_EQ(slope(), doubles(plain));
  EXPECT_EQ((std::array<double, 6>{1005 + 5, 20, 0, 5000 - 10, 0, -20}), plain.georeference.map_from_node);
  EXPECT_TRUE(has_note(plain, "overview of 20 x 12, minimum and maximum of the overview; --full reads all"));
  const std::vector<double> stated = doubles(read_raster(write(true), options));
  EXPECT_EQ(-5, stated.front());
  EXPECT_EQ(500, stated.back());

  // Coarser than the overview: its samples are averaged.
  options.decimation->samples = 60;
  const Raster coarse = read_raster(path("o.tif"), options);
  EXPECT_EQ(averages(), doubles(coarse));
  EXPECT_TRUE(has_note(coarse, "overview of 20 x 12, average of 2 x 2, minimum"));
}

TEST_F(ReadingPlan, SkipsMissingBlocksOfSparseFiles) {
  constexpr int kSide = 100'000;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  CPLStringList how;
  for (const char* option :
       {"SPARSE_OK=TRUE", "TILED=YES", "BLOCKXSIZE=1024", "BLOCKYSIZE=1024", "BIGTIFF=YES", "COMPRESS=DEFLATE"})
    how.AddString(option);
  {
    const GDALDatasetUniquePtr dataset(driver->Create(path("s.tif").c_str(), kSide, kSide, 1, GDT_Int16, how.List()));
    dataset->GetRasterBand(1)->SetNoDataValue(-1);
    std::vector<std::int16_t> samples(1024 * 1024);
    std::iota(samples.begin(), samples.begin() + 1000, std::int16_t{0});
    EXPECT_EQ(CE_None, dataset->GetRasterBand(1)->RasterIO(GF_Write, 51200, 51200, 1024, 1024, samples.data(), 1024,
                                                           1024, GDT_Int16, 0, 0, nullptr));
  }
  RasterOptions options;
  options.decimation = Decimation{.above = 1000, .samples = 10'000};
  const std::vector<double> out = doubles(read_raster(path("s.tif"), options));
  EXPECT_EQ(999, *std::max_element(out.begin(), out.end()));
  EXPECT_EQ(-1, out.front());
}

TEST_F(ReadingPlan, RejectsTooManySamples) {
  const std::string file = write(
      "huge.vrt",
      "<VRTDataset rasterXSize=\"2147483647\" rasterYSize=\"2147483647\"><VRTRasterBand dataType=\"Int16\" band=\"1\"/>"
      "</VRTDataset>");
  RasterOptions options;
  options.decimation = Decimation{};
  expect_says(read_error(file, options), "2147483647 x 2147483647 samples are too many to read (");
  expect_says(read_error(file), "of memory are free (read a part with --window COL,ROW,COLS,ROWS)");
}

TEST_F(ReadingPlan, LimitsTheGdalBlockCache) {
  GIntBig least = GDALGetCacheMax64();
  const GIntBig before = least;
  read_raster(write_tiff("a.tif", GDT_Int16, kManyCols, kManyRows, slope()), {}, [&](double) {
    least = std::min(least, GDALGetCacheMax64());
    return true;
  });
  EXPECT_LE(least, 64 << 20);
  EXPECT_EQ(before, GDALGetCacheMax64());
}

}  // namespace
}  // namespace scarp
