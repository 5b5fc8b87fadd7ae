// SPDX-License-Identifier: MIT
// `scarp viewshed`, `shadow`, `los` and `profile`: their output, and their one-line errors; and what all maps share.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "cli/maps_cli.h"
#include "full_disk.h"

namespace scarp::test {
namespace {

namespace fs = std::filesystem;

TEST_F(MapsCli, ViewshedIsAGeoreferencedRaster) {
  const auto result = run(on_dem("viewshed") + Names{"--observer", "500105,5000105,2", "-o", path("seen.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(lines(result.out), 1) << result.out;
  const auto dataset = open(path("seen.tif"));
  ASSERT_TRUE(dataset);
  double map[6];
  ASSERT_EQ(dataset->GetGeoTransform(map), CE_None);
  EXPECT_EQ(map[0], 500000);
  EXPECT_EQ(map[3], 5000200);
  EXPECT_EQ(map[1], 10);
  EXPECT_EQ(map[5], -10);
  ASSERT_NE(dataset->GetSpatialRef(), nullptr);
  EXPECT_STREQ(dataset->GetSpatialRef()->GetAuthorityCode(nullptr), "32633");
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  EXPECT_EQ(band.GetNoDataValue(), 255);
  ASSERT_NE(band.GetColorTable(), nullptr);
  EXPECT_NE(std::string(dataset->GetMetadataItem("METHOD")).find("exact"), std::string::npos);
  int block[2];
  band.GetBlockSize(&block[0], &block[1]);
  EXPECT_EQ(block[0], 256);
  const Pixels seen = pixels_of(*dataset);
  EXPECT_EQ(seen.at(0, 0), 255);
  EXPECT_EQ(seen.at(5, 5), 1);
  EXPECT_EQ(seen.at(20, 9), 1);  // the wall
  EXPECT_EQ(seen.at(25, 9), 0);  // behind it
  EXPECT_EQ(scratch_.files(), (Names{"dem.asc", "seen.tif"}));
}

TEST_F(MapsCli, AcceptsGdalViewshedFlags) {
  const auto ours =
      run(on_dem("viewshed") + Names{"--observer", "500105,5000105", "--observer-height", "3", "--max-distance", "150",
                                     "--visible-value", "255", "-o", path("a.tif")});
  const auto theirs =
      run({"viewshed", "-ox", "500105", "-oy", "5000105", "-oz",          "3",     "-md",        "150", "-vv",
           "255",      "-iv", "0",      "-q",  "-co",     "COMPRESS=LZW", "--crs", "EPSG:32633", dem_,  path("b.tif")});
  ASSERT_EQ(ours.status, 0) << ours.err;
  ASSERT_EQ(theirs.status, 0) << theirs.err;
  EXPECT_EQ(theirs.out, "");
  const auto a = open(path("a.tif")), b = open(path("b.tif"));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(pixels_of(*a).samples, pixels_of(*b).samples);
  EXPECT_STREQ(b->GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE"), "LZW");
  expect_refused({"viewshed", "-ox", "500105", dem_, path("c.tif")}, "give both");
}

TEST_F(MapsCli, AppliesViewshedPixelValues) {
  const Names view = on_dem("viewshed") +
                     Names{"--observer", "500105,5000105", "--max-distance", "150", "--cc", "0", "-o", path("a.tif")};
  struct Seen {
    double nodata;
    float visible, hidden, beyond;
    std::string share;
  };
  const auto seen = [&](const Names& more) {
    const auto result = run(view + more);
    EXPECT_EQ(result.status, 0) << result.err;
    const auto dataset = open(path("a.tif"));
    const Pixels pixels = pixels_of(*dataset);
    const double nodata = dataset->GetRasterBand(1)->GetNoDataValue();
    EXPECT_EQ(pixels.at(0, 0), nodata);
    const auto end = result.out.find(" % visible");
    return Seen{nodata, pixels.at(5, 5), pixels.at(22, 9), pixels.at(29, 19),
                result.out.substr(result.out.rfind(' ', end - 1) + 1, end - result.out.rfind(' ', end - 1) - 1)};
  };
  const Seen plain = seen({});
  EXPECT_EQ(plain.nodata, 255);
  EXPECT_EQ(plain.beyond, 255);
  const Seen recoded = seen({"-vv", "255"});
  EXPECT_EQ(recoded.nodata, 254);
  EXPECT_EQ(recoded.visible, 255);
  EXPECT_EQ(recoded.hidden, 0);
  EXPECT_EQ(recoded.beyond, 254);
  EXPECT_EQ(recoded.share, plain.share);
  const Seen crowded = seen({"-vv", "255", "-iv", "253", "-ov", "254"});
  EXPECT_EQ(crowded.nodata, 252);
  EXPECT_EQ(crowded.beyond, 254);
  EXPECT_EQ(crowded.share, plain.share);
  // As in gdal_viewshed: hidden and out of range have the same value.
  const Seen theirs = seen({"-vv", "255", "-iv", "0", "-ov", "0", "-a_nodata", "0"});
  EXPECT_EQ(theirs.nodata, 0);
  EXPECT_EQ(theirs.visible, 255);
  EXPECT_EQ(theirs.hidden, 0);
  EXPECT_EQ(theirs.beyond, 0);
  EXPECT_EQ(theirs.share, plain.share);
  fs::remove(path("a.tif"));
  expect_refused(view + Names{"--visible-value", "7", "--hidden-value", "7"}, "--visible-value 7 and --hidden-value 7");
  expect_refused(view + Names{"-vv", "0"}, "--visible-value 0 and --hidden-value 0");
  expect_refused(view + Names{"-vv", "9", "-ov", "9"}, "--visible-value 9 and --out-of-range-value 9");
  expect_refused(view + Names{"-vv", "9", "-a_nodata", "9"}, "--visible-value 9 and --nodata-value 9");
  expect_refused(view + Names{"--mode", "ground", "--nodata-value", "0"},
                 "--nodata-value 0: is also a value of the map");
}

TEST_F(MapsCli, CountsObserversAndFindsLeastVisibleHeights) {
  const std::string table = scratch_.write("towers.csv", "name,x,y,z\na,500105,5000105,2\nb,500285,5000105,2\n");
  ASSERT_EQ(run(on_dem("viewshed") + Names{"--observers", table, "--mode", "count", "-o", path("count.tif")}).status,
            0);
  const auto count = pixels_of(*open(path("count.tif")));
  EXPECT_EQ(count.at(10, 9), 1);
  EXPECT_EQ(count.at(20, 9), 2);
  ASSERT_EQ(run(on_dem("viewshed") + Names{"--observer", "500105,5000105,2", "--cc", "0", "--mode", "ground", "--of",
                                           "COG", "-o", path("ground.tif")})
                .status,
            0);
  const auto dataset = open(path("ground.tif"));
  EXPECT_STREQ(dataset->GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE"), "COG");
  const auto ground = pixels_of(*dataset);
  EXPECT_EQ(ground.at(15, 10), 0);
  // Row 9.5 from the south; the observer is at column 10. The line of sight over the wall rises 48 m in 10 cells, so at
  // column 25 the least height is 72 + 2 m.
  EXPECT_FLOAT_EQ(ground.at(25, 9), 48 * 1.5 + 2);
  EXPECT_EQ(ground.at(0, 0), -9999);
}

TEST_F(MapsCli, AnglesAreMeasuredFromTheHorizontal) {
  const Names angles = on_dem("viewshed") + Names{"--mode", "angle", "--cc", "0", "-o", path("angle.tif")};
  ASSERT_EQ(run(angles + Names{"--observer", "500105,5000105,2"}).status, 0);
  const auto dataset = open(path("angle.tif"));
  EXPECT_STREQ(dataset->GetRasterBand(1)->GetUnitType(), "degrees");
  const auto one = pixels_of(*dataset);
  // Cells are 0.01 % longer than in the map.
  EXPECT_NEAR(one.at(15, 9), std::atan(-2 / 50.) * 180 / 3.14159265, 1e-2);
  EXPECT_NEAR(one.at(20, 9), std::atan(48 / 100.) * 180 / 3.14159265, 1e-2);
  EXPECT_EQ(one.at(25, 9), -9999);
  EXPECT_EQ(one.at(0, 0), -9999);
  // The share is that of the targets within the limits, as in --mode visible.
  const auto share = [&](const Names& more) {
    const auto result = run(on_dem("viewshed") +
                            Names{"--observer", "500105,5000105,2", "--observer", "500255,5000055,9", "--max-distance",
                                  "70", "-o", path("share.tif")} +
                            more);
    const auto end = result.out.find(" % visible"), begin = result.out.rfind(' ', end - 1);
    return result.out.substr(begin + 1, end - begin - 1);
  };
  EXPECT_EQ(share({"--mode", "angle"}), share({}));
  EXPECT_NE(share({}), "100");
  // The largest angle counts: the higher of the two observers sees the ground at a smaller one.
  ASSERT_EQ(run(angles + Names{"--observer", "500105,5000105,2", "--observer", "500105,5000105,9"}).status, 0);
  EXPECT_EQ(pixels_of(*open(path("angle.tif"))).at(15, 9), one.at(15, 9));
}

TEST_F(MapsCli, ShadowWritesOneBandPerSun) {
  ASSERT_EQ(run(on_dem("shadow") + Names{"--sun", "90,45", "--sun", "270,45", "-o", path("sun.tif")}).status, 0);
  const auto dataset = open(path("sun.tif"));
  ASSERT_EQ(dataset->GetRasterCount(), 2);
  const auto east = pixels_of(*dataset, 1), west = pixels_of(*dataset, 2);
  // Grid north is true north within 0.001 degrees here; the wall is 5 cells high.
  EXPECT_EQ(east.at(21, 9), 0);
  EXPECT_EQ(east.at(19, 9), 1);
  EXPECT_EQ(east.at(17, 9), 2);
  EXPECT_EQ(east.at(13, 9), 0);
  EXPECT_EQ(west.at(21, 9), 1);
  EXPECT_EQ(west.at(0, 0), 255);
  ASSERT_EQ(run(on_dem("shadow") + Names{"--sun", "90,45", "--fraction", "-o", path("part.tif")}).status, 0);
  const auto part = pixels_of(*open(path("part.tif")));
  EXPECT_NEAR(part.at(21, 9), 1, 1e-6);
  EXPECT_NEAR(part.at(17, 9), 0, 1e-6);
}

TEST_F(MapsCli, ShadowAcceptsTimes) {
  const auto result = run(on_dem("shadow") + Names{"--time", "2026-06-21T12:00+02:00", "-o", path("noon.tif")});
  if (result.err.find("SCARP_ERFA") != std::string::npos) GTEST_SKIP() << "built without ERFA";
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("altitude 6"), std::string::npos) << result.out;  // 45 degrees north at midsummer
  expect_refused(on_dem("shadow") + Names{"--time", "2026-06-21T01:00+02:00", "-o", path("x.tif")},
                 "below the horizon");
  expect_refused(on_dem("shadow") + Names{"--time", "21.6.2026 12:00", "-o", path("x.tif")}, "2026-06-21T09:00+02:00");
  // With a sun position for every pixel: here within 0.003 degrees of the one at the centre.
  EXPECT_NE(result.err.find("--sun-per-cell"), std::string::npos) << result.err;
  const Names evening = on_dem("shadow") + Names{"--time", "2026-06-21T19:00+02:00", "-o"};
  const auto local = run(evening + Names{path("local.tif"), "--sun-per-cell"});
  ASSERT_EQ(local.status, 0) << local.err;
  EXPECT_EQ(local.err.find("one sun"), std::string::npos) << local.err;
  ASSERT_EQ(run(evening + Names{path("one.tif")}).status, 0);
  EXPECT_EQ(pixels_of(*open(path("local.tif"))).samples, pixels_of(*open(path("one.tif"))).samples);
  for (const char* part : {"1/2", "2/2"})
    EXPECT_EQ(run(evening + Names{path("p.tif"), "--sun-per-cell", "--fraction", "--part", part}).status, 0);
  fs::remove(path("p.tif"));
  expect_refused(on_dem("shadow") + Names{"--time", "2026-06-21T01:00+02:00", "--sun-per-cell", "-o", path("x.tif")},
                 "below the horizon");
  expect_refused({"shadow", dem_, "--crs", "none", "--time", "2026-06-21T12:00Z", "-o", path("x.tif")}, "CRS");
}

// The parts together are the whole map, pixel by pixel, and each is georeferenced by its rows.
TEST_F(MapsCli, PartsMatchTheWhole) {
  const Names maps[] = {
      Names{"viewshed", "--observer", "500105,5000105,2", "--observer", "500255,5000055,9"},
      Names{"viewshed", "--observer", "500105,5000105,2", "--mode", "ground", "--max-distance", "60"},
      Names{"viewshed", "--observer", "500105,5000105,2", "--observer", "500255,5000055,9", "--mode", "angle"},
      Names{"shadow", "--sun", "160,20", "--sun", "280,3"},
      Names{"shadow", "--sun", "70,10", "--fraction"},
      Names{"horizon", "--azimuths", "3", "--first-azimuth", "20", "--distance"},
      Names{"horizon", "--azimuths", "3", "--distance", "--max-distance", "25"},
      Names{"skyview", "--measure", "sky-view-factor", "--measure", "negative-openness", "--azimuths", "9"},
      Names{"skyview", "--measure", "sky-view-factor", "--azimuths", "9", "--max-distance", "25"},
#ifdef SCARP_ERFA
      Names{"sunhours", "--date", "2026-06-21", "--step", "120", "--first-last"},
      Names{"sunhours", "--date", "2026-06-21", "--step", "120", "--refraction", "--max-distance", "25"},
#endif
  };
  for (const Names& map : maps) {
    const Names words = map + Names{dem_, "--crs", "EPSG:32633", "-o"};
    ASSERT_EQ(run(words + Names{path("whole.tif")}).status, 0);
    const auto whole = open(path("whole.tif"));
    std::vector<std::vector<float>> together(static_cast<std::size_t>(whole->GetRasterCount()));
    for (int i = 1; i <= 3; ++i) {
      const auto result = run(words + Names{path("part.tif"), "--part", fmt::format("{}/3", i)});
      ASSERT_EQ(result.status, 0) << result.err;
      const auto part = open(path("part.tif"));
      double place[6];
      ASSERT_EQ(part->GetGeoTransform(place), CE_None);
      EXPECT_EQ(place[0], 500000);
      EXPECT_EQ(place[3], 5000200 - 10. * static_cast<double>(together[0].size()) / 30);
      for (std::size_t band = 0; band < together.size(); ++band) {
        const auto pixels = pixels_of(*part, static_cast<int>(band) + 1);
        EXPECT_EQ(pixels.cols, 30);
        together[band].insert(together[band].end(), pixels.samples.begin(), pixels.samples.end());
      }
    }
    for (std::size_t band = 0; band < together.size(); ++band)
      EXPECT_EQ(pixels_of(*whole, static_cast<int>(band) + 1).samples, together[band]) << map[0];
  }
  const Names sun = on_dem("shadow") + Names{"--sun", "160,20", "-o", path("x.tif"), "--part"};
  expect_refused(sun + Names{"0/3"}, "--part '0/3': expected I/N");
  expect_refused(sun + Names{"4/3"}, "1 <= I <= N");
  expect_refused(sun + Names{"1.5/3"}, "whole numbers");
  expect_refused(sun + Names{"2"}, "for example 3/16");
  expect_refused(sun + Names{"1/21"}, "has only 20 rows");
}

// Between the samples of a saddle, the ground is higher than at any grid line that a diagonal crosses.
TEST_F(MapsCli, SupportsBilinearSurface) {
  const std::string saddle =
      scratch_.write("saddle.asc", "ncols 2\nnrows 2\nxllcorner -5\nyllcorner -5\ncellsize 10\n0 30\n30 0\n");
  const Names line{"los", saddle, "--coords", "map", "--cc", "0", "--from", "0,10,8", "--to", "10,0,8"};
  const auto crossings = run(line), bilinear = run(line + Names{"--surface", "bilinear"});
  ASSERT_EQ(bilinear.status, 0) << bilinear.err;
  EXPECT_NE(crossings.out.find("\n1,1,"), std::string::npos) << crossings.out;
  EXPECT_NE(bilinear.out.find("\n1,0,14.14213562,8,8,-7,"), std::string::npos) << bilinear.out;
  const Names sun{"shadow", saddle, "--sun", "135,10", "-o", path("s.tif")};
  ASSERT_EQ(run(sun).status, 0);
  EXPECT_EQ(pixels_of(*open(path("s.tif"))).at(0, 0), 0);
  for (const char* part : {"1/1", "1/2"}) {
    ASSERT_EQ(run(sun + Names{"--surface", "bilinear", "--part", part}).status, 0);
    const auto dataset = open(path("s.tif"));
    EXPECT_EQ(pixels_of(*dataset).at(0, 0), 1);
    EXPECT_NE(std::string(dataset->GetMetadataItem("METHOD")).find("bilinear"), std::string::npos);
  }
  ASSERT_EQ(run(sun + Names{"--surface", "bilinear", "--fraction"}).status, 0);
  EXPECT_EQ(pixels_of(*open(path("s.tif"))).at(0, 0), 0);
  fs::remove(path("s.tif"));
  expect_refused(on_dem("los") + Names{"--from", "500105,5000105", "--to", "500185,5000105", "--surface", "bilinear"},
                 "--cc 0");
  const std::string row = scratch_.write("row.asc", "ncols 3\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3");
  expect_refused({"shadow", row, "--sun", "90,45", "--surface", "bilinear", "-o", path("x.tif")}, "row.asc: ");
}

TEST_F(MapsCli, LosWritesCsvAndGeoJson) {
  const Names places{"--from", "500105,5000105,2", "--to", "500185,5000105", "--to", "500285,5000105,5", "--cc", "0"};
  const auto csv = run(on_dem("los") + places);
  ASSERT_EQ(csv.status, 0) << csv.err;
  EXPECT_EQ(lines(csv.out), 3);
  EXPECT_NE(csv.out.find("\n1,1,"), std::string::npos) << csv.out;
  EXPECT_NE(csv.out.find("\n2,0,"), std::string::npos) << csv.out;
  ASSERT_EQ(run(on_dem("los") + places + Names{"--parts", "-o", path("l.geojson")}).status, 0);
  const auto json = nlohmann::json::parse(text_of(path("l.geojson")));
  ASSERT_EQ(json["features"].size(), 3u);
  EXPECT_EQ(json["features"][1]["properties"]["part"], "visible");
  EXPECT_EQ(json["features"][2]["properties"]["part"], "blocked");
  EXPECT_EQ(json["features"][1]["geometry"]["coordinates"][1], json["features"][2]["geometry"]["coordinates"][0]);
  EXPECT_NEAR(json["features"][0]["geometry"]["coordinates"][0][0].get<double>(), 15, 0.01);
  // Its own output is also a valid table of lines.
  ASSERT_EQ(run(on_dem("los") + places + Names{"-o", path("l.geojson")}).status, 0);
  const auto again = run(on_dem("los") + Names{"--lines", path("l.geojson"), "--heights", "sea", "--cc", "0"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(lines(again.out), 3);
}

TEST_F(MapsCli, ProfileWritesATableOrAFigure) {
  const Names line = on_dem("profile") + Names{"--from", "500105,5000105,2", "--to", "500285,5000105,5"};
  const auto csv = run(line);
  ASSERT_EQ(csv.status, 0) << csv.err;
  EXPECT_EQ(lines(csv.out), 1 + 19);
#ifdef SCARP_CAIRO
  ASSERT_EQ(run(line + Names{"-o", path("p.svg")}).status, 0);
  EXPECT_NE(text_of(path("p.svg")).find("<svg"), std::string::npos);
  ASSERT_EQ(run(line + Names{"-o", path("p.png"), "--size", "400x300"}).status, 0);
  EXPECT_EQ(text_of(path("p.png")).substr(1, 3), "PNG");
  // There are no samples in the middle of this line: only paper above that part of the axis.
  const auto ground_at = [&](const std::string& name, double share) {
    const auto picture = open(name);
    const Pixels red = pixels_of(*picture, 1), blue = pixels_of(*picture, 3);
    const int col = static_cast<int>(share * red.cols);
    int ground = 0;
    for (int row = 0; row < red.rows; ++row) ground += red.at(col, row) > blue.at(col, row) + 20;
    return ground;
  };
  std::string table = "ncols 30\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value -1\n";
  for (int i = 0; i < 60; ++i) table += i % 30 > 12 && i % 30 < 18 ? "-1 " : "50 ";
  const std::string holes = scratch_.write("holes.asc", table);
  ASSERT_EQ(run({"profile", holes, "--from", "5,5,2", "--to", "295,5,2", "-o", path("h.png")}).status, 0);
  EXPECT_GT(ground_at(path("h.png"), 0.3), 0);
  EXPECT_EQ(ground_at(path("h.png"), 0.5), 0);
  EXPECT_GT(ground_at(path("h.png"), 0.7), 0);
#endif
  expect_refused(line + Names{"-o", path("p.gif")}, "expected .csv, .svg, .pdf or .png");
}

TEST_F(MapsCli, ProfileDrawsTheStepsOfMarches) {
  const Names line = on_dem("profile") + Names{"--from", "500105,5000105,40", "--to", "500285,5000105"};
#ifdef SCARP_CAIRO
  const auto result =
      run(line + Names{"--march", "naive,relaxed,lipschitz,fixed-step,max-mip,max-mip-bisect", "-o", path("m.svg")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(lines(result.out), 6) << result.out;
  EXPECT_NE(result.out.find("max-mip: "), std::string::npos) << result.out;
  EXPECT_NE(text_of(path("m.svg")).find("<svg"), std::string::npos);
  // The ray of --ray is that of --from and --to.
  const auto typed = run(on_dem("profile") + Names{"--heights", "sea", "--from", "500105,5000105,90", "--to",
                                                   "500285,5000105,60", "--march", "max-mip", "-o", path("t.pdf")});
  ASSERT_EQ(typed.status, 0) << typed.err;
  const auto ray =
      run(on_dem("profile") + Names{"--ray", "500105,5000105,90,180,0,-30", "--march", "max-mip", "-o", path("r.png")});
  ASSERT_EQ(ray.status, 0) << ray.err;
  EXPECT_EQ(text_of(path("t.pdf")).substr(0, 4), "%PDF");
  EXPECT_EQ(typed.out.substr(path("t.pdf").size()), ray.out.substr(path("r.png").size()));
  // A setting of a march that is drawn.
  const Names step{"--fixed-step", "3", "-o", path("s.png"), "--march"};
  EXPECT_EQ(run(line + step + Names{"max-mip,fixed-step"}).status, 0);
  expect_refused(line + step + Names{"max-mip,naive"}, "--fixed-step needs --march fixed-step");
  expect_refused(on_dem("profile") + Names{"--ray", "0,0,90,-1,0,0", "--march", "naive", "-o", path("x.svg")},
                 "does not pass over");
  expect_refused(
      on_dem("profile") + Names{"--ray", "500105,5000105,90,0,0,-1", "--march", "naive", "-o", path("x.svg")},
      "not vertical");
  expect_refused(line + Names{"--march", "naive,max-mip", "--size", "300x200", "-o", path("x.svg")}, "do not fit");
#endif
  expect_refused(line + Names{"--march", "exhaustive", "-o", path("x.svg")}, "--march 'exhaustive': expected max-mip");
  expect_refused(line + Names{"--march", "naive", "-o", path("x.csv")}, "has no effect without a .svg");
  expect_refused(line + Names{"--shrink", "0.5"}, "--shrink needs --march lipschitz");
  expect_refused(on_dem("profile") + Names{"--to", "500285,5000105"}, "--from X,Y[,H] is required");
}

// Green where the observer sees the ground, grey elsewhere, height colours outside the map.
TEST_F(MapsCli, PreviewOverlaysTheMap) {
  const Names view = on_dem("viewshed") + Names{"--observer", "500105,5000105,2", "-o", path("v.tif")};
#ifndef SCARP_CAIRO
  expect_refused(view + Names{"--preview", path("v.png")}, "SCARP_CAIRO");
#else
  const auto result = run(view + Names{"--max-distance", "170", "--preview", path("v.png")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(scratch_.files(), (Names{"dem.asc", "v.png", "v.tif"}));
  const auto picture = open(path("v.png"));
  ASSERT_TRUE(picture);
  const Pixels red = pixels_of(*picture, 1), green = pixels_of(*picture, 2), blue = pixels_of(*picture, 3);
  int greens = 0, greys = 0, whites = 0;
  for (std::size_t i = 0; i < red.samples.size(); ++i) {
    const float r = red.samples[i], g = green.samples[i], b = blue.samples[i];
    greens += g > 1.5f * r && g > 1.5f * b;
    greys += r < 250 && r > 100 && std::abs(r - g) < 12 && std::abs(g - b) < 12;
    whites += r + g + b == 3 * 255;
  }
  const auto share = [&](int pixels) { return static_cast<double>(pixels) / static_cast<double>(red.samples.size()); };
  EXPECT_GT(share(greens), 0.3);
  EXPECT_GT(share(greys), 0.02);
  EXPECT_GT(share(whites), 0.05);  // the margin with the legend
  for (const Names& map : maps()) {
    if (map[0] == "viewshed") continue;  // above
    EXPECT_EQ(run(map + Names{"-o", path("v.tif"), "--preview", path("v.png")}).status, 0) << map[0];
    EXPECT_EQ(text_of(path("v.png")).substr(1, 3), "PNG") << map[0];
    fs::remove(path("v.png"));
  }
  // A map of heights has a ramp; this one covers a part of the field.
  EXPECT_EQ(run(view + Names{"--mode", "ground", "--part", "1/2", "--preview", path("g.pdf")}).status, 0);
  EXPECT_EQ(text_of(path("g.pdf")).substr(0, 4), "%PDF");
  fs::remove(path("g.pdf"));
  const Names shadow = on_dem("shadow") + Names{"--sun", "90,45", "-o", path("x.tif"), "--preview"};
  expect_refused(shadow + Names{path("x.exr")}, "no margins");
  expect_refused(shadow + Names{path("x.png.txt")},
                 "unknown picture format (name it *.png (PNG), *.jpg (JPEG), *.pdf (PDF))");
  expect_refused(shadow + Names{path("./x.tif")}, "x.tif");
  expect_refused(shadow + Names{path("none/x.png")}, "none");
  expect_refused(on_dem("shadow") + Names{"--sun", "90,45", "-o", path("y.png"), "--preview", path("./y.png")},
                 "is the output");
  const std::string line = scratch_.write("line.asc", "ncols 3\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3");
  expect_refused({"shadow", line, "--sun", "90,45", "-o", path("x.tif"), "--preview", path("x.png")}, "no ground");
#endif
}

TEST_F(MapsCli, ReportsBadInputInOneLineWithoutOutput) {
  const std::string out = path("x.tif");
  const Names view = on_dem("viewshed") + Names{"-o", out};
  expect_refused(view, "no observer");
  expect_refused(view + Names{"--observer", "500305,5000105"}, "is outside");
  expect_refused(view + Names{"--observer", "500005,5000195"}, "on nodata");
  expect_refused(view + Names{"--observer", "here"}, "expected X,Y");
  expect_refused(view + Names{"--observer", "500105,5000105,-3"}, "observer height");
  expect_refused(view + Names{"--observer", "500105,5000105", "--cc", "7"}, "--cc");
  expect_refused(view + Names{"--observer", "500105,5000105", "--min-distance", "9", "--max-distance", "5"},
                 "--max-distance");
  expect_refused(view + Names{"--observer", "500105,5000105", "--azimuth", "1,2,3"}, "--azimuth");
  expect_refused(view + Names{"--observer", "500105,5000105", "--pitch", "9,-9"}, "--pitch");
  expect_refused(view + Names{"--observer", "500105,5000105", "--of", "NOSUCH"}, "format 'NOSUCH': unknown");
  expect_refused(view + Names{"--observer", "500105,5000105", "--co", "tiled"}, "NAME=VALUE");
  expect_refused(view + Names{"--observer", "500105,5000105", "--co", "COMPRESS=HUGE"}, "COMPRESS");
  expect_refused(view + Names{"--observers", scratch_.write("names.csv", "name,height\na,1\n")},
                 "no columns with places");
  expect_refused(view + Names{"--observers", scratch_.write("bad.csv", "x,y\n1,2\n3,four\n")}, "line 3");
  expect_refused(view + Names{"--observers", scratch_.write("none.csv", "x,y\n")}, "contains no points");
  expect_refused(on_dem("viewshed") + Names{"-o", dem_, "--of", "GTiff", "--observer", "500105,5000105"},
                 "is the input");
  expect_refused(on_dem("viewshed") + Names{"-o", path("x.nosuch"), "--observer", "500105,5000105"},
                 "no raster format");
  expect_refused(on_dem("shadow") + Names{"-o", out}, "no sun");
  expect_refused(on_dem("shadow") + Names{"-o", out, "--sun", "90,-1"}, "--sun");
  expect_refused(on_dem("shadow") + Names{"-o", out, "--sun", "90"}, "--sun");
  expect_refused(on_dem("los") + Names{"--from", "500105,5000105"}, "--to");
  expect_refused(on_dem("los") + Names{"--from", "500105,5000105", "--to", "499999,5000105"},
                 "--to: 499999,5000105 is outside");
  expect_refused(on_dem("los") + Names{"--lines", path("missing.csv")}, "missing.csv");
  expect_refused(on_dem("los") + Names{"--lines", dem_}, "dem.asc");
}

// Other usage errors, one line each.
TEST_F(MapsCli, ValidatesPlacesTimesAndFiles) {
  const std::string out = path("x.tif");
  const Names view = on_dem("viewshed") + Names{"-o", out, "--observer"};
  for (const char* place : {"500105", "nan,5000105", "500105,5000105,1e300", "500105,5000105,2,3", ""})
    expect_refused(view + Names{place}, fmt::format("--observer '{}': expected", place));
  for (const char* number : {"-1", "nan", "1e300", "six"}) {
    const std::string wanted = fmt::format("--cc '{}': expected a number from 0 to 1", number);
    expect_refused(view + Names{"500105,5000105", fmt::format("--cc={}", number)}, wanted);
    expect_refused(view + Names{"500105,5000105", "-cc", number}, wanted);
    expect_refused(on_dem("los") + Names{"--from", "500105,5000105", "--to", "500185,5000105", "--cc", number}, wanted);
    expect_refused(on_dem("profile") + Names{"--from", "500105,5000105", "--to", "500185,5000105", "--cc", number},
                   wanted);
  }
  for (const char* value : {"256", "-1", "2.5"})
    expect_refused(view + Names{"500105,5000105", fmt::format("--nodata-value={}", value)}, "from 0 to 255");
  const Names watch = on_dem("viewshed") + Names{"-o", out, "--observers"};
  expect_refused(watch + Names{scratch_.write("empty.csv", "")}, "empty.csv: is empty");
  expect_refused(watch + Names{scratch_.write("blank.csv", "x,y\n,\n")}, "blank.csv: line 2: x ''");
  expect_refused(watch + Names{scratch_.write("both.csv", "x,y,lon,lat\n1,2,3,4\n")}, "both.csv: ");
  expect_refused(watch + Names{scratch_.write("none.geojson", R"({"type":"FeatureCollection","features":[]})")},
                 "none.geojson: contains no points");
  expect_refused(
      watch + Names{scratch_.write("null.geojson", R"({"type":"FeatureCollection","features":[{"type":"Feature",)"
                                                   R"("properties":{},"geometry":null}]})")},
      "null.geojson: feature 1: has no geometry");
  expect_refused(watch + Names{path("missing.csv")}, "missing.csv: cannot be opened");
#ifdef SCARP_ERFA
  const Names sun = on_dem("shadow") + Names{"-o", out, "--time"};
  expect_refused(sun + Names{"21-06-2026T09:00Z"}, "expected YYYY-MM-DD");
  expect_refused(sun + Names{"2026-21-06T09:00Z"}, "no such date");
  expect_refused(sun + Names{"2026-02-30T09:00Z"}, "no such date");
  expect_refused(sun + Names{"2026-06-21T09:00"}, "UTC offset");
  expect_refused(sun + Names{"1526-06-21T09:00Z"}, "1900 to 2100");
  for (const char* rule : {"--sun-per-cell", "--refraction"})
    expect_refused({"shadow", dem_, "--crs", "none", "--time", "2026-06-21T12:00Z", rule, "-o", out}, "--crs");
#endif
  // The error is found before the work starts.
  const Names there = on_dem("viewshed") + Names{"--observer", "500105,5000105", "--of", "GTiff", "-o"};
  expect_refused(there + Names{path("none/x.tif")}, "'" + path("none") + "' does not exist");
  expect_refused(there + Names{path("")}, path(""));
}

TEST_F(MapsCli, NeverOverwritesInputs) {
  const std::string lines_file = scratch_.write("lines.csv", "x,y,tx,ty\n500105,5000105,500185,5000105\n");
  const std::string tower = scratch_.write("tower.csv", "x,y\n500105,5000105\n");
  fs::create_hard_link(dem_, path("link.tif"));
  fs::create_symlink(dem_, path("link.png"));
  for (const Names& map : maps()) expect_refused(map + Names{"-o", path("link.tif")}, "is the input");
  expect_refused(on_dem("viewshed") + Names{"--observers", tower, "--of", "GTiff", "-o", tower}, "is the input");
  expect_refused(on_dem("los") + Names{"--lines", lines_file, "-o", lines_file}, "is the input");
#ifdef SCARP_CAIRO
  expect_refused(maps()[0] + Names{"-o", path("x.tif"), "--preview", path("link.png")}, "is the input");
  expect_refused(
      on_dem("profile") + Names{"--from", "500105,5000105", "--to", "500185,5000105", "-o", path("link.png")},
      "is the input");
#endif
}

TEST_F(MapsCli, FullDiskLeavesNoOutput) {
  const auto expect_full = [&](const Names& arguments, std::uint64_t bytes, const std::string& name) {
    const auto before = scratch_.files();
    const auto result = [&] {
      const FullDisk disk(bytes);
      return Program(arguments).result();
    }();
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(name + ": cannot be written"), std::string::npos) << result.err;
    EXPECT_EQ(scratch_.files(), before);
  };
  constexpr std::uint64_t kFew = 600;
  const Names view = on_dem("viewshed") + Names{"--observer", "500105,5000105"};
  const Names ends{"--from", "500105,5000105", "--to", "500285,5000105", "--to", "500285,5000055"};
  const Names line{"--from", "500105,5000105", "--to", "500285,5000105"};
  for (const Names& map : maps()) expect_full(map + Names{"-o", path("x.tif")}, kFew, "x.tif");
  expect_full(view + Names{"--mode", "ground", "--of", "COG", "-o", path("x.tif")}, kFew, "x.tif");
  expect_full(on_dem("shadow") + Names{"--sun", "90,45", "-o", path("x.img")}, kFew, "x.img");
  expect_full(on_dem("los") + ends + Names{"-o", path("x.geojson")}, kFew, "x.geojson");
  expect_full(on_dem("profile") + line + Names{"-o", path("x.csv")}, kFew, "x.csv");
#ifdef SCARP_CAIRO
  expect_full(on_dem("profile") + line + Names{"-o", path("x.svg")}, kFew, "x.svg");
  expect_full(on_dem("profile") + line + Names{"-o", path("x.png")}, kFew, "x.png");
  // The map exists, its picture does not.
  constexpr std::uint64_t kSome = 6000;
  scratch_.write("x.tif", "old");
  expect_full(view + Names{"-o", path("x.tif"), "--preview", path("x.png")}, kSome, "x.png");
  EXPECT_TRUE(open(path("x.tif")));
#endif
  for (const Names& command : {on_dem("los") + ends, on_dem("profile") + line}) {
    const auto result = Program(command, "/dev/full").result();
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("standard output: cannot be written"), std::string::npos) << result.err;
  }
}

// Ctrl-C during long work.
TEST_F(MapsCli, InterruptLeavesNoOutput) {
  std::string text = "ncols 400\nnrows 400\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\n", table = "x,y\n";
  for (int i = 0; i < 400 * 400; ++i) text += fmt::format("{} ", i * 7919 % 31);
  for (int i = 0; i < 4000; ++i) table += fmt::format("{},{}\n", 500005 + i % 200 * 10, 5000005 + i / 200 * 10);
  const std::string dem = scratch_.write("large.asc", text), towers = scratch_.write("towers.csv", table);
  const auto before = scratch_.files();
  Names suns{"shadow", "--fraction"};
  for (int i = 0; i < 200; ++i) suns = suns + Names{"--sun", fmt::format("{},20", i)};
  const std::vector<Names> long_maps{{"viewshed", "--observers", towers, "--mode", "count"},
                                     {"viewshed", "--observers", towers, "--mode", "ground"},
                                     {"viewshed", "--observers", towers, "--mode", "angle"},
                                     suns,
                                     {"horizon", "--azimuths", "1000"},
#ifdef SCARP_ERFA
                                     {"sunhours", "--date", "2026-01-01", "--to", "2026-12-31", "--step", "1"},
#endif
                                     {"skyview", "--azimuths", "3600"}};
  for (const Names& map : long_maps) {
    Program program(map + Names{dem, "--crs", "EPSG:32633", "-o", path("x.tif"), "--preview", path("x.png")});
#ifdef SCARP_CAIRO
    // The picture's file is reserved when the work starts.
    for (int i = 0; i < 2000 && scratch_.files() == before; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_NE(scratch_.files(), before);
#endif
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    ::kill(program.pid(), SIGINT);
    const auto result = program.result();
#ifdef SCARP_CAIRO
    EXPECT_EQ(result.status, 128 + SIGINT) << result.err;
    EXPECT_TRUE(result.err.ends_with("scarp: interrupted\n")) << result.err;
#endif
    EXPECT_EQ(scratch_.files(), before);
  }
}

TEST_F(MapsCli, DryRunWritesNothing) {
  for (const Names& map : maps()) {
    const auto result = run(map + Names{"-o", path("x.tif"), "--dry-run"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("30 x 20"), std::string::npos) << result.out;
    EXPECT_EQ(scratch_.files(), Names{"dem.asc"});
  }
}

// A degree has a different length in the north of a large raster than in its south.
TEST_F(MapsCli, RejectsDegreesWhereThePlaneErrorIsLarge) {
  std::string text = "ncols 200\nnrows 200\nxllcorner 10\nyllcorner 45\ncellsize 0.01\n";
  for (int i = 0; i < 200 * 200; ++i) text += "1 ";
  const std::string dem = scratch_.write("degrees.asc", text);
  const Names view{"viewshed", dem, "--crs", "EPSG:4326", "--observer", "11.005,46.005", "-o", path("x.tif")};
  expect_refused(view, "gdalwarp -t_srs '+proj=aeqd +lat_0=46.005000 +lon_0=11.005000 +datum=WGS84'");
  const auto near = run(view + Names{"--max-distance", "2000"});
  EXPECT_EQ(near.status, 0) << near.err;
  EXPECT_NE(near.err.find("metric plane"), std::string::npos) << near.err;
  EXPECT_EQ(run(view + Names{"--plane-error", "9"}).status, 0);
}

}  // namespace
}  // namespace scarp::test
