// SPDX-License-Identifier: MIT
// Viewsheds of several observers: the summary of each, and a map for each.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "cli/csv_rows.h"
#include "cli/maps_cli.h"
#include "cli/vector_package.h"

namespace scarp::test {
namespace {

class ViewshedObservers : public MapsCli {
 protected:
  // Three observers: before the wall, outside, and above the wall.
  std::string towers() const {
    return scratch_.write("towers.csv",
                          "Name,x,y,z\nnear,500105,5000105,2\nfar,600000,5000000,2\nhigh,500255,5000055,60\n");
  }
  Result viewshed(const Names& options) const { return run(on_dem("viewshed") + options); }
  void write(const std::string& name, const Names& options) const {
    const Result result = viewshed(options + Names{"-o", path(name)});
    ASSERT_EQ(result.status, 0) << result.err;
  }
  Pixels pixels(const std::string& name, int band = 1) const { return pixels_of(*open(path(name)), band); }

  // Observers at these columns and rows, by the row of the table.
  struct At {
    int row, col, line;
    const char* typed;
  };
  static std::vector<At> observers() { return {{9, 10, 1, "500105,5000105,2"}, {14, 25, 3, "500255,5000055,60"}}; }
};

TEST_F(ViewshedObservers, SummaryHasAreaShareAndFarthestOfEachObserver) {
  // Pixels are 10 m wide on the map, whose scale at the central meridian is 0.9996.
  constexpr double kSide = 10 / 0.9996;
  for (const Names& mode : {Names{"--mode", "count"}, Names{"--mode", "ground"}, Names{"--per-observer", "bands"}}) {
    write("all.tif",
          mode + Names{"--observers", towers(), "--skip-bad", "--max-distance", "150", "--summary", path("seen.csv")});
    const auto rows = rows_of(text_of(path("seen.csv")));
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[1].at("status"), "outside");
    EXPECT_EQ(rows[1].at("area"), "");
    for (const At& at : observers()) {
      write("one.tif", {"--observer", at.typed, "--max-distance", "150"});
      const Pixels one = pixels("one.tif");
      double visible = 0, all = 0, farthest = 0;
      for (int row = 0; row < one.rows; ++row) {
        for (int col = 0; col < one.cols; ++col) {
          all += one.at(col, row) != 255;
          if (one.at(col, row) != 1) continue;
          ++visible;
          farthest = std::max(farthest, kSide * std::hypot(col - at.col, row - at.row));
        }
      }
      const Row& row = rows[static_cast<std::size_t>(at.line - 1)];
      EXPECT_EQ(row.at("status"), "ok");
      EXPECT_EQ(row.at("observer"), fmt::format("{}", at.line));
      EXPECT_EQ(row.at("Name"), at.line == 1 ? "near" : "high");
      EXPECT_EQ(row.at("eye"), at.line == 1 ? "2" : "60");
      // 100 m from the meridian the scale differs by 1e-10; the table has 10 digits.
      EXPECT_NEAR(number(row, "area"), visible * kSide * kSide, 1e-4 * visible);
      EXPECT_NEAR(number(row, "share"), visible / all, 1e-5);
      EXPECT_NEAR(number(row, "farthest"), farthest, 1e-4);
      EXPECT_LT(number(row, "share"), 1);
    }
  }
}

TEST_F(ViewshedObservers, EveryObserverHasABandOrAFile) {
  for (const char* mode : {"visible", "angle"}) {
    const Names options{"--observers", towers(), "--skip-bad", "--mode", mode, "--per-observer"};
    write("bands.tif", options + Names{"bands"});
    write("files.tif", options + Names{"files"});
    ASSERT_EQ(open(path("bands.tif"))->GetRasterCount(), 2);
    EXPECT_EQ(open(path("files.tif")), nullptr);
    int band = 0;
    for (const At& at : observers()) {
      write("one.tif", {"--observer", at.typed, "--mode", mode});
      const std::vector<float> one = pixels("one.tif").samples;
      EXPECT_EQ(pixels("bands.tif", ++band).samples, one) << mode;
      EXPECT_EQ(pixels(fmt::format("files_{}.tif", at.line)).samples, one) << mode;
      const std::string name = open(path("bands.tif"))->GetRasterBand(band)->GetDescription();
      EXPECT_TRUE(name.starts_with(at.line == 1 ? "near: " : "high: ")) << name;
    }
  }
}

// Rolling ground of 24 x 16 samples with 10 m cells, and a mosaic around it that is wider on the west by 15 samples
// without ground, as `gdalbuildvrt -te` makes it.
constexpr int kGroundCols = 24, kGroundRows = 16, kMargin = 15;

double rolling(int col, int row) {
  return 100 + std::round(20 * std::sin(0.7 * col) * std::cos(0.45 * row) + 9 * std::sin(1.9 * (col + 2 * row)));
}

// Whether a straight line between two samples of the mosaic stays above the ground where it crosses grid lines, linear
// between samples; there is none in the margin.
bool is_seen(int col, int row, double eye, int to_col, int to_row) {
  const auto height = [](int c, int r) { return c < kMargin ? std::nan("") : rolling(c - kMargin, r); };
  const double target = height(to_col, to_row), dx = to_col - col, dy = to_row - row;
  const auto hides = [&](double t, int c0, int r0, int c1, int r1, double share) {
    return (1 - share) * height(c0, r0) + share * height(c1, r1) > eye + t * (target - eye);
  };
  for (int c = std::min(col, to_col) + 1; c < std::max(col, to_col); ++c) {
    const double t = (c - col) / dx, y = row + t * dy;
    const int r = static_cast<int>(std::floor(y));
    if (y > r ? hides(t, c, r, c, r + 1, y - r) : hides(t, c, r, c, r, 0)) return false;
  }
  for (int r = std::min(row, to_row) + 1; r < std::max(row, to_row); ++r) {
    const double t = (r - row) / dy, x = col + t * dx;
    const int c = static_cast<int>(std::floor(x));
    if (x > c ? hides(t, c, r, c + 1, r, x - c) : hides(t, c, r, c, r, 0)) return false;
  }
  return true;
}

// As doc/user/viewshed.md tells: nothing hides between the observer and the border.
TEST_F(ViewshedObservers, ObserversStandBeyondTheBorderOfAWidenedRaster) {
  std::string text = "ncols 24\nnrows 16\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value -9999\n";
  for (int row = 0; row < kGroundRows; ++row) {
    for (int col = 0; col < kGroundCols; ++col) text += fmt::format("{} ", rolling(col, row));
    text += '\n';
  }
  const std::string ground = scratch_.write("ground.asc", text);
  const std::string wide = scratch_.write(
      "wide.vrt",
      fmt::format("<VRTDataset rasterXSize=\"39\" rasterYSize=\"16\"><GeoTransform>-150,10,0,160,0,-10</GeoTransform>"
                  "<VRTRasterBand dataType=\"Float32\" band=\"1\"><NoDataValue>-9999</NoDataValue><ComplexSource>"
                  "<SourceFilename relativeToVRT=\"1\">ground.asc</SourceFilename><SourceBand>1</SourceBand>"
                  "<SrcRect xOff=\"0\" yOff=\"0\" xSize=\"24\" ySize=\"16\"/>"
                  "<DstRect xOff=\"15\" yOff=\"0\" xSize=\"24\" ySize=\"16\"/><NODATA>-9999</NODATA></ComplexSource>"
                  "</VRTRasterBand></VRTDataset>"));
  // 95 m west of the border pixels, in row 8.
  const std::string observer = "-95,75,131.3";
  expect_refused({"viewshed", ground, "--observer=" + observer, "--heights", "sea", "-o", path("a.tif")},
                 "-95,75 is outside");
  expect_refused({"los", ground, "--from=" + observer, "--to", "105,75,0", "-o", path("a.csv")}, "gdalbuildvrt -te");
  const Names words{"--crs", "none", "--heights", "sea", "--cc", "0"};
  const Result seen = run(Names{"viewshed", wide, "--observer=" + observer, "-o", path("a.tif")} + words);
  ASSERT_EQ(seen.status, 0) << seen.err;
  const Pixels map = pixels("a.tif");
  std::string lines = "x,y,z,tx,ty,tz\n";
  std::vector<bool> expected;
  int visible = 0;
  for (int row = 0; row < kGroundRows; ++row) {
    for (int col = kMargin; col < kMargin + kGroundCols; ++col) {
      expected.push_back(is_seen(5, 8, 131.3, col, row));
      visible += expected.back();
      EXPECT_EQ(map.at(col, row), expected.back() ? 1 : 0) << col << ", " << row;
      lines +=
          fmt::format("-95,75,131.3,{},{},{}\n", 10 * (col - kMargin) + 5, 155 - 10 * row, rolling(col - kMargin, row));
    }
    EXPECT_EQ(map.at(3, row), 255);
  }
  EXPECT_GT(visible, 50);
  EXPECT_LT(visible, kGroundCols * kGroundRows - 50);
  const Result sight = run(Names{"los", wide, "--lines", scratch_.write("lines.csv", lines)} + words);
  ASSERT_EQ(sight.status, 0) << sight.err;
  const auto rows = rows_of(sight.out);
  ASSERT_EQ(rows.size(), expected.size());
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i].at("visible"), expected[i] ? "1" : "0") << i;
}

// A line, a square with a hole, a polygon smaller than the spacing, and one that leaves the raster.
std::string shapes_file(const std::string& path) {
  return vector_package(
      path, {{"shapes", "road", "LINESTRING (500015 5000015, 500055 5000015)"},
             {"shapes", "park",
              "POLYGON ((500095 5000045, 500195 5000045, 500195 5000105, 500095 5000105, 500095 5000045),"
              "(500135 5000065, 500155 5000065, 500155 5000085, 500135 5000085, 500135 5000065))"},
             {"shapes", "hut", "MULTIPOLYGON (((500254 5000154, 500256 5000154, 500255 5000157, 500254 5000154)))"},
             {"shapes", "far", "POLYGON ((500254 5000154, 500256 5000154, 600255 5000156, 500254 5000154))"}});
}

TEST_F(ViewshedObservers, ObserversStandAlongLinesAndOverPolygons) {
  const std::string file = shapes_file(path("shapes.gpkg"));
  write("seen.tif", {"--observers", file, "--observer-spacing", "20", "--skip-bad", "--summary", path("seen.csv")});
  std::set<std::string> found, expected{"far,outside,,"};
  for (const int x : {500015, 500035, 500055}) expected.insert(fmt::format("road,ok,{},5000015", x));
  for (const int x : {500105, 500125, 500145, 500165, 500185})
    for (const int y : {5000055, 5000075, 5000095})
      if (x != 500145 || y != 5000075) expected.insert(fmt::format("park,ok,{},{}", x, y));
  expected.insert("hut,ok,500255,5000155");
  for (const Row& row : rows_of(text_of(path("seen.csv"))))
    found.insert(fmt::format("{},{},{},{}", row.at("name"), row.at("status") == "ok" ? "ok" : "outside", row.at("x"),
                             row.at("y")));
  EXPECT_EQ(found, expected);
  expect_refused(on_dem("viewshed") + Names{"--observers", file, "--observer-spacing", "20", "-o", path("a.tif")},
                 "shapes.gpkg: feature 4: 16.27530715,45.14776062 is outside");
  expect_refused(on_dem("viewshed") + Names{"--observers", file, "--observer-spacing", "0.01", "-o", path("a.tif")},
                 "more than 1000000 observers");
}

TEST_F(ViewshedObservers, RejectsInvalidOutputsAndTables) {
  const auto refused = [&](const Names& options, const std::string& what) {
    expect_refused(on_dem("viewshed") + Names{"--observer", "500105,5000105,2", "-o", path("a.tif")} + options, what);
  };
  refused({"--mode", "count", "--per-observer", "bands"}, "--per-observer does not apply to --mode count");
  refused({"--summary", path("a.txt")}, "expected a name that ends in .csv");
  refused({"--summary", path("no/a.csv")}, "no/a.csv");
  const std::string kept = text_of(towers());
  const Result result = viewshed({"--observers", towers(), "--summary", towers(), "-o", path("a.tif")});
  EXPECT_NE(result.status, 0);
  EXPECT_EQ(text_of(path("towers.csv")), kept);
}

}  // namespace
}  // namespace scarp::test
