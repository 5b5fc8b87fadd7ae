// SPDX-License-Identifier: MIT
// Positions in map coordinates, in degrees and above ground, and errors.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "cli/program.h"

namespace scarp::test {
namespace {

namespace fs = std::filesystem;
constexpr int kValleySide = 21;

class Places : public testing::Test {
 protected:
  // A valley that runs north: 3 m per column away from the middle. Samples are 10 m apart, the south-west one is at
  // (1005, 2005) of the map. The hole is at column 2, row 2.
  std::string valley(const std::string& corner, const std::string& cell) const {
    std::string text =
        fmt::format("ncols {0}\nnrows {0}\n{1}cellsize {2}\nNODATA_value -1\n", kValleySide, corner, cell);
    for (int row = 0; row < kValleySide; ++row) {
      for (int col = 0; col < kValleySide; ++col)
        text += fmt::format("{} ", row == 2 && col == 2 ? -1 : 100 + 3 * std::abs(col - kValleySide / 2));
      text += '\n';
    }
    return text;
  }

  // Bytes of the picture.
  std::string picture(const Names& more, const std::string& input = {}) const {
    Names arguments{"render", input.empty() ? dem_ : input, "-o", out_, "--size", "24x18", "--aa", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    fs::remove(out_);
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return text_of(out_);
  }
  std::string refusal(const Names& more, const Names& input = {}) const {
    Names arguments{"render", "-o", out_, "--size", "24x18"};
    if (input.empty()) arguments.push_back(dem_);
    arguments.insert(arguments.end(), input.begin(), input.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    fs::remove(out_);
    const auto result = run(arguments);
    EXPECT_NE(result.status, 0);
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_FALSE(fs::exists(out_));
    return result.err;
  }
  void expect_refused(const Names& more, const std::string& what, const Names& input = {}) const {
    const std::string text = refusal(more, input);
    EXPECT_NE(text.find(what), std::string::npos) << text;
  }

  Scratch scratch_;
  const std::string dem_ = scratch_.write("valley.asc", valley("xllcorner 1000\nyllcorner 2000\n", "10")),
                    out_ = scratch_.path("out.png");
};

TEST_F(Places, AgreeInAllCoordinateSystems) {
  const Names local{"--eye", "20,10,150", "--target", "100,100,110"};
  const std::string expected = picture(local);
  EXPECT_EQ(picture({"--coords", "local", "--eye", "20,10,150", "--target", "100,100,110"}), expected);
  EXPECT_EQ(picture({"--coords", "map", "--eye", "1025,2015,150", "--target", "1105,2105,110"}), expected);
  // Map coordinates have heights as in the file.
  const Names twice{"--exaggeration", "2", "--eye", "20,10,300", "--target", "100,100,220"},
      mapped{"--exaggeration", "2", "--coords", "map", "--eye", "1025,2015,150", "--target", "1105,2105,110"};
  EXPECT_EQ(picture(twice), picture(mapped));
  const std::string degrees = scratch_.write("degrees.asc", valley("xllcorner 10\nyllcorner 50\n", "0.001"));
  const Names crs{"--crs", "EPSG:4326", "--coords"}, eye{"--eye", "10.002,50.002,300", "--target", "10.01,50.01,100"};
  Names lonlat = crs, map = crs;
  lonlat.emplace_back("lonlat"), map.emplace_back("map");
  lonlat.insert(lonlat.end(), eye.begin(), eye.end()), map.insert(map.end(), eye.begin(), eye.end());
  EXPECT_EQ(picture(lonlat, degrees), picture(map, degrees));
}

TEST_F(Places, MeasureHeightsFromGroundAndWater) {
  const std::string target = "100,100,110";
  const auto from = [&](const Names& eye) {
    Names all{"--target", target};
    all.insert(all.end(), eye.begin(), eye.end());
    return picture(all);
  };
  // 20 m from the western border: 8 columns from the middle.
  EXPECT_EQ(from({"--eye", "20,100", "--eye-above", "5"}), from({"--eye", "20,100,129"}));
  EXPECT_EQ(from({"--eye", "20,100", "--eye-above", "5", "--exaggeration", "2"}),
            from({"--eye", "20,100,258", "--exaggeration", "2"}));
  EXPECT_EQ(from({"--eye", "100,50", "--eye-above", "5", "--water", "110"}),
            from({"--eye", "100,50,115", "--water", "110"}));
  EXPECT_EQ(picture({"--eye", "20,100,150", "--target", "100,150"}),
            picture({"--eye", "20,100,150", "--target", "100,150,100"}));
}

TEST_F(Places, OnPathsFollowTheGround) {
  const std::string frames = scratch_.path("frame-#.png");
  const auto flight = [&](const std::string& table, const Names& more) {
    Names arguments{"render",
                    dem_,
                    "-o",
                    frames,
                    "--size",
                    "24x18",
                    "--aa",
                    "1",
                    "--overwrite",
                    "--path",
                    scratch_.write("path.csv", table)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  // Across the valley: in its middle the eye is lower than at either end.
  const auto result = flight("x,y,tx,ty\n1025,2105,1105,2155\n1185,2105,1105,2155\n",
                             {"--coords", "map", "--eye-above", "4", "--frames", "3"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(text_of(scratch_.path("frame-1.png")), picture({"--eye", "100,100,104", "--target", "100,150,100"}));
  EXPECT_EQ(text_of(scratch_.path("frame-2.png")), picture({"--eye", "180,100,128", "--target", "100,150,100"}));
  // In degrees, under the names that other tables have.
  const std::string degrees = scratch_.write("degrees.asc", valley("xllcorner 10\nyllcorner 50\n", "0.001"));
  const auto cross = [&](const std::string& header, const std::string& coordinates) {
    const std::string table = scratch_.write("degrees.csv", header + "\n10.002,50.002,300,10.01,50.01,100\n");
    return run({"render", degrees, "--crs", "EPSG:4326", "-o", frames, "--size", "24x18", "--aa", "1", "--overwrite",
                "--path", table, "--coords", coordinates});
  };
  ASSERT_EQ(cross("x,y,z,tx,ty,tz", "lonlat").status, 0);
  const std::string expected = text_of(scratch_.path("frame-0.png"));
  fs::remove(scratch_.path("frame-0.png"));
  const auto named = cross("lon,lat,z,tlon,tlat,tz", "lonlat");
  ASSERT_EQ(named.status, 0) << named.err;
  EXPECT_EQ(text_of(scratch_.path("frame-0.png")), expected);
  EXPECT_NE(cross("lon,lat,z,tlon,tlat,tz", "map").err.find("has columns lon and lat (give --coords lonlat)"),
            std::string::npos);
  EXPECT_NE(cross("lon,lat,z,tlon,tlat,tz\n,,,,,", "lonlat").err.find("column 'lon' is empty"), std::string::npos);
  EXPECT_NE(cross("lon,y,z,tlon,tlat,tz", "lonlat").err.find("no column 'lat'"), std::string::npos);
  const std::string plain = "x,y,z,dx,dy,dz\n20,100,150,1,0,0\n";
  EXPECT_NE(flight(plain, {"--eye-above", "4"}).err.find("which --eye-above replaces"), std::string::npos);
  EXPECT_NE(flight("x,y,dx,dy,dz\n20,100,1,0,0\n", {}).err.find("has no column 'z' (give --eye-above M)"),
            std::string::npos);
}

TEST_F(Places, ReportErrorsInOneLine) {
  expect_refused({"--eye", "5,5"}, "--eye '5,5': expected X,Y,Z, or X,Y with --eye-above M");
  expect_refused({"--eye", "5,5,200", "--eye-above", "2"}, "--eye-above replaces Z");
  expect_refused({"--eye-above", "2"}, "--eye-above has no effect without --eye X,Y or --path FILE");
  expect_refused({"--coords", "map"}, "--coords has no effect without --eye, --area, --path or --mesh-at");
  expect_refused({"--coords", "map", "--eye", "20,10", "--eye-above", "2"},
                 "--eye: there is no ground at 20,10, outside the bounds in map coordinates: x 1005 to 1205, y 2005 to "
                 "2205");
  expect_refused({"--coords", "map", "--eye", "1025,2185", "--eye-above", "2"}, "a hole within the bounds in map");
  expect_refused({"--coords", "lonlat", "--eye", "10,50,5"}, "valley.asc: no coordinate reference system");
  expect_refused({"--coords", "map", "--eye", "0,0,50"}, "--coords map or lonlat applies to terrain only",
                 {"--function", "hills"});
}

TEST_F(Places, MeasureHeightsFromFunctionsAndScenes) {
  const auto view = [&](const Names& input, const Names& eye) {
    Names arguments{"render", "-o", out_, "--size", "24x18", "--target", "0,0,0"};
    arguments.insert(arguments.end(), input.begin(), input.end());
    arguments.insert(arguments.end(), eye.begin(), eye.end());
    fs::remove(out_);
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return text_of(out_);
  };
  const std::string plane = scratch_.write("plane.json", R"({"type": "plane", "height": 7, "slope": [0.5, 0]})"),
                    ball = scratch_.write("ball.json", R"({"objects": [{"shape": {"sphere": {"radius": 5}}}]})");
  EXPECT_EQ(view({"--function", plane}, {"--eye", "100,20", "--eye-above", "3"}),
            view({"--function", plane}, {"--eye", "100,20,60"}));
  // Found by a ray from above, which hits the sphere at z = 4.
  EXPECT_EQ(view({ball}, {"--eye", "0,3", "--eye-above", "6"}), view({ball}, {"--eye", "0,3,10"}));
}

}  // namespace
}  // namespace scarp::test
