// SPDX-License-Identifier: MIT
// `scarp horizon` as a picture: the outline of the skyline and the places of names, against sums of the test's own.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cli/drawn_skyline.h"
#include "cli/maps_cli.h"

namespace scarp::test {
namespace {

// The wall is 50 m high, 100 m east of the eye, without a CRS: a metre is a metre, and grid north is true north.
class Skyline : public MapsCli {
 protected:
  Names wall(const std::string& eye = "500105,5000105,2") const { return {"horizon", dem_, "--cc", "0", "--at", eye}; }
};

TEST_F(Skyline, OutlineIsTheWall) {
  const auto result = run(wall() + Names{"--azimuths", "720", "-o", path("s.svg")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("highest 25.64 degrees at azimuth 90"), std::string::npos) << result.out;
  const DrawnSkyline skyline(path("s.svg"));
  // The scale of elevations: the highest point of the wall, and 0.
  const double top = std::atan(48.0 / 100) / kDegree, level = skyline.level();
  const double per_degree = (level - skyline.y(90)) / top;
  ASSERT_GT(per_degree, 5);
  // A step of coordinates each at the point, at the level and at the top; and in x, where the line is less steep
  // than 1.
  const double tolerance = 4 * kSvgStep;
  for (double azimuth = 0; azimuth < 360; azimuth += 0.5) {
    // The wall reaches from row 0 to 19, the eye is in row 9.
    if (azimuth > 48 && azimuth < 134) {
      const double elevation = std::atan(48 * std::sin(azimuth * kDegree) / 100) / kDegree;
      EXPECT_NEAR(skyline.y(azimuth), level - per_degree * elevation, tolerance) << azimuth;
    } else if (azimuth > 180) {
      EXPECT_GT(skyline.y(azimuth), level) << azimuth;  // flat ground, seen from above
    }
  }
  // The nearest layer ends after 100 m, before the wall.
  const DrawnSkyline nearest(path("s.svg"), "fill:rgb(25%,33%,20%)");
  EXPECT_GT(nearest.y(60), level);
  EXPECT_LT(skyline.y(60), level);
}

// From any first azimuth on, over one turn.
TEST_F(Skyline, BeginsAtTheFirstAzimuth) {
  ASSERT_EQ(run(wall() + Names{"--azimuths", "360", "--first-azimuth", "200", "-o", path("s.svg")}).status, 0);
  const DrawnSkyline skyline(path("s.svg"));
  EXPECT_NEAR(skyline.azimuth(skyline.top().x, 200), 360 + 90, 1e-3);
}

TEST_F(Skyline, NamesWhatIsVisible) {
  // On the wall; over the wall by 10 m; on the plain before it; behind the wall; over the hole; beside the model.
  const std::string names =
      scratch_.write("names.csv",
                     "id,name,x,y,z\n1,Wall,500205,5000125,0\n2,Mast,500255,5000085,110\n3,Plain,500005,5000105,0\n"
                     "4,Behind,500265,5000105,0\n5,Hole,500005,5000195,0\n6,Beside,500505,5000105,0\n");
  const auto result = run(wall() + Names{"--azimuths", "720", "--labels", names, "-o", path("s.svg")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("3 of 6 points are visible, 1 are hidden by the ground, 2 are outside"), std::string::npos)
      << result.err;
  EXPECT_EQ(result.err.find("no room"), std::string::npos) << result.err;
  const DrawnSkyline skyline(path("s.svg"));
  const std::vector<SvgPoint> dots = skyline.dots();
  ASSERT_EQ(dots.size(), 3u);
  const double level = skyline.level();
  const double per_degree = (level - skyline.y(90)) / (std::atan(48.0 / 100) / kDegree);
  const struct { double east, north, up; } places[] = {{100, 20, 48}, {150, -20, 108}, {-100, 0, -2}};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& [east, north, up] = places[i];
    const double azimuth = std::atan2(east, north) / kDegree, elevation = std::atan2(up, std::hypot(east, north));
    EXPECT_NEAR(skyline.azimuth(dots[i].x), azimuth < 0 ? azimuth + 360 : azimuth, 0.01) << i;
    EXPECT_NEAR(dots[i].y, level - per_degree * elevation / kDegree, 8 * kSvgStep) << i;
  }
  // Farther away than ground counts.
  const auto near = run(wall() + Names{"--max-distance", "120", "--labels", names, "-o", path("n.svg")});
  EXPECT_NE(near.err.find("2 of 6 points are visible, 0 are hidden by the ground, 4 are outside"), std::string::npos)
      << near.err;
  // The column of names is the first without one of that name; a second name of the same place has a row of its own.
  std::string many = "what,x,y\n";
  for (int i = 0; i < 40; ++i) many += fmt::format("Tower {},500205,5000125\n", i);
  const auto crowded =
      run(wall() + Names{"--labels", scratch_.write("many.csv", many), "--size", "400x300", "-o", path("m.png")});
  ASSERT_EQ(crowded.status, 0) << crowded.err;
  EXPECT_NE(crowded.err.find("40 of 40 points are visible, 0 are hidden by the ground; "), std::string::npos);
  EXPECT_NE(crowded.err.find(" names have no room"), std::string::npos) << crowded.err;
}

// Grid north is 2.7 degrees east of true north: atan(tan(18.8149 - 15) sin(45.0909)), longitude and latitude of the
// eye.
TEST_F(Skyline, AzimuthsCountFromTrueNorth) {
  std::string text = "ncols 30\nnrows 20\nxllcorner 800000\nyllcorner 5000000\ncellsize 10\n";
  for (int i = 0; i < 600; ++i) text += i == 4 * 30 + 25 ? "60 " : "0 ";  // 150 m east and 50 m north of the eye
  const std::string spike = scratch_.write("spike.asc", text);
  const std::string names = scratch_.write("names.csv", "name,x,y\nSpike,800255,5000155\n");
  const auto result = run({"horizon", spike, "--crs", "EPSG:32633", "--at", "800105,5000105,2", "--azimuths", "3600",
                           "--labels", names, "-o", path("s.svg")});
  ASSERT_EQ(result.status, 0) << result.err;
  const double convergence = std::atan(std::tan(3.8149 * kDegree) * std::sin(45.0909 * kDegree)) / kDegree;
  const double expected = std::atan2(150, 50) / kDegree + convergence;
  const DrawnSkyline skyline(path("s.svg"));
  EXPECT_NEAR(skyline.azimuth(skyline.top().x), expected, 0.11);  // a step of azimuth is 0.1
  ASSERT_EQ(skyline.dots().size(), 1u);
  EXPECT_NEAR(skyline.azimuth(skyline.dots()[0].x), expected, 0.01);
}

TEST_F(Skyline, WritesAllFormatsAndRefusesOthers) {
  ASSERT_EQ(run(wall() + Names{"-o", path("s.pdf"), "--size", "300x200"}).status, 0);
  EXPECT_EQ(text_of(path("s.pdf")).substr(0, 4), "%PDF");
  ASSERT_EQ(run(wall() + Names{"-o", path("s.png"), "--size", "300x200"}).status, 0);
  EXPECT_EQ(text_of(path("s.png")).substr(1, 3), "PNG");
  const std::string none = scratch_.write("none.csv", "x,y\n500205,5000125\n");
  expect_refused(wall() + Names{"-o", path("x.gif")}, "expected .csv, .svg, .pdf or .png with --at or --points");
  expect_refused(wall() + Names{"-o", path("x.svg"), "--labels", none}, "no column with names");
  expect_refused(wall() + Names{"-o", path("x.svg"), "--labels", path("no.csv")}, "no.csv");
  expect_refused(wall() + Names{"-o", path("x.csv"), "--labels", none}, "--labels has no effect without --at X,Y and");
  expect_refused(wall() + Names{"-o", path("x.csv"), "--size", "300x200"}, "--size has no effect without --at X,Y and");
  expect_refused(wall() + Names{"-o", path("x.svg"), "--size", "10x10"}, "--size");
  expect_refused(wall() + Names{"-o", path("x.svg"), "--clamp"}, "--clamp has no effect without a map or a table");
  expect_refused(wall() + Names{"-o", path("x.svg"), "--at", "500125,5000105"}, "a figure shows one point, not 2");
  expect_refused(wall("500005,5000195") + Names{"-o", path("x.svg")}, "the point is over a hole");
  const std::string low = scratch_.write("low.csv", "name,x,y,z\nPit,500205,5000125,-3\n");
  expect_refused(wall() + Names{"-o", path("x.svg"), "--labels", low}, "low.csv: line 2: height -3");
}

}  // namespace
}  // namespace scarp::test
