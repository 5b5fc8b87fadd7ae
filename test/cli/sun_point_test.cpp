// SPDX-License-Identifier: MIT
// `scarp sunhours --at`: first and last sun against almanac formulas, energy against maps, and the picture.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>

#include "cli/csv_rows.h"
#include "cli/drawn_skyline.h"
#include "cli/maps_cli.h"

namespace scarp::test {
namespace {

class SunPoint : public MapsCli {
 protected:
  // Declination of the sun on 2026-06-21: the obliquity, which nutation changes by less than 0.003 degrees.
  static constexpr double kDeclination = 23.436 * kDegree;
  // Hours per degree of hour angle: on this day the equation of time falls by 13 s.
  static constexpr double kHours = (1 + 13.0 / 86400) / 15;
  // 1 s each for the sun's parallax at both ends, 2 s for nutation, and 1 s for rounding and bisection.
  static constexpr double kSeconds = 5.0 / 3600;

  static double hours(const std::string& time) {
    int hour = 0, minute = 0, second = 0;
    EXPECT_EQ(std::sscanf(time.c_str(), "%d:%d:%d", &hour, &minute, &second), 3) << time;
    return hour + minute / 60.0 + second / 3600.0;
  }
  // Altitude and azimuth of the sun at an hour angle.
  static double altitude(double latitude, double hour_angle) {
    return std::asin(std::sin(latitude) * std::sin(kDeclination) +
                     std::cos(latitude) * std::cos(kDeclination) * std::cos(hour_angle));
  }
  static double azimuth(double latitude, double hour_angle) {
    return std::atan2(-std::cos(kDeclination) * std::sin(hour_angle),
                      std::cos(latitude) * std::sin(kDeclination) -
                          std::sin(latitude) * std::cos(kDeclination) * std::cos(hour_angle));
  }
  // Half of the day on a plain, as an angle.
  static double half_day(double latitude) { return std::acos(-std::tan(latitude) * std::tan(kDeclination)); }

  // The model of MapsCli, or a plain, with its south-west corner at `east`.
  std::string model(int east, int wall) const {
    std::string text = fmt::format("ncols 30\nnrows 20\nxllcorner {}\nyllcorner 5000000\ncellsize 10\n", east);
    for (int i = 0; i < 600; ++i) text += fmt::format("{} ", i % 30 == 20 ? wall : 0);
    return scratch_.write(fmt::format("model-{}-{}.asc", east, wall), text);
  }
  Row day(const Names& words) const {
    const auto result = run(words);
    EXPECT_EQ(result.status, 0) << result.err;
    const auto rows = rows_of(result.out);
    EXPECT_EQ(rows.size(), 1u);
    return rows.empty() ? Row{} : rows[0];
  }
  static Names at(const std::string& file, const std::string& place) {
    return {"sunhours", file, "--crs", "EPSG:32633", "--cc", "0", "--date", "2026-06-21", "--at", place};
  }
};

TEST_F(SunPoint, SunOfAPlainIsTheDay) {
  const Row sun = day(at(model(500000, 0), "500105,5000105"));
  EXPECT_EQ(sun.at("date"), "2026-06-21");
  const double latitude = 45.1530 * kDegree, length = 2 * half_day(latitude) / kDegree * kHours;
  const double first = hours(sun.at("first_sun")), last = hours(sun.at("last_sun"));
  EXPECT_NEAR(number(sun, "hours"), length, kSeconds);
  EXPECT_NEAR(last - first, length, kSeconds);
  // The equation of time is -1 min 50 s on average over this day, and changes by 13 s per day.
  EXPECT_NEAR((first + last) / 2, 12 + 110.0 / 3600, 10.0 / 3600);
  // Steps only find where to search.
  const Row coarse = day(at(model(500000, 0), "500105,5000105") + Names{"--step", "47"});
  EXPECT_NEAR(hours(coarse.at("first_sun")), first, 2.0 / 3600);
  EXPECT_NEAR(number(coarse, "hours"), number(sun, "hours"), 2.0 / 3600);
  // Refraction lifts the sun to the horizon by 34 minutes of arc.
  const Row lifted = day(at(model(500000, 0), "500105,5000105") + Names{"--refraction"});
  const double late = half_day(latitude) + (number(lifted, "hours") - number(sun, "hours")) / 2 / kHours * kDegree;
  EXPECT_NEAR(altitude(latitude, late) / kDegree, -34.0 / 60, 0.02);
}

// A wall 50 m high east of the eye, 100 m away on the map; the second model is far from the zone's meridian: grid north
// is 2.7 degrees east of true north.
TEST_F(SunPoint, SunComesOverAWallOfKnownHeight) {
  const struct {
    int east;
    double longitude, latitude, scale;
  } models[] = {{500000, 15.0013, 45.1536, 0.9996}, {800000, 18.8138, 45.0907, 1.000708}};
  for (const auto& m : models) {
    const std::string place = fmt::format("{},5000105", m.east + 105);
    const Row sun = day(at(model(m.east, 50), place));
    const double latitude = m.latitude * kDegree;
    const double convergence = std::atan(std::tan((m.longitude - 15) * kDegree) * std::sin(latitude));
    // The hour angle, negative in the morning, at which the sun is as high as the wall.
    double dark = -half_day(latitude), lit = -0.1;
    while (lit - dark > 1e-7) {
      const double middle = (dark + lit) / 2;
      const double wall = std::atan(50 * std::sin(azimuth(latitude, middle) - convergence) / (100 / m.scale));
      (altitude(latitude, middle) > wall ? lit : dark) = middle;
    }
    const double expected = (half_day(latitude) - lit) / kDegree * kHours;
    EXPECT_NEAR(hours(sun.at("last_sun")) - hours(sun.at("first_sun")), expected, 2 * kSeconds) << m.east;
    EXPECT_NEAR(number(sun, "hours"), expected, 2 * kSeconds);
    // Over the wall there is the sun of a plain.
    const Row high = day(at(model(m.east, 50), place + ",50"));
    EXPECT_NEAR(number(high, "hours"), 2 * half_day(latitude) / kDegree * kHours, kSeconds);
  }
}

TEST_F(SunPoint, EnergyIsThatOfTheMap) {
  const Names on_map = on_dem("sunhours") + Names{"--date", "2026-06-21", "--cc", "0", "--energy", "--step", "1"};
  ASSERT_EQ(run(on_map + Names{"-o", path("m.tif")}).status, 0);
  const auto map = open(path("m.tif"));
  // The top of the wall, its foot, and the plain.
  for (const int col : {20, 19, 5}) {
    const Row sun = day(at(dem_, fmt::format("{},5000105", 500005 + 10 * col)) + Names{"--energy"});
    const auto pixel = [&](int band) { return static_cast<double>(pixels_of(*map, band).at(col, 9)); };
    const double energy = pixel(2);
    EXPECT_NEAR(number(sun, "hours"), pixel(1), 2.0 / 60) << col;  // steps
    // A minute of low sun, and floats.
    EXPECT_NEAR(number(sun, "energy"), energy, 0.001 * energy) << col;
    EXPECT_NEAR(number(sun, "beam"), pixel(3), 0.001 * energy) << col;
    EXPECT_NEAR(number(sun, "diffuse"), pixel(4), 0.001 * energy) << col;
    EXPECT_NEAR(number(sun, "reflected"), pixel(5), 0.001 * energy) << col;
  }
}

TEST_F(SunPoint, DaysAreRowsAndMayHaveNoSun) {
  std::string text = "ncols 3\nnrows 3\nxllcorner 20\nyllcorner 70\ncellsize 0.001\n0 0 0 0 0 0 0 0 0\n";
  const std::string north = scratch_.write("north.asc", text);
  const Names place{"sunhours", north, "--crs", "EPSG:4326", "--at", "20.0015,70.0015", "-o", path("d.csv")};
  const auto result = run(place + Names{"--date", "2026-12-20", "--to", "2026-12-22"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("3 days"), std::string::npos) << result.out;
  EXPECT_TRUE(text_of(path("d.csv")).starts_with("date,first_sun,last_sun,hours\n2026-12-20,,,0.0000\n2026-12-21,"));
  ASSERT_EQ(run(place + Names{"--date", "2026-06-21"}).status, 0);
  EXPECT_NE(text_of(path("d.csv")).find("2026-06-21,00:00:00,24:00:00,24.0000\n"), std::string::npos);
}

// Each point has the rows that --at has there; months are the sums of their days.
TEST_F(SunPoint, PointsHaveTheRowsOfSinglePlaces) {
  const std::string table =
      scratch_.write("sites.csv", "name,x,y,z\n\"mast, north\",500105,5000105,25\nfar,1,1,0\nhut,500155,5000055,0\n");
  const Names sun =
      on_dem("sunhours") + Names{"--date", "2026-03-30", "--to", "2026-04-01", "--step", "30", "--energy"};
  const Names points = sun + Names{"--points", table};
  const auto result = run(points + Names{"--skip-bad", "-o", path("p.csv")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("3 points, 3 days"), std::string::npos) << result.out;
  const std::string energy = ",energy,beam,diffuse,reflected";
  std::string expected = "name,point,date,first_sun,last_sun,hours" + energy + ",status\n";
  std::string months = "name,point,period,hours" + energy + ",status\n";
  const auto add = [&](const std::string& before, const std::string& place) {
    const auto one = run(sun + Names{"--at", place});
    EXPECT_EQ(one.status, 0) << one.err;
    std::string header, line;
    std::istringstream days(one.out);
    std::getline(days, header);
    while (std::getline(days, line)) expected += before + line + ",ok\n";
    const auto sums = run(sun + Names{"--at", place, "--sum", "month"});
    std::istringstream of_months(sums.out);
    std::getline(of_months, header);
    while (std::getline(of_months, line)) months += before + line + ",ok\n";
  };
  add("\"mast, north\",1,", "500105,5000105,25");
  expected += "far,2,,,,,,,,,outside\n", months += "far,2,,,,,,,outside\n";
  add("hut,3,", "500155,5000055,0");
  EXPECT_EQ(text_of(path("p.csv")), expected);
  ASSERT_EQ(run(points + Names{"--skip-bad", "--sum", "month", "-o", path("p.csv")}).status, 0);
  EXPECT_EQ(text_of(path("p.csv")), months);
  // March has two of the days.
  double hours[3] = {}, march = 0, beam[3] = {}, of_march = 0;
  const Names at = sun + Names{"--at", "500155,5000055"};
  const std::string days = run(at).out, sums = run(at + Names{"--sum", "month"}).out;
  const auto line = [](const std::string& text, int number) {
    std::size_t begin = 0;
    for (int i = 0; i < number; ++i) begin = text.find('\n', begin) + 1;
    return text.substr(begin, text.find('\n', begin) - begin);
  };
  for (int i = 0; i < 3; ++i)
    ASSERT_EQ(std::sscanf(line(days, i + 1).c_str(), "%*[^,],%*[^,],%*[^,],%lf,%*f,%lf", &hours[i], &beam[i]), 2)
        << days;
  ASSERT_EQ(std::sscanf(line(sums, 1).c_str(), "2026-03,%lf,%*f,%lf", &march, &of_march), 2) << sums;
  // Rounded to 4 and 5 decimals.
  EXPECT_NEAR(march, hours[0] + hours[1], 1.5e-4);
  EXPECT_NEAR(of_march, beam[0] + beam[1], 1.5e-5);
  expect_refused(points + Names{"-o", path("x.csv")}, "sites.csv: line 3: 1,1 is outside");
  expect_refused(on_dem("sunhours") + Names{"--date", "2026-03-30", "--points", table, "-o", path("x.svg")},
                 "a figure shows one point, not 3");
}

TEST_F(SunPoint, ReportsBadInputInOneLineWithoutOutput) {
  const Names point = on_dem("sunhours") + Names{"--date", "2026-06-21", "--at", "500105,5000105"};
  expect_refused(on_dem("sunhours") + Names{"--date", "2026-06-21"}, "-o FILE is required");
  expect_refused(on_dem("sunhours") + Names{"--date", "2026-06-21", "--coords", "map", "-o", path("x.tif")},
                 "--coords has no effect without --at or --points");
  expect_refused(point + Names{"-o", path("x.tif")}, "expected .csv, .svg, .pdf or .png with --at");
  for (const Names& option : {Names{"--first-last"}, {"--part", "1/2"}, {"--engine", "exact"}})
    expect_refused(point + option, option[0] + " cannot be combined with --at");
  expect_refused(point + Names{"--to", "2026-06-22", "-o", path("x.svg")},
                 "--to has no effect without a map or a table");
  expect_refused(point + Names{"--sum", "day", "-o", path("x.svg")}, "--sum has no effect without a map or a table");
  expect_refused(point + Names{"--points", path("x.csv")}, "--points cannot be combined with --at");
  expect_refused(point + Names{"--skip-bad"}, "--skip-bad");
  expect_refused(point + Names{"--energy", "-o", path("x.svg")}, "--energy has no effect without a map or a table");
  expect_refused(on_dem("sunhours") + Names{"--date", "2026-06-21", "--at", "500005,5000195"}, "over a hole");
  expect_refused(on_dem("sunhours") + Names{"--date", "2026-06-21", "--at", "nan,1"}, "--at");
  expect_refused(on_dem("sunhours") + Names{"--date", "2026-06-21", "--at", "1,1"}, "is outside");
  expect_refused({"sunhours", dem_, "--crs", "none", "--date", "2026-06-21", "--at", "500105,5000105"}, "CRS");
}

#ifdef SCARP_CAIRO
TEST_F(SunPoint, PictureHasThePathOfTheSun) {
  const auto result = run(at(model(500000, 50), "500105,5000105,2") + Names{"-o", path("s.svg")});
  ASSERT_EQ(result.status, 0) << result.err;
  const DrawnSkyline skyline(path("s.svg"));
  const double per_degree = (skyline.level() - skyline.y(90)) / (std::atan(48 / 100.04) / kDegree);
  // The highest point of the path of this day is noon.
  const SvgPath& path_of_sun = skyline.path("stroke:rgb(90%,55%,5%)");
  ASSERT_GT(path_of_sun.points.size(), 150u);
  const auto noon = std::min_element(path_of_sun.points.begin(), path_of_sun.points.end(),
                                     [](const SvgPoint& a, const SvgPoint& b) { return a.y < b.y; });
  const double latitude = 45.1536;
  // A point every 5 minutes: noon is 0.625 degrees of hour angle away at most, where the sun is 0.01 degrees lower.
  EXPECT_NEAR((skyline.level() - noon->y) / per_degree, 90 - latitude + kDeclination / kDegree, 0.05);
  // In azimuth cos(declination) / cos(altitude) times that, and a step of coordinates.
  EXPECT_NEAR(skyline.azimuth(noon->x), 180, 0.625 * 2.5 + 0.01);
  // Sunrise and sunset are marked; a sun that does not set has none.
  const auto marks = [&] {
    int count = 0;
    for (const SvgPath& p : paths_of(text_of(path("s.svg"))))
      count += p.curved && p.style.find("fill:rgb(62%,20%,16%)") != std::string::npos;
    return count;
  };
  EXPECT_EQ(marks(), 2);
  const std::string north =
      scratch_.write("north.asc", "ncols 2\nnrows 2\nxllcorner 20\nyllcorner 70\ncellsize 0.001\n0 0 0 0\n");
  ASSERT_EQ(run({"sunhours", north, "--crs", "EPSG:4326", "--at", "20.001,70.001", "--date", "2026-06-21", "-o",
                 path("s.svg")})
                .status,
            0);
  EXPECT_EQ(marks(), 0);
  EXPECT_EQ(run(at(model(500000, 50), "500105,5000105") + Names{"-o", path("s.png"), "--size", "300x200"}).status, 0);
  EXPECT_EQ(text_of(path("s.png")).substr(1, 3), "PNG");
}
#endif

}  // namespace
}  // namespace scarp::test
