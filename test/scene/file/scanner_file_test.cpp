// SPDX-License-Identifier: MIT
#include "scarp/scene/file/scanner_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "base/refusal.h"
#include "scarp/base/error.h"

namespace scarp {
namespace {

namespace fs = std::filesystem;

constexpr double kRadiansPerDegreeHere = std::numbers::pi / 180;

// A scanner of these parts; each of the first four may be left out.
std::string scanner_text(const std::string& elevations = R"("elevations": [2, -10])",
                         const std::string& azimuths = R"("azimuths": {"count": 360})",
                         const std::string& rate = R"("rate": 10)",
                         const std::string& place = R"("pose": {"at": [1, 2, 3]})", const std::string& more = "") {
  std::string text;
  for (const std::string& part : {elevations, azimuths, rate, place, more}) {
    if (!part.empty()) text += (text.empty() ? "" : ", ") + part;
  }
  return "{" + text + "}";
}

std::string with_more(const std::string& more) { return scanner_text().insert(scanner_text().size() - 1, ", " + more); }

TEST(ScannerFile, ReadsAStationaryScanner) {
  const ScannerFile file = parse_scanner(R"({
    "about": "test",
    "elevations": {"from": 2, "to": -24, "count": 27},
    "azimuths": {"from": -60, "step": 0.1, "count": 1200},
    "rate": 5, "turns": 3, "range": [0.5, 80],
    "noise": {"range": 0.02, "seed": 7},
    "mounting": {"forward": 1, "right": -0.5, "up": 1.7, "yaw": 10, "pitch": -2, "roll": 0.5},
    "pose": {"at": [500, 300], "above": 1.5, "heading": 90, "pitch": 1, "roll": -1}})",
                                         "");
  const Lidar& lidar = file.lidar;
  EXPECT_NO_THROW(validate(lidar));
  ASSERT_EQ(lidar.channels(), 27u);
  for (int i = 0; i < 27; ++i)
    EXPECT_NEAR(lidar.elevations[static_cast<std::size_t>(i)], (2 - i) * kRadiansPerDegreeHere, 1e-15);
  EXPECT_NEAR(lidar.first_azimuth, -60 * kRadiansPerDegreeHere, 1e-15);
  EXPECT_NEAR(lidar.azimuth_step, 0.1 * kRadiansPerDegreeHere, 1e-15);
  EXPECT_EQ(lidar.columns, 1200);
  EXPECT_EQ(lidar.rate, 5);
  EXPECT_EQ(lidar.turns, 3);
  EXPECT_EQ(lidar.min_range, 0.5);
  EXPECT_EQ(lidar.max_range, 80);
  EXPECT_EQ(lidar.range_noise, 0.02);
  EXPECT_EQ(lidar.seed, 7u);
  EXPECT_EQ(lidar.mounting.forward, 1);
  EXPECT_EQ(lidar.mounting.right, -0.5);
  EXPECT_EQ(lidar.mounting.up, 1.7);
  EXPECT_NEAR(lidar.mounting.yaw, 10 * kRadiansPerDegreeHere, 1e-15);
  EXPECT_NEAR(lidar.mounting.pitch, -2 * kRadiansPerDegreeHere, 1e-15);
  EXPECT_NEAR(lidar.mounting.roll, 0.5 * kRadiansPerDegreeHere, 1e-15);
  EXPECT_TRUE(lidar.above_ground);
  ASSERT_EQ(lidar.path.size(), 1u);
  EXPECT_EQ(lidar.path[0].position, dvec3(500, 300, 1.5));
  EXPECT_NEAR(lidar.path[0].heading, 90 * kRadiansPerDegreeHere, 1e-15);
  EXPECT_NEAR(lidar.path[0].pitch, kRadiansPerDegreeHere, 1e-15);
  EXPECT_NEAR(lidar.path[0].roll, -kRadiansPerDegreeHere, 1e-15);
}

TEST(ScannerFile, DefaultsAreAWholeTurnWithoutNoise) {
  const Lidar lidar = parse_scanner(scanner_text(), "").lidar;
  EXPECT_NEAR(lidar.azimuth_step, kRadiansPerDegreeHere, 1e-15);
  EXPECT_EQ(lidar.first_azimuth, 0);
  EXPECT_EQ(lidar.turns, 1);
  EXPECT_EQ(lidar.range_noise, 0);
  EXPECT_EQ(lidar.min_range, 0);
  EXPECT_TRUE(std::isinf(lidar.max_range));
  EXPECT_FALSE(lidar.above_ground);
  EXPECT_EQ(lidar.path.at(0).heading, 0);
}

// 3600 steps of 0.1 degrees are a full turn, although the sum of these doubles is larger.
TEST(ScannerFile, StepsThatFillATurnAreAccepted) {
  for (const int count : {7, 360, 1800, 3600, 36000}) {
    for (const char* sign : {"", "-"}) {
      const std::string azimuths = "\"azimuths\": {\"step\": " + std::string(sign) + std::to_string(360.0 / count) +
                                   ", \"count\": " + std::to_string(count) + "}";
      EXPECT_NO_THROW(validate(
          parse_scanner(scanner_text(R"("elevations": [0])", count == 7 ? R"("azimuths": {"count": 7})" : azimuths), "")
              .lidar))
          << azimuths;
    }
  }
}

TEST(ScannerFile, ReadsAPath) {
  const ScannerFile file =
      parse_scanner(scanner_text(R"("elevations": [2, -10])", R"("azimuths": {"count": 360})", R"("rate": 10)",
                                 R"("path": [{"time": 0, "at": [1, 2], "above": 1, "heading": 0},
                      {"time": 0.5, "at": [3, 2], "above": 1, "heading": 90, "roll": 3}])",
                                 R"("time_offsets": [0, 1e-5], "azimuth_offsets": [-1.5, 2])"),
                    "");
  const Lidar& lidar = file.lidar;
  EXPECT_NO_THROW(validate(lidar));
  ASSERT_EQ(lidar.path.size(), 2u);
  EXPECT_EQ(lidar.path[1].time, 0.5);
  EXPECT_TRUE(lidar.above_ground);
  EXPECT_EQ(lidar.time_offsets.at(1), 1e-5);
  EXPECT_NEAR(lidar.azimuth_offsets.at(0), -1.5 * kRadiansPerDegreeHere, 1e-15);
  EXPECT_EQ(file.places.at(1), "/path/1");
}

TEST(ScannerFile, ReadsThePathFromATableBesideTheFile) {
  std::string name = (fs::temp_directory_path() / "scarp-scanner-XXXXXX").string();
  const fs::path folder = ::mkdtemp(name.data());
  std::ofstream(folder / "drive.csv") << "time,lon,lat,z,heading\n0,10,0,5,350\n1,10.1,0,5,10\n";
  std::ofstream(folder / "car.json") << scanner_text(R"("elevations": [0])", R"("azimuths": {"count": 9})",
                                                     R"("rate": 1)", R"("path": "drive.csv")");
  std::ofstream(folder / "short.csv") << "time,x,y,z,heading\n0,10,0,5,350\n";
  std::ofstream(folder / "short.json") << scanner_text(R"("elevations": [0])", R"("azimuths": {"count": 9})",
                                                       R"("rate": 1)", R"("path": "short.csv")");
  const ScannerFile file = read_scanner((folder / "car.json").string());
  EXPECT_TRUE(file.lonlat);
  EXPECT_EQ(file.lidar.path.at(1).position, dvec3(10.1, 0, 5));
  EXPECT_EQ(file.files, std::vector<std::string>{(folder / "drive.csv").string()});
  EXPECT_EQ(file.places.at(1), (folder / "drive.csv").string() + ": line 3");
  const std::string one = test::refusal([&] { read_scanner((folder / "short.json").string()); });
  EXPECT_NE(one.find("short.json: /path: \"short.csv\" has one pose; expected two or more"), std::string::npos) << one;
  const std::string none = test::refusal([&] { read_scanner(folder.string()); });
  EXPECT_NE(none.find("is a folder; give the file of a scanner"), std::string::npos) << none;
  fs::remove_all(folder);
}

TEST(ScannerFile, ErrorsNameThePositionAndTheExpectedValue) {
  const std::string e = R"("elevations": [2, -10])", a = R"("azimuths": {"count": 360})", r = R"("rate": 10)",
                    p = R"("pose": {"at": [1, 2, 3]})";
  const struct {
    std::string text, fragment;
  } cases[] = {
      {"", "no JSON"},
      {scanner_text().substr(0, 40), "no JSON"},
      {"[]", "/: is a list of 0; expected an object"},
      {"{}", "/elevations: is missing; expected degrees above the horizon"},
      {scanner_text(""), "/elevations: is missing"},
      {scanner_text(e, ""), "/azimuths: is missing; expected an object"},
      {scanner_text(e, a, ""), "/rate: is missing; expected turns per second"},
      {scanner_text(e, a, r, ""), "/pose: is missing; expected where the scanner stands, or /path"},
      {scanner_text(R"("elevations": [])"), "/elevations: is a list of 0; expected a list of 1 to 4096"},
      {scanner_text(R"("elevations": 3)"), "/elevations: is 3; expected degrees above the horizon"},
      {scanner_text(R"("elevations": [2, "low"])"), "/elevations/1: is \"low\"; expected degrees"},
      {scanner_text(R"("elevations": [91])"), "/elevations/0: is 91; expected degrees above the horizon, -90 to 90"},
      {scanner_text(R"("elevations": [NaN])"), "no JSON: parse error at line 1"},
      {scanner_text(R"("elevations": [1e999])"), "too large"},
      {scanner_text(R"("elevations": {"from": 2, "to": -2})"), "/elevations/count: is missing"},
      {scanner_text(R"("elevations": {"from": 2, "to": -2, "count": 0})"), "/elevations/count: is 0; expected a whole"},
      {scanner_text(R"("elevations": {"from": 2, "to": -2, "count": 1e9})"), "/elevations/count: is 1000000000.0"},
      {scanner_text(R"("elevations": {"from": 2, "to": -2, "count": 9, "step": 1})"), "/elevations/step: unknown"},
      {scanner_text(e, R"("azimuths": 360)"), "/azimuths: is 360; expected an object"},
      {scanner_text(e, R"("azimuths": {})"), "/azimuths/count: is missing"},
      {scanner_text(e, R"("azimuths": {"count": 0})"), "/azimuths/count: is 0; expected a whole number, 1 to 1048576"},
      {scanner_text(e, R"("azimuths": {"count": -3})"), "/azimuths/count: is -3"},
      {scanner_text(e, R"("azimuths": {"count": 99999999999})"), "/azimuths/count: is 99999999999"},
      {scanner_text(e, R"("azimuths": {"count": 361, "step": 1})"), "/azimuths/step: is 1; expected degrees between"},
      {scanner_text(e, R"("azimuths": {"count": 36, "step": 0})"), "/azimuths/step: is 0"},
      {scanner_text(e, R"("azimuths": {"count": 36, "from": 400})"), "/azimuths/from: is 400"},
      {scanner_text(e, a, R"("rate": 0)"), "/rate: is 0; expected turns per second, a number above 0"},
      {scanner_text(e, a, R"("rate": "600 rpm")"), "/rate: is \"600 rpm\"; expected turns per second"},
      {scanner_text(e, a, r, R"("pose": {"heading": 3})"), "/pose/at: is missing; expected [x, y, z]"},
      {scanner_text(e, a, r, R"("pose": {"at": [1, 2]})"), "/pose/at: is a list of 2; expected [x, y, z]"},
      {scanner_text(e, a, r, R"("pose": {"at": [1, 2, 3], "above": 1})"), "/pose/at: is a list of 3"},
      {scanner_text(e, a, r, R"("pose": {"at": [1, null, 3]})"), "/pose/at/1: is null; expected a coordinate"},
      {scanner_text(e, a, r, R"("pose": {"at": [1, 2, 3], "heading": 720})"), "/pose/heading: is 720"},
      {scanner_text(e, a, r, R"("pose": {"at": [1, 2, 3], "yaw": 3})"), "/pose/yaw: unknown (available: "},
      {scanner_text(e, a, r, R"("path": [])"), "/path: is a list of 0; expected a list of two poses or more"},
      {scanner_text(e, a, r, R"("path": [{"time": 0, "at": [1, 2, 3], "heading": 0}])"), "/path: is a list of 1"},
      {scanner_text(e, a, r, R"("path": [{"at": [1, 2, 3], "heading": 0}, {}])"), "/path/0/time: is missing"},
      {scanner_text(e, a, r, R"("path": [{"time": 0, "at": [1, 2, 3]}, {}])"), "/path/0/heading: is missing"},
      {scanner_text(
           e, a, r,
           R"("path": [{"time": 5, "at": [1, 2, 3], "heading": 0}, {"time": 5, "at": [1, 2, 3], "heading": 0}])"),
       "/path/1/time: is 5; expected a time later than 5"},
      {scanner_text(
           e, a, r,
           R"("path": [{"time": 5, "at": [1, 2, 3], "heading": 0}, {"time": 6, "at": [1, 2], "above": 3, "heading": 0}])"),
       "/path/1: expected above in all poses, or in none"},
      {scanner_text(e, a, r, R"("path": "/no/drive.csv")"), "/path: /no/drive.csv: "},
      {scanner_text(e, a, r, p, R"("path": "drive.csv")"), "/path: does not go with pose"},
      {scanner_text(e, a, r, R"("path": "drive.csv")", R"("turns": 2)"), "/turns: does not go with path"},
      {with_more(R"("turns": 1.5)"), "/turns: is 1.5; expected a whole number"},
      {with_more(R"("range": [5, 5])"), "/range: is [5, 5]; expected the smallest and the largest range"},
      {with_more(R"("range": 5)"), "/range: is 5; expected a list of two finite numbers"},
      {with_more(R"("range": [-1, 5])"), "/range: is [-1, 5]"},
      {with_more(R"("noise": 0.02)"), "/noise: is 0.02; expected an object"},
      {with_more(R"("noise": {"range": -1})"), "/noise/range: is -1; expected the standard deviation"},
      {with_more(R"("noise": {"range": 1, "seed": -1})"), "/noise/seed: is -1"},
      {with_more(R"("mounting": {"height": 2})"), "/mounting/height: unknown (available: forward, right, up"},
      {with_more(R"("mounting": {"up": "2 m"})"), "/mounting/up: is \"2 m\"; expected metres"},
      {with_more(R"("time_offsets": [0])"), "/time_offsets: is a list of 1; expected a list of 2 numbers"},
      {with_more(R"("time_offsets": [0, -1])"), "/time_offsets/1: is -1; expected seconds"},
      {with_more(R"("azimuth_offsets": {"a": 1})"), "/azimuth_offsets: is an object; expected a list: degrees"},
      {with_more(R"("rate": 3)"), "/rate: is there twice"},
      {with_more(R"("beams": 3)"), "/beams: unknown (available: "},
  };
  for (const auto& c : cases) {
    const std::string what = test::refusal([&] { parse_scanner(c.text, ""); });
    EXPECT_NE(what.find(c.fragment), std::string::npos) << c.text << ":\n  " << what << "\n  " << c.fragment;
    EXPECT_LT(what.size(), 250u) << what;
  }
  EXPECT_EQ(test::refusal([] { read_scanner("/no/car.json"); }), "/no/car.json: cannot be read; is it there?");
}

}  // namespace
}  // namespace scarp
