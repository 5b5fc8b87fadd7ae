// SPDX-License-Identifier: MIT
// Images over a raster.
#include <cmath>

#include "scarp/source/raster/colour_image.h"
#include "source/files.h"

namespace scarp {
namespace {

using namespace test;

constexpr std::int64_t kAllPixels = 1 << 30;

// 101 x 61 samples, 10 m apart, in UTM zone 10.
constexpr int kWide = 101, kHigh = 61;
Georeference ground() {
  Georeference geo;
  geo.present = true;
  geo.map_from_node = {500'000, 10, 0, 5'000'000, 0, -10};
  OGRSpatialReference crs;
  crs.importFromEPSG(32610);
  char* text = nullptr;
  crs.exportToWkt(&text);
  geo.crs_wkt = text;
  CPLFree(text);
  return geo;
}

class OverlayTest : public Files {
 protected:
  // Writes bands for red, green, blue and opacity; `map` is the geotransform of the pixel edges.
  std::string write_rgba(const std::string& name, int cols, int rows, const std::vector<std::uint8_t>& rgba,
                         std::array<double, 6> map, int epsg = 32610) const {
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    const char* options[] = {"PHOTOMETRIC=RGB", "ALPHA=YES", nullptr};
    const GDALDatasetUniquePtr dataset(
        driver->Create(path(name).c_str(), cols, rows, 4, GDT_Byte, const_cast<char**>(options)));
    for (int b = 0; b < 4; ++b) {
      EXPECT_EQ(CE_None, dataset->GetRasterBand(b + 1)->RasterIO(GF_Write, 0, 0, cols, rows,
                                                                 const_cast<std::uint8_t*>(rgba.data()) + b, cols, rows,
                                                                 GDT_Byte, 4, 4 * cols, nullptr));
    }
    dataset->SetGeoTransform(map.data());
    OGRSpatialReference crs;
    crs.importFromEPSG(epsg);
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    dataset->SetSpatialRef(&crs);
    return path(name);
  }
};

std::vector<std::uint8_t> pattern(int cols, int rows) {
  std::vector<std::uint8_t> rgba;
  for (int i = 0; i < cols * rows; ++i) {
    for (const int byte : {i * 31 % 256, i * 57 % 256, i * 11 % 256, 255})
      rgba.push_back(static_cast<std::uint8_t>(byte));
  }
  return rgba;
}

// Like a map from the first sample to the last, whose pixels need not be square.
TEST_F(OverlayTest, MapOfTheRasterKeepsItsPixels) {
  const std::vector<std::uint8_t> rgba = pattern(128, 90);
  const Overlay overlay =
      read_overlay(write_rgba("map.tif", 128, 90, rgba, {500'000, 1000.0 / 128, 0, 5'000'000, 0, -600.0 / 90}),
                   ground(), kWide, kHigh, kAllPixels);
  EXPECT_EQ(128, overlay.image.width);
  EXPECT_EQ(90, overlay.image.height);
  EXPECT_EQ(rgba, overlay.image.rgba);
  EXPECT_NEAR(0, overlay.west, 1e-12);
  EXPECT_NEAR(0, overlay.north, 1e-12);
  EXPECT_NEAR(1, overlay.east, 1e-12);
  EXPECT_NEAR(1, overlay.south, 1e-12);
}

TEST_F(OverlayTest, KeepsOnlyItsOwnPixels) {
  // 40 x 30 pixels of 1 m, a thousandth of the raster at their resolution.
  const std::vector<std::uint8_t> rgba = pattern(40, 30);
  const Overlay small = read_overlay(write_rgba("small.tif", 40, 30, rgba, {500'200, 1, 0, 4'999'900, 0, -1}), ground(),
                                     kWide, kHigh, kAllPixels);
  EXPECT_EQ(rgba, small.image.rgba);
  EXPECT_NEAR(0.2, small.west, 1e-9);
  EXPECT_NEAR(0.24, small.east, 1e-9);
  EXPECT_NEAR(100.0 / 600, small.north, 1e-9);
  EXPECT_NEAR(130.0 / 600, small.south, 1e-9);
  // 400 x 300 pixels of 10 m, of which the raster covers 100 x 60.
  const Overlay large =
      read_overlay(write_rgba("large.tif", 400, 300, pattern(400, 300), {499'005, 10, 0, 5'001'005, 0, -10}), ground(),
                   kWide, kHigh, kAllPixels);
  EXPECT_EQ(101, large.image.width);
  EXPECT_EQ(61, large.image.height);
  EXPECT_NEAR(-0.005, large.west, 1e-9);
  EXPECT_NEAR(1.005, large.east, 1e-9);
}

TEST_F(OverlayTest, IsAveragedToTheUsefulResolution) {
  std::vector<std::uint8_t> rgba;
  for (int i = 0; i < 128 * 90; ++i) rgba.insert(rgba.end(), {static_cast<std::uint8_t>(i % 2 ? 200 : 0), 50, 0, 255});
  const Overlay overlay =
      read_overlay(write_rgba("map.tif", 128, 90, rgba, {500'000, 1000.0 / 128, 0, 5'000'000, 0, -600.0 / 90}),
                   ground(), kWide, kHigh, 128 * 90 / 4);
  EXPECT_EQ(64, overlay.image.width);
  EXPECT_EQ(45, overlay.image.height);
  EXPECT_EQ(100, overlay.image.rgba[0]);
  EXPECT_EQ(50, overlay.image.rgba[1]);
}

TEST_F(OverlayTest, IsWarpedFromOtherCrs) {
  const Overlay overlay =
      read_overlay(write_rgba("degrees.tif", 50, 50, pattern(50, 50), {-123.0 + 0.005, 1e-4, 0, 45.15, 0, -1e-4}, 4326),
                   ground(), kWide, kHigh, kAllPixels);
  EXPECT_GT(overlay.west, 0.2);
  EXPECT_LT(overlay.east - overlay.west, 0.5);
  EXPECT_LT(overlay.image.width, 80);
}

TEST_F(OverlayTest, RejectsOverlaysOutsideTheRaster) {
  const std::string file = write_rgba("far.tif", 4, 4, pattern(4, 4), {600'000, 1, 0, 5'000'000, 0, -1});
  expect_says(error_of([&] { read_overlay(file, ground(), kWide, kHigh, kAllPixels); }), "does not overlap the raster");
}

}  // namespace
}  // namespace scarp
