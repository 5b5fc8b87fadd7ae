// SPDX-License-Identifier: MIT
// Files of observers, targets and points: bad rows, layers, names of columns, and places on the raster's border.
#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/csv_rows.h"
#include "cli/program.h"
#include "cli/vector_package.h"

namespace scarp::test {
namespace {

// The header and the rows.
std::vector<Names> csv_of(const std::string& text) {
  std::vector<Names> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) rows.push_back(fields_of(line));
  return rows;
}

class PlaceFiles : public testing::Test {
 protected:
  // 30 x 20 samples of 10 m, a ridge along column 20, a hole in the north-west corner. The south-west sample is at
  // (500005, 5000005) of UTM zone 33.
  PlaceFiles() {
    GDALAllRegister();
    std::string text = "ncols 30\nnrows 20\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\nNODATA_value -1\n";
    for (int row = 0; row < 20; ++row) {
      for (int col = 0; col < 30; ++col) text += fmt::format("{} ", col + row == 0 ? -1 : col == 20 ? 50 : 0);
      text += '\n';
    }
    dem_ = scratch_.write("dem.asc", text);
  }
  Result on_dem(const std::string& command, const Names& options) const {
    return run(Names{command, dem_, "--crs", "EPSG:32633"} + options);
  }
  void expect_refused(const Result& result, const std::string& what) const {
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
  }
  std::string write(const std::string& name, const std::string& text) const { return scratch_.write(name, text); }
  std::string path(const std::string& name) const { return scratch_.path(name); }

  // A GeoPackage with the layers roads, of a line, and towers and masts, of a point each.
  std::string layers() const {
    return vector_package(path("a.gpkg"), {{"roads", "road", "LINESTRING (500105 5000105, 500185 5000105)"},
                                           {"towers", "tower", "POINT (500105 5000105)"},
                                           {"masts", "mast", "POINT (500275 5000105)"}});
  }

  Scratch scratch_;
  std::string dem_;
};

// The first row is visible, the last is behind the ridge.
constexpr const char* kLines =
    "name,x,y,tx,ty\nfree,500105,5000105,500185,5000105\nword,500105,here,500185,5000105\nshort,500105\n"
    "far,500105,5000105,600185,5000105\nhole,500005,5000195,500185,5000105\nhid,500105,5000105,500285,5000105\n";

TEST_F(PlaceFiles, BadLinesAreSkippedOnRequest) {
  const std::string file = write("lines.csv", kLines);
  expect_refused(on_dem("los", {"--lines", file}), "lines.csv: line 3: y 'here' is not a finite number");
  const Result result = on_dem("los", {"--lines", file, "--skip-bad"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("note: 4 of 6 rows skipped; the first: " + file + ": line 3: y 'here'"), std::string::npos)
      << result.err;
  const auto rows = csv_of(result.out);
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_EQ((Names{rows[0].begin(), rows[0].begin() + 4}), (Names{"name", "line", "status", "visible"}));
  const Names expected[] = {{"free", "1", "ok", "1"},    {"word", "2", "invalid", ""}, {"short", "3", "invalid", ""},
                            {"far", "4", "outside", ""}, {"hole", "5", "nodata", ""},  {"hid", "6", "ok", "0"}};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(rows[i + 1].size(), rows[0].size()) << i;
    EXPECT_EQ((Names{rows[i + 1].begin(), rows[i + 1].begin() + 4}), expected[i]);
  }
  // Good rows are those of a table without the bad ones.
  const Result good = on_dem("los", {"--lines", write("good.csv", "x,y,tx,ty\n500105,5000105,500285,5000105\n")});
  const Names alone = csv_of(good.out).at(1);
  EXPECT_EQ((Names{rows[6].begin() + 3, rows[6].end()}), (Names{alone.begin() + 1, alone.end()}));
}

TEST_F(PlaceFiles, BadLinesInGeoJsonHaveNoGeometry) {
  const Result result =
      on_dem("los", {"--lines", write("lines.csv", kLines), "--skip-bad", "-o", path("links.geojson")});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto features = nlohmann::json::parse(text_of(path("links.geojson")))["features"];
  ASSERT_EQ(features.size(), 6u);
  EXPECT_EQ(features[3]["properties"]["status"], "outside");
  EXPECT_TRUE(features[3]["geometry"].is_null());
  EXPECT_EQ(features[5]["properties"]["status"], "ok");
  EXPECT_FALSE(features[5]["geometry"].is_null());
}

TEST_F(PlaceFiles, BadPointsAreSkippedOnRequest) {
  const std::string file = write("points.csv", "x,y\n500105,5000105\n1,2\n500005,5000195\nhere,there\n");
  expect_refused(on_dem("horizon", {"--points", file, "--azimuths", "4"}), "line 5: x 'here'");
  const Result result = on_dem("horizon", {"--points", file, "--azimuths", "4", "--skip-bad"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto rows = csv_of(result.out);
  ASSERT_EQ(rows.size(), 8u);
  EXPECT_EQ(rows[0].back(), "status");
  EXPECT_EQ(rows[4].back(), "ok");
  EXPECT_EQ(rows[5], (Names{"2", "", "", "", "outside"}));
  EXPECT_EQ(rows[6], (Names{"3", "", "", "", "nodata"}));
  EXPECT_EQ(rows[7], (Names{"4", "", "", "", "invalid"}));
}

TEST_F(PlaceFiles, BadObserversAreSkippedOnRequest) {
  const std::string file = write("towers.csv", "x,y,z\n1,2,3\n500105,5000105,2\n500005,5000195,2\n500105,5000105,-9\n");
  const Names output{"-o", path("some.tif"), "--observers"};
  expect_refused(on_dem("viewshed", {"-o", path("some.tif"), "--observers", file}), "line 2: 1,2 is outside");
  const Result some = on_dem("viewshed", {"-o", path("some.tif"), "--observers", file, "--skip-bad"});
  ASSERT_EQ(some.status, 0) << some.err;
  EXPECT_NE(some.err.find("note: 3 of 4 rows skipped"), std::string::npos) << some.err;
  ASSERT_EQ(on_dem("viewshed", {"-o", path("one.tif"), "--observer", "500105,5000105,2"}).status, 0);
  const auto pixels = [&](const char* name) {
    const GDALDatasetUniquePtr raster(GDALDataset::Open(path(name).c_str()));
    std::vector<std::uint8_t> all(30 * 20);
    EXPECT_EQ(raster->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 30, 20, all.data(), 30, 20, GDT_Byte, 0, 0, nullptr),
              CE_None);
    return all;
  };
  EXPECT_EQ(pixels("some.tif"), pixels("one.tif"));
  const GDALDatasetUniquePtr raster(GDALDataset::Open(path("some.tif").c_str()));
  EXPECT_STREQ(raster->GetMetadataItem("OBSERVERS"), "500105,5000105 2 m above ground") << "without skipped ones";
  expect_refused(
      on_dem("viewshed", {"-o", path("none.tif"), "--observers", write("none.csv", "x,y\n1,2\n3,4\n"), "--skip-bad"}),
      "no row can be used; the first: ");
  expect_refused(on_dem("viewshed", {"-o", path("none.tif"), "--observer", "500105,5000105", "--skip-bad"}),
                 "--skip-bad has no effect without --observers FILE");
}

// Observers along a line of two segments are those at its stations: every 40 m, and at the end.
TEST_F(PlaceFiles, ObserversStandAlongLines) {
  const auto map = [&](const std::string& name, const Names& options) {
    // Without a CRS, metres on the map are metres on the ground.
    const Result result = run(Names{"viewshed", dem_} + options + Names{"--mode", "count", "-o", path(name)});
    EXPECT_EQ(result.status, 0) << result.err;
    return GDALDatasetUniquePtr(GDALDataset::Open(path(name).c_str()));
  };
  const auto pixels = [](GDALDataset& raster) {
    std::vector<int> all(30 * 20);
    EXPECT_EQ(raster.GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 30, 20, all.data(), 30, 20, GDT_Int32, 0, 0, nullptr),
              CE_None);
    return all;
  };
  const std::string line = write("line.csv", "x,y,z\n500105,5000105,2\n500205,5000105,4\n500205,5000155,\n"),
                    points = write("points.csv",
                                   "x,y,z\n500105,5000105,2\n500145,5000105,2.8\n500185,5000105,3.6\n"
                                   "500205,5000125,\n500205,5000155,\n");
  const auto along = map("along.tif", {"--observers", line, "--observer-spacing", "40"}),
             each = map("each.tif", {"--observers", points});
  EXPECT_EQ(pixels(*along), pixels(*each));
  EXPECT_STREQ(along->GetMetadataItem("OBSERVERS"), each->GetMetadataItem("OBSERVERS")) << "and heights";
  // Stations on one sample are one observer: 16 samples along the line.
  const auto dense = map("dense.tif", {"--observers", line, "--observer-spacing", "3"});
  const std::vector<int> counts = pixels(*dense);
  EXPECT_EQ(counts[10 * 30 + 11], 16);
  // Lines outside are errors, or skipped.
  const std::string lines_file =
      write("lines.geojson", R"({"type":"FeatureCollection","features":[)"
                             R"({"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":)"
                             R"([[15.0014,45.1539],[15.0020,45.1540]]}},)"
                             R"({"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":)"
                             R"([[15.0014,45.1539],[16.0020,45.1540]]}}]})");
  const Names spaced{"--observers", lines_file, "--observer-spacing", "20"};
  expect_refused(on_dem("viewshed", spaced + Names{"-o", path("x.tif")}), "feature 2: 16.002,45.154 is outside");
  EXPECT_EQ(on_dem("viewshed", spaced + Names{"--skip-bad", "-o", path("x.tif")}).status, 0);
  expect_refused(on_dem("viewshed", {"--observer", "500105,5000105", "--observer-spacing", "9", "-o", path("y.tif")}),
                 "--observer-spacing has no effect without --observers FILE");
  expect_refused(on_dem("viewshed", {"--observers", line, "--observer-spacing", "1e-9", "-o", path("y.tif")}),
                 "--observer-spacing 1e-09: more than 1000000 stations");
}

// Each pair once; both ends are observers.
TEST_F(PlaceFiles, AllPairsOfPointsAreTested) {
  const std::string table = "name,x,y,z\na,500105,5000105,3\nb,500185,5000105,\nc,500285,5000055,90\nd,1,2,\n";
  const std::string file = write("towers.csv", table);
  expect_refused(on_dem("los", {"--lines", file, "--pairs"}), "towers.csv: line 5: 1,2 is outside");
  const Result pairs = on_dem("los", {"--lines", file, "--pairs", "--observer-height", "4", "--skip-bad"});
  ASSERT_EQ(pairs.status, 0) << pairs.err;
  const auto rows = csv_of(pairs.out);
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_EQ((Names{rows[0].begin(), rows[0].begin() + 6}),
            (Names{"from", "to", "name_from", "name_to", "line", "status"}));
  const Names ends[] = {{"1", "2", "a", "b"}, {"1", "3", "a", "c"}, {"1", "4", "a", "d"},
                        {"2", "3", "b", "c"}, {"2", "4", "b", "d"}, {"3", "4", "c", "d"}};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ((Names{rows[i + 1].begin(), rows[i + 1].begin() + 4}), ends[i]);
    EXPECT_EQ(rows[i + 1][5], ends[i][1] == "4" ? "outside" : "ok");
  }
  // The line from b to c, by its ends.
  const auto alone = csv_of(on_dem("los", {"--from", "500185,5000105,4", "--to", "500285,5000055,90"}).out).at(1);
  EXPECT_EQ((Names{rows[4].begin() + 6, rows[4].end()}), (Names{alone.begin() + 1, alone.end()}));
  EXPECT_EQ(csv_of(on_dem("los", {"--from", "500105,5000105", "--from", "500185,5000105", "--pairs"}).out).size(), 2u);
  expect_refused(on_dem("los", {"--from", "500105,5000105", "--pairs"}), "one point makes no pair");
  expect_refused(on_dem("los", {"--from", "500105,5000105", "--to", "500105,5000105", "--pairs"}), "--to");
}

TEST_F(PlaceFiles, LayersAreChosenByGeometryOrName) {
  const std::string file = layers();
  const auto first = [](const Result& result) { return csv_of(result.out).at(1); };
  const Result towers = on_dem("horizon", {"--points", file, "--azimuths", "1", "--first-azimuth", "90"});
  ASSERT_EQ(towers.status, 0) << towers.err;
  EXPECT_NE(towers.err.find("3 layers ('roads', 'towers', 'masts'); 'towers' is read (--layer)"), std::string::npos)
      << towers.err;
  const Result named =
      on_dem("horizon", {"--points", file, "--azimuths", "1", "--first-azimuth", "90", "--layer", "masts"});
  ASSERT_EQ(named.status, 0) << named.err;
  EXPECT_EQ(named.err.find("layers"), std::string::npos) << named.err;
  EXPECT_NE(first(towers), first(named));
  const Result roads = on_dem("los", {"--lines", file});
  ASSERT_EQ(roads.status, 0) << roads.err;
  EXPECT_NE(roads.err.find("'roads' is read"), std::string::npos) << roads.err;
  expect_refused(on_dem("los", {"--lines", file, "--layer", "paths"}), "a.gpkg: no layer 'paths' (layers: 'roads', ");
  expect_refused(on_dem("los", {"--lines", write("lines.csv", kLines), "--layer", "paths"}),
                 "is a table without layers");
}

TEST_F(PlaceFiles, NamesOfColumnsAreInAnyCase) {
  // Longitude 15 is the central meridian, x = 500000.
  const std::string upper = write("upper.csv", "X,Y,TX,TY\n500105,5000105,500285,5000105\n"),
                    lower = write("lower.csv", "x,y,tx,ty\n500105,5000105,500285,5000105\n");
  const Result expected = on_dem("los", {"--lines", lower});
  ASSERT_EQ(expected.status, 0) << expected.err;
  EXPECT_EQ(on_dem("los", {"--lines", upper}).out, expected.out);
  const std::string places = "15.001334,45.153949,15.003620,45.153949\n";
  const Result degrees = on_dem("los", {"--lines", write("d.csv", "lon,lat,tlon,tlat\n" + places)});
  ASSERT_EQ(degrees.status, 0) << degrees.err;
  for (const char* header : {"Longitude,LATITUDE,tLongitude,TLatitude\n", "LON,Lat,TLON,tlat\n"})
    EXPECT_EQ(on_dem("los", {"--lines", write("e.csv", header + places)}).out, degrees.out) << header;
  // Beside x and y, the long names are other columns.
  const Result both =
      on_dem("los", {"--lines", write("f.csv", "x,y,tx,ty,longitude\n500105,5000105,500285,5000105,7\n")});
  ASSERT_EQ(both.status, 0) << both.err;
  EXPECT_TRUE(both.out.starts_with("longitude,line,")) << both.out;
}

TEST_F(PlaceFiles, CastReadsLongitudeAndLatitude) {
  const std::string ray = "15.002,45.1539,100,0,0,-1\n";
  const Result expected = on_dem("cast", {"--coords", "lonlat", "--rays", write("xy.csv", "x,y,z,dx,dy,dz\n" + ray)});
  ASSERT_EQ(expected.status, 0) << expected.err;
  EXPECT_EQ(csv_of(expected.out).at(1).at(1), "hit");
  for (const char* header : {"lon,lat,z,dx,dy,dz\n", "Longitude,Latitude,Z,DX,DY,DZ\n"}) {
    const std::string file = write("lonlat.csv", header + ray);
    EXPECT_EQ(on_dem("cast", {"--rays", file}).out, expected.out) << header;
    expect_refused(on_dem("cast", {"--rays", file, "--coords", "map"}), "has columns lon and lat");
  }
}

// Rays straight down: bad ones are a word, a place without a map position, a wrong cell; good ones are unchanged.
TEST_F(PlaceFiles, BadRaysAreSkippedOnRequest) {
  const std::string header = "id,lon,lat,z,dx,dy,dz,start_col,start_row\n", one = "a,15.0020,45.1539,100,0,0,-1,,\n",
                    two = "e,15.0021,45.1539,100,0,0,-1,,\n";
  const std::string file = write("rays.csv", header + one + "b,15.0020,45.1539,here,0,0,-1,,\n" +
                                                 "c,15.0020,950,100,0,0,-1,,\n" +
                                                 "d,15.0020,45.1539,100,0,0,-1,999,0\n" + two + "f,1\n"),
                    good = write("good.csv", header + one + two);
  expect_refused(on_dem("cast", {"--rays", file}), "rays.csv: line 3 (ray 1): 'here' in column 'z'");
  const Result result = on_dem("cast", {"--rays", file, "--skip-bad"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("note: 4 of 6 rays skipped; the first: " + file + ": line 3 (ray 1): 'here'"),
            std::string::npos)
      << result.err;
  const auto rows = csv_of(result.out), alone = csv_of(on_dem("cast", {"--rays", good}).out);
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_EQ(rows[1], alone.at(1));
  EXPECT_EQ((Names{rows[5].begin(), rows[5].begin() + 3}), (Names{"e", "4", "hit"}));
  EXPECT_EQ((Names{rows[5].begin() + 2, rows[5].end()}), (Names{alone.at(2).begin() + 2, alone.at(2).end()}));
  const char* const ids[] = {"b", "c", "d", "", "f"};
  for (const std::size_t i : {1, 2, 3, 5}) {
    EXPECT_EQ((Names{rows[i + 1].begin(), rows[i + 1].begin() + 4}),
              (Names{ids[i - 1], fmt::format("{}", i), "invalid", ""}));
    EXPECT_EQ(rows[i + 1].size(), rows[0].size());
  }
  const Result any = on_dem("cast", {"--rays", file, "--skip-bad", "--any"});
  EXPECT_EQ(any.out, "id,ray,blocked\na,0,1\nb,1,\nc,2,\nd,3,\ne,4,1\nf,5,\n");
  expect_refused(on_dem("cast", {"--rays", write("none.csv", header + "f,1\n"), "--skip-bad"}),
                 "no ray can be used; the first: ");
}

TEST_F(PlaceFiles, AzimuthsMayBeNegative) {
  const auto view = [&](const std::string& name, const std::string& azimuth) {
    const Result result =
        on_dem("viewshed", {"--observer", "500105,5000105", "--azimuth=" + azimuth, "-o", path(name)});
    EXPECT_EQ(result.status, 0) << result.err;
    const GDALDatasetUniquePtr raster(GDALDataset::Open(path(name).c_str()));
    return GDALChecksumImage(raster->GetRasterBand(1), 0, 0, 30, 20);
  };
  EXPECT_EQ(view("a.tif", "-45,60"), view("b.tif", "315,60"));
  EXPECT_NE(view("c.tif", "45,60"), view("b.tif", "315,60"));
  const Names point{"--at", "500105,5000105", "--azimuths", "3"};
  const auto horizon = [&](const std::string& first) {
    return on_dem("horizon", {"--at", "500105,5000105", "--azimuths", "3", "--first-azimuth=" + first}).out;
  };
  EXPECT_EQ(horizon("-90"), horizon("270"));
}

TEST_F(PlaceFiles, PlacesInBorderPixelsAreMovedToTheirSamples) {
  const auto line = [&](const char* from) { return on_dem("los", {"--from", from, "--to", "500185,5000105"}); };
  const Result border = line("500001,5000105"), sample = line("500005,5000105");
  ASSERT_EQ(border.status, 0) << border.err;
  EXPECT_EQ(border.out, sample.out);
  EXPECT_NE(border.err.find("in the outer half of a border pixel"), std::string::npos) << border.err;
  EXPECT_EQ(sample.err.find("border"), std::string::npos) << sample.err;
  EXPECT_EQ(on_dem("horizon", {"--at", "500299,5000105", "--azimuths", "4"}).status, 0);
  expect_refused(line("499999,5000105"), "is outside");
}

TEST_F(PlaceFiles, SwappedCoordinatesAreSuspected) {
  expect_refused(on_dem("los", {"--from", "5000105,500105", "--to", "500185,5000105"}),
                 "500105,5000105 is inside: are x and y swapped?");
  expect_refused(on_dem("viewshed", {"--coords", "lonlat", "--observer", "45.1539,15.002", "-o", path("x.tif")}),
                 "15.002,45.1539 is inside: are longitude and latitude swapped?");
  const Result far = on_dem("los", {"--from", "1,2", "--to", "500185,5000105"});
  EXPECT_EQ(far.err.find("swapped"), std::string::npos) << far.err;
}

// Along a row and then a column: stations every 35 m, on ground of height 0 and a ridge of 50 m.
TEST_F(PlaceFiles, ProfilesFollowPolylines) {
  const std::string file = write("path.csv", "x,y\n500105,5000105\n500205,5000105\n500205,5000155\n");
  const Result result = on_dem("profile", {"--path", file, "--spacing", "35"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto rows = csv_of(result.out);
  ASSERT_EQ(rows.size(), 7u) << result.out;
  EXPECT_EQ(rows[0], (Names{"path", "distance", "x", "y", "ground"}));
  const double expected[][4] = {{0, 500105, 5000105, 0},    {35, 500140, 5000105, 0},   {70, 500175, 5000105, 0},
                                {105, 500205, 5000110, 50}, {140, 500205, 5000145, 50}, {150, 500205, 5000155, 50}};
  // UTM's scale, 0.9996 here, stretches distances on the ground.
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(rows[i + 1][0], "1");
    EXPECT_NEAR(std::stod(rows[i + 1][1]), expected[i][0], 0.1);
    for (std::size_t k = 1; k < 3; ++k) EXPECT_NEAR(std::stod(rows[i + 1][k + 1]), expected[i][k], 0.1) << i;
    EXPECT_EQ(std::stod(rows[i + 1][4]), expected[i][3]) << i;
  }
  const std::string lines_file = write(
      "lines.geojson", R"({"type":"FeatureCollection","features":[)"
                       R"({"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":)"
                       R"([[15.0014,45.1539],[15.0020,45.1540],[15.0025,45.1535]]}},)"
                       R"({"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[15,45]}}]})");
  expect_refused(on_dem("profile", {"--path", lines_file}), "lines.geojson: feature 2: is a POINT");
  const auto paths = csv_of(on_dem("profile", {"--path", lines_file, "--spacing", "20", "--skip-bad"}).out);
  ASSERT_GT(paths.size(), 4u);
  EXPECT_EQ(paths.back(), (Names{"2", "", "", "", "", "invalid"}));
  EXPECT_EQ(paths[1].back(), "ok");
  expect_refused(on_dem("profile", {"--path", file, "--from", "500105,5000105"}), "--from");
  expect_refused(on_dem("profile", {"--path", file, "-o", path("x.svg")}), "expected .csv with --path");
  expect_refused(on_dem("profile", {"--path", file, "--spacing", "0"}), "--spacing");
  expect_refused(on_dem("profile", {"--path", write("one.csv", "x,y\n500105,5000105\n")}), "at least two vertices");
  const Result skipped =
      on_dem("profile", {"--path", write("bad.csv", "x,y\n500105,5000105\nhere,1\n500205,5000105\n500205,5000155\n"),
                         "--spacing", "35", "--skip-bad"});
  EXPECT_EQ(lines(skipped.out), 7) << skipped.out;
  EXPECT_NE(skipped.err.find("1 of 4 vertices skipped; the first: "), std::string::npos) << skipped.err;
}

}  // namespace
}  // namespace scarp::test
