// SPDX-License-Identifier: MIT
// `scarp cast` from outside: tables of rays in, tables of hits out.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/csv_rows.h"
#include "cli/program.h"
#include "cli/refused.h"
#include "scarp/march/march_settings.h"

namespace scarp {
namespace {

using test::Names;
using test::number;
using test::Row;
using test::rows_of;
using test::run;

class Cast : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return scratch_.path(name); }
  std::string write(const std::string& name, const std::string& bytes) const { return scratch_.write(name, bytes); }
  std::string rays(const std::string& bytes) const { return write("rays.csv", bytes); }

  static int sample(int col, int row) { return 100 + 7 * col * col - 3 * row * col + 11 * row; }
  static constexpr int kCols = 5, kRows = 4;

  // An ESRI ASCII grid, node (0, 3) at map (1000, 2000), cells of 10.
  std::string hills(const std::string& samples = "") const {
    std::string text = samples;
    for (int row = 0; samples.empty() && row < kRows; ++row) {
      for (int col = 0; col < kCols; ++col) text += fmt::format("{} ", sample(col, row));
      text += "\n";
    }
    return write("hills.asc", fmt::format("ncols {}\nnrows {}\nxllcenter 1000\nyllcenter 2000\ncellsize 10\n"
                                          "NODATA_value -9999\n{}\n",
                                          kCols, kRows, text));
  }

  // `cast` on hills must fail: one line on stderr that contains the fragment, nothing on stdout, no file left.
  void expect_refused(const Names& options, const std::string& fragment) {
    hills();
    const Names before = scratch_.files();
    Names arguments = {"cast", path("hills.asc"), "-o", path("hits.csv")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = run(arguments);
    test::expect_refused(result, fragment);
    EXPECT_EQ(scratch_.files(), before);
  }
  void expect_rays_refused(const std::string& table, const std::string& fragment, Names options = {}) {
    options.insert(options.end(), {"--rays", rays(table)});
    expect_refused(options, fragment);
  }

  // Looks straight down at each node, whose position is `place(col, row)`; `inner`: skips nodes on the border.
  template <class Place>
  std::vector<Row> look_down(const Names& options, const Place& place, bool inner = false) {
    std::string table = "col_in,row_in,x,y,z,dx,dy,dz\n";
    const int margin = inner ? 1 : 0;
    for (int row = margin; row < kRows - margin; ++row) {
      for (int col = margin; col < kCols - margin; ++col) {
        const auto [x, y] = place(col, row);
        table += fmt::format("{},{},{},{},4096,0,0,-0.5\n", col, row, x, y);
      }
    }
    Names arguments = {"cast", hills(), "--rays", rays(table)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    const std::vector<Row> rows = rows_of(result.out);
    EXPECT_EQ(rows.size(), static_cast<std::size_t>((kCols - 2 * margin) * (kRows - 2 * margin)));
    for (const Row& row : rows) {
      const int col = std::stoi(row.at("col_in")), raster_row = std::stoi(row.at("row_in"));
      const auto [x, y] = place(col, raster_row);
      EXPECT_EQ(row.at("status"), "hit");
      EXPECT_EQ(number(row, "x"), x);
      EXPECT_EQ(number(row, "y"), y);
      EXPECT_EQ(number(row, "z"), sample(col, raster_row)) << row.at("z");
      EXPECT_EQ(number(row, "t"), 2 * (4096 - sample(col, raster_row))) << row.at("t");
      EXPECT_EQ(number(row, "col") + number(row, "u"), col);
      EXPECT_EQ(number(row, "row") + number(row, "v"), raster_row);
      EXPECT_EQ(row.at("wall"), "0");
    }
    return rows;
  }

  test::Scratch scratch_;
};

TEST_F(Cast, LocalNodesHitTheirSamples) {
  look_down({"--coords", "local"}, [](int col, int row) { return std::pair(10.0 * col, 10.0 * (kRows - 1 - row)); });
}

TEST_F(Cast, MapNodesHitTheirSamples) {
  const auto place = [](int col, int row) { return std::pair(1000 + 10.0 * col, 2000 + 10.0 * (kRows - 1 - row)); };
  const auto asked = look_down({"--coords", "map"}, place), by_default = look_down({}, place);
  EXPECT_EQ(asked, by_default) << "a raster with a place has map coordinates";
}

TEST_F(Cast, LonlatNodesHitTheirSamples) {
  // Cells of 1/1024 degree: nodes and edges are exact numbers.
  const double west = -84.5, south = 36.25, cell = 1.0 / 1024;
  const std::string bounds = fmt::format("--bounds={},{},{},{}", west - cell / 2, south - cell / 2,
                                         west + (kCols - 0.5) * cell, south + (kRows - 0.5) * cell);
  // Their cell sizes in metres are rounded: a border node may be outside by a rounding error.
  look_down(
      {"--coords", "lonlat", "--crs", "EPSG:4326", bounds},
      [&](int col, int row) { return std::pair(west + cell * col, south + cell * (kRows - 1 - row)); }, true);
}

TEST_F(Cast, CoordinateSystemsAgree) {
  // UTM zone 16N (721085, 4030060) is this longitude and latitude by Krueger's series; nodes are 30 m apart, the
  // south-west one at (721015, 4030015).
  const double west = 721015, south = 4030015, x = 721085, y = 4030060;
  const auto cast = [&](const std::string& place, const std::string& crs) {
    const auto result = run({"cast", hills(), "--rays", rays(fmt::format("x,y,z,dx,dy,dz\n{},900,0,0,-1\n", place)),
                             "--coords", crs, "--crs", "EPSG:32616", "--bounds=721000,4030000,721150,4030120"});
    EXPECT_EQ(result.status, 0) << result.err;
    const auto rows = rows_of(result.out);
    return rows.empty() ? Row() : rows[0];
  };
  const double north = sample(2, 1) + (sample(3, 1) - sample(2, 1)) / 3.0,
               below = sample(2, 2) + (sample(3, 2) - sample(2, 2)) / 3.0;
  // The series are accurate to some micrometres, and the slope is about 1.
  constexpr double kSeries = 1e-5;
  const Row map = cast(fmt::format("{},{}", x, y), "map"), lonlat = cast("-84.535001630948,36.390278541168", "lonlat");
  for (const Row& row : {map, lonlat}) {
    EXPECT_EQ(row.at("col") + row.at("row"), "21");
    EXPECT_NEAR(number(row, "u"), 1.0 / 3, kSeries);
    EXPECT_NEAR(number(row, "z"), (north + below) / 2, kSeries);
  }
  // Local metres are ground metres: map metres times one scale, here 1.0002.
  const double scale = 1.0002;
  const Row local = cast(fmt::format("{},{}", (x - west) * scale, (y - south) * scale), "local");
  EXPECT_NEAR(number(local, "u"), 1.0 / 3, 0.001);
  EXPECT_NEAR(number(local, "v"), 0.5, 0.001);
}

TEST_F(Cast, ReportsHitsWithoutLongitude) {
  // The Earth from far away: the corners of this map show the sky behind it.
  hills("0 0 0 0 0\n0 0 0 0 0\n0 0 0 0 0\n0 0 0 0 0");
  const auto result =
      run({"cast", path("hills.asc"), "--rays", rays("x,y,z,dx,dy,dz\n0,0,1000,6000,6000,-1\n"), "--coords", "lonlat",
           "--crs", "+proj=ortho +lat_0=0 +lon_0=0 +ellps=WGS84", "--bounds=-9000000,-9000000,9000000,9000000"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(test::lines(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("line 2 (ray 0): its hit is at a place that has no longitude"), std::string::npos)
      << result.err;
}

TEST_F(Cast, CarriesColumnsForEveryStatus) {
  hills();
  const auto result = run({"cast", path("hills.asc"), "--coords", "local", "--rays",
                           rays("name;x;y;z;dx;dy;dz;t_max\r\nhit;15;15;500;0;0;-1;\r\nup;15;15;500;0;0;1;\r\n"
                                "short;15;15;500;0;0;-1;10\r\nunder;15;15;1;0;0;-1;\r\n")});
  EXPECT_EQ(result.status, 0) << result.err;
  const auto rows = rows_of(result.out);
  ASSERT_EQ(rows.size(), 4u);
  const char* expected[][2] = {{"hit", "hit"}, {"up", "miss"}, {"short", "miss"}, {"under", "below"}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(rows[i].at("name"), expected[i][0]);
    EXPECT_EQ(rows[i].at("ray"), std::to_string(i));
    EXPECT_EQ(rows[i].at("status"), expected[i][1]);
    EXPECT_EQ(rows[i].at("t").empty(), i != 0);
  }
}

TEST_F(Cast, MarchesAgree) {
  std::string table = "x,y,z,dx,dy,dz\n";
  for (int i = 0; i < 50; ++i)
    table += fmt::format("{},{},{},{},{},-20\n", i % 7 * 6, i % 5 * 6, 300, i % 9 - 4, i % 4 - 2);
  hills();
  rays(table);
  const auto exact = rows_of(run({"cast", path("hills.asc"), "--coords", "local", "--rays", path("rays.csv")}).out);
  const auto judge = rows_of(
      run({"cast", path("hills.asc"), "--coords", "local", "--rays", path("rays.csv"), "--march", "exhaustive"}).out);
  const auto any =
      rows_of(run({"cast", path("hills.asc"), "--coords", "local", "--rays", path("rays.csv"), "--any"}).out);
  ASSERT_EQ(exact.size(), 50u);
  ASSERT_EQ(judge.size(), 50u);
  ASSERT_EQ(any.size(), 50u);
  int hits = 0;
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(exact[i].at("status"), judge[i].at("status"));
    EXPECT_EQ(any[i].at("blocked"), exact[i].at("status") == "hit" ? "1" : "0");
    if (exact[i].at("status") != "hit") continue;
    ++hits;
    EXPECT_NEAR(number(exact[i], "t"), number(judge[i], "t"), 1e-9);
  }
  EXPECT_GT(hits, 10);
}

TEST_F(Cast, AllHitsAreSortedByT) {
  // Two ridges along the ray.
  hills("1 9 1 9 1\n1 9 1 9 1\n1 9 1 9 1\n1 9 1 9 1");
  rays("x,y,z,dx,dy,dz\n-5,15,5,1,0,0\n-5,15,20,1,0,0\n");
  for (const char* march : {"max-mip", "exhaustive"}) {
    const auto rows = rows_of(
        run({"cast", path("hills.asc"), "--coords", "local", "--rays", path("rays.csv"), "--all", "--march", march})
            .out);
    ASSERT_EQ(rows.size(), 3u) << march;
    EXPECT_EQ(number(rows[0], "t"), 10);
    EXPECT_EQ(number(rows[1], "t"), 30);
    EXPECT_EQ(rows[1].at("ray"), "0");
    EXPECT_EQ(rows[2].at("ray"), "1");
    EXPECT_EQ(rows[2].at("status"), "miss");
  }
  expect_rays_refused("x,y,z,dx,dy,dz\n1,1,9,0,0,-1\n", "only max-mip and exhaustive find all hits",
                      {"--all", "--march", "naive"});
  expect_rays_refused("x,y,z,dx,dy,dz\n1,1,9,0,0,-1\n", "--any", {"--all", "--any"});
}

TEST_F(Cast, WarnsAboutRaysFromBelow) {
  hills("10 10 10 10 10\n10 10 10 10 10\n10 10 10 10 10\n10 10 10 10 10");
  // Rays from below going up, from above going down, and from above going up.
  rays("x,y,z,dx,dy,dz\n15,15,5,0.1,0,1\n15,15,15,0.1,0,-1\n15,15,15,0.1,0,1\n");
  const Names arguments{"cast", path("hills.asc"), "--coords", "local", "--rays", path("rays.csv")};
  Names any = arguments;
  any.push_back("--any");
  const auto told = run(any);
  const auto rows = rows_of(told.out);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].at("blocked"), "0");
  EXPECT_EQ(rows[1].at("blocked"), "1");
  EXPECT_NE(told.err.find("note: 1 of 3 rays start below ground and never emerge; they are reported as not blocked"),
            std::string::npos)
      << told.err;
  EXPECT_EQ(rows_of(run(arguments).out)[0].at("status"), "below");
}

// Each kind of input, hit from straight above.
class CastInputs : public Cast {
 protected:
  // One row per ray; `options` begin with the input.
  std::vector<Row> cast(const Names& options, const std::string& table) {
    Names arguments = {"cast"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.insert(arguments.end(), {"--rays", rays(table)});
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return rows_of(result.out);
  }
  void expect_error(Names arguments, const std::string& fragment) {
    arguments.insert(arguments.begin(), "cast");
    arguments.insert(arguments.end(), {"--rays", path("rays.csv")});
    const auto result = run(arguments);
    EXPECT_NE(result.status, 0) << fragment;
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(fragment), std::string::npos) << result.err;
  }
  static std::string down(double x, double y) { return fmt::format("x,y,z,dx,dy,dz\n{},{},100,0,0,-2\n", x, y); }

  // A ball of radius 3 on a plane, and the plane with its own colour.
  std::string scene() const {
    return write("scene.json", R"({
      "materials": {"grey": {"colour": "#808080"}, "red": {"colour": "#ff0000"}},
      "objects": [{"function": 2, "material": "grey"},
                  {"shape": {"union": [{"sphere": {"radius": 3, "at": [0, 0, 5]}, "material": "red"}]}}]})");
  }
  // Two columns, each of one voxel, with a gap between them.
  std::string columns() const { return write("columns.raw", std::string("\1\0\1", 3)); }
  const Names volume_{"--volume", "3x1x1:u8"};
};

TEST_F(CastInputs, VoxelHitsReportVoxelAndFace) {
  const auto rows = cast({columns(), volume_[0], volume_[1]}, down(2.25, 0.5));
  ASSERT_EQ(rows.size(), 1u);
  const Row& row = rows[0];
  EXPECT_EQ(row.at("status") + row.at("kind") + row.at("face"), "hitvoxelshigh_z");
  EXPECT_EQ(row.at("voxel_x") + row.at("voxel_y") + row.at("voxel_z") + row.at("part") + row.at("object"), "20000");
  EXPECT_EQ(number(row, "t"), 49.5);
  EXPECT_EQ(number(row, "z"), 1);
  EXPECT_EQ(number(row, "nz"), 1);
  for (const char* column : {"col", "row", "u", "v", "wall", "material", "triangle"})
    EXPECT_EQ(row.at(column), "") << column;
  EXPECT_EQ(cast({columns(), volume_[0], volume_[1]}, down(1.5, 0.5))[0].at("status"), "miss");
  EXPECT_EQ(cast({columns(), volume_[0], volume_[1], "--any"}, down(0.5, 0.5))[0].at("blocked"), "1");
  for (const char* march : {"voxel-exhaustive", "voxel-planes"})
    EXPECT_EQ(cast({columns(), volume_[0], volume_[1], "--march", march}, down(2.25, 0.5)), rows) << march;
}

TEST_F(CastInputs, FunctionHitsReportHeightAndNormal) {
  const auto rows = cast({"--function", write("plane.json", "7")}, down(1e6, -3));
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].at("status") + rows[0].at("kind"), "hitfunction");
  EXPECT_NEAR(number(rows[0], "z"), 7, LipschitzLocalSettings{}.tolerance * 93);
  EXPECT_EQ(number(rows[0], "nz"), 1);
  EXPECT_EQ(rows[0].at("col") + rows[0].at("voxel_x") + rows[0].at("material"), "");
}

TEST_F(CastInputs, SceneHitsReportObjectAndMaterial) {
  const auto rows =
      cast({scene()}, "id,x,y,z,dx,dy,dz\nball,0,0,100,0,0,-1\nplane,50,0,100,0,0,-1\nsky,0,0,100,0,0,1\n");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].at("id") + rows[0].at("object") + rows[0].at("kind") + rows[0].at("material"), "ball1shape1");
  EXPECT_NEAR(number(rows[0], "z"), 8, SphereTraceSettings{}.tolerance * 92);
  EXPECT_EQ(rows[1].at("id") + rows[1].at("object") + rows[1].at("kind") + rows[1].at("material"), "plane0function0");
  EXPECT_EQ(rows[2].at("status") + rows[2].at("object"), "miss");
  ASSERT_EQ(run({"cast", path("scene.json"), "--rays", path("rays.csv"), "-o", path("hits.npy")}).status, 0);
  EXPECT_EQ(test::text_of(path("hits.npy")).size() % 64, 3 * 23 * 8 % 64u);
}

// A terrain's own columns have the same values as in a cast of the terrain alone.
TEST_F(CastInputs, TerrainHitsInASceneReportTheCell) {
  const std::string dem = hills(), table = "x,y,z,dx,dy,dz\n15,15,900,0,0,-1\n";
  const Row alone = cast({dem, "--coords", "local"}, table).at(0),
            among = cast({write("terrain.json", R"({"objects": [{"heights": {"file": "hills.asc"}}]})")}, table).at(0);
  for (const auto& [column, value] : alone) EXPECT_EQ(among.at(column), value) << column;
  EXPECT_EQ(among.at("status") + among.at("kind") + among.at("object"), "hitheights0");
}

#ifdef SCARP_MESHES_IN_SCENES
TEST_F(CastInputs, MeshHitsReportTheTriangle) {
  const std::string mesh = write("roof.obj", "v 0 0 5\nv 8 0 5\nv 0 8 5\nv 8 8 5\nf 1 2 3\nf 2 4 3\n");
  const Row row = cast({mesh, "--mesh-up", "z"}, down(6, 6)).at(0);
  EXPECT_EQ(row.at("status") + row.at("kind") + row.at("triangle") + row.at("col"), "hitmesh1");
  EXPECT_EQ(number(row, "z"), 5);
  EXPECT_EQ(number(row, "t"), 47.5);
  // The corners (8, 0), (8, 8), (0, 8).
  EXPECT_FLOAT_EQ(static_cast<float>(number(row, "u")), 0.5f);
  EXPECT_FLOAT_EQ(static_cast<float>(number(row, "v")), 0.25f);
  // On terrain, the mesh is an object of the scene, as the terrain is.
  const Names over{hills(), "--coords", "local", "--mesh", mesh, "--mesh-up", "z", "--mesh-at", "15,15,900"};
  const auto rows = cast(over, "x,y,z,dx,dy,dz\n15,15,1000,0,0,-1\n35,25,1000,0,0,-1\n");
  EXPECT_EQ(rows[0].at("kind") + rows[0].at("object") + rows[0].at("z"), "mesh1900");
  EXPECT_EQ(rows[1].at("kind") + rows[1].at("object") + rows[1].at("col"), "heights03");
}

// The middle of the box is empty: the mesh stands on the nearest column.
TEST_F(CastInputs, MeshStandsOnTheNearestSurface) {
  const std::string mesh = write("tile.obj", "v -0.01 -0.01 0\nv 0.01 -0.01 0\nv 0 0.01 0.5\nf 1 2 3\n");
  const Names on{columns(), volume_[0], volume_[1], "--mesh", mesh, "--mesh-up", "z"};
  int found = 0;
  for (const double x : {0.984375, 2.015625}) {
    const Row row = cast(on, down(x, 0.5)).at(0);
    const bool mesh_hit = row.at("kind") == "mesh";
    found += mesh_hit;
    EXPECT_FLOAT_EQ(static_cast<float>(number(row, "z")), mesh_hit ? 1.25f : 1.0f) << x;
  }
  EXPECT_EQ(found, 1);
}
#endif

TEST_F(CastInputs, RejectsTerrainOptionsForOtherInputs) {
  rays("x,y,z,dx,dy,dz\n1,1,9,0,0,-1\n");
  const std::string function = write("plane.json", "7");
  expect_error({scene(), "--all"}, "--all applies to terrain only (marches of other fields return the first hit only)");
  expect_error({scene(), "--coords", "map"},
               "--coords map or lonlat applies to terrain only (other inputs have no georeference)");
  expect_error({scene(), "--march", "naive"}, "--march applies to terrain, voxels and functions only");
  expect_error({columns(), volume_[0], volume_[1], "--march", "max-mip"}, "voxel-exhaustive");
  expect_error({columns(), volume_[0], volume_[1], "--wrap", "periodic"}, "--wrap applies to terrain only");
  expect_error({"--function", function, "--march", "max-mip"}, "lipschitz-local");
  expect_error({"--function", function, scene()}, "--function replaces files");
  expect_error({}, "IN (or --function NAME) is required");
  expect_error({hills(), "--all", "--mesh", "a.obj"}, "--mesh");
  rays("x,y,z,dx,dy,dz,start_col,start_row\n0.5,0.5,1,1,0,0,0,0\n");
  expect_error({columns(), volume_[0], volume_[1]}, "line 2 (ray 0): start_col and start_row name a cell");
  expect_error({write("broken.vox", "VOX ")}, "broken.vox");
}

TEST_F(Cast, AppliesSurfaceOptions) {
  hills("0 0 0 0 0\n0 0 0 0 0\n0 0 8 0 0\n0 0 0 0 0");
  const auto cast = [&](const std::string& table, const Names& options) {
    Names arguments = {"cast", path("hills.asc"), "--coords", "local", "--rays", rays(table)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    const auto rows = rows_of(result.out);
    return rows.empty() ? Row() : rows[0];
  };
  // At the middle of the cell whose south-east corner is the peak, the bilinear surface has a quarter of its height;
  // the diagonal of the triangles joins the two other corners.
  const std::string down = "x,y,z,dx,dy,dz\n15,15,100,0,0,-1\n";
  EXPECT_EQ(number(cast(down, {}), "z"), 2);
  EXPECT_EQ(number(cast(down, {"--surface", "triangles"}), "z"), 0);
  EXPECT_EQ(number(cast(down, {"--exaggeration", "3"}), "z"), 6);
  const std::string beyond = "x,y,z,dx,dy,dz,t_max\n65,15,100,0,0,-1,200\n";
  EXPECT_EQ(cast(beyond, {}).at("status"), "miss");
  EXPECT_EQ(number(cast(beyond, {"--wrap", "periodic"}), "z"), 2) << "period 5 cells";
  const std::string from_west = "x,y,z,dx,dy,dz\n-5,15,-3,2,0,0\n";
  EXPECT_NE(cast(from_west, {}).at("status"), "hit");
  const Row wall = cast(from_west, {"--solid"});
  EXPECT_EQ(wall.at("status"), "hit");
  EXPECT_EQ(wall.at("wall"), "1");
  EXPECT_EQ(number(wall, "t"), 2.5);
  EXPECT_EQ(number(wall, "nx"), -1);
  EXPECT_EQ(number(wall, "nz"), 0);
  const Row south = cast("x,y,z,dx,dy,dz\n15,-5,-3,0.5,1,0\n", {"--solid"});
  EXPECT_EQ(number(south, "ny"), -1);
  EXPECT_EQ(number(cast("x,y,z,dx,dy,dz\n45,15,-3,-1,0.25,0\n", {"--solid"}), "nx"), 1);
  EXPECT_EQ(number(cast("x,y,z,dx,dy,dz\n15,35,-3,0,-1,0\n", {"--solid"}), "ny"), 1);
}

TEST_F(Cast, RenderAcceptsTheSameSurfaces) {
  hills();
  const Names arguments = {"render", path("hills.asc"), "-o", path("out.png"), "--size", "32x24"};
  const auto with = [&](const Names& more) {
    Names all = arguments;
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  };
  EXPECT_EQ(with({"--surface", "triangles", "--solid"}).status, 0);
  for (const char* wrap : {"periodic", "mirror"}) EXPECT_EQ(with({"--wrap", wrap}).status, 0) << wrap;
}

TEST_F(Cast, NotesExplainWhyNothingWasHit) {
  const auto note = [&](const std::string& table, Names more = {}) {
    Names arguments{"cast", hills(), "--coords", "local", "--rays", rays(table)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.err;
  };
  const std::string header = "x,y,z,dx,dy,dz\n", under = header + "-50,15,-9000,1,0,0\n",
                    beside = header + "-50,15,90000,1,0,0\n";
  EXPECT_NE(note(header).find("the table of rays has a header alone: 0 rays"), std::string::npos);
  for (const Names& any : {Names{}, {"--any"}}) {
    EXPECT_NE(note(under, any).find("1 of 1 rays start below ground, or enter it through its border"),
              std::string::npos);
    EXPECT_EQ(note(under, any).find("--coords"), std::string::npos);
    EXPECT_NE(note(beside, any).find("are the rays in these (--coords)?"), std::string::npos);
  }
}

TEST_F(Cast, ReadsAndWritesFilesAndStreams) {
  const std::string table = "x,y,z,dx,dy,dz\n15,15,500,0,0,-1\n";
  const Names arguments = {"cast", hills(), "--coords", "local", "--rays"};
  const auto with = [&](Names more) {
    more.insert(more.begin(), arguments.begin(), arguments.end());
    return more;
  };
  const auto to_stdout = run(with({rays(table)}));
  const auto to_file = run(with({path("rays.csv"), "-o", path("hits.csv")}));
  EXPECT_EQ(to_file.status, 0) << to_file.err;
  EXPECT_EQ(to_file.out, "");
  EXPECT_EQ(test::text_of(path("hits.csv")), to_stdout.out);
  EXPECT_EQ(run(with({"-"}), path("rays.csv")).out, to_stdout.out);
  EXPECT_NE(run(with({"-"})).err.find("-: empty file"), std::string::npos);
  EXPECT_EQ(run(with({path("rays.csv"), "-o", path("hits.npy")})).status, 0);
  EXPECT_EQ(test::text_of(path("hits.npy")).size() % 64, 14 * 8 % 64u);
  // The output of one cast is the input of the next, which reads the columns that it knows and ignores the others.
  EXPECT_NE(run(with({path("hits.npy")})).err.find("no column 'dx'"), std::string::npos);
  EXPECT_EQ(run(with({rays("x,y,z,dx,dy,dz\n")})).out, "ray,status,t,x,y,z,col,row,u,v,nx,ny,nz,wall\n");
}

TEST_F(Cast, ClosedPipeIsNotAnError) {
  std::string table = "x,y,z,dx,dy,dz\n";
  for (int i = 0; i < 100000; ++i) table += "15,15,500,0,0,-1\n";
  const std::string command = fmt::format("'{}' cast '{}' --coords local --rays '{}' 2> '{}' | head -n 1 > '{}'",
                                          SCARP_PROGRAM, hills(), rays(table), path("err"), path("out"));
  // The second shell starts `scarp` with SIGPIPE ignored, as some daemons do.
  for (const std::string& line : {command, "trap '' PIPE; " + command}) {
    EXPECT_EQ(std::system(line.c_str()), 0);
    EXPECT_EQ(test::text_of(path("err")).find("scarp: "), std::string::npos) << test::text_of(path("err"));
    EXPECT_EQ(test::lines(test::text_of(path("out"))), 1);
  }
}

TEST_F(Cast, ReportsAFullDisk) {
  test::Program program({"cast", hills(), "--rays", rays("x,y,z,dx,dy,dz\n15,15,500,0,0,-1\n")}, "/dev/full");
  const auto result = program.result();
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("cannot be written"), std::string::npos) << result.err;
}

TEST_F(Cast, ErrorsInRaysNameFileAndRow) {
  const std::string header = "x,y,z,dx,dy,dz\n", good = "15,15,500,0,0,-1\n";
  std::string six = header;
  for (int i = 0; i < 6; ++i) six += good;
  expect_rays_refused(six + "15,15,500,0,0\n", fmt::format("{}: line 8 (ray 6): 5 fields", path("rays.csv")));
  expect_rays_refused(six + "15,15,500,0,0,-1,3\n", "line 8 (ray 6): 7 fields");
  expect_rays_refused(header + "15,15,500,0,0,0\n", "line 2 (ray 0): direction is zero");
  expect_rays_refused(header + "15,nan,500,0,0,-1\n", "line 2 (ray 0): origin is not finite");
  expect_rays_refused(header + "15,15,500,0,0,nan\n", "line 2 (ray 0): direction is not finite");
  expect_rays_refused(header + "15,15,high,0,0,-1\n", "'high' in column 'z'");
  expect_rays_refused("", "empty file");
  expect_rays_refused("x,y,z\n1,2,3\n", "no column 'dx'");
  expect_rays_refused(header + good + good, "line 2 (ray 0): its range has no end", {"--wrap", "periodic"});
  const std::string on_surface = "x,y,z,dx,dy,dz,start_col,start_row\n15,15,0,0,0,1,";
  expect_rays_refused(on_surface + "4,0\n", "line 2 (ray 0): it starts on the surface of cell (4, 0)");
  expect_rays_refused("ray,x,y,z,dx,dy,dz\n1,15,15,500,0,0,-1\n", "column 'ray'");
  expect_rays_refused(header + "-184,36,500,0,0,-1\n1015,2015,500,0,0,-1\n", "line 3 (ray 1): (1015, 2015)",
                      {"--coords", "lonlat", "--crs", "EPSG:32616"});
  expect_refused({"--rays", path("no.csv")}, "cannot be opened");
  expect_refused({"--rays", path("")}, "is a directory");
  expect_refused({"--rays", write("rays.npy", "\x93NUMPY")}, "rays.npy");
}

TEST_F(Cast, RejectsInvalidOptions) {
  const std::string good = "x,y,z,dx,dy,dz\n15,15,500,0,0,-1\n";
  expect_refused({}, "--rays");
  expect_rays_refused(good, "--coords 'EPSG:4326': expected local, map or lonlat", {"--coords", "EPSG:4326"});
  expect_rays_refused(good, "--crs 'lonlat': expected a CRS, for example EPSG:4326 (--coords", {"--crs", "lonlat"});
  expect_rays_refused(good, "(specify one, or use map coordinates)", {"--coords", "lonlat"});
  expect_rays_refused(good, "bilinear or triangles", {"--surface", "spline"});
  expect_rays_refused(good, "none, periodic or shared", {"--wrap", "mirror"});
  expect_rays_refused(good, "not shared", {"--wrap", "shared"});
  expect_rays_refused(good, "above 0", {"--exaggeration", "0"});
  expect_rays_refused(good, "unknown", {"--march", "quick"});
  expect_rays_refused(good, "march 'sphere-trace': is not for terrain (available: exhaustive, max-mip",
                      {"--march", "sphere-trace"});
  expect_rays_refused(good, "correct --crs or --bounds", {"--crs", "EPSG:4326"});
  hills();
  rays(good);
  for (const std::string output : {"hits.txt", "no/hits.csv"}) {
    const auto result = run({"cast", path("hills.asc"), "--rays", path("rays.csv"), "-o", path(output)});
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(test::lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(" " + path(output) + ": "), std::string::npos) << result.err;
  }
  EXPECT_NE(run({"cast", path("missing.tif"), "--rays", path("rays.csv")}).err.find("missing.tif"), std::string::npos);
}

TEST_F(Cast, RaysFarFromTheRasterPrintItsExtent) {
  const auto note_of = [&](const std::string& ray) {
    return run({"cast", hills(), "--rays", rays("x,y,z,dx,dy,dz\n" + ray + "\n")}).err;
  };
  const std::string note = "map coordinates x 1000 to 1040, y 2000 to 2030";
  EXPECT_NE(note_of("15,15,500,0,0,-1").find(note), std::string::npos);
  EXPECT_EQ(note_of("1015,2015,500,0,0,1").find(note), std::string::npos) << "over it";
  EXPECT_EQ(note_of("990,2015,500,1,0,-10").find("nothing was hit"), std::string::npos) << "a hit";
}

TEST_F(Cast, WarnsThatAFieldWithoutCellsIsNeverHit) {
  const auto result = run({"cast", write("row.asc", "ncols 3\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n"),
                           "--rays", rays("x,y,z,dx,dy,dz\n1,0.5,9,0,0,-1\n")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("every ray misses"), std::string::npos) << result.err;
  EXPECT_EQ(rows_of(result.out).at(0).at("status"), "miss");
}

TEST_F(Cast, WarnsThatAFieldWithoutCompleteCellsIsNeverHit) {
  const auto result = run({"cast",
                           write("board.asc",
                                 "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n"
                                 "1 -9 1\n-9 1 -9\n1 -9 1\n"),
                           "--rays", rays("x,y,z,dx,dy,dz\n1,1,9,0,0,-1\n")});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("none of the 4 cells has four valid samples"), std::string::npos) << result.err;
  EXPECT_EQ(rows_of(result.out).at(0).at("status"), "miss");
}

#ifdef SCARP_VULKAN
// Rows from a device match the CPU's within delta of numerics.md. The CPU's rays are raised and lowered by delta: where
// all three answers of the CPU agree, the device's answer agrees with them, and its hit is no farther from the CPU's
// than theirs are.
TEST_F(Cast, DeviceMatchesCpu) {
  const auto devices = nlohmann::json::parse(test::run_on_device({"devices", "--json"}).out);
  if (devices["devices"].empty()) GTEST_SKIP() << std::string(devices["why_none"]);
  // A field with a shared border and a hole; cells of 1 m, heights from 100 to 105.
  constexpr int kSide = 9;
  constexpr double kDelta = 2 * 16 * 0x1p-24 * (3 * 5 + (2 * kSide + 1) * 5);
  std::string field =
      fmt::format("ncols {0}\nnrows {0}\nxllcenter 0\nyllcenter 0\ncellsize 1\nNODATA_value -9999\n", kSide);
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      const int height = 100 + (3 * (col % (kSide - 1)) + 5 * (row % (kSide - 1))) % 6;
      field += row == 4 && col == 5 ? "-9999 " : fmt::format("{} ", height);
    }
  }
  const std::string dem = write("shared.asc", field);
  const auto table = [&](double raised) {
    std::string text = "x,y,z,dx,dy,dz,t_max\n";
    for (int i = 0; i < 200; ++i) {
      const double x = 0.37 + 0.0401 * i, dx = (i * 7 % 13 - 6) * 0.31, dy = (i * 5 % 11 - 5) * 0.27;
      const bool below = i % 20 == 19;
      text += fmt::format("{},{},{},{},{},{},30\n", x, 8.11 - x, (below ? 98.5 : 105.4) + raised, dx, dy,
                          i % 20 == 18 ? 0.4 : -0.35);
    }
    return text;
  };
  const auto cast = [&](double raised, Names more) {
    Names arguments{"cast", dem, "--rays", rays(table(raised))};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = test::run_on_device(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return rows_of(result.out);
  };
  for (const std::string wrap : {"none", "shared"}) {
    const Names options{"--wrap", wrap};
    const auto cpu = cast(0, options), low = cast(-kDelta, options), high = cast(kDelta, options);
    const auto device = cast(0, {"--wrap", wrap, "--device", "auto"});
    const auto blocked = cast(0, {"--wrap", wrap, "--any", "--device", "auto"});
    ASSERT_EQ(device.size(), cpu.size());
    std::map<std::string, int> compared;
    for (std::size_t i = 0; i < cpu.size(); ++i) {
      EXPECT_EQ(blocked[i].at("blocked") == "1", device[i].at("status") == "hit") << i;
      const std::string status = cpu[i].at("status");
      if (low[i].at("status") != status || high[i].at("status") != status) continue;
      ++compared[status];
      ASSERT_EQ(device[i].at("status"), status) << i;
      if (status != "hit") continue;
      const double t = number(cpu[i], "t");
      const double off = std::max(std::abs(number(low[i], "t") - t), std::abs(number(high[i], "t") - t));
      // The device's time is two floats, relative to a start in double.
      EXPECT_LE(std::abs(number(device[i], "t") - t), off + 0x1p-22 * t) << i;
    }
    EXPECT_GT(compared["hit"], 60) << wrap;
    EXPECT_GT(compared["miss"], 5) << wrap;
    EXPECT_GT(compared["below"], 2) << wrap;
  }
  expect_rays_refused("x,y,z,dx,dy,dz\n15,15,500,0,0,-1\n", "--all --device auto: devices return only the first hit",
                      {"--all", "--device", "auto"});
  expect_rays_refused("x,y,z,dx,dy,dz\n15,15,500,0,0,-1\n", "march 'exhaustive' does not run on Vulkan devices",
                      {"--march", "exhaustive", "--device", "auto"});
}
#endif

}  // namespace
}  // namespace scarp
