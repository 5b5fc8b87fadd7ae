// SPDX-License-Identifier: MIT
// `scarp cast --scanner` from outside: a scanner file in, points out.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <map>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "cli/csv_rows.h"
#include "cli/program.h"
#include "cli/refused.h"
#include "full_disk.h"
#include "scene/lidar_rounding.h"

namespace scarp {
namespace {

using test::Names;
using test::number;
using test::Row;
using test::rows_of;
using test::run;

// Runs `cast`; an ESRI grid gets --crs none, because a note would mention the missing CRS.
test::Result cast(Names arguments) {
  arguments.insert(arguments.begin(), "cast");
  if (arguments[1].ends_with(".asc")) arguments.insert(arguments.end(), {"--crs", "none"});
  return run(arguments);
}

constexpr double kScanDegree = std::numbers::pi / 180;
const std::string kHead = "time,column,channel,azimuth,elevation,range,x,y,z,object\n";

class Scan : public testing::Test {
 protected:
  static constexpr int kSide = 101;

  std::string path(const std::string& name) const { return scratch_.path(name); }
  std::string write(const std::string& name, const std::string& text) const { return scratch_.write(name, text); }

  // An ESRI ASCII grid with its south-west node at (1000, 2000), cells of 10.
  template <class Height>
  std::string grid(const std::string& name, const Height& height) const {
    std::string text =
        fmt::format("ncols {0}\nnrows {0}\nxllcenter 1000\nyllcenter 2000\ncellsize 10\nNODATA_value -9999\n", kSide);
    for (int row = 0; row < kSide; ++row) {
      for (int col = 0; col < kSide; ++col) text += fmt::format("{:.2f} ", height(col, row));
      text += "\n";
    }
    return write(name, text);
  }
  std::string flat() const {
    return grid("flat.asc", [](int, int) { return 100.0; });
  }
  static double hill(int col, int row) {
    return 100 + 20 * std::sin(0.11 * col) * std::cos(0.09 * row) + 2 * std::sin(0.9 * col + row);
  }
  // Largest height difference between neighbouring nodes: 20 * 0.11 + 4 * sin(0.45), and less along the other axis.
  static constexpr double kSteepestEdge = 4;
  std::string hills() const { return grid("hills.asc", hill); }
  // Height between the nodes of hills(), which are written in hundredths.
  static std::optional<double> height_of_hills(double x, double y) {
    const double col = (x - 1000) / 10, row = (2000 + 10 * (kSide - 1) - y) / 10;
    if (!(col >= 0 && col < kSide - 1 && row >= 0 && row < kSide - 1)) return {};
    const int c = static_cast<int>(col), r = static_cast<int>(row);
    const auto node = [&](int a, int b) { return std::round(100 * hill(c + a, r + b)) / 100; };
    const double u = col - c, v = row - r;
    return (1 - v) * ((1 - u) * node(0, 0) + u * node(1, 0)) + v * ((1 - u) * node(0, 1) + u * node(1, 1));
  }
  std::string scanner(const std::string& place, const std::string& more = "",
                      const std::string& elevations = "[5, -10, -30]") const {
    return write("car.json", fmt::format("{{\"elevations\": {}, \"azimuths\": {{\"count\": 36}}, \"rate\": 10, {}{}}}",
                                         elevations, place, more));
  }
  std::string still() const { return scanner(R"("pose": {"at": [1500, 2500], "above": 1.5, "heading": 45})"); }

  // One line on stderr that contains the fragment, and no file left.
  void expect_refused(const Names& arguments, const std::string& fragment) const {
    const Names before = scratch_.files();
    expect_refusal(run(arguments), before, fragment);
  }
  void expect_refusal(const test::Result& result, const Names& before, const std::string& fragment) const {
    test::expect_refused(result, fragment);
    EXPECT_EQ(scratch_.files(), before);
  }

  test::Scratch scratch_;
};

TEST_F(Scan, MeasuresAPlain) {
  const auto result = cast({flat(), "--scanner", still()});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  ASSERT_EQ(result.out.find(kHead), 0u);
  const std::vector<Row> rows = rows_of(result.out);
  ASSERT_EQ(rows.size(), 36u * 2u) << "rays above the horizon are left out";
  constexpr double kWritten = 0x1p-16;  // half a unit of floats from 256 to 512 degrees
  for (const Row& row : rows) {
    const double elevation = number(row, "channel") == 1 ? -10 : -30;
    const double azimuth = std::fmod(45 + 10 * number(row, "column"), 360);
    EXPECT_NEAR(number(row, "elevation"), elevation, test::room_of_angle() / kScanDegree + kWritten);
    EXPECT_NEAR(number(row, "azimuth"), azimuth, test::room_of_angle(elevation * kScanDegree) / kScanDegree + kWritten);
    EXPECT_DOUBLE_EQ(number(row, "time"), number(row, "column") / 360);
    const double away = 1.5 / std::tan(-elevation * kScanDegree), range = 1.5 / std::sin(-elevation * kScanDegree);
    const double off = test::room_on_plain(range, elevation * kScanDegree);
    EXPECT_NEAR(number(row, "range"), range, off);
    EXPECT_NEAR(number(row, "x"), 1500 + away * std::sin(azimuth * kScanDegree), off);
    EXPECT_NEAR(number(row, "y"), 2500 + away * std::cos(azimuth * kScanDegree), off);
    EXPECT_NEAR(number(row, "z"), 100, off);
    EXPECT_EQ(row.at("object"), "0");
  }
}

// Neither a pipe nor what a file already has in it is overwritten.
TEST_F(Scan, StandardOutputIsNeverRewound) {
  const std::string words = fmt::format("{} cast '{}' --crs none --scanner '{}'", SCARP_PROGRAM, flat(), still());
  const auto said = [&](const std::string& command) {
    const std::string out = path("said");
    EXPECT_EQ(std::system(fmt::format("({}) >'{}'", command, out).c_str()), 0) << command;
    return test::text_of(out);
  };
  const std::string points = cast({flat(), "--scanner", still()}).out;
  EXPECT_GT(points.size(), 1000u);
  EXPECT_EQ(said("{ " + words + "; echo status $?; } | cat"), points + "status 0\n");
  EXPECT_EQ(said("echo before; " + words + "; " + words), "before\n" + points + points);
}

TEST_F(Scan, MissesAreWrittenOnRequest) {
  const auto result = cast({flat(), "--scanner", still(), "--misses"});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::vector<Row> rows = rows_of(result.out);
  ASSERT_EQ(rows.size(), 36u * 3u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].at("channel"), std::to_string(i % 3));
    EXPECT_EQ(rows[i].at("range").empty(), i % 3 == 0);
    EXPECT_EQ(rows[i].at("x").empty(), i % 3 == 0);
  }
  for (const char* output : {"o.las", "o.ply"})
    expect_refused({"cast", flat(), "--scanner", still(), "--misses", "-o", path(output)},
                   fmt::format("--misses: '{}' holds points only (write .csv or .npy)", path(output)));
}

// Every file has the same points.
TEST_F(Scan, FormatsAgree) {
  const std::string ground = hills(), lidar = still();
  const std::vector<Row> rows = rows_of(cast({ground, "--scanner", lidar}).out);
  ASSERT_GT(rows.size(), 40u);
  std::map<std::string, std::string> files;
  for (const char* name : {"o.csv", "o.npy", "o.ply", "o.las"}) {
    const auto result = cast({ground, "--scanner", lidar, "-o", path(name)});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out + result.err, "");
    files[name] = test::text_of(path(name));
  }
  EXPECT_EQ(rows_of(files["o.csv"]), rows);
  const auto at = [](const std::string& bytes, std::size_t offset) {
    double number = 0;
    std::memcpy(&number, bytes.data() + offset, sizeof number);
    return number;
  };
  const std::size_t count = rows.size();
  const std::size_t npy = files["o.npy"].size() - count * 60, ply = files["o.ply"].size() - count * 60;
  std::uint32_t las = 0;
  std::uint64_t points = 0;
  std::memcpy(&las, files["o.las"].data() + 96, sizeof las);
  std::memcpy(&points, files["o.las"].data() + 247, sizeof points);
  EXPECT_EQ(points, count);
  ASSERT_EQ(files["o.las"].size(), las + count * 40);
  for (std::size_t i = 0; i < count; ++i) {
    const char* axes[] = {"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double expected = number(rows[i], axes[axis]);
      EXPECT_EQ(at(files["o.npy"], npy + i * 60 + 32 + 8 * axis), expected);
      EXPECT_EQ(at(files["o.ply"], ply + i * 60 + 8 * axis), expected);
      std::int32_t steps = 0;
      std::memcpy(&steps, files["o.las"].data() + las + i * 40 + 4 * axis, sizeof steps);
      const double scale = at(files["o.las"], 131 + 8 * axis), offset = at(files["o.las"], 155 + 8 * axis);
      EXPECT_LE(std::abs(steps * scale + offset - expected), 0.5 * scale * (1 + 0x1p-20)) << "half a step, rounded";
    }
    EXPECT_EQ(at(files["o.las"], las + i * 40 + 22), number(rows[i], "time"));
  }
}

// The fan of max-mip, batches of other marches, and a scene with a mesh or of other fields.
TEST_F(Scan, MarchesAgree) {
  const std::string ground = hills(), lidar = still();
  const std::vector<Row> fan = rows_of(cast({ground, "--scanner", lidar}).out);
  const std::vector<Row> judge = rows_of(cast({ground, "--scanner", lidar, "--march", "exhaustive"}).out);
  ASSERT_EQ(fan.size(), judge.size());
  for (std::size_t i = 0; i < fan.size(); ++i) {
    EXPECT_EQ(fan[i].at("column"), judge[i].at("column"));
    EXPECT_EQ(fan[i].at("channel"), judge[i].at("channel"));
    const auto at = [](const Row& row) { return dvec3(number(row, "x"), number(row, "y"), number(row, "z")); };
    const double range = number(judge[i], "range");
    EXPECT_TRUE(
        test::is_one_hit(at(fan[i]), at(judge[i]), range, test::room_above(range, kSteepestEdge, 10), height_of_hills))
        << i;
  }
}

TEST_F(Scan, FollowsAPathOverGround) {
  write("drive.csv", "time,x,y,above,heading\n0,1200,2300,2,90\n1,1600,2300,2,90\n");
  const std::string lidar = write(
      "drive.json",
      R"({"elevations": [-90], "azimuths": {"count": 4}, "rate": 5, "path": "drive.csv", "mounting": {"forward": 3}})");
  const auto result = cast({flat(), "--scanner", lidar});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::vector<Row> rows = rows_of(result.out);
  ASSERT_EQ(rows.size(), 21u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double off = test::room_on_plain(2, 0.5 * std::numbers::pi);
    EXPECT_DOUBLE_EQ(number(rows[i], "time"), 0.05 * static_cast<double>(i));
    EXPECT_NEAR(number(rows[i], "x"), 1203 + 20 * static_cast<double>(i), off);
    EXPECT_NEAR(number(rows[i], "y"), 2300, off);
    EXPECT_NEAR(number(rows[i], "range"), 2, off);
  }
  expect_refused({"cast", flat(), "--scanner", lidar, "-o", path("drive.csv")}, "is the input");
}

TEST_F(Scan, ScansOtherInputs) {
  const auto function = cast(
      {"--function", "hills", "--scanner", scanner(R"("pose": {"at": [0, 0], "above": 5})", R"(, "range": [0, 300])")});
  EXPECT_EQ(function.status, 0) << function.err;
  EXPECT_GT(rows_of(function.out).size(), 20u);
  // A ball of radius 5 on the plain is the second object.
  flat();
  const std::string scene = write("scene.json", R"({"objects": [
    {"heights": {"file": "flat.asc"}},
    {"shape": {"sphere": {"radius": 5}}, "at": [500, 520, 105]}]})");
  const std::string lidar = scanner(R"("pose": {"at": [500, 500, 105]})", "", "[0, -45]");
  const auto result = cast({scene, "--scanner", lidar});
  ASSERT_EQ(result.status, 0) << result.err;
  int on_ball = 0;
  for (const Row& row : rows_of(result.out)) {
    if (row.at("object") != "1") continue;
    ++on_ball;
    EXPECT_NEAR(std::hypot(number(row, "x") - 500, number(row, "y") - 520, number(row, "z") - 105), 5, 1e-3);
  }
  EXPECT_EQ(on_ball, 3) << "at azimuths of -10, 0 and 10 degrees";
}

TEST_F(Scan, NoiseIsOffByDefaultAndRepeatable) {
  const std::string pose = R"("pose": {"at": [1500, 2500], "above": 1.5})";
  const auto scan = [&](const std::string& more) { return cast({flat(), "--scanner", scanner(pose, more)}).out; };
  const std::string exact = scan(""), a = scan(R"(, "noise": {"range": 0.02})"),
                    b = scan(R"(, "noise": {"range": 0.02})"), c = scan(R"(, "noise": {"range": 0.02, "seed": 2})");
  EXPECT_EQ(exact, scan(R"(, "noise": {"range": 0})"));
  EXPECT_NE(exact, a);
  EXPECT_EQ(a, b);
  EXPECT_NE(a, c);
}

TEST_F(Scan, ThreadsDoNotChangeThePoints) {
  const std::string ground = hills();
  const std::string lidar = scanner(R"("pose": {"at": [1500, 2500], "above": 1.5, "pitch": 7})", R"(, "turns": 300)");
  cast({ground, "--scanner", lidar, "-o", path("a.npy"), "--threads", "1"});
  cast({ground, "--scanner", lidar, "-o", path("b.npy"), "--threads", "3"});
  EXPECT_EQ(test::text_of(path("a.npy")), test::text_of(path("b.npy")));
  EXPECT_GT(test::text_of(path("a.npy")).size(), 100000u);
}

TEST_F(Scan, ScansWithoutPointsWriteValidFilesAndANote) {
  const std::string up = scanner(R"("pose": {"at": [1500, 2500], "above": 1.5})", "", "[30, 60]");
  for (const char* name : {"o.csv", "o.npy", "o.ply", "o.las"}) {
    const auto result = cast({flat(), "--scanner", up, "-o", path(name)});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "note: nothing was hit: all 72 rays end above the ground, or beyond the range\n");
    EXPECT_GT(test::text_of(path(name)).size(), 20u);
  }
  EXPECT_EQ(test::text_of(path("o.csv")), kHead);
  const auto beside = cast({flat(), "--scanner", scanner(R"("pose": {"at": [0, 0, 150]})")});
  EXPECT_EQ(beside.status, 0);
  EXPECT_EQ(beside.err.find("note: nothing was hit: the scanner starts at x 0, y 0; the scene is in map coordinates x "
                            "1000 to 2000, y 2000 to 3000"),
            0u)
      << beside.err;
  const auto below = cast({flat(), "--scanner", scanner(R"("pose": {"at": [1500, 2500, 50]})")});
  EXPECT_NE(below.err.find("rays start below ground, or enter it"), std::string::npos) << below.err;
  const auto none = cast({flat(), "--scanner", scanner(R"("path": [{"time": 0, "at": [1500, 2500], "above": 1,
      "heading": 0}, {"time": 1, "at": [1510, 2500], "above": 1, "heading": 0}], "time_offsets": [0, 0, 2])")});
  EXPECT_EQ(none.err, "note: the path is shorter than a column of the scanner: 0 rays, and no points in the output\n");
}

TEST_F(Scan, ErrorsSuggestARemedy) {
  const std::string ground = flat(), lidar = still(), rays = write("rays.csv", "x,y,z,dx,dy,dz\n1,2,3,0,0,-1\n");
  expect_refused({"cast", ground}, "--rays FILE or --scanner FILE is required");
  expect_refused({"cast", ground, "--rays", rays, "--scanner", lidar}, "--scanner");
  expect_refused({"cast", ground, "--rays", rays, "--misses"}, "--misses has no effect without --scanner FILE");
  expect_refused({"cast", ground, "--scanner", lidar, "--any"}, "--any");
  expect_refused({"cast", ground, "--scanner", lidar, "--all"}, "--all");
  expect_refused({"cast", ground, "--scanner", lidar, "-o", path("o.laz")}, "end the name in .csv, .npy, .ply or .las");
  expect_refused({"cast", ground, "--rays", rays, "-o", path("o.las")}, "end the name in .csv or .npy");
  expect_refused({"cast", ground, "--scanner", lidar, "-o", lidar}, "is the input");
  expect_refused({"cast", ground, "--scanner", path("none.json")}, "none.json: cannot be read; is it there?");
  expect_refused({"cast", ground, "--scanner", ground}, "flat.asc: no JSON");
  expect_refused({"cast", ground, "--scanner", scanner(R"("pose": {"at": [1, 2], "above": 3})")},
                 "car.json: /pose: there is no ground at 1,2, outside the bounds in map coordinates");
  expect_refused({"cast", ground, "--wrap", "periodic", "--scanner", lidar}, "scanner: has no largest range");
  expect_refused({"cast", ground, "--scanner", lidar, "--coords", "lonlat"}, "flat.asc: ");
  write("drive.csv", "time,lon,lat,above,heading\n0,1,2,2,90\n1,1.1,2,2,90\n");
  expect_refused({"cast", ground, "--scanner", scanner(R"("path": "drive.csv")")}, "(give --coords lonlat)");
  write("drive.csv", "time,x,y,above,heading\n0,1200,2300,2,90\n1,1300,nan,2,90\n");
  expect_refused({"cast", ground, "--scanner", scanner(R"("path": "drive.csv")")},
                 "drive.csv: line 3: y 'nan' is not a finite number");
}

TEST_F(Scan, FullDiskLeavesNoFile) {
  const std::string ground = flat();
  const std::string lidar = scanner(R"("pose": {"at": [1500, 2500], "above": 1.5})", R"(, "turns": 300)");
  const Names before = scratch_.files();
  const test::FullDisk disk(400000);
  for (const char* name : {"o.csv", "o.npy", "o.ply", "o.las"}) {
    test::Program program({"cast", ground, "--scanner", lidar, "-o", path(name)});
    expect_refusal(program.result(), before, "cannot be written (is the disk full?)");
  }
}

TEST_F(Scan, InterruptLeavesNoFile) {
  const std::string ground = flat();
  const std::string lidar = scanner(R"("pose": {"at": [1500, 2500], "above": 1.5})", R"(, "turns": 1000000)");
  const Names before = scratch_.files();
  test::Program program({"cast", ground, "--scanner", lidar, "-o", path("o.las")});
  for (int i = 0; i < 10000 && scratch_.files() == before; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_NE(scratch_.files(), before);
  ::kill(program.pid(), SIGINT);
  const auto result = program.result();
  EXPECT_EQ(result.status, 128 + SIGINT) << result.err;
  EXPECT_EQ(scratch_.files(), before);
}

// LAS coordinates are degrees in steps of 1e-8, and the CRS is WKT 1.
TEST_F(Scan, LasInDegreesKeepsMillimetres) {
  const std::string ground = grid("flat.asc", [](int, int) { return 100.0; });
  const Names raster = {"--crs", "EPSG:4326", "--bounds=10,0,10.01,0.01"};
  const std::string lidar = scanner(R"("pose": {"at": [10.005, 0.005], "above": 1.5})");
  for (const char* crs : {"map", "lonlat"}) {
    Names arguments = {"cast", ground, "--scanner", lidar, "--coords", crs, "-o", path("o.las")};
    arguments.insert(arguments.end(), raster.begin(), raster.end());
    const auto result = run(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
    const std::string las = test::text_of(path("o.las"));
    double scale = 0;
    std::memcpy(&scale, las.data() + 131, sizeof scale);
    EXPECT_EQ(scale, 1e-8);
    EXPECT_EQ(las.substr(375 + 2, 15), "LASF_Projection");
    EXPECT_EQ(las.substr(375 + 54, 7), "GEOGCS[");
  }
  Names arguments = {"cast",     ground,  "--scanner", scanner(R"("pose": {"at": [500, 500], "above": 1.5})"),
                     "--coords", "local", "-o",        path("o.las")};
  arguments.insert(arguments.end(), raster.begin(), raster.end());
  ASSERT_EQ(run(arguments).status, 0);
  EXPECT_EQ(test::text_of(path("o.las")).substr(375 + 2, 9), "LASF_Spec") << "local metres have no CRS";
}

}  // namespace
}  // namespace scarp
