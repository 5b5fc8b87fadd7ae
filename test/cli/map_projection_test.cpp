// SPDX-License-Identifier: MIT
// Maps and lines over large projected rasters, where north and scale change, against PROJ's geodesics.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <geodesic.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "cli/maps_cli.h"

namespace scarp::test {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
// Tables have ten digits, so that numbers are off by at most 5e-10 of themselves.
constexpr double kTextDigits = 1e-9;

class MapProjection : public MapsCli {
 protected:
  // A raster of level ground at 100 m, whose north-west sample is at (x, y), with some other heights.
  struct Ground {
    int epsg, cols, rows;
    double x, y, cell;
  };
  using Heights = std::function<float(int col, int row)>;
  std::string write(
      const Ground& ground, const std::string& name, const Heights& heights = [](int, int) { return 100.0f; }) {
    GDALAllRegister();
    const GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        path(name).c_str(), ground.cols, ground.rows, 1, GDT_Float32, nullptr));
    double map[] = {ground.x - ground.cell / 2, ground.cell, 0, ground.y + ground.cell / 2, 0, -ground.cell};
    dataset->SetGeoTransform(map);
    OGRSpatialReference crs;
    crs.importFromEPSG(ground.epsg);
    dataset->SetSpatialRef(&crs);
    std::vector<float> samples;
    for (int row = 0; row < ground.rows; ++row)
      for (int col = 0; col < ground.cols; ++col) samples.push_back(heights(col, row));
    EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, ground.cols, ground.rows, samples.data(), ground.cols,
                                                  ground.rows, GDT_Float32, 0, 0, nullptr),
              CE_None);
    return path(name);
  }

  // Geodesics on WGS 84 between positions of a CRS.
  class Judge {
   public:
    explicit Judge(int epsg) {
      OGRSpatialReference map, lonlat;
      map.importFromEPSG(epsg);
      lonlat.importFromEPSG(4326);
      for (auto* crs : {&map, &lonlat}) crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
      transform_.reset(OGRCreateCoordinateTransformation(&map, &lonlat));
      geod_init(&earth_, 6378137, 1 / 298.257223563);
    }
    struct Way {
      double distance, azimuth;  // metres, degrees 0..360
    };
    Way way(double x1, double y1, double x2, double y2) const {
      transform_->Transform(1, &x1, &y1);
      transform_->Transform(1, &x2, &y2);
      Way way{};
      geod_inverse(&earth_, y1, x1, y2, x2, &way.distance, &way.azimuth, nullptr);
      if (way.azimuth < 0) way.azimuth += 360;
      return way;
    }

   private:
    struct Deleter {
      void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
    };
    std::unique_ptr<OGRCoordinateTransformation, Deleter> transform_;
    geod_geodesic earth_{};
  };

  // The fields of the last row of a table.
  static std::vector<double> last_row(const std::string& csv) {
    std::vector<double> row;
    std::istringstream all(csv);
    for (std::string line; std::getline(all, line);) {
      row.clear();
      std::istringstream fields(line);
      for (std::string field; std::getline(fields, field, ',');) row.push_back(std::strtod(field.c_str(), nullptr));
    }
    return row;
  }

  // Compares a viewshed of level ground on a flat Earth with geodesics: pixels are visible in a sector. Pixels closer
  // to its border than `cells`, the error that the plane may have, may have either value.
  void expect_sector(const Ground& ground, double x, double y, double reach, double from, double to, double cells) {
    const std::string dem = write(ground, fmt::format("{}.tif", ground.epsg));
    const auto result = run({"viewshed", dem, "--observer", fmt::format("{:.10g},{:.10g},50", x, y), "--cc", "0",
                             "--max-distance", fmt::format("{}", reach), "--azimuth", fmt::format("{},{}", from, to),
                             "--plane-error", fmt::format("{}", cells), "-o", path("seen.tif")});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto dataset = open(path("seen.tif"));
    ASSERT_TRUE(dataset);
    const Pixels pixels = pixels_of(*dataset);
    const Judge judge(ground.epsg);
    const double margin = cells * ground.cell;
    int seen = 0, wrong = 0;
    for (int row = 0; row < ground.rows; ++row)
      for (int col = 0; col < ground.cols; ++col) {
        const Judge::Way way = judge.way(x, y, ground.x + col * ground.cell, ground.y - row * ground.cell);
        const double distance = way.distance, azimuth = way.azimuth;
        const bool visible = pixels.at(col, row) == 1;
        seen += visible;
        const auto beside = [&](double border) {
          const double off = std::remainder(azimuth - border, 360) * kRadians;
          return std::cos(off) > 0 && std::abs(distance * std::sin(off)) <= margin;
        };
        if (distance <= margin || std::abs(distance - reach) <= margin || beside(from) || beside(to)) continue;
        wrong += visible != (distance < reach && azimuth > from && azimuth < to);
      }
    EXPECT_EQ(wrong, 0);
    // The pixels of the sector, by its area.
    EXPECT_GT(seen, 100);
  }
};

TEST_F(MapProjection, ViewshedsUseNorthAndScaleOfTheObserver) {
  // The west of a raster over all of UTM zone 33 and its neighbours, where grid north is 3 degrees off.
  expect_sector({32633, 670, 60, 165500, 5180000, 1000}, 170500, 5150000, 45000, 20, 110, 0.1);
  // East and west of Greenland, where grid north is far from true north.
  expect_sector({3413, 150, 150, -900000, -1500000, 1000}, -850000, -1550000, 40000, 20, 110, 0.1);
  // Far from the centre of a raster of 10 degrees of latitude.
  expect_sector({3857, 100, 1800, 1000000, 7200000, 1000}, 1050000, 7100000, 20000, 200, 300, 0.2);
}

TEST_F(MapProjection, RefusesPlanesWithLargeErrors) {
  const std::string dem = write({3857, 100, 1800, 1000000, 7200000, 1000}, "mercator.tif");
  const Names view{"viewshed", dem, "--observer", "1050000,7100000,50", "-o", path("x.tif")};
  expect_refused(view, "gdalwarp -t_srs '+proj=aeqd +lat_0=53.");
  const auto near = run(view + Names{"--max-distance", "9000"});
  EXPECT_EQ(near.status, 0) << near.err;
  EXPECT_EQ(run(view + Names{"--plane-error", "9999"}).status, 0);
  expect_refused({"los", dem, "--from", "1000000,5500000", "--to", "1090000,7100000"}, "--plane-error");
}

TEST_F(MapProjection, LinesHaveGeodesicLengths) {
  const std::string dem = write({3857, 100, 1800, 1000000, 7200000, 1000}, "mercator.tif");
  const Judge judge(3857);
  const auto expect_length = [&](double x1, double y1, double x2, double y2) {
    const double expected = judge.way(x1, y1, x2, y2).distance;
    const Names ends{
        dem, "--from", fmt::format("{},{},50", x1, y1), "--to", fmt::format("{},{},50", x2, y2), "--plane-error", "99"};
    const auto los = run(Names{"los"} + ends), profile = run(Names{"profile"} + ends);
    ASSERT_EQ(los.status, 0) << los.err;
    ASSERT_EQ(profile.status, 0) << profile.err;
    EXPECT_NEAR(last_row(los.out)[2], expected, kTextDigits * expected);
    EXPECT_NEAR(last_row(profile.out)[0], expected, kTextDigits * expected);
  };
  expect_length(1010000, 7150000, 1010000, 7100000);
  expect_length(1010000, 5450000, 1080000, 5470000);
  expect_length(1000000, 5500000, 1090000, 7100000);
}

// PROJ converts no other body's longitudes to those of WGS 84.
TEST_F(MapProjection, OtherBodiesHaveTheirOwnGeodesics) {
  const std::string dem = write({32633, 100, 100, 0, 300000, 1000}, "moon.tif");
  const std::string moon = "+proj=eqc +R=1737400 +units=m +type=crs";
  const auto result = run({"los", dem, "--crs", moon, "--from", "10000,290000,9000", "--to", "90000,210000,9000"});
  ASSERT_EQ(result.status, 0) << result.err;
  geod_geodesic sphere{};
  geod_init(&sphere, 1737400, 0);
  double distance = 0;
  const auto degrees = [](double metres) { return metres / 1737400 / kRadians; };
  geod_inverse(&sphere, degrees(290000), degrees(10000), degrees(210000), degrees(90000), &distance, nullptr, nullptr);
  EXPECT_NEAR(last_row(result.out)[2], distance, kTextDigits * distance);
  const auto view = run({"viewshed", dem, "--crs", moon, "--observer", "50000,250000,9", "--azimuth", "0,90",
                         "--max-distance", "5000", "-o", path("seen.tif")});
  EXPECT_EQ(view.status, 0) << view.err;
  expect_refused({"los", dem, "--crs", moon, "--lines", scratch_.write("l.csv", "lon,lat,tlon,tlat\n1,2,3,4\n")},
                 "PROJ cannot convert between WGS 84");
}

TEST_F(MapProjection, StationsAlongPathsAreEvenlySpacedOnTheGround) {
  const std::string dem = write({3857, 100, 1800, 1000000, 7200000, 1000}, "mercator.tif");
  const std::string road = scratch_.write("road.csv", "x,y\n1010000,5500000\n1010000,7100000\n");
  const auto result = run({"profile", dem, "--path", road, "--spacing", "25000"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Judge judge(3857);
  std::istringstream rows(result.out);
  std::string line;
  std::getline(rows, line);
  double last_y = 0;
  int stations = 0;
  for (; std::getline(rows, line); ++stations) {
    const std::vector<double> row = last_row(line);
    const double length = stations > 0 ? judge.way(1010000, last_y, row[2], row[3]).distance : 0;
    // The scale changes by 1 in 1000 over the pieces of 1 km on which it is constant.
    if (stations > 0 && row[3] < 7100000) {
      EXPECT_NEAR(length, 25000, 1);
    }
    last_y = row[3];
  }
  EXPECT_GT(stations, 30);
}

// The height of the ground at a crossing of a ray with a grid line; -1 outside.
template <class Height>
double ground_between(const Height& height, double col, double row, int cols, int rows) {
  if (col < 0 || row < 0 || col > cols - 1 || row > rows - 1) return -1;
  const int c = static_cast<int>(col), r = static_cast<int>(row);
  const double u = col - c, v = row - r;
  // One of both is 0.
  return u > 0 ? height(c, r) * (1 - u) + height(c + 1, r) * u
               : height(c, r) * (1 - v) + (v > 0 ? height(c, r + 1) * v : 0);
}

// The greatest height by which the ground is above the ray from a node to the sun.
template <class Height>
double blocked_by(const Height& height, int col, int row, int cols, int rows, double cell, double azimuth,
                  double altitude) {
  const double x = std::sin(azimuth), y = -std::cos(azimuth), rise = cell * std::tan(altitude);
  double most = -1e9;
  for (int i = 1; i < cols; ++i)
    for (const bool along_cols : {true, false}) {
      const double t = i / std::abs(along_cols ? x : y);
      const double at_col = along_cols ? col + std::copysign(i, x) : col + t * x,
                   at_row = along_cols ? row + t * y : row + std::copysign(i, y);
      const double ground = ground_between(height, at_col, at_row, cols, rows);
      if (ground >= 0) most = std::max(most, ground - height(col, row) - t * rise);
    }
  return most;
}

// Over 670 km, grid north turns by 6 degrees: blocks of pixels have the sun at their middles.
TEST_F(MapProjection, ShadowsHaveTheNorthOfTheirBlock) {
  constexpr int kCols = 335, kRows = 140;
  constexpr double kWideCell = 2000, kAltitude = 4 * kRadians;
  const auto height = [](int col, int row) {
    const unsigned hash = (static_cast<unsigned>(col) * 2654435761u) ^ (static_cast<unsigned>(row) * 40503u * 65537u);
    return static_cast<float>((hash >> 13) % 97 < 5 ? 300 + (hash >> 5) % 1200 : (hash >> 7) % 20);
  };
  const std::string dem = write({32633, kCols, kRows, 165000, 5280000, kWideCell}, "wide.tif", height);
  const Names words{"shadow", dem, "--sun", "300,4"};
  ASSERT_EQ(run(words + Names{"-o", path("s.tif")}).status, 0);
  const auto dataset = open(path("s.tif"));
  ASSERT_TRUE(dataset);
  const Pixels pixels = pixels_of(*dataset);
  const Judge judge(32633);
  // Shadow maps have the lengths of the raster's middle.
  const double middle_x = 165000 + 0.5 * (kCols - 1) * kWideCell, middle_y = 5280000 - 0.5 * (kRows - 1) * kWideCell;
  const double cell = judge.way(middle_x, middle_y - 1000, middle_x, middle_y + 1000).distance * kWideCell / 2000;
  // Rays nearer to the ground are left out: scale and north are known to 1e-6 (ground_scale.h), over the longest shadow
  // and on the steepest ground, and heights are floats.
  constexpr double kHighest = 1500, kAccuracy = 1e-6;
  const double reach = kHighest / std::tan(kAltitude);
  const double close = kAccuracy * reach * (kHighest / kWideCell + std::tan(kAltitude)) + kHighest * 0x1p-20;
  int shaded = 0, other = 0;
  for (int row = 1; row < kRows; row += 3)
    for (int col = 1; col < kCols; ++col) {
      const auto direction = [&](double at_col, double at_row) {
        const double x = 165000 + at_col * kWideCell, y = 5280000 - at_row * kWideCell;
        return (300 - judge.way(x, y - 50, x, y + 50).azimuth) * kRadians;
      };
      const int left = col / 128 * 128, top = row / 128 * 128;
      const double own =
          direction(0.5 * (left + std::min(left + 128, kCols) - 1), 0.5 * (top + std::min(top + 128, kRows) - 1));
      const double above = blocked_by(height, col, row, kCols, kRows, cell, own, kAltitude);
      if (std::abs(above) < close) continue;
      ASSERT_EQ(pixels.at(col, row) != 0, above > 0) << col << ' ' << row << ": " << above;
      shaded += above > 0;
      const double centre = direction(0.5 * (kCols - 1), 0.5 * (kRows - 1));
      other += (blocked_by(height, col, row, kCols, kRows, cell, centre, kAltitude) > 0) != (above > 0);
    }
  EXPECT_GT(shaded, 500);
  EXPECT_GT(other, 50) << "pixels that the north of the centre gets wrong";
  // Parts have the same pixels, on one thread.
  std::vector<float> joined;
  for (const char* part : {"1/3", "2/3", "3/3"}) {
    ASSERT_EQ(run(words + Names{"--part", part, "--threads", "1", "-o", path("p.tif")}).status, 0);
    const Pixels some = pixels_of(*open(path("p.tif")));
    joined.insert(joined.end(), some.samples.begin(), some.samples.end());
  }
  EXPECT_EQ(joined, pixels.samples);
}

#ifdef SCARP_ERFA

// The sun's geographic position from the low-precision formulas of the Astronomical Almanac, within 0.01 degree.
struct SubsolarPoint {
  double lon, lat;  // degrees
};
SubsolarPoint subsolar(double days_since_2000, double utc_hours) {
  const double n = days_since_2000, mean = 280.460 + 0.9856474 * n, anomaly = (357.528 + 0.9856003 * n) * kRadians;
  const double ecliptic = (mean + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * kRadians,
               tilt = (23.439 - 0.0000004 * n) * kRadians;
  const double ascension = std::atan2(std::cos(tilt) * std::sin(ecliptic), std::cos(ecliptic)) / kRadians;
  const double equation_of_time = std::remainder(mean - ascension, 360);  // degrees
  return {std::remainder(-15 * (utc_hours - 12) - equation_of_time, 360),
          std::asin(std::sin(tilt) * std::sin(ecliptic)) / kRadians};
}

// A tower at a pole: its shadow lies opposite to the meridian of the sun.
// Blocks are swept over all ground that may shade them: the more, the lower their sun.
TEST_F(MapProjection, DryRunsOfShadowsCountWhatBlocksDependOn) {
  const std::string dem = path("dem.vrt");
  scratch_.write("dem.vrt", R"(<VRTDataset rasterXSize="20000" rasterYSize="20000"><SRS>EPSG:32633</SRS>
<GeoTransform>200000, 30, 0, 5600000, 0, -30</GeoTransform><VRTRasterBand dataType="Int16" band="1"/></VRTDataset>)");
  const auto seconds = [&](const std::string& sun) {
    const auto result = run({"shadow", dem, "--sun", sun, "--dry-run", "-o", path("x.tif")});
    EXPECT_EQ(result.status, 0) << result.err;
    return std::strtod(result.out.c_str() + result.out.find("memory") + std::string("memory and ").size(), nullptr);
  };
  const double high = seconds("180,89.9"), low = seconds("180,10"), diagonal = seconds("135,10");
  EXPECT_GT(high, 1);
  EXPECT_GT(low, 1.5 * high);
  EXPECT_GT(diagonal, low);
}

TEST_F(MapProjection, ShadowsAtPolesPointAwayFromTheSun) {
  struct Pole {
    int epsg;
    double side;  // 1: north
    const char* day;
    double days;  // since noon of 1 January 2000
  };
  for (const auto& [epsg, side, day, days] : {Pole{3413, 1, "2026-06-21", 9668}, Pole{3976, -1, "2026-12-21", 9851}})
    for (const double hour : {3.0, 12.0}) {
      SCOPED_TRACE(fmt::format("EPSG:{} at {} h", epsg, hour));
      const std::string dem = write({epsg, 101, 101, -5000, 5000, 100}, fmt::format("{}.tif", epsg),
                                    [](int col, int row) { return col == 50 && row == 50 ? 1600.0f : 0.0f; });
      // The direction to the sun on the map: along its meridian, away from the pole.
      OGRSpatialReference map, lonlat;
      map.importFromEPSG(epsg);
      lonlat.importFromEPSG(4326);
      for (auto* crs : {&map, &lonlat}) crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
      OGRCoordinateTransformation* transform = OGRCreateCoordinateTransformation(&lonlat, &map);
      const SubsolarPoint sun = subsolar(days + (hour - 12) / 24, hour);
      double x = sun.lon, y = side * 89;
      transform->Transform(1, &x, &y);
      OGRCoordinateTransformation::DestroyCT(transform);
      const double expected = std::atan2(-x, -y);  // clockwise from grid north
      for (const bool per_cell : {false, true}) {
        Names words{"shadow",         dem, "--time", fmt::format("{}T{:02}:00Z", day, static_cast<int>(hour)), "-o",
                    path("shade.tif")};
        if (per_cell) words.emplace_back("--sun-per-cell");
        const auto result = run(words);
        ASSERT_EQ(result.status, 0) << result.err;
        const auto dataset = open(path("shade.tif"));
        ASSERT_TRUE(dataset);
        const Pixels pixels = pixels_of(*dataset);
        double east = 0, north = 0;
        for (int row = 0; row < 101; ++row)
          for (int col = 0; col < 101; ++col)
            if (pixels.at(col, row) == 2 && (col != 50 || row != 50)) east += col - 50, north += 50 - row;
        // The shadow is one pixel wide and 36 long: its axis is within half a pixel of its pixels.
        EXPECT_NEAR(std::remainder(std::atan2(east, north) - expected, 2 * std::numbers::pi), 0, 0.5 / 18);
        const std::string note = "it is up to ";
        const auto off = result.err.find(note);
        EXPECT_EQ(off == std::string::npos, per_cell) << result.err;
        if (per_cell) continue;
        // At a corner, the sun's direction differs by at most the angle between the verticals; the note has three
        // digits.
        const double most = Judge(epsg).way(0, 0, 5000, 5000).distance / 6399594;
        const double degrees = std::strtod(result.err.c_str() + off + note.size(), nullptr);
        EXPECT_GT(degrees, 0);
        EXPECT_LT(degrees, 1.001 * most / kRadians);
      }
    }
}

// A wall along a column, where grid north is 3 degrees west of true north, and a sun between both: the shadow is on the
// other side than with the north of the raster's centre.
TEST_F(MapProjection, FixedSunsTurnWithNorth) {
  const std::string dem = write({32633, 670, 60, 165500, 5180000, 1000}, "zone.tif",
                                [](int col, int) { return col == 20 ? 9000.0f : 0.0f; });
  const double grid_north = Judge(32633).way(185500, 5140000, 185500, 5141000).azimuth;
  EXPECT_LT(grid_north, 357.5);
  for (const bool per_cell : {false, true}) {
    Names words{"shadow", dem, "--sun", "358,1", "-o", path("shade.tif")};
    if (per_cell) words.emplace_back("--sun-per-cell");
    const auto result = run(words);
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err.find("degrees off in the corners"), std::string::npos) << result.err;
    const auto dataset = open(path("shade.tif"));
    ASSERT_TRUE(dataset);
    const Pixels pixels = pixels_of(*dataset);
    EXPECT_NE(pixels.at(19, 40), 0);
    EXPECT_EQ(pixels.at(21, 40), 0);
  }
}

#endif

}  // namespace
}  // namespace scarp::test
