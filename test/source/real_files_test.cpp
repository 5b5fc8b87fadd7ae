// SPDX-License-Identifier: MIT
// Real-world files: those of ../shared/data/dem beside the checkout and of Debian's python-matplotlib-data.
#include <algorithm>
#include <cmath>

#include "source/files.h"

namespace scarp {
namespace {

using namespace test;

// Path of a file of shared data, empty when it is not there.
std::string shared_dem(const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(SCARP_SOURCE_DIR) / ".." / "shared" / "data" / "dem" / name;
  return std::filesystem::exists(file) ? file.string() : "";
}

#define SKIP_WITHOUT(file) \
  if ((file).empty()) GTEST_SKIP() << "no shared data beside the checkout (../shared/data/dem)"

struct Range {
  double min = 1e300, max = -1e300;
  int holes = 0;
};

Range range_of(const Raster& raster) {
  Range range;
  for (const double s : doubles(raster)) {
    if (std::isnan(s) || (raster.nodata && s == *raster.nodata)) {
      ++range.holes;
    } else {
      range.min = std::min(range.min, s);
      range.max = std::max(range.max, s);
    }
  }
  return range;
}

TEST(RealFiles, ReadsSaintHelensInNad27Utm) {
  const std::string file = shared_dem("SainteHelens.dem");
  SKIP_WITHOUT(file);
  const Raster raster = read_raster(file, {});
  ASSERT_TRUE(holds<std::int16_t>(raster));
  EXPECT_EQ(327, raster.cols);
  EXPECT_EQ(468, raster.rows);
  EXPECT_EQ(-32767, raster.nodata);
  const Range range = range_of(raster);
  EXPECT_EQ(682, range.min);
  EXPECT_EQ(2543, range.max);
  EXPECT_EQ(4151, range.holes);
  EXPECT_NEAR(30.0106, raster.georeference.cell_x_m, 1e-4);
  // Convergence of a transverse Mercator, first order: 0.8125 degrees of longitude times sin(46.19 degrees).
  EXPECT_NEAR(0.586, raster.georeference.grid_north_azimuth * 57.29578, 0.001);
  EXPECT_EQ("NAD27 / UTM zone 10N", raster.georeference.crs_name);
}

TEST(RealFiles, ReadsAnSrtmTileOnTheEquator) {
  const std::string file = shared_dem("N00E010.hgt");
  SKIP_WITHOUT(file);
  const Raster raster = read_raster(file, {});
  ASSERT_TRUE(holds<std::int16_t>(raster));
  EXPECT_EQ(1201, raster.cols);
  const Range range = range_of(raster);
  EXPECT_EQ(1, range.min);
  EXPECT_EQ(1005, range.max);
  // The samples are at whole degrees.
  EXPECT_NEAR(10, raster.georeference.map_from_node[0], 1e-9);
  EXPECT_NEAR(1, raster.georeference.map_from_node[3], 1e-9);
  EXPECT_NEAR(92.763, raster.georeference.cell_x_m, 1e-3);
  EXPECT_NEAR(92.145, raster.georeference.cell_y_m, 1e-3);
}

TEST(RealFiles, ReadsALidarModelInUtm) {
  const std::string file = shared_dem("lidar_dsm.tif");
  SKIP_WITHOUT(file);
  const Raster raster = read_raster(file, {});
  ASSERT_TRUE(holds<float>(raster));
  const Range range = range_of(raster);
  EXPECT_GE(range.min, 0);
  EXPECT_LT(range.max, 500);
  EXPECT_NEAR(1.00034, raster.georeference.cell_x_m, 1e-5);
}

TEST(RealFiles, ScalesWebMercatorToGroundDistances) {
  const std::string file = shared_dem("rgbify_elev.tif");
  SKIP_WITHOUT(file);
  const Raster raster = read_raster(file, {});
  EXPECT_NEAR(6.721808968646656 / 1.264, raster.georeference.cell_x_m, 0.001);
  EXPECT_NEAR(6.059025744365499 / 1.2693, raster.georeference.cell_y_m, 0.001);
}

TEST(RealFiles, ReadsJacksboroFromMatplotlib) {
  const std::string file = "/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "Debian's python-matplotlib-data is not installed";
  RasterOptions options;
  options.crs = "EPSG:4326";
  options.bounds = {-84.41375, 36.44625, -84.07791666666667, 36.73291666666667};
  const Raster raster = read_raster(file, options);
  ASSERT_TRUE(holds<std::int16_t>(raster));
  EXPECT_EQ(403, raster.cols);
  EXPECT_EQ(344, raster.rows);
  const Range range = range_of(raster);
  EXPECT_EQ(236, range.min);
  EXPECT_EQ(1076, range.max);
  EXPECT_NEAR(0.000833333333, raster.georeference.map_from_node[1], 1e-9);
  EXPECT_NEAR(74.5, raster.georeference.cell_x_m, 0.1);
  EXPECT_NEAR(92.5, raster.georeference.cell_y_m, 0.1);
}

}  // namespace
}  // namespace scarp
