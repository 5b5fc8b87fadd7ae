// SPDX-License-Identifier: MIT
// Vectors and observers on maps: `render --top --draw`, and previews.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "cli/maps_cli.h"
#include "cli/vector_package.h"
#include "output/read_png.h"

namespace scarp::test {
namespace {

using Colour = std::array<int, 3>;
constexpr Colour kMarked = {235, 0, 140}, kDrawn = {190, 20, 30};

// On pictures of greys.
bool is_red(const Colour& colour) { return colour[0] - colour[1] > 100 && colour[0] - colour[2] > 100; }

class DrawnVectors : public MapsCli {
 protected:
  // A line to the east, a square with a hole, and a point.
  std::string shapes() const {
    return vector_package(path("shapes.gpkg"),
                          {{"shapes", "road", "LINESTRING (500025 5000185, 500125 5000185)"},
                           {"shapes", "park",
                            "POLYGON ((500155 5000045, 500255 5000045, 500255 5000145, 500155 5000145, 500155 5000045),"
                            "(500185 5000075, 500225 5000075, 500225 5000115, 500185 5000115, 500185 5000075))"},
                           {"shapes", "mast", "POINT (500055 5000055)"}});
  }
  // A picture with 3 x 3 pixels per metre.
  Rgb render(const Names& options) const {
    const Result result = run(Names{"render", dem_, "--crs", "EPSG:32633", "--top", "--size", "870x570", "--look",
                                    "height", "-o", path("map.png")} +
                              options);
    EXPECT_EQ(result.status, 0) << result.err;
    return read_png(path("map.png"));
  }
  // The pixel 500005 + x east and 5000195 - y north.
  static Colour metre(const Rgb& picture, int x, int y) { return at(picture, 3 * x, 3 * y); }
  static Colour at(const Rgb& picture, int x, int y) {
    const auto* pixel = picture.pixel(x, y);
    return {pixel[0], pixel[1], pixel[2]};
  }
  static int changes(const Rgb& a, const Rgb& b, int west, int north, int east, int south) {
    int count = 0;
    for (int y = north; y < south; ++y)
      for (int x = west; x < east; ++x) count += at(a, x, y) != at(b, x, y);
    return count;
  }
};

TEST_F(DrawnVectors, MapsShowPointsLinesAndPolygons) {
  const Rgb plain = render({}), drawn = render({"--draw", shapes()});
  EXPECT_TRUE(is_red(metre(drawn, 70, 10))) << "in the middle of the line";
  EXPECT_TRUE(is_red(metre(drawn, 50, 140))) << "on the point";
  EXPECT_TRUE(is_red(metre(drawn, 150, 100))) << "on the western side of the polygon";
  EXPECT_TRUE(is_red(metre(drawn, 180, 100))) << "on the western side of its hole";
  const Colour inside = metre(drawn, 165, 60), before = metre(plain, 165, 60);
  EXPECT_NE(inside, before) << "inside the polygon";
  EXPECT_FALSE(is_red(inside));
  EXPECT_EQ(metre(drawn, 200, 100), metre(plain, 200, 100)) << "in its hole";
  EXPECT_EQ(changes(drawn, plain, 0, 60, 420, 390), 0) << "between them";
}

TEST_F(DrawnVectors, LabelsStandBesidePoints) {
  const Names draw{"--draw", shapes()};
  const Rgb drawn = render(draw), named = render(draw + Names{"--draw-label", "NAME"});
  EXPECT_GT(changes(named, drawn, 165, 390, 300, 450), 20) << "to the right of the point";
  EXPECT_EQ(changes(named, drawn, 0, 390, 135, 450), 0) << "to its left";
}

// Where pixels have this colour, on average.
std::array<double, 2> centre_of(const Rgb& picture, const Colour& colour) {
  double x_sum = 0, y_sum = 0, count = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const auto* pixel = picture.pixel(x, y);
      if (Colour{pixel[0], pixel[1], pixel[2]} == colour) x_sum += x, y_sum += y, ++count;
    }
  }
  EXPECT_GT(count, 0);
  return {x_sum / count, y_sum / count};
}

TEST_F(DrawnVectors, PreviewsMarkObserversAndLeaveCountsOfZeroClear) {
  const std::string point = scratch_.write("point.csv", "x,y\n500245,5000155\n");
  const Names options{"--observer", "500055,5000055", "--draw", point, "-o", path("a.tif"), "--preview", path("p.png")};
  const auto preview = [&](const Names& more) {
    const Result result = run(on_dem("viewshed") + options + more);
    EXPECT_EQ(result.status, 0) << result.err;
    return read_png(path("p.png"));
  };
  const Rgb count = preview({"--mode", "count"}), clear = preview({"--hidden-value", "255", "--nodata-value", "255"});
  const auto observer = centre_of(count, kMarked), drawn = centre_of(count, kDrawn);
  // The longer side, 290 m, has 1000 pixels.
  constexpr double kPerMetre = 1000.0 / 290, kPixel = 1;
  EXPECT_NEAR(drawn[0] - observer[0], 190 * kPerMetre, kPixel);
  EXPECT_NEAR(observer[1] - drawn[1], 100 * kPerMetre, kPixel);
  // Behind the wall, and before it.
  EXPECT_EQ(at(count, 900, 300), at(clear, 900, 300));
  EXPECT_NE(at(count, 400, 300), at(clear, 900, 300));
}

TEST_F(DrawnVectors, RejectsWhatCannotBeDrawn) {
  const Names map{"render", dem_, "--crs", "EPSG:32633", "--top", "-o", path("a.png")};
  const std::string file = shapes();
  expect_refused(map + Names{"--draw", path("no.gpkg")}, "no.gpkg");
  expect_refused(map + Names{"--draw", file, "--draw-label", "height"}, "--draw-label 'height': no such column in ");
  expect_refused(map + Names{"--draw-label", "name"}, "--draw-label has no effect without --draw FILE");
  expect_refused({"render", dem_, "-o", path("a.png"), "--draw", file}, "--draw has no effect without --top");
  expect_refused(on_dem("viewshed") + Names{"--observer", "500055,5000055", "--draw", file, "-o", path("a.tif")},
                 "--draw has no effect without --preview FILE");
}

}  // namespace
}  // namespace scarp::test
