// SPDX-License-Identifier: MIT
// `scarp merge` joins all parts of one map, and no others.
#include <fmt/format.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "cli/map_limits.h"

namespace scarp::test {
namespace {

using MapMerge = MapLimits;

TEST_F(MapMerge, MergeRefusesPartsThatDoNotFit) {
  const std::string dem = model("dem.tif", 30, 40, GDT_Int16);
  const auto part = [&](const std::string& which, const std::string& name, const std::string& sun = "135,20") {
    written({"shadow", dem, "--sun", sun, "--part", which}, name);
    return path(name);
  };
  const std::string a = part("1/3", "a.tif"), b = part("2/3", "b.tif"), c = part("3/3", "c.tif");
  const std::string other = part("2/3", "other.tif", "136,20"), of_four = part("2/4", "four.tif");
  written({"shadow", dem, "--sun", "135,20"}, "whole.tif");
  const Names out{"-o", path("out.tif")};
  expect_refused(Names{"merge", a, c} + out, "1 of 3 parts is missing: 2");
  expect_refused(Names{"merge", b} + out, "2 of 3 parts are missing: 1, 3");
  expect_refused(Names{"merge", a, b, c, b} + out, "part 2 is given twice");
  expect_refused(Names{"merge", a, other, c} + out, "other.tif: is not of the same map as");
  expect_refused(Names{"merge", a, of_four, c} + out, "is one of 4 parts");
  expect_refused(Names{"merge", a, path("whole.tif")} + out, "whole.tif: is not a part of a map");
  expect_refused(Names{"merge", a, path("nothing.tif")} + out, "nothing.tif: missing, or not a raster");
  expect_refused({"merge", a, b, c, "-o", b}, "is the input");
  const std::string text = text_of(c);
  std::ofstream(c, std::ios::binary) << text.substr(0, text.size() / 2);
  expect_refused(Names{"merge", a, b, c} + out, "c.tif: ");
}

TEST_F(MapMerge, JoinsPartsWhoseInputWasSpelledInOtherWays) {
  const std::string dem = model("dem.tif", 30, 40, GDT_Int16);
  const std::string around = (std::filesystem::path(dem).parent_path() / "." / "dem.tif").string();
  ASSERT_NE(dem, around);
  int number = 0;
  Names merge{"merge", "-o", path("joined.tif")};
  for (const std::string& input : {dem, around}) {
    const std::string name = fmt::format("spelled{}.tif", ++number);
    written({"shadow", input, "--sun", "135,20", "--part", fmt::format("{}/2", number)}, name);
    merge.push_back(path(name));
  }
  EXPECT_EQ(run(merge).status, 0);
}

TEST_F(MapMerge, RefusesPartsOfOtherCommandsAndInputs) {
  const std::string dem = model("dem.tif", 30, 40, GDT_Int16);
  const Names words{"viewshed", dem, "--observer", "500200,4999800,9"};
  const auto part = [&](const std::string& which, const std::string& name, const Names& more = {}) {
    written(words + Names{"--part", which} + more, name);
    return path(name);
  };
  const std::string north = part("1/2", "north.tif"), south = part("2/2", "south.tif");
  const Names out{"-o", path("out.tif")};
  for (const Names& more : {Names{"--min-distance", "50"}, Names{"--azimuth", "0,180"}, Names{"--pitch=-5,5"},
                            Names{"--visible-value", "7"}, Names{"--out-of-range-value", "9"}, Names{"--nodata", "400"},
                            Names{"--crs", "EPSG:32634"}, Names{"--max-distance", "300"}})
    expect_refused(Names{"merge", north, part("2/2", "other.tif", more)} + out, "is not of the same map as");
  // These change no pixel.
  for (const Names& more : {Names{"--threads", "1"}, Names{"--memory", "256M"}, Names{"--co", "COMPRESS=LZW"},
                            Names{"--summary", path("seen.csv")}})
    EXPECT_EQ(run(Names{"merge", north, part("2/2", "same.tif", more)} + out).status, 0) << more[0];
  // The place of a part that was moved.
  {
    const GDALDatasetUniquePtr file(GDALDataset::Open(south.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    std::array<double, 6> map{};
    file->GetGeoTransform(map.data());
    map[3] += 12.5;
    file->SetGeoTransform(map.data());
  }
  expect_refused(Names{"merge", north, south} + out, "is at another place");
  {
    const GDALDatasetUniquePtr file(GDALDataset::Open(part("2/2", "crs.tif").c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    OGRSpatialReference crs;
    crs.importFromEPSG(32634);
    file->SetSpatialRef(&crs);
  }
  expect_refused(Names{"merge", north, path("crs.tif")} + out, "CRS '");
  // Another input under the same name.
  fs::last_write_time(dem, fs::last_write_time(dem) + std::chrono::seconds(3));
  expect_refused(Names{"merge", north, part("2/2", "later.tif")} + out, "its input had another size or time");
}

// Schedulers run thousands of tasks, but a process may open few files.
TEST_F(MapMerge, OpensFewFilesAtOnce) {
  const std::string dem = model("dem.tif", 30, 60, GDT_Int16);
  const Names words{"shadow", dem, "--sun", "135,20"};
  const std::string all = written(words, "all.tif");
  Names parts;
  for (int i = 1; i <= 45; ++i) {
    parts.push_back(path(fmt::format("part{}.tif", i)));
    written(words + Names{"--part", fmt::format("{}/45", i)}, fmt::format("part{}.tif", i));
  }
  {
    const ResourceLimit files(RLIMIT_NOFILE, 40);
    const Result result = Program(Names{"merge"} + parts + Names{"--quiet", "-o", path("out.tif")}).result();
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out + result.err, "");
  }
  EXPECT_TRUE(content_of(path("out.tif")) == content_of(path("all.tif")));
}

TEST_F(MapMerge, NamesTheReasonOfTheSystem) {
  const std::string loop = path("loop.tif");
  fs::create_symlink(loop, loop);
  expect_refused({"merge", loop, "-o", path("out.tif")}, "loop.tif: cannot be read: Too many levels of symbolic links");
}

}  // namespace
}  // namespace scarp::test
