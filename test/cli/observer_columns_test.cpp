// SPDX-License-Identifier: MIT
// Heights, limits and names of observers from columns of tables and vector files, against the same values in options;
// and what Z of points means.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/maps_cli.h"

namespace scarp::test {
namespace {

class ObserverColumns : public MapsCli {
 protected:
  using Columns = std::vector<std::pair<std::string, std::string>>;

  // One point with columns, as CSV and as a GeoPackage with text and number columns.
  std::string csv(const Columns& columns, const std::string& place = "500105,5000105", const std::string& xy = "x,y") {
    std::string header = xy, row = place;
    for (const auto& [name, value] : columns) header += "," + name, row += "," + value;
    return scratch_.write("points.csv", header + "\n" + row + "\n");
  }
  std::string package(const Columns& columns, double x, double y, std::optional<double> z = {}) {
    GDALAllRegister();
    std::filesystem::remove(path("points.gpkg"));
    const GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GPKG")->Create(
        path("points.gpkg").c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    OGRSpatialReference crs;
    crs.importFromEPSG(32633);
    OGRLayer& layer = *dataset->CreateLayer("points", &crs, z ? wkbPoint25D : wkbPoint);
    for (const auto& [name, value] : columns) {
      OGRFieldDefn field(name.c_str(), name == "label" || name == "owner" ? OFTString : OFTReal);
      layer.CreateField(&field);
    }
    OGRFeature feature(layer.GetLayerDefn());
    for (const auto& [name, value] : columns) feature.SetField(name.c_str(), value.c_str());
    OGRPoint point(x, y);
    if (z) point.setZ(*z);
    feature.SetGeometry(&point);
    EXPECT_EQ(layer.CreateFeature(&feature), OGRERR_NONE);
    return path("points.gpkg");
  }
  std::vector<float> seen(const Names& words) {
    const auto result = run(on_dem("viewshed") + words + Names{"--mode", mode_, "-o", path("seen.tif")});
    EXPECT_EQ(result.status, 0) << result.err;
    err_ = result.err;
    const auto dataset = open(path("seen.tif"));
    if (!dataset) return {};
    observers_ = dataset->GetMetadataItem("OBSERVERS");
    return pixels_of(*dataset).samples;
  }

  std::string mode_ = "visible", err_, observers_;
};

TEST_F(ObserverColumns, HaveTheNamesOfOtherPrograms) {
  const std::vector<float> expected = seen({"--observer", "500105,5000105,7", "--target-height", "3", "--min-distance",
                                            "20", "--max-distance", "130", "--azimuth", "45,250", "--pitch=-20,30"});
  const Columns families[] = {{{"OFFSETA", "7"},
                               {"OFFSETB", "3"},
                               {"RADIUS1", "20"},
                               {"RADIUS2", "-130"},
                               {"AZIMUTH1", "45"},
                               {"AZIMUTH2", "250"},
                               {"VERT1", "30"},
                               {"VERT2", "-20"}},
                              {{"observ_hgt", "7"},
                               {"target_hgt", "3"},
                               {"radius_in", "20"},
                               {"radius", "130"},
                               {"azim_1", "45"},
                               {"azim_2", "250"},
                               {"angle_down", "-20"},
                               {"angle_up", "30"}},
                              {{"height", "7"},
                               {"target_height", "3"},
                               {"min_distance", "20"},
                               {"max_distance", "130"},
                               {"start_angle", "45"},
                               {"end_angle", "250"},
                               {"low_pitch", "-20"},
                               {"high_pitch", "30"}},
                              {{"oz", "7"},
                               {"tz", "3"},
                               {"Min_Distance", "20"},
                               {"md", "130"},
                               {"Azimuth1", "45"},
                               {"Azimuth2", "250"},
                               {"Vert1", "30"},
                               {"Vert2", "-20"}}};
  for (const Columns& family : families) {
    EXPECT_EQ(seen({"--observers", csv(family)}), expected) << family[0].first;
    EXPECT_EQ(err_.find("not used"), std::string::npos) << err_;
    EXPECT_EQ(seen({"--observers", package(family, 500105, 5000105)}), expected) << family[0].first;
  }
  // Columns precede options, which fill empty cells.
  EXPECT_EQ(seen({"--observers", csv({{"OFFSETA", ""}, {"RADIUS2", "130"}}), "--max-distance", "50"}),
            seen({"--observer", "500105,5000105", "--max-distance", "130"}));
}

TEST_F(ObserverColumns, NotesWhatIsUsedAndWhatIsNot) {
  for (const bool vector : {false, true}) {
    const Columns columns{{"OFFSETA", "7"}, {"label", "North tower"}, {"owner", "none"}, {"height", ""}};
    seen({"--observers", vector ? package(columns, 500105, 5000105) : csv(columns)});
    EXPECT_NE(err_.find("columns used: label (name), height (observer height); columns not used: OFFSETA, owner"),
              std::string::npos)
        << err_;
    EXPECT_TRUE(observers_.starts_with("North tower: 500105,5000105")) << observers_;
  }
}

// The ground of column 20 is at 50 m.
TEST_F(ObserverColumns, ZOfPointsIsAHeightAboveTheSea) {
  mode_ = "angle";  // depends on the height everywhere
  const auto above_sea = [&](double z) {
    return seen({"--observer", fmt::format("500205,5000105,{}", z), "--heights", "sea"});
  };
  const auto above_ground = [&](double z) { return seen({"--observer", fmt::format("500205,5000105,{}", z)}); };
  const auto expected = above_sea(53);
  ASSERT_NE(expected, above_ground(53));
  const std::string points = package({}, 500205, 5000105, 53);
  EXPECT_EQ(seen({"--observers", points}), expected);
  EXPECT_NE(err_.find("Z is a height above the sea (--observer-z)"), std::string::npos) << err_;
  EXPECT_EQ(observers_, "500205,5000105 53 m above sea");
  EXPECT_EQ(seen({"--observers", points, "--observer-z", "sea"}), expected);
  EXPECT_EQ(err_.find("--observer-z"), std::string::npos) << err_;
  EXPECT_EQ(seen({"--observers", points, "--observer-z", "ground"}), above_ground(53));
  EXPECT_EQ(seen({"--observers", points, "--heights", "ground"}), above_ground(53));
  EXPECT_EQ(seen({"--observers", points, "--observer-z", "ignore"}), above_ground(2));
  // z of tables counts from the ground, as documented.
  EXPECT_EQ(seen({"--observers", csv({{"z", "53"}}, "500205,5000105")}), above_ground(53));
  EXPECT_EQ(seen({"--observers", csv({{"z", "53"}}, "500205,5000105"), "--observer-z", "sea"}), expected);
  // Offsets add to Z, as in ArcGIS; SPOT is the height of the ground.
  EXPECT_EQ(seen({"--observers", package({{"OFFSETA", "4"}}, 500205, 5000105, 53)}), above_sea(57));
  EXPECT_EQ(seen({"--observers", csv({{"SPOT", "51"}}, "500205,5000105")}), expected);
  expect_refused(on_dem("viewshed") + Names{"--observers", package({}, 500205, 5000105, 20), "-o", path("seen2.tif")},
                 "points.gpkg: feature 1: viewshed: observer at 20 m is below the ground at 50 m (heights above sea");
}

TEST_F(ObserverColumns, ErrorNamesTheRow) {
  const Names view = on_dem("viewshed") + Names{"-o", path("x.tif"), "--observers"};
  expect_refused(view + Names{csv({{"OFFSETA", "6 ft"}})}, "points.csv: line 2: OFFSETA '6 ft' is not a finite number");
  expect_refused(view + Names{csv({{"OFFSETA", "nan"}})}, "line 2: OFFSETA 'nan' is not a finite number");
  expect_refused(view + Names{csv({{"OFFSETB", "-1"}})}, "line 2: OFFSETB '-1' is negative");
  expect_refused(view + Names{csv({{"VERT1", "-95"}})}, "line 2: pitch from -90 to -95");
  expect_refused(view + Names{csv({{"RADIUS1", "90"}, {"RADIUS2", "50"}})}, "line 2: --max-distance 50");
  expect_refused(view + Names{csv({}), "--crop"}, "line 2: needs --max-distance");
  expect_refused(on_dem("viewshed") + Names{"--observer", "500105,5000105", "--observer-z", "sea", "-o", path("x.tif")},
                 "--observers FILE");
  const std::string two = scratch_.write("two.csv", "x,y,OFFSETA\n500105,5000105,far\n500105,5000105,7\n");
  EXPECT_EQ(seen({"--observers", two, "--skip-bad"}), seen({"--observer", "500105,5000105,7"}));
}

TEST_F(ObserverColumns, AreThoseOfTheLineForObserversAlongIt) {
  const std::string lines = scratch_.write("road.geojson", R"({"type":"FeatureCollection",
"crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32633"}},"features":[{"type":"Feature",
"properties":{"OFFSETA":9,"RADIUS2":60},"geometry":{"type":"LineString","coordinates":[[500055,5000105],[500105,5000105]]}}]})");
  const auto result = run(on_dem("viewshed") + Names{"--observers", lines, "--observer-spacing", "50", "--coords",
                                                     "map", "-o", path("seen.tif")});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto road = pixels_of(*open(path("seen.tif"))).samples;
  EXPECT_EQ(road, seen({"--observer", "500055,5000105,9", "--observer", "500105,5000105,9", "--max-distance", "60"}));
}

TEST_F(ObserverColumns, GiveHeightsToLinesOfSight) {
  const auto eyes = [&](const Names& words) {
    const auto result = run(on_dem("los") + words);
    EXPECT_EQ(result.status, 0) << result.err;
    const auto row = result.out.find('\n') + 1;
    return result.out.substr(row);
  };
  const std::string lines = scratch_.write("l.csv", "x,y,tx,ty,OFFSETA,OFFSETB\n500105,5000105,500205,5000105,7,3\n");
  EXPECT_EQ(eyes({"--lines", lines}).rfind("7,3,1,1,100.0", 0), 0u);
  EXPECT_NE(eyes({"--lines", lines}).find(",7,53,"), std::string::npos);
  const std::string points = scratch_.write("p.csv", "x,y,OFFSETA\n500105,5000105,7\n500205,5000105,3\n");
  EXPECT_NE(eyes({"--lines", points, "--pairs"}).find(",7,53,"), std::string::npos);
  const std::string cable = scratch_.write("cable.geojson", R"({"type":"FeatureCollection",
"crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32633"}},"features":[{"type":"Feature",
"properties":{},"geometry":{"type":"LineString","coordinates":[[500105,5000105,7],[500205,5000105,54]]}}]})");
  EXPECT_NE(eyes({"--lines", cable}).find(",7,54,"), std::string::npos);
  EXPECT_NE(eyes({"--lines", cable, "--observer-z", "ground"}).find(",7,104,"), std::string::npos);
}

}  // namespace
}  // namespace scarp::test
