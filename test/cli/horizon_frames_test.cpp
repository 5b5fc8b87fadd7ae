// SPDX-License-Identifier: MIT
// Maps of horizons where north or the lengths of cells differ over the raster: planes, whose horizons are known for any
// north and length, and parts.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <geodesic.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "cli/maps_cli.h"

namespace scarp::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

class HorizonFramesCli : public MapsCli {
 protected:
  // Rises by `step` metres per column.
  std::string ramp(const std::string& name, int cols, int rows, const std::string& place, double step) const {
    std::string text = fmt::format("ncols {}\nnrows {}\n{}\n", cols, rows, place);
    for (int row = 0; row < rows; ++row) {
      for (int col = 0; col < cols; ++col) text += fmt::format("{} ", step * col);
      text += '\n';
    }
    return scratch_.write(name, text);
  }
  // Parts hold the rows of the whole map.
  void expect_same_parts(const Names& words, const std::string& whole, int parts) const {
    const auto map = open(whole);
    for (int band = 1; band <= map->GetRasterCount(); ++band) {
      const Pixels all = pixels_of(*map, band);
      std::vector<float> joined;
      for (int part = 1; part <= parts; ++part) {
        const Names one{"--part", fmt::format("{}/{}", part, parts), "-o", path(fmt::format("p{}.tif", part))};
        if (band == 1) {
          ASSERT_EQ(run(words + one).status, 0);
        }
        const Pixels some = pixels_of(*open(path(fmt::format("p{}.tif", part))), band);
        joined.insert(joined.end(), some.samples.begin(), some.samples.end());
      }
      EXPECT_EQ(joined, all.samples) << band;
    }
  }
};

// Longitude and latitude in degrees of a place in UTM zone 33.
struct LonLat {
  double lon, lat;
};
LonLat lonlat_of(double x, double y) {
  OGRSpatialReference utm, degrees;
  utm.importFromEPSG(32633), degrees.importFromEPSG(4326);
  degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> to(OGRCreateCoordinateTransformation(&utm, &degrees));
  EXPECT_TRUE(to->Transform(1, &x, &y));
  return {x, y};
}

// Far from the zone's meridian, 48 km of columns: grid north turns by 0.45 degrees over them.
TEST_F(HorizonFramesCli, AzimuthsAreFromTheNorthOfEachBlock) {
  const double cell = 80, west = 740000, south = 5000000;
  const std::string dem =
      ramp("wide.asc", 600, 6, fmt::format("xllcorner {}\nyllcorner {}\ncellsize {}", west, south, cell), 4);
  const Names words{"horizon", dem, "--crs", "EPSG:32633", "--cc", "0", "--azimuths", "1"};
  const auto result = run(words + Names{"-o", path("h.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto map = open(path("h.tif"));
  const char* const stated = map->GetMetadataItem("BLOCKS");
  const std::string blocks = stated ? stated : "";
  EXPECT_TRUE(blocks.starts_with("128 x 6 pixels")) << blocks;
  const Pixels pixels = pixels_of(*map);
  const auto north = [&](double col) {
    const LonLat at = lonlat_of(west + (col + 0.5) * cell, south + 3 * cell);
    return std::atan(std::tan((at.lon - 15) * kDegree) * std::sin(at.lat * kDegree));
  };
  const double scale = 0.9996 * (1 + std::pow((west + 300 * cell - 500000) / 0.9996 / 6'378'000, 2) / 2);
  for (int block = 0; block < 5; ++block) {
    const int first = 128 * block, last = std::min(first + 128, 600) - 1;
    const double slope = -std::sin(north(0.5 * (first + last))) * 4 / (cell / scale);
    for (const int col : {first + 20, last - 20}) {
      // Heights of 2400 m are floats, and the eastern ones of the first columns are 8 m above them.
      EXPECT_NEAR(static_cast<double>(pixels.at(col, 5)), std::atan(slope) / kDegree, 1e-4) << col;
      EXPECT_LT(std::abs(north(col) - north(0.5 * (first + last))), 0.05 * kDegree);
      // At a point, north is that of the point.
      const auto point = run(words + Names{"--at", fmt::format("{},{}", west + (col + 0.5) * cell, south + cell / 2)});
      double angle = 0;
      ASSERT_EQ(std::sscanf(point.out.substr(point.out.find('\n')).c_str(), "\n1,0,%lf", &angle), 1) << point.out;
      EXPECT_NEAR(angle, std::atan(-std::sin(north(col)) * 4 / (cell / scale)) / kDegree, 1e-4);
    }
  }
  expect_same_parts(words, path("h.tif"), 3);
  const auto swept = run(words + Names{"--engine", "sweep", "-o", path("s.tif")});
  EXPECT_NE(swept.err.find("true north at the centre, up to 0.22 degrees off"), std::string::npos) << swept.err;
}

// Two degrees of latitude, over which the columns widen by 6 %, and three of longitude.
TEST_F(HorizonFramesCli, RowsInDegreesHaveTheirOwnLengths) {
  const std::string dem = ramp("degrees.asc", 150, 200, "xllcorner 10\nyllcorner 58\ncellsize 0.01", 40);
  const Names words{"horizon",    dem, "--crs",          "EPSG:4326", "--cc",          "0",
                    "--azimuths", "4", "--max-distance", "2000",      "--plane-error", "0.1"};
  const auto result = run(words + Names{"-o", path("h.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("metric planes, one for 32 rows"), std::string::npos) << result.err;
  ASSERT_EQ(run({"skyview", dem, "--crs", "EPSG:4326", "--cc", "0", "--azimuths", "2", "--max-distance", "2000",
                 "--plane-error", "0.1", "--measure", "sky-view-factor", "-o", path("s.tif")})
                .status,
            0);
  const Pixels east = pixels_of(*open(path("h.tif")), 2), sky = pixels_of(*open(path("s.tif")));
  for (int row = 0; row < 200; ++row) {
    // The strip's middle, on WGS 84.
    const int first = row / 32 * 32, last = std::min(first + 32, 200) - 1;
    const double latitude = (60 - 0.01 * (0.5 * (first + last) + 0.5)) * kDegree;
    const double e2 = 0.00669437999014;
    const double radius = 6378137 / std::sqrt(1 - e2 * std::pow(std::sin(latitude), 2));
    const double slope = 40 / (radius * std::cos(latitude) * 0.01 * kDegree);
    EXPECT_NEAR(static_cast<double>(east.at(3, row)), std::atan(slope) / kDegree, 1e-5) << row;
    // To the north and to the south, the plane looks level: cos b.
    EXPECT_NEAR(static_cast<double>(sky.at(3, row)), 1 / std::sqrt(1 + slope * slope), 1e-5) << row;
  }
  expect_same_parts(words, path("h.tif"), 3);
  expect_refused({"horizon", dem, "--crs", "EPSG:4326", "--max-distance", "100000", "-o", path("x.tif")},
                 "up to 100000 m away are up to");
  expect_refused({"horizon", dem, "--crs", "EPSG:4326", "-o", path("x.tif")}, "cells off the metric plane");
  expect_refused({"skyview", dem, "--crs", "EPSG:4326", "--engine", "sweep", "-o", path("x.tif")},
                 "cells off the metric plane");
}

// Ten degrees of latitude in Web Mercator, over which cells shrink from 707 to 575 metres.
TEST_F(HorizonFramesCli, BlocksOfProjectedRastersHaveTheirOwnLengths) {
  const double cell = 1000, west = 1000000, south = 5621500, reach = 10000, plane_error = 0.1;
  const int rows = 1740;
  const std::string dem =
      ramp("mercator.asc", 40, rows, fmt::format("xllcorner {}\nyllcorner {}\ncellsize {}", west, south, cell), 30);
  const Names place{"--crs", "EPSG:3857", "--cc", "0"},
      limits{"--max-distance", fmt::format("{}", reach), "--plane-error", fmt::format("{}", plane_error)};
  const Names words = Names{"horizon", dem, "--azimuths", "4"} + place + limits;
  const auto result = run(words + Names{"-o", path("h.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto sky_result = run(Names{"skyview", dem, "--azimuths", "2", "--measure", "sky-view-factor"} + place +
                              limits + Names{"-o", path("s.tif")});
  ASSERT_EQ(sky_result.status, 0) << sky_result.err;
  OGRSpatialReference map, degrees;
  map.importFromEPSG(3857), degrees.importFromEPSG(4326);
  degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> to(OGRCreateCoordinateTransformation(&map, &degrees));
  geod_geodesic earth{};
  geod_init(&earth, 6378137, 1 / 298.257223563);
  const Pixels east = pixels_of(*open(path("h.tif")), 2), sky = pixels_of(*open(path("s.tif")));
  for (int row = 0; row < rows; row += 3) {
    double x[] = {west, west + cell}, y[2], length = 0;
    y[0] = y[1] = south + (rows - row - 0.5) * cell;
    ASSERT_TRUE(to->Transform(2, x, y));
    geod_inverse(&earth, y[0], x[0], y[1], x[1], &length, nullptr, nullptr);
    // The plane may be off by so much at the reach, and by a share of it before.
    const double slope = 30 / length, share = plane_error * length / reach;
    EXPECT_NEAR(std::tan(static_cast<double>(east.at(3, row)) * kDegree), slope, share * slope) << row;
    // To the north and to the south, the plane looks level: cos b.
    const double level = 1 / std::sqrt(1 + slope * slope);
    EXPECT_NEAR(static_cast<double>(sky.at(3, row)), level, share * (1 - level * level) + 0x1p-22) << row;
  }
  expect_same_parts(words, path("h.tif"), 3);
  const std::string too_far = "cells off the metric plane of a block";
  expect_refused(Names{"horizon", dem} + place + Names{"-o", path("x.tif")}, too_far);
  expect_refused(Names{"skyview", dem} + place + Names{"-o", path("x.tif")}, too_far);
  expect_refused(Names{"skyview", dem, "--engine", "sweep"} + place + Names{"-o", path("x.tif")},
                 "metric plane of the centre");
#ifdef SCARP_ERFA
  const Names day{"sunhours", dem, "--date", "2026-06-21"};
  expect_refused(day + place + Names{"-o", path("x.tif")}, too_far);
  ASSERT_EQ(run(day + place + limits + Names{"--step", "240", "-o", path("d.tif")}).status, 0);
  EXPECT_TRUE(open(path("d.tif"))->GetMetadataItem("BLOCKS"));
#endif
}

#ifdef SCARP_ERFA
// Noon moves by 4 minutes per degree of longitude.
TEST_F(HorizonFramesCli, SunsOfBlocksRiseByLongitude) {
  const std::string dem = ramp("plain.asc", 1200, 3, "xllcorner 420000\nyllcorner 5000000\ncellsize 100", 0);
  const Names words{"sunhours", dem,          "--crs",  "EPSG:32633", "--cc",        "0",
                    "--date",   "2026-03-20", "--step", "1",          "--first-last"};
  const auto noon = [&](int col) {
    const auto map = open(path("s.tif"));
    return static_cast<double>(pixels_of(*map, 2).at(col, 1) + pixels_of(*map, 3).at(col, 1)) / 2;
  };
  const auto one = run(words + Names{"-o", path("s.tif")});
  ASSERT_EQ(one.status, 0) << one.err;
  EXPECT_NE(one.err.find("up to 0.54 degrees off in the corners (--sun-per-cell)"), std::string::npos) << one.err;
  EXPECT_EQ(noon(10), noon(1190));
  const auto result = run(words + Names{"--sun-per-cell", "-o", path("s.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err.find("one sun"), std::string::npos) << result.err;
  // Middles of the first and of the last block of 128 columns.
  const double turn = lonlat_of(420000 + 100 * 1176, 5000150).lon - lonlat_of(420000 + 100 * 64, 5000150).lon;
  // First and last sun are off by half a step each, at both places.
  EXPECT_NEAR(noon(10) - noon(1190), turn / 15, 1.0 / 60);
  EXPECT_GT(noon(10), noon(1190) + 4.0 / 60);
  expect_refused(words + Names{"--sun-per-cell", "--engine", "sweep", "-o", path("x.tif")},
                 "--sun-per-cell has no effect without --engine exact");
}
#endif

}  // namespace
}  // namespace scarp::test
