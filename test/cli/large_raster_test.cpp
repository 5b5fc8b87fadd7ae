// SPDX-License-Identifier: MIT
// Pictures of rasters with more samples than they show.
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "cli/csv_rows.h"
#include "cli/program.h"
#include "output/read_png.h"

namespace scarp {
namespace {

// 8001 x 8000 samples: each of the file's 2 x 2 samples, repeated many times.
std::string large_raster(const test::Scratch& scratch) {
  scratch.write("small.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1000\n10 20\n30 4000\n");
  return scratch.write("large.vrt", R"(<VRTDataset rasterXSize="8001" rasterYSize="8000">
<SRS>EPSG:32610</SRS><GeoTransform>500000, 10, 0, 5000000, 0, -10</GeoTransform>
<VRTRasterBand dataType="Int16" band="1"><SimpleSource><SourceFilename relativeToVRT="1">small.asc</SourceFilename>
<SourceBand>1</SourceBand><SrcRect xOff="0" yOff="0" xSize="2" ySize="2"/>
<DstRect xOff="0" yOff="0" xSize="8001" ySize="8000"/></SimpleSource></VRTRasterBand></VRTDataset>)");
}

TEST(LargeRaster, IsAveragedUnlessFullIsGiven) {
  const test::Scratch scratch;
  const std::string dem = large_raster(scratch), few = scratch.path("few.png"), all = scratch.path("all.png");
  const std::vector<std::string> look{"--top", "--size", "64x64", "--look", "height"};
  const auto render = [&](const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> words{"render", dem, "-o", out};
    words.insert(words.end(), look.begin(), look.end());
    words.insert(words.end(), more.begin(), more.end());
    return test::run(words);
  };
  const auto reduced = render(few, {});
  ASSERT_EQ(reduced.status, 0) << reduced.err;
  EXPECT_NE(
      reduced.err.find("note: 8001 x 8000 samples, rendered from 2667 x 2667 (average of 3 x 3; --full reads all)"),
      std::string::npos)
      << reduced.err;
  const auto full = render(all, {"--full"});
  ASSERT_EQ(full.status, 0) << full.err;
  EXPECT_EQ(full.err.find("--full"), std::string::npos) << full.err;
  const test::Rgb a = test::read_png(few), b = test::read_png(all);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      // The pixels over the steps between the four heights show either side.
      if (std::abs(x - 32) < 2 || std::abs(y - 32) < 2) continue;
      EXPECT_EQ(a.pixel(x, y)[0], b.pixel(x, y)[0]) << x << ' ' << y;
    }
  }
  EXPECT_NE(a.pixel(60, 60)[0], a.pixel(4, 4)[0]) << "blank";
}

// 200,000 x 200,000 samples, 74 GiB, of which a picture-sized part has hills.
std::string country(const test::Scratch& scratch) {
  std::string text = "ncols 800\nnrows 800\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
  for (int i = 0; i < 800 * 800; ++i) text += std::to_string(300 + (i % 800 / 20 + i / 16000) % 7 * 30) + ' ';
  scratch.write("hills.asc", text);
  return scratch.write("country.vrt", R"(<VRTDataset rasterXSize="200000" rasterYSize="200000">
<SRS>EPSG:32632</SRS><GeoTransform>0, 10, 0, 6000000, 0, -10</GeoTransform>
<VRTRasterBand dataType="Int16" band="1"><NoDataValue>-32768</NoDataValue>
<SimpleSource><SourceFilename relativeToVRT="1">hills.asc</SourceFilename>
<SourceBand>1</SourceBand><SrcRect xOff="0" yOff="0" xSize="800" ySize="800"/>
<DstRect xOff="100000" yOff="100000" xSize="800" ySize="800"/></SimpleSource></VRTRasterBand></VRTDataset>)");
}

TEST(LargeRaster, OfACountryIsReadOnlyWhereAQuestionNeedsIt) {
  const test::Scratch scratch;
  const std::string dem = country(scratch), out = scratch.path("seen.tif");
  const std::vector<std::string> calls[] = {
      {"info", dem},
      {"los", dem, "--from", "1004000,4996000,2", "--to", "1004500,4996500,2"},
      {"profile", dem, "--from", "1004000,4996000,2", "--to", "1004500,4996500,2"},
      {"viewshed", dem, "--observer", "1004000,4996000,2", "--max-distance", "3000", "-o", out},
      {"viewshed", dem, "--observer", "1004000,4996000,2", "--max-distance", "3000", "--crop", "-o", out},
      {"viewshed", dem, "--observer", "1004000,4996000,2", "--dry-run", "-o", out},
      {"shadow", dem, "--sun", "135,20", "--dry-run", "-o", out},
      {"horizon", dem, "--max-distance", "3000", "--dry-run", "-o", out},
      {"horizon", dem, "--at", "1004000,4996000", "--max-distance", "3000"},
      {"skyview", dem, "--max-distance", "3000", "--dry-run", "-o", out},
#ifdef SCARP_ERFA
      {"sunhours", dem, "--date", "2026-06-21", "--max-distance", "3000", "--dry-run", "-o", out},
#endif
  };
  for (const std::vector<std::string>& call : calls) {
    const auto result = test::run(call);
    EXPECT_EQ(result.status, 0) << call.front() << ": " << result.err;
    constexpr std::uint64_t kMost = 100 << 20;
    EXPECT_GT(result.peak, 0u) << "unknown";
    EXPECT_LT(result.peak, kMost) << call.front();
  }
}

// 9000 x 9000 samples, of which a part has hills.
std::string county(const test::Scratch& scratch) {
  std::string text = "ncols 300\nnrows 300\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
  for (int i = 0; i < 300 * 300; ++i) text += std::to_string(300 + i * 7919 % 101) + ' ';
  scratch.write("hills.asc", text);
  return scratch.write("county.vrt", R"(<VRTDataset rasterXSize="9000" rasterYSize="9000">
<SRS>EPSG:32632</SRS><GeoTransform>450000, 10, 0, 5000000, 0, -10</GeoTransform>
<VRTRasterBand dataType="Int16" band="1">
<SimpleSource><SourceFilename relativeToVRT="1">hills.asc</SourceFilename>
<SourceBand>1</SourceBand><SrcRect xOff="0" yOff="0" xSize="300" ySize="300"/>
<DstRect xOff="4000" yOff="5000" xSize="300" ySize="300"/></SimpleSource></VRTRasterBand></VRTDataset>)");
}

// A diagonal of 40,000 cells, whose box takes 3.2 GB.
TEST(LargeRaster, IsReadAlongLinesOfSight) {
  const test::Scratch scratch;
  const std::string dem = country(scratch);
  const auto seen = test::run({"los", dem, "--from", "1004000,4996000,900", "--to", "1403990,4596010,900", "--heights",
                               "sea", "--cc", "0", "--plane-error", "1e4"});
  ASSERT_EQ(seen.status, 0) << seen.err;
  EXPECT_LT(seen.peak, 100u << 20);
  EXPECT_EQ(test::rows_of(seen.out)[0].at("visible"), "1");
}

// The blocks of a file take more memory than those of a virtual raster.
TEST(LargeRaster, KeepsFewBlocksOfFilesAlongLines) {
  GDALAllRegister();
  const test::Scratch scratch;
  const std::string dem = scratch.path("flat.tif");
  constexpr int kSide = 40000;
  char* options[] = {const_cast<char*>("TILED=YES"), const_cast<char*>("SPARSE_OK=TRUE"), nullptr};
  GDALDatasetUniquePtr(
      GetGDALDriverManager()->GetDriverByName("GTiff")->Create(dem.c_str(), kSide, kSide, 1, GDT_Int16, options));
  const auto seen = test::run({"los", dem, "--coords", "local", "--from", "3,39997,2", "--to", "39998,5,2"});
  ASSERT_EQ(seen.status, 0) << seen.err;
  EXPECT_LT(seen.peak, 100u << 20);
}

// A line alone is read along itself; with many others, all of the raster is read at once.
TEST(LargeRaster, LinesOfSightAreThoseOfTheWholeRaster) {
  const test::Scratch scratch;
  const std::string dem = county(scratch);
  // Lines whose box is most of the raster, across the hills.
  std::string lines;
  for (int i = 0; i < 40; ++i)
    lines += std::to_string(450100 + i * 997) + ",4999900," + std::to_string(539000 - i * 1013) + ",4910500\n";
  const auto los = [&](const std::string& table) {
    return test::run(
        {"los", dem, "--lines", scratch.write("lines.csv", table), "--frequency", "5800", "--observer-height", "40"});
  };
  const auto all = los("x,y,tx,ty\n" + lines);
  ASSERT_EQ(all.status, 0) << all.err;
  EXPECT_GT(all.peak, 9000u * 9000 * 2) << "the whole raster was not read";
  const std::vector<test::Row> expected = test::rows_of(all.out);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const std::size_t end = lines.find('\n', begin) + 1;
    if (i % 16 == 5) {
      const auto alone = los("x,y,tx,ty\n" + lines.substr(begin, end - begin));
      ASSERT_EQ(alone.status, 0) << alone.err;
      EXPECT_LT(alone.peak, 100u << 20);
      test::Row row = test::rows_of(alone.out)[0];
      row["line"] = expected[i].at("line");
      EXPECT_EQ(row, expected[i]) << i;
    }
    begin = end;
  }
}

TEST(LargeRaster, IsReadWhereRaysEndAndHitAtTheSamePlaces) {
  const test::Scratch scratch;
  const std::string dem = county(scratch);
  for (const std::string coordinates : {"map", "local"}) {
    const int west = coordinates == "map" ? 490200 : 40200, north = coordinates == "map" ? 4949000 : 39000;
    std::string rays = "x,y,z,dx,dy,dz,t_min,t_max\n";
    for (int i = 0; i < 40; ++i)
      rays += std::to_string(west + i * 61) + "," + std::to_string(north - i * 53) + ",500," +
              std::to_string(i % 5 - 2) + ",1." + std::to_string(i) + ",-0.7,0," + (i % 9 == 0 ? "40" : "900") + "\n";
    const auto cast = [&](const std::string& table) {
      return test::run({"cast", dem, "--coords", coordinates, "--rays", scratch.write("rays.csv", table)});
    };
    // A level ray that never ends needs all of the raster north-east of it.
    const std::string level = coordinates == "map" ? "450010,4910010,99999,1,1,0,0,\n" : "10,10,99999,1,1,0,0,\n";
    const auto part = cast(rays), whole = cast(rays + level);
    ASSERT_EQ(part.status, 0) << part.err;
    ASSERT_EQ(whole.status, 0) << whole.err;
    EXPECT_LT(part.peak + (100 << 20), whole.peak) << "the whole raster was read";
    const std::vector<test::Row> here = test::rows_of(part.out), all = test::rows_of(whole.out);
    ASSERT_EQ(here.size() + 1, all.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
      for (const char* same : {"ray", "status", "col", "row"}) EXPECT_EQ(here[i].at(same), all[i].at(same)) << i;
      if (here[i].at("status") != "hit") continue;
      // Local coordinates below 2^17 m round by 2^-37 m, eight times from the ray to its hit: across the surface, in
      // each of the two runs. Map coordinates below 2^23 m are converted twice, and round by 2^-31 m.
      constexpr double kMoved = 8 * 0x1p-37, kMap = 2 * 0x1p-31, kCell = 10;
      const double d[3] = {static_cast<double>(i % 5) - 2, std::stod("1." + std::to_string(i)), -0.7};
      const double length = std::hypot(d[0], d[1], d[2]);
      const double slope =
          d[0] * test::number(here[i], "nx") + d[1] * test::number(here[i], "ny") + d[2] * test::number(here[i], "nz");
      const double along = 2 * kMoved * length / std::abs(slope);
      const auto expect_close = [&](const char* column, double tolerance) {
        EXPECT_NEAR(test::number(here[i], column), test::number(all[i], column), tolerance) << i << ' ' << column;
      };
      expect_close("t", along / length);
      for (const char* metres : {"x", "y", "z"}) expect_close(metres, along + kMap);
      for (const char* share : {"u", "v"}) expect_close(share, (along + kMap) / kCell);
    }
  }
}

// Rays without an end are below all samples of 16 bits after some kilometres, and vertical ones at one place.
TEST(LargeRaster, IsReadWhereRaysWithoutAnEndMayHit) {
  const test::Scratch scratch;
  const std::string dem = county(scratch);
  std::string rays = "x,y,z,dx,dy,dz\n";
  for (int i = 0; i < 40; ++i)
    rays += std::to_string(490200 + i * 61) + "," + std::to_string(4949000 - i * 53) + ",500," +
            (i % 7 == 0 ? "0,0" : std::to_string(i % 5 - 2) + ",1." + std::to_string(i)) + ",-9\n";
  const auto cast = [&](const std::string& table) {
    return test::run({"cast", dem, "--coords", "map", "--rays", scratch.write("rays.csv", table)});
  };
  const auto part = cast(rays), whole = cast(rays + "450010,4910010,99999,1,1,0\n");
  ASSERT_EQ(part.status, 0) << part.err;
  ASSERT_EQ(whole.status, 0) << whole.err;
  EXPECT_LT(part.peak + (100 << 20), whole.peak) << "the whole raster was read";
  const std::vector<test::Row> here = test::rows_of(part.out), all = test::rows_of(whole.out);
  ASSERT_EQ(here.size() + 1, all.size());
  int hits = 0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    for (const char* same : {"ray", "status", "col", "row"}) EXPECT_EQ(here[i].at(same), all[i].at(same)) << i;
    hits += here[i].at("status") == "hit";
  }
  EXPECT_GT(hits, 20);
}

}  // namespace
}  // namespace scarp
