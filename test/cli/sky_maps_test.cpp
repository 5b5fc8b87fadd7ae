// SPDX-License-Identifier: MIT
// `scarp horizon`, `skyview` and `sunhours`: their output, and their one-line errors.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cli/maps_cli.h"

namespace scarp::test {
namespace {

class SkyMaps : public MapsCli {};

// The wall is 50 m high and 100 m on the map, 100.04 m on the ground, east of column 10.
TEST_F(SkyMaps, HorizonsAreMeasuredFromEveryPixel) {
  const Names flat = on_dem("horizon") + Names{"--cc", "0"};
  const auto result = run(flat + Names{"--azimuths", "4", "--distance", "-o", path("h.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("4 azimuths, highest 78.69 degrees"), std::string::npos) << result.out;  // 50 m, 10 m away
  const auto map = open(path("h.tif"));
  ASSERT_EQ(map->GetRasterCount(), 8);
  EXPECT_STREQ(map->GetRasterBand(2)->GetDescription(), "horizon 90");
  EXPECT_NEAR(pixels_of(*map, 2).at(10, 9), 26.5559f, 1e-3f);  // atan(50 / 100.04)
  EXPECT_NEAR(pixels_of(*map, 6).at(10, 9), 100.04f, 1e-3f);
  EXPECT_FLOAT_EQ(pixels_of(*map, 4).at(10, 9), 0);     // west: flat
  EXPECT_FLOAT_EQ(pixels_of(*map, 4).at(0, 9), -90);    // the border
  EXPECT_FLOAT_EQ(pixels_of(*map, 2).at(0, 0), -9999);  // the hole
  const auto points = run(flat + Names{"--azimuths", "4", "--clamp", "--at", "500105,5000105,25"});
  ASSERT_EQ(points.status, 0) << points.err;
  EXPECT_EQ(lines(points.out), 5);
  EXPECT_TRUE(points.out.starts_with("point,horizon_azimuth,horizon_elevation,distance\n1,0,0.000000,90.036"))
      << points.out;
  EXPECT_NE(points.out.find("\n1,90,14.0308"), std::string::npos) << points.out;  // atan(25 / 100.04)
}

// The top of the wall sees the whole sky, its foot a little more than the half away from it.
TEST_F(SkyMaps, SkyviewNamesItsMeasures) {
  const auto result = run(on_dem("skyview") + Names{"--cc", "0", "--measure", "sky-fraction", "--measure",
                                                    "positive-openness", "-o", path("s.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto map = open(path("s.tif"));
  ASSERT_EQ(map->GetRasterCount(), 2);
  EXPECT_STREQ(map->GetRasterBand(1)->GetDescription(), "sky-fraction");
  EXPECT_STREQ(map->GetRasterBand(2)->GetUnitType(), "degrees");
  EXPECT_STREQ(map->GetMetadataItem("FORMULA sky-fraction"), "mean of 1 - sin h, h the horizon, at least 0");
  const auto fraction = pixels_of(*map, 1), openness = pixels_of(*map, 2);
  EXPECT_FLOAT_EQ(fraction.at(20, 9), 1);
  EXPECT_GT(fraction.at(19, 9), 0.5f);
  EXPECT_LT(fraction.at(19, 9), 0.6f);
  EXPECT_GT(openness.at(20, 9), 90);
  EXPECT_EQ(fraction.at(0, 0), -9999);
}

#ifdef SCARP_ERFA
// On a plain at 45.15 degrees north, the sun's centre is up for 2 acos(-tan(latitude) tan(declination)) / 15 degrees.
// Steps of a minute are off by one at both ends.
TEST_F(SkyMaps, SunHoursOfAPlainAreTheDay) {
  std::string text = "ncols 3\nnrows 3\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\n";
  for (int i = 0; i < 9; ++i) text += "0 ";
  const std::string plain = scratch_.write("plain.asc", text);
  const auto result = run({"sunhours", plain, "--crs", "EPSG:32633", "--date", "2026-06-21", "--step", "1",
                           "--first-last", "-o", path("sun.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("UTC+01:00"), std::string::npos) << result.err;
  const auto map = open(path("sun.tif"));
  ASSERT_EQ(map->GetRasterCount(), 3);
  constexpr double kRadian = 0.017453292519943295;
  const double day = 2 * std::acos(-std::tan(45.1529 * kRadian) * std::tan(23.437 * kRadian)) / kRadian / 15;
  EXPECT_NEAR(static_cast<double>(pixels_of(*map, 1).at(1, 1)), day, 2.0 / 60);
  const double first = static_cast<double>(pixels_of(*map, 2).at(1, 1));
  const double last = static_cast<double>(pixels_of(*map, 3).at(1, 1));
  EXPECT_NEAR(last - first, day, 3.0 / 60);
  EXPECT_NEAR((first + last) / 2, 12, 5.0 / 60) << "solar noon at 15 degrees east, equation of time 2 minutes";
  const Names sun{"sunhours", plain, "--crs", "EPSG:32633", "-o", path("x.tif")};
  expect_refused(sun, "--date DATE is required");
  expect_refused(sun + Names{"--date", "2026-02-30"}, "expected a date");
  expect_refused(sun + Names{"--date", "2026-06-21", "--to", "2026-06-20"}, "is before");
  expect_refused(sun + Names{"--date", "2026-06-21", "--utc-offset", "5"}, "+HH:MM");
  expect_refused({"sunhours", plain, "--crs", "none", "--date", "2026-06-21", "-o", path("x.tif")}, "CRS");
}
#endif

TEST_F(SkyMaps, ReportBadInputInOneLineWithoutOutput) {
  const std::string out = path("x.tif");
  expect_refused(on_dem("horizon"), "-o FILE is required");
  expect_refused(on_dem("horizon") + Names{"-o", out, "--azimuths", "0"}, "--azimuths");
  expect_refused(on_dem("horizon") + Names{"--at", "500005,5000195"}, "no sample under the point");
  expect_refused(on_dem("horizon") + Names{"--at", "500105,5000105,-2"}, "at least 0 metres");
  expect_refused(on_dem("horizon") + Names{"--at", "500105,5000105", "-o", out}, "expected .csv");
  expect_refused(on_dem("skyview") + Names{"-o", out, "--measure", "svf"}, "--measure");
  expect_refused(on_dem("skyview") + Names{"-o", path("x.png")}, "cannot store Float32 samples");
}

}  // namespace
}  // namespace scarp::test
