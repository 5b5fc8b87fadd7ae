// SPDX-License-Identifier: MIT
// Maps as files: georeferenced TIFF, other formats, and overlays.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "cli/program.h"
#include "output/read_png.h"

namespace scarp {
namespace {

using test::Names;

struct Rgba {
  int width = 0, height = 0;
  std::array<double, 6> place{};
  bool placed = false;
  std::string crs{};
  std::vector<std::uint8_t> bytes{};

  const std::uint8_t* pixel(int x, int y) const { return bytes.data() + 4 * (y * width + x); }
};

Rgba read_map(const std::string& path) {
  GDALAllRegister();
  const GDALDatasetUniquePtr dataset(GDALDataset::Open(path.c_str()));
  if (!dataset || dataset->GetRasterCount() != 4) return {};
  Rgba map{dataset->GetRasterXSize(), dataset->GetRasterYSize()};
  map.placed = dataset->GetGeoTransform(map.place.data()) == CE_None;
  if (const OGRSpatialReference* crs = dataset->GetSpatialRef()) map.crs = crs->GetAuthorityCode(nullptr);
  map.bytes.resize(std::size_t{4} * static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
  const CPLErr error = dataset->RasterIO(GF_Read, 0, 0, map.width, map.height, map.bytes.data(), map.width, map.height,
                                         GDT_Byte, 4, nullptr, 4, std::int64_t{4} * map.width, 1, nullptr);
  return error == CE_None ? map : Rgba{};
}

class MapOutput : public testing::Test {
 protected:
  // 41 x 31 samples of 30 m in UTM zone 16, with a hill and a hole; columns 30 to 34 of rows 10 to 14 are nodata.
  MapOutput() {
    GDALAllRegister();
    dem_ = write("dem.tif", {600000, 30, 0, 4000000, 0, -30}, 32616);
  }

  std::string write(const std::string& name, std::array<double, 6> place, int epsg, bool south_up = false) {
    constexpr int kCols = 41, kRows = 31;
    std::vector<float> heights;
    for (int row = 0; row < kRows; ++row) {
      for (int col = 0; col < kCols; ++col) {
        const int r = south_up ? kRows - 1 - row : row;
        const bool hole = r >= 10 && r < 15 && col >= 30 && col < 35;
        heights.push_back(hole ? -9999.0f
                               : 200.0f + 150.0f * std::exp(-0.01f * static_cast<float>((col - 15) * (col - 15) +
                                                                                        (r - 15) * (r - 15))));
      }
    }
    const GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        scratch_.path(name).c_str(), kCols, kRows, 1, GDT_Float32, nullptr));
    if (epsg > 0) {
      OGRSpatialReference crs;
      crs.importFromEPSG(epsg);
      dataset->SetSpatialRef(&crs);
      dataset->SetGeoTransform(place.data());
    }
    dataset->GetRasterBand(1)->SetNoDataValue(-9999);
    EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, kCols, kRows, heights.data(), kCols, kRows,
                                                  GDT_Float32, 0, 0, nullptr),
              CE_None);
    return scratch_.path(name);
  }

  test::Result render(const std::string& dem, const std::string& output, const Names& options) {
    Names arguments{"render", dem, "-o", scratch_.path(output)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return test::run(arguments);
  }

  test::Scratch scratch_;
  std::string dem_;
};

// 400 x 300 pixels over 40 x 30 cells: ten pixels per cell.
TEST_F(MapOutput, PixelsAreGeoreferenced) {
  for (const bool south_up : {false, true}) {
    const std::string dem = south_up ? write("up.tif", {600000, 30, 0, 4000000 - 31 * 30, 0, 30}, 32616, true) : dem_;
    const auto result = render(dem, "map.tif", {"--top", "--size", "400x300", "--aa", "1", "--unlit"});
    ASSERT_EQ(result.status, 0) << result.err;
    const Rgba map = read_map(scratch_.path("map.tif"));
    ASSERT_EQ(map.width, 400);
    EXPECT_EQ(map.crs, "32616");
    // The first sample is in the middle of the raster's first pixel.
    const std::array<double, 6> expected{600015, 3, 0, 3999985, 0, -3};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(map.place[i], expected[i], 1e-4) << i;
    // Cells around nodata samples are holes: columns 29 to 34, rows 9 to 14.
    for (const auto& [x, y, alpha] : {std::tuple(0, 0, 255),
                                      {399, 299, 255},
                                      {288, 120, 255},
                                      {292, 92, 0},
                                      {345, 145, 0},
                                      {352, 120, 255},
                                      {320, 88, 255},
                                      {320, 152, 255}})
      EXPECT_EQ(map.pixel(x, y)[3], alpha) << x << " " << y;
  }
  EXPECT_EQ(scratch_.files(), (Names{"dem.tif", "map.tif", "up.tif"}));
}

// The rim's pixels are partly covered, and have the colour of their ground alone: none is tinted by the sky.
TEST_F(MapOutput, RimsArePartlyOpaqueAndUntinted) {
  ASSERT_EQ(render(dem_, "map.tif", {"--top", "--size", "401x301", "--unlit", "--ramp", "magma"}).status, 0);
  const Rgba map = read_map(scratch_.path("map.tif"));
  int partial = 0;
  for (int y = 80; y < 160; ++y) {
    for (int x = 280; x < 360; ++x) {
      const std::uint8_t* p = map.pixel(x, y);
      if (p[3] == 0 || p[3] == 255) continue;
      ++partial;
      // Ground near the hole is low: the dark end of the ramp; the sky is bright.
      EXPECT_LT(p[0], 60) << x << " " << y;
    }
  }
  EXPECT_GT(partial, 50);
}

TEST_F(MapOutput, OverlaysItsOwnTerrain) {
  ASSERT_EQ(render(dem_, "map.tif", {"--top", "--size", "400x300", "--aa", "1", "--contours", "10"}).status, 0);
  ASSERT_EQ(render(dem_, "again.tif", {"--top", "--size", "400x300", "--unlit", "--overlay", scratch_.path("map.tif")})
                .status,
            0);
  const Rgba map = read_map(scratch_.path("map.tif")), again = read_map(scratch_.path("again.tif"));
  EXPECT_EQ(again.pixel(320, 120)[3], 0);
  // Mean difference, and that of maps moved by a pixel.
  const auto difference = [&](int dx, int dy) {
    double sum = 0;
    int count = 0;
    for (int y = 2; y < 198; ++y) {
      for (int x = 2; x < 258; ++x) {
        for (int k = 0; k < 3; ++k) sum += std::abs(map.pixel(x, y)[k] - again.pixel(x + dx, y + dy)[k]), ++count;
      }
    }
    return sum / count;
  };
  const double same = difference(0, 0);
  EXPECT_LT(same, 3) << "interpolated twice";
  for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) EXPECT_GT(difference(dx, dy), 1.5 * same);
}

TEST_F(MapOutput, ReportsMissingGeoreference) {
  const std::string plain = write("plain.tif", {}, 0);
  const auto result = render(plain, "map.tif", {"--top", "--size", "80x60"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("note: the input has no georeference, nor has"), std::string::npos) << result.err;
  EXPECT_FALSE(read_map(scratch_.path("map.tif")).placed);
  EXPECT_EQ(
      render(plain, "b.png", {"--top", "--size", "80x60", "--unlit", "--overlay", scratch_.path("map.tif")}).status, 0);
}

TEST_F(MapOutput, EveryLookHasTheSameOpacity) {
  for (const std::string look : {"hillshade", "steps", "height"}) {
    ASSERT_EQ(render(dem_, "map.tif", {"--top", "--size", "80x60", "--look", look}).status, 0);
    const Rgba map = read_map(scratch_.path("map.tif"));
    EXPECT_EQ(map.pixel(64, 24)[3], 0) << look;
    EXPECT_EQ(map.pixel(50, 24)[3], 255) << look;
  }
}

TEST_F(MapOutput, WritesEveryListedFormat) {
  const auto refused = [&](const std::string& output, const Names& options, const std::string& fragment) {
    const auto result = render(dem_, output, options);
    EXPECT_NE(result.status, 0) << output;
    EXPECT_NE(result.err.find(fragment), std::string::npos) << result.err;
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
  };
  refused("a.bmp", {},
          "unknown picture format (name it *.png (PNG), *.jpg (JPEG), *.pdf (PDF), *.tif (GeoTIFF), *.exr");
  refused("a.tif", {}, "a GeoTIFF is a map (add --top, or name it *.png)");
  refused("a-##.tif", {"--turntable"}, "frames are pictures, not maps (name it frame-####.png)");
  refused("a.png", {"--dpi", "300"}, "--dpi applies to .pdf files only");
  EXPECT_EQ(scratch_.files(), Names{"dem.tif"});
  EXPECT_EQ(render(dem_, "a.JPEG", {"--size", "80x60"}).status, 0);
  EXPECT_TRUE(test::text_of(scratch_.path("a.JPEG")).starts_with("\xff\xd8\xff"));
#ifdef SCARP_CAIRO
  refused("a.tif", {"--top", "--legend", "--layout", "beside"}, "margins have no place on Earth");
  refused("a.exr", {"--title", "x"}, "--title is not drawn into EXR");
  refused("a.png", {"--title", "\xff"}, "--title: the text is not valid UTF-8");
  refused("a.png", {"--top", "--layout", "beside"}, "--layout has no effect without --legend");
  refused("a.png", {"--graticule", "auto"}, "--graticule has no effect without --top");
  refused("a.png", {"--top", "--contour-labels"}, "--contour-labels has no effect without --contours");
  refused("a.png", {"--top", "--graticule", "x"}, "--graticule 'x': expected");
  refused("a.png", {"--top", "--graticule", "10"}, "no lines cross the map");
  refused("a.png", {"--top", "--graticule", "0.00001"}, "lines cross the map");
  EXPECT_EQ(render(dem_, "a.pdf", {"--size", "80x60", "--dpi", "72"}).status, 0);
  EXPECT_NE(test::text_of(scratch_.path("a.pdf")).find("/MediaBox [ 0 0 80 60"), std::string::npos);
#endif
}

#ifdef SCARP_CAIRO
TEST_F(MapOutput, BesideLayoutExtendsThePage) {
  const Names map{"--top", "--size", "400x300", "--aa", "1", "--contours", "10"};
  ASSERT_EQ(render(dem_, "plain.png", map).status, 0);
  Names all = map;
  all.insert(all.end(), {"--title", "A hill", "--legend", "--scale-bar", "--north-arrow", "--layout", "beside"});
  const auto result = render(dem_, "beside.png", all);
  ASSERT_EQ(result.status, 0) << result.err;
  const test::Rgb plain = test::read_png(scratch_.path("plain.png")),
                  page = test::read_png(scratch_.path("beside.png"));
  const std::string message = fmt::format("{} x {} pixels", page.width, page.height);
  EXPECT_NE(result.out.find(message), std::string::npos) << result.out << message;
  bool found = false;
  for (int top = 0; top + 300 <= page.height && !found; ++top) {
    for (int left = 0; left + 400 <= page.width && !found; ++left) {
      found = true;
      for (int y = 0; y < 300 && found; ++y) {
        const auto row = plain.bytes.begin() + 3 * 400 * y;
        found = std::equal(row, row + 3 * 400, page.bytes.begin() + 3 * ((top + y) * page.width + left));
      }
    }
  }
  EXPECT_TRUE(found);
}

// A meridian and a parallel of round numbers, where PROJ puts them.
TEST_F(MapOutput, GraticuleMatchesItsCoordinates) {
  const Names options{"--top", "--size", "400x300", "--aa", "1", "--unlit"};
  ASSERT_EQ(render(dem_, "plain.png", options).status, 0);
  Names lined = options;
  lined.insert(lined.end(), {"--graticule", "auto"});
  ASSERT_EQ(render(dem_, "lined.png", lined).status, 0);
  const test::Rgb plain = test::read_png(scratch_.path("plain.png")),
                  drawn = test::read_png(scratch_.path("lined.png"));
  OGRSpatialReference utm, lonlat;
  utm.importFromEPSG(32616), lonlat.importFromEPSG(4326);
  for (OGRSpatialReference* crs : {&utm, &lonlat}) crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> to_map(OGRCreateCoordinateTransformation(&lonlat, &utm)),
      to_lonlat(OGRCreateCoordinateTransformation(&utm, &lonlat));
  double lon = 600600, lat = 3999500;
  ASSERT_TRUE(to_lonlat->Transform(1, &lon, &lat));
  int lines = 0;
  for (int i = -8; i <= 8; ++i) {
    double x = (std::round(lon * 360) + i) / 360, y = lat;  // 10 seconds
    ASSERT_TRUE(to_map->Transform(1, &x, &y));
    const double col = (x - 600015) / 3, row = (3999985 - y) / 3;
    if (col < 40 || col > 390 || row < 40 || row > 290) continue;
    ++lines;
    const auto at = static_cast<int>(col), down = static_cast<int>(row);
    EXPECT_LT(drawn.pixel(at, down)[1], plain.pixel(at, down)[1]) << i;
    EXPECT_EQ(drawn.pixel(at + 12, down + 12)[1], plain.pixel(at + 12, down + 12)[1]) << i;
  }
  EXPECT_GE(lines, 3);
}

TEST_F(MapOutput, ContourLabelsAreDrawnOnTheirLines) {
  const Names options{"--top", "--size", "640x480", "--aa", "1", "--contours", "10"};
  ASSERT_EQ(render(dem_, "plain.png", options).status, 0);
  Names labelled = options;
  labelled.insert(labelled.end(), "--contour-labels");
  ASSERT_EQ(render(dem_, "labels.png", labelled).status, 0);
  const test::Rgb plain = test::read_png(scratch_.path("plain.png")),
                  drawn = test::read_png(scratch_.path("labels.png"));
  int changed = 0;
  for (std::size_t i = 0; i < plain.bytes.size(); i += 3) changed += plain.bytes[i] != drawn.bytes[i];
  EXPECT_GT(changed, 500);
  EXPECT_LT(changed, 30000);
}
#endif

}  // namespace
}  // namespace scarp
