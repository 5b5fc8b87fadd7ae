// SPDX-License-Identifier: MIT
// `scarp cast --samples` and `section --ray`: the steps of marches as tables and figures.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/csv_rows.h"
#include "cli/program.h"
#include "cli/refused.h"
#include "full_disk.h"

namespace scarp {
namespace {

using test::Names;
using test::number;
using test::Row;
using test::rows_of;
using test::run;
using test::text_of;
using test::operator+;

constexpr double kMetres = 0x1p-43;  // two roundings of numbers below 2^9
constexpr double kSample = 0x1p-17;  // samples below 128 m are floats

class MarchSamples : public testing::Test {
 protected:
  static constexpr int kCols = 33, kRows = 25;
  static constexpr double kCell = 10;

  static double sample(int col, int row) { return 40 + 30 * std::sin(0.4 * col) * std::cos(0.3 * row); }
  // Bilinear, at metres from the south-west sample.
  static double ground(double x, double y) {
    const double col = x / kCell, row = kRows - 1 - y / kCell;
    const int c = std::clamp(static_cast<int>(col), 0, kCols - 2), r = std::clamp(static_cast<int>(row), 0, kRows - 2);
    const double u = col - c, v = row - r;
    const double north = sample(c, r) + u * (sample(c + 1, r) - sample(c, r));
    const double south = sample(c, r + 1) + u * (sample(c + 1, r + 1) - sample(c, r + 1));
    return north + v * (south - north);
  }

  // An ESRI ASCII grid with node (0, 24) at map (1000, 2000).
  std::string hills() const {
    std::string text =
        fmt::format("ncols {}\nnrows {}\nxllcenter 1000\nyllcenter 2000\ncellsize {}\n", kCols, kRows, kCell);
    for (int row = 0; row < kRows; ++row) {
      for (int col = 0; col < kCols; ++col) text += fmt::format("{} ", sample(col, row));
      text += "\n";
    }
    return scratch_.write("hills.asc", text);
  }
  std::string rays() const {
    return scratch_.write("rays.csv",
                          "x,y,z,dx,dy,dz\n5,12,150,1,0.7,-0.4\n300,200,120,-2,-1,-0.6\n10,10,200,1,1,0.5\n");
  }
  // 16 x 16 x 16 voxels with a wall at x = 12.
  std::string wall() const {
    std::string bytes(16 * 16 * 16, '\0');
    for (int z = 0; z < 16; ++z) {
      for (int y = 0; y < 16; ++y) bytes[static_cast<std::size_t>((z * 16 + y) * 16 + 12)] = '\1';
    }
    bytes[0] = '\1';
    return scratch_.write("wall.raw", bytes);
  }
  std::string path(const std::string& name) const { return scratch_.path(name); }

  std::vector<Row> samples(const std::string& march) const {
    const auto result = run({"cast", hills(), "--rays", rays(), "--coords", "local", "--march", march, "--samples",
                             path("s.csv"), "-o", path("hits.csv")});
    EXPECT_EQ(result.status, 0) << result.err;
    return rows_of(text_of(path("s.csv")));
  }

  test::Scratch scratch_;
};

TEST_F(MarchSamples, SamplesLieOnTheirRaysAboveTheGround) {
  const std::vector<std::array<double, 6>> typed{
      {5, 12, 150, 1, 0.7, -0.4}, {300, 200, 120, -2, -1, -0.6}, {10, 10, 200, 1, 1, 0.5}};
  for (const char* march : {"naive", "relaxed", "fixed-step", "lipschitz", "max-mip"}) {
    const std::vector<Row> rows = samples(march);
    const std::vector<Row> hits = rows_of(text_of(path("hits.csv")));
    std::map<int, int> count;
    int balls = 0;
    for (const Row& row : rows) {
      const int ray = static_cast<int>(number(row, "ray"));
      ASSERT_TRUE(ray >= 0 && ray < 3);
      EXPECT_EQ(number(row, "index"), count[ray]++) << march;
      if (row.at("t").empty()) continue;
      const auto& r = typed[static_cast<std::size_t>(ray)];
      const double t = number(row, "t"), x = r[0] + t * r[3], y = r[1] + t * r[4], z = r[2] + t * r[5];
      EXPECT_NEAR(number(row, "x"), x, kMetres) << march;
      EXPECT_NEAR(number(row, "y"), y, kMetres) << march;
      EXPECT_NEAR(number(row, "z"), z, kMetres) << march;
      if (row.at("kind") == "sample") {
        EXPECT_NEAR(number(row, "clearance"), z - ground(x, y), kSample) << march << " t=" << t;
      }
      balls += !row.at("free").empty();
      if (row.at("kind") == "passed-block") {
        EXPECT_GE(number(row, "maximum"), ground(x, y) - kSample) << march;
      }
    }
    EXPECT_EQ(balls > 0, std::string(march) == "lipschitz");
    // The last row of each ray is its result.
    ASSERT_EQ(hits.size(), 3u);
    for (std::size_t ray = 0; ray < 3; ++ray) {
      const auto last = std::find_if(rows.rbegin(), rows.rend(),
                                     [&](const Row& row) { return number(row, "ray") == static_cast<double>(ray); });
      ASSERT_NE(last, rows.rend());
      EXPECT_EQ(last->at("kind"), hits[ray].at("status")) << march;
      EXPECT_EQ(last->at("t"), hits[ray].at("t")) << march;
    }
    EXPECT_GT(rows.size(), 6u) << march;
  }
}

TEST_F(MarchSamples, FixedStepsAreEquallyLong) {
  const std::vector<Row> rows = samples("fixed-step");
  const double step = number(rows.at(1), "t") - number(rows.at(0), "t");
  for (std::size_t i = 2; rows.at(i).at("kind") == "sample" && number(rows[i], "ray") == 0 && i < 20; ++i)
    EXPECT_NEAR(number(rows[i], "t") - number(rows[i - 1], "t"), step, kMetres);
}

TEST_F(MarchSamples, PlacesAreInTheCoordinatesOfRays) {
  const std::string table = scratch_.write("map.csv", "x,y,z,dx,dy,dz\n1005,2012,150,1,0.7,-0.4\n");
  ASSERT_EQ(run({"cast", hills(), "--rays", table, "--samples", path("s.csv"), "-o", path("h.csv")}).status, 0);
  const std::vector<Row> rows = rows_of(text_of(path("s.csv")));
  for (const Row& row : rows)
    EXPECT_NEAR(number(row, "x"), 1005 + number(row, "t"), 0x1p-41);  // four roundings below 2^11
}

TEST_F(MarchSamples, VoxelMarchesRecordWhatTheySkip) {
  const std::string table = scratch_.write("v.csv", "x,y,z,dx,dy,dz\n1.5,8.5,8.5,1,0,0\n");
  std::map<std::string, std::size_t> counts;
  for (const std::string march : {"planes", "spheres", "cubes", "cubes-jump", "octants", "bricks"}) {
    const auto result = run({"cast", wall(), "--volume", "16x16x16:u8", "--solid-from", "1", "--rays", table, "--march",
                             "voxel-" + march, "--samples", path("s.csv"), "-o", path("h.csv")});
    ASSERT_EQ(result.status, 0) << result.err;
    const std::vector<Row> rows = rows_of(text_of(path("s.csv")));
    ASSERT_GE(rows.size(), 2u) << march;
    const Row &solid = rows[rows.size() - 2], &last = rows.back(), hit = rows_of(text_of(path("h.csv"))).at(0);
    EXPECT_EQ(solid.at("kind"), "solid") << march;
    for (const char* column : {"voxel_x", "voxel_y", "voxel_z", "t"})
      EXPECT_EQ(solid.at(column), hit.at(column)) << march;
    EXPECT_EQ(last.at("kind"), "hit");
    for (std::size_t i = 0; i + 2 < rows.size(); ++i) {
      EXPECT_EQ(rows[i].at("t_out"), rows[i + 1].at("t")) << march;
      EXPECT_LT(number(rows[i], "voxel_x"), 12) << march;
      // An empty cube ends in front of the wall.
      if (rows[i].at("kind") == "cube") {
        EXPECT_LE(number(rows[i], "low_x") + number(rows[i], "size"), 12) << march;
      }
    }
    counts[march] = rows.size();
  }
  EXPECT_EQ(counts["planes"], 11u + 2u);
  EXPECT_LT(counts["cubes"], counts["planes"]);
  EXPECT_LE(counts["octants"], counts["cubes"]);
}

TEST_F(MarchSamples, SectionDrawsVisitedVoxelsAndEmptyBodies) {
  const Names section{"section", wall(), "--volume", "16x16x16:u8", "--solid-from", "1", "-o", path("s.svg")};
  const auto draw = [&](const Names& more) { return run(section + more); };
  const auto count = [&](const std::string& part) {
    const std::string text = text_of(path("s.svg"));
    int found = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
  };
  const std::string ray = "--ray=-2,8.5,8.5,1,0.25,0";
  const auto spheres = draw({ray, "--march", "voxel-planes,voxel-spheres"});
  ASSERT_EQ(spheres.status, 0) << spheres.err;
  EXPECT_NE(spheres.out.find("s.svg: voxel-planes: 17 steps, hits voxel 12,11,8"), std::string::npos) << spheres.out;
  EXPECT_NE(spheres.out.find("s.svg: voxel-spheres: "), std::string::npos) << spheres.out;
  EXPECT_EQ(count("<svg"), 1 + 2);
  EXPECT_EQ(count("hits voxel 12,11,8"), 2);
  // The default march; the layer is perpendicular to an axis along which the ray does not travel.
  const auto cubes = draw({"--ray=-2,8.5,8.5,1,0,0.25"});
  ASSERT_EQ(cubes.status, 0) << cubes.err;
  EXPECT_NE(cubes.out.find("voxel-cubes: "), std::string::npos) << cubes.out;
  std::filesystem::remove(path("s.svg"));
  const std::vector<std::pair<Names, std::string>> bad{
      {{"--ray=-2,8.5,8.5,1,0.25,0.1"}, "leaves its layer"},
      {{ray, "--axis", "y"}, "leaves its layer"},
      {{"--ray=1,2,3,0,0,0"}, "the direction is zero"},
      {{"--ray=1,2,3"}, "--ray '1,2,3': expected X,Y,Z,DX,DY,DZ"},
      {{"--ray=-2,8.5,99,1,0.25,0"}, "layer 99 along z is beside the model"},
      {{"--ray=-2,99,8.5,1,0.25,0"}, "does not pass through the model"},
      {{ray, "--march", "voxel-exhaustive"}, "--march 'voxel-exhaustive': expected voxel-planes"},
      {{"--march", "voxel-cubes"}, "--march has no effect without --ray"},
      {{ray, "--at", "3"}, "--at"},
      {{ray, "--radii", "cubes"}, "--ray"},
      {{ray, "--outlines"}, "--outlines cannot be combined with --ray"}};
  for (const auto& [arguments, fragment] : bad) test::expect_refused(draw(arguments), fragment);
}

// Outlines hold no solid voxel, and each empty voxel whose radius is not 0 is in one of them.
TEST_F(MarchSamples, OutlinesCoverTheEmptyVoxels) {
  struct Square {
    int x, y, side;
    bool holds(int cx, int cy) const { return cx > x && cx < x + side && cy > y && cy < y + side; }
  };
  for (const char* radii : {"cubes", "spheres"}) {
    const auto result = run({"section", wall(), "--volume", "16x16x16:u8", "--solid-from", "1", "-o", path("s.svg"),
                             "--radii", radii, "--outlines"});
    ASSERT_EQ(result.status, 0) << result.err;
    std::vector<Square> outlines, solid, empty;
    const std::string svg = text_of(path("s.svg"));
    for (auto at = svg.find("<rect "); at != std::string::npos; at = svg.find("<rect ", at + 1)) {
      Square square{};
      ASSERT_EQ(
          std::sscanf(svg.c_str() + at, "<rect x=\"%d\" y=\"%d\" width=\"%d\"", &square.x, &square.y, &square.side), 3);
      const std::string line = svg.substr(at, svg.find('\n', at) - at);
      if (line.find("fill=\"none\"") != std::string::npos) {
        outlines.push_back(square);
      } else if (line.find("<text") == std::string::npos) {
        solid.push_back(square);
      } else if (line.find(">0</text>") == std::string::npos) {
        empty.push_back(square);
      }
    }
    ASSERT_FALSE(outlines.empty() || solid.empty() || empty.empty());
    const auto held = [&](const Square& cell) {
      return std::any_of(outlines.begin(), outlines.end(),
                         [&](const Square& outline) { return outline.holds(cell.x + 10, cell.y + 10); });
    };
    EXPECT_TRUE(std::none_of(solid.begin(), solid.end(), held)) << radii;
    EXPECT_TRUE(std::all_of(empty.begin(), empty.end(), held)) << radii;
  }
}

TEST_F(MarchSamples, ReportsBadInputInOneLineWithoutOutput) {
  const Names cast{"cast", hills(), "--rays", rays(), "--coords", "local", "-o", path("h.csv"), "--samples"};
  const auto refused = [&](const Names& arguments, const Names& more, const std::string& fragment) {
    test::expect_refused(scratch_, arguments + more, fragment);
  };
  refused(cast, {path("s.npy")}, "end the name in .csv");
  refused(cast, {path("none/s.csv")}, "none");
  refused(cast, {path("hills.asc")}, "hills.asc");
  refused(cast, {path("rays.csv")}, "is the input");
  refused(cast, {path("h.csv")}, "--samples '" + path("h.csv") + "': is the output");
  refused(cast, {path("./h.csv")}, "': is the output");
  refused(cast, {path("s.csv"), "--march", "exhaustive"}, "the march exhaustive records no steps (use max-mip");
  refused({"cast", "--function", "ridges", "--rays", rays(), "--samples", path("s.csv")}, {},
          "the march lipschitz-local records no steps (use naive");
}

// A virtual raster that reads a table of points.
TEST_F(MarchSamples, NeverOverwritesFilesThatTheInputReads) {
  const std::string points = "x,y,z\n0,10,1\n10,10,2\n0,0,3\n10,0,4\n", source = scratch_.write("points.csv", points);
  const std::string raster = scratch_.write("points.vrt", R"(<VRTDataset rasterXSize="2" rasterYSize="2">
<GeoTransform>-5,10,0,15,0,-10</GeoTransform><VRTRasterBand dataType="Float32" band="1"><SimpleSource>
<SourceFilename relativeToVRT="1">points.csv</SourceFilename><SourceBand>1</SourceBand>
</SimpleSource></VRTRasterBand></VRTDataset>)");
  const Names cast{"cast", raster, "--rays", rays(), "--coords", "local", "-o", path("h.csv"), "--samples"};
  const auto with = [&](const std::string& samples) { return run(cast + Names{samples}); };
  test::expect_refused(with(source), "output '" + source + "': is the input");
  EXPECT_EQ(text_of(source), points);
  EXPECT_FALSE(std::filesystem::exists(path("h.csv")));
  ASSERT_EQ(with(path("s.csv")).status, 0);
}

TEST_F(MarchSamples, FullDiskLeavesNeitherHitsNorSamples) {
  const Names cast{"cast",    hills(), "--rays", rays(),        "--coords",  "local",
                   "--march", "naive", "-o",     path("h.csv"), "--samples", path("s.csv")};
  const Names before = scratch_.files();
  const auto result = [&] {
    constexpr std::uint64_t kHitsOnly = 2000;
    const test::FullDisk disk(kHitsOnly);
    return test::Program(cast).result();
  }();
  test::expect_refused(result, "s.csv: cannot be written");
  EXPECT_EQ(scratch_.files(), before);
}

}  // namespace
}  // namespace scarp
