// SPDX-License-Identifier: MIT
// Maps as polygons and heights as contour lines, against pixels and a plane.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "cli/program.h"

namespace scarp::test {
namespace {

constexpr int kMapCols = 30, kMapRows = 20;

class MapVectors : public testing::Test {
 protected:
  // 30 x 20 samples of 10 m, rising 3 m per column, with a ridge along column 20 and a hole in the north-west corner.
  // The south-west sample is at (500005, 5000005) of UTM zone 33.
  MapVectors() {
    GDALAllRegister();
    dem_ = write("dem.asc", [](int col, int row) { return col + row == 0 ? -1 : 3 * col + (col == 20 ? 50 : 0); });
  }
  template <class Height>
  std::string write(const std::string& name, const Height& height) const {
    std::string text = "ncols 30\nnrows 20\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\nNODATA_value -1\n";
    for (int row = 0; row < kMapRows; ++row) {
      for (int col = 0; col < kMapCols; ++col) text += fmt::format("{} ", height(col, row));
      text += '\n';
    }
    return scratch_.write(name, text);
  }
  std::string path(const std::string& name) const { return scratch_.path(name); }
  Result on(const std::string& dem, const std::string& command, const Names& options) const {
    return run(Names{command, dem, "--crs", "EPSG:32633"} + options);
  }
  static GDALDatasetUniquePtr open(const std::string& file) {
    return GDALDatasetUniquePtr(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR));
  }

  // The value of the polygon around each pixel's centre; -1: none, -2: several.
  static std::vector<int> burnt(const std::string& file, const std::string& band = "") {
    const auto dataset = open(file);
    std::vector<int> pixels(kMapCols * kMapRows, -1);
    if (!dataset) return {};
    OGRLayer& layer = *dataset->GetLayer(0);
    OGRSpatialReference utm, other(*layer.GetSpatialRef());
    utm.importFromEPSG(32633);
    for (OGRSpatialReference* crs : {&utm, &other}) crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    OGRCoordinateTransformation* to = OGRCreateCoordinateTransformation(&utm, &other);
    for (const auto& feature : layer) {
      if (!band.empty() && feature->GetFieldAsString("band") != band) continue;
      for (int i = 0; i < kMapCols * kMapRows; ++i) {
        OGRPoint centre(500005 + i % kMapCols * 10, 5000195 - i / kMapCols * 10);
        centre.transform(to);
        if (!feature->GetGeometryRef()->Contains(&centre)) continue;
        int& pixel = pixels[static_cast<std::size_t>(i)];
        pixel = pixel == -1 ? feature->GetFieldAsInteger("value") : -2;
      }
    }
    OGRCoordinateTransformation::DestroyCT(to);
    return pixels;
  }
  static std::vector<int> pixels_of(const std::string& file, int band = 1) {
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
    std::vector<int> pixels(kMapCols * kMapRows);
    GDALRasterBand& from = *dataset->GetRasterBand(band);
    EXPECT_EQ(
        from.RasterIO(GF_Read, 0, 0, kMapCols, kMapRows, pixels.data(), kMapCols, kMapRows, GDT_Int32, 0, 0, nullptr),
        CE_None);
    for (int& pixel : pixels)
      if (pixel == from.GetNoDataValue()) pixel = -1;
    return pixels;
  }

  Scratch scratch_;
  std::string dem_;
};

TEST_F(MapVectors, PolygonsCoverThePixelsOfTheMap) {
  for (const char* mode : {"visible", "count"}) {
    const Names options{
        "--observer", "500105,5000105", "--observer", "500255,5000055", "--max-distance", "120", "--mode", mode, "-o"};
    const auto write = [&](const std::string& name) {
      const Result result = on(dem_, "viewshed", options + Names{path(name)});
      EXPECT_EQ(result.status, 0) << name << ": " << result.err;
      return path(name);
    };
    const std::vector<int> expected = pixels_of(write("a.tif"));
    for (const char* name : {"a.gpkg", "a.geojson", "a.shp", "a.fgb"})
      EXPECT_EQ(burnt(write(name)), expected) << name << ", " << mode;
  }
  // A layer with the CRS and the names of classes.
  ASSERT_EQ(on(dem_, "viewshed", {"--observer", "500105,5000105", "-o", path("b.gpkg")}).status, 0);
  const auto dataset = open(path("b.gpkg"));
  ASSERT_TRUE(dataset);
  OGRLayer& layer = *dataset->GetLayer(0);
  EXPECT_STREQ(layer.GetName(), "b");
  EXPECT_STREQ(layer.GetSpatialRef()->GetAuthorityCode(nullptr), "32633");
  std::set<std::string> classes;
  for (const auto& feature : layer) classes.insert(feature->GetFieldAsString("class"));
  EXPECT_EQ(classes, (std::set<std::string>{"hidden", "visible"}));
}

TEST_F(MapVectors, PolygonsOfSeveralSunsNameTheirBand) {
  const Names suns{"--sun", "90,20", "--sun", "180,40", "-o"};
  for (const char* name : {"a.tif", "a.gpkg"}) ASSERT_EQ(on(dem_, "shadow", suns + Names{path(name)}).status, 0);
  const GDALDatasetUniquePtr raster(GDALDataset::Open(path("a.tif").c_str(), GDAL_OF_RASTER));
  for (int band = 1; band <= 2; ++band)
    EXPECT_EQ(burnt(path("a.gpkg"), raster->GetRasterBand(band)->GetDescription()), pixels_of(path("a.tif"), band));
}

TEST_F(MapVectors, MapsOfHeightsAreNoPolygons) {
  const auto refused = [&](const std::string& dem, const std::string& command, const Names& options,
                           const std::string& what) {
    const auto before = scratch_.files();
    const Result result = on(dem, command, options);
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
    EXPECT_EQ(scratch_.files(), before);
  };
  refused(dem_, "viewshed", {"--observer", "500105,5000105", "--mode", "dem", "-o", path("a.geojson")},
          "polygons are for codes and counts (name it *.tif)");
  refused(dem_, "viewshed", {"--observer", "500105,5000105", "--co", "A=B", "-o", path("a.geojson")},
          "--co: applies to rasters");
  refused(dem_, "contours", {"-o", path("a.gpkg")}, "--interval M or --levels M,M,... is required");
  refused(dem_, "contours", {"--interval", "0", "-o", path("a.gpkg")},
          "--interval '0': expected a finite number above 0");
  refused(dem_, "contours", {"--interval", "1e-6", "-o", path("a.gpkg")}, "more than 10000 lines over");
  refused(dem_, "contours", {"--levels", "10,x", "-o", path("a.gpkg")}, "--levels '10,x': expected heights");
  refused(dem_, "contours", {"--interval", "5", "-o", path("a.png")}, "expected .gpkg, .geojson, .shp or .fgb");
  refused(dem_, "contours", {"--levels", "5", "--base", "5", "-o", path("a.gpkg")}, "--base");
}

// GDAL moves heights by up to 1e-6 (EPS of its marching squares), which here is as much in x.
constexpr double kMoved = 2e-6;

TEST_F(MapVectors, ContoursOfAPlaneAreStraight) {
  const std::string plane = write("plane.asc", [](int col, int) { return 10 * col; });
  for (const Names& options : {Names{"--interval", "100", "--base", "55"}, Names{"--levels", "55,155,255"}}) {
    const Result result = on(plane, "contours", options + Names{"-o", path("lines.gpkg")});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto dataset = open(path("lines.gpkg"));
    ASSERT_TRUE(dataset);
    std::set<double> levels;
    for (const auto& feature : *dataset->GetLayer(0)) {
      const double level = feature->GetFieldAsDouble("elev");
      levels.insert(level);
      const OGRLineString& line = *feature->GetGeometryRef()->toLineString();
      for (const auto& point : line) EXPECT_NEAR(point.getX(), 500005 + level, kMoved);
      EXPECT_EQ(std::abs(line.getY(0) - line.getY(line.getNumPoints() - 1)), 200) << "from border to border";
    }
    EXPECT_EQ(levels, (std::set<double>{55, 155, 255}));
  }
}

// Coordinates without a georeference are metres from the south-west sample, with north up.
TEST_F(MapVectors, ContoursWithoutAGeoreferenceAreInLocalMetres) {
  const GDALDatasetUniquePtr tiff(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path("plain.tif").c_str(), kMapCols, kMapRows, 1, GDT_Float32, nullptr));
  std::vector<float> heights;
  for (int i = 0; i < kMapCols * kMapRows; ++i) heights.push_back(static_cast<float>(kMapRows - 1 - i / kMapCols));
  ASSERT_EQ(tiff->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, kMapCols, kMapRows, heights.data(), kMapCols, kMapRows,
                                             GDT_Float32, 0, 0, nullptr),
            CE_None);
  tiff->FlushCache();
  const Result result = run({"contours", path("plain.tif"), "--levels", "4.5", "-o", path("lines.geojson")});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto dataset = open(path("lines.geojson"));
  ASSERT_TRUE(dataset);
  ASSERT_EQ(dataset->GetLayer(0)->GetFeatureCount(), 1);
  for (const auto& feature : *dataset->GetLayer(0))
    for (const auto& point : *feature->GetGeometryRef()->toLineString()) EXPECT_NEAR(point.getY(), 4.5, kMoved);
}

}  // namespace
}  // namespace scarp::test
