// SPDX-License-Identifier: MIT
// Rays of a stationary or moving scanner: ranges and positions match independent formulas, and fans and batches agree.
#include "scarp/scene/lidar.h"
#include "scene/lidar_rounding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "base/refusal.h"
#include "scarp/base/error.h"
#include "scarp/scene/combine.h"

namespace scarp {
namespace {

constexpr double kPi = std::numbers::pi, kDegree = kPi / 180;

// Ground at z = `height`, 20 km wide.
Terrain plain(float height = 0) {
  return Terrain::own(std::vector<float>(21 * 21, height), 21, 21, {.cell_x = 1000, .cell_y = 1000});
}

Terrain hills() {
  std::vector<float> samples;
  for (int row = 0; row < 150; ++row) {
    for (int col = 0; col < 201; ++col)
      samples.push_back(static_cast<float>(20 * std::sin(0.05 * col) * std::cos(0.04 * row) + std::sin(0.7 * col)));
  }
  return Terrain::own(std::move(samples), 201, 150, {.cell_x = 10, .cell_y = 8});
}

Lidar scanner(int columns, std::vector<double> elevations_deg) {
  Lidar lidar;
  for (const double elevation : elevations_deg) lidar.elevations.push_back(elevation * kDegree);
  lidar.columns = columns;
  lidar.azimuth_step = 2 * kPi / columns;
  lidar.path = {{}};
  return lidar;
}

// The greatest height difference along an edge of a cell, with holes as the lowest sample.
double steepest_edge(const Terrain& ground) {
  const HeightField& field = ground.field();
  const auto at = [&](int col, int row) {
    return ground.height((col % field.cols()) * field.settings().cell_x, (row % field.rows()) * field.settings().cell_y)
        .value_or(field.min_height());
  };
  double most = 0;
  for (int row = 0; row < field.rows(); ++row) {
    for (int col = 0; col < field.cols(); ++col) {
      const double here = at(col, row);
      most = std::max({most, std::abs(here - at(col + 1, row)), std::abs(here - at(col, row + 1))});
    }
  }
  return most;
}

// Metres by which a hit of a fan may be above or below the ground, for its range.
auto room_over(const Terrain& ground) {
  const HeightFieldSettings& settings = ground.field().settings();
  return [edge = steepest_edge(ground), cell = std::min(settings.cell_x, settings.cell_y)](double range) {
    return test::room_above(range, edge, cell);
  };
}

std::vector<LidarReturn> all_of(const LidarScan& scan) {
  std::vector<LidarReturn> returns;
  scan.cast(0, scan.columns(), returns);
  return returns;
}

void expect_near(const dvec3& a, const dvec3& b, double tolerance, const std::string& what = "") {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << what << " axis " << i;
}

TEST(LidarScan, RangesOverAPlainFollowFromHeightAndElevation) {
  const Terrain ground = plain(7);
  Lidar lidar = scanner(12, {-80, -30, -1, 0, 40});
  lidar.path[0].position = {10000, 9000, 7 + 30};
  lidar.path[0].time = 5;
  lidar.rate = 4;
  lidar.turns = 2;
  const LidarScan scan(ground, lidar);
  EXPECT_TRUE(scan.by_fans());
  const auto returns = all_of(scan);
  ASSERT_EQ(returns.size(), 2u * 12u * 5u);
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const LidarReturn& answer = returns[i];
    const auto channel = i % 5;
    const auto column = static_cast<int>(i / 5);
    EXPECT_EQ(answer.channel, static_cast<int>(channel));
    EXPECT_EQ(answer.column, column);
    EXPECT_DOUBLE_EQ(answer.time, 5 + column / 12.0 / 4);
    const double azimuth = column % 12 * 30 * kDegree, elevation = lidar.elevations[channel];
    EXPECT_NEAR(static_cast<double>(answer.elevation), elevation, test::room_of_angle());
    EXPECT_NEAR(std::remainder(static_cast<double>(answer.azimuth) - azimuth, 2 * kPi), 0,
                test::room_of_angle(elevation));
    ASSERT_EQ(static_cast<bool>(answer), elevation < 0) << channel;
    if (!answer) {
      EXPECT_TRUE(std::isinf(answer.range));
      continue;
    }
    const double range = 30 / -std::sin(elevation), flat = 30 / std::tan(-elevation);
    const double room = test::room_on_plain(range, elevation);
    EXPECT_NEAR(static_cast<double>(answer.range), range, room);
    expect_near(answer.position, {10000 + flat * std::sin(azimuth), 9000 + flat * std::cos(azimuth), 7}, room);
  }
}

TEST(LidarScan, FansAndBatchesAgree) {
  const Terrain ground = hills();
  Lidar lidar = scanner(100, {3, -2, -12, -7, -25, 0.5, -40});
  lidar.path[0].position = {1003, 597, 45};
  const auto room = room_over(ground);
  const auto height = [&](double x, double y) { return ground.height(x, y); };
  for (const bool tilted : {false, true}) {
    if (tilted) {
      lidar.path[0].heading = 0.7, lidar.path[0].pitch = 0.2, lidar.path[0].roll = -0.1;
      lidar.mounting = {.forward = 1, .right = -2, .up = 3, .yaw = 0.3, .pitch = -0.05, .roll = 0.02};
      for (std::size_t i = 0; i < lidar.channels(); ++i) lidar.azimuth_offsets.push_back(0.01 * static_cast<double>(i));
      lidar.north = 0.01;
    }
    const LidarScan fans(ground, lidar), batches(ground, lidar, LidarWay::batches);
    EXPECT_TRUE(fans.by_fans());
    EXPECT_FALSE(batches.by_fans());
    const auto a = all_of(fans), b = all_of(batches);
    ASSERT_EQ(a.size(), b.size());
    int hits = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(a[i].status, b[i].status) << i;
      EXPECT_EQ(a[i].time, b[i].time);
      EXPECT_EQ(a[i].azimuth, b[i].azimuth);
      EXPECT_EQ(a[i].elevation, b[i].elevation);
      EXPECT_EQ(a[i].scan_angle, b[i].scan_angle);
      EXPECT_EQ(a[i].column, b[i].column);
      EXPECT_EQ(a[i].channel, b[i].channel);
      if (!a[i]) continue;
      ++hits;
      const double range = static_cast<double>(b[i].range);
      EXPECT_TRUE(test::is_one_hit(a[i].position, b[i].position, range, room(range), height)) << i;
    }
    EXPECT_GT(hits, 300);
  }
}

// Holes, walls, triangles and repetition, from inside and from beside the field.
TEST(LidarScan, FansAndBatchesAgreeOnEveryKindOfTerrain) {
  std::vector<float> samples;
  for (int row = 0; row < 40; ++row) {
    for (int col = 0; col < 40; ++col) {
      const bool hole = col > 15 && col < 20 && row > 8 && row < 30;
      samples.push_back(hole ? std::numeric_limits<float>::quiet_NaN()
                             : static_cast<float>(6 * std::sin(0.4 * col) + 5 * std::cos(0.3 * row)));
    }
  }
  HeightFieldSettings solid{.cell_x = 3, .cell_y = 4}, triangles = solid, repeated = solid;
  solid.solid = true;
  triangles.surface = Surface::triangles;
  repeated.wrap = Wrap::periodic;
  for (const HeightFieldSettings& settings : {solid, triangles, repeated}) {
    const Terrain ground = Terrain::own(samples, 40, 40, settings);
    const auto room = room_over(ground);
    const auto height = [&](double x, double y) { return ground.height(x, y); };
    for (const dvec3& eye : {dvec3(30, 60, 20), dvec3(-40, 70, 3), dvec3(60, 80, -20)}) {
      Lidar lidar = scanner(180, {10, 2, -1, -5, -20, -45, -89});
      lidar.path[0].position = eye;
      lidar.path[0].roll = 0.1;
      lidar.max_range = 400;
      const LidarScan fans(ground, lidar), batches(ground, lidar, LidarWay::batches);
      EXPECT_TRUE(fans.by_fans());
      const auto a = all_of(fans), b = all_of(batches);
      for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a[i].status, b[i].status) << i;
        if (!a[i]) continue;
        const double range = static_cast<double>(b[i].range);
        ASSERT_TRUE(test::is_one_hit(a[i].position, b[i].position, range, room(range), height)) << i;
      }
    }
  }
}

TEST(LidarScan, SceneOfSeveralFieldsMatchesItsTerrain) {
  const Terrain ground = hills();
  const Scene both = combine({{ground}, {plain(-500)}});
  Lidar lidar = scanner(60, {-5, -15, -30});
  lidar.path[0].position = {1003, 597, 45};
  lidar.max_range = 300;
  const LidarScan alone(ground, lidar), among(both, lidar);
  EXPECT_TRUE(alone.by_fans());
  EXPECT_FALSE(among.by_fans());
  const auto a = all_of(alone), b = all_of(among);
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(static_cast<bool>(a[i]), static_cast<bool>(b[i])) << i;
    if (!a[i]) continue;
    EXPECT_NEAR(static_cast<double>(a[i].range), static_cast<double>(b[i].range), 2e-3);
  }
}

// Heading clockwise, then pitch with the nose up, then roll with the right side down.
TEST(LidarScan, OrientationsAreAppliedInOrder) {
  const Terrain ground = plain();
  Lidar lidar = scanner(4, {-50, -60});
  const double heading = 0.5, pitch = 0.15, roll = -0.25;
  lidar.path[0] = {0, {10000, 10000, 100}, heading, pitch, roll};
  lidar.mounting.forward = 2, lidar.mounting.right = 3, lidar.mounting.up = 5;
  // The axes of the body, from one rotation after another.
  dvec3 right(std::cos(heading), -std::sin(heading), 0), forward(std::sin(heading), std::cos(heading), 0), up(0, 0, 1);
  const dvec3 level_forward = forward;
  forward = std::cos(pitch) * level_forward + std::sin(pitch) * up;
  up = std::cos(pitch) * up - std::sin(pitch) * level_forward;
  const dvec3 level_right = right;
  right = std::cos(roll) * level_right - std::sin(roll) * up;
  up = std::cos(roll) * up + std::sin(roll) * level_right;
  const dvec3 eye = dvec3(10000, 10000, 100) + 2.0 * forward + 3.0 * right + 5.0 * up;
  for (const LidarWay way : {LidarWay::automatic, LidarWay::batches}) {
    const auto returns = all_of(LidarScan(ground, lidar, way));
    ASSERT_EQ(returns.size(), 8u);
    for (const LidarReturn& answer : returns) {
      const double azimuth = static_cast<double>(answer.column) * kPi / 2;
      const double elevation = lidar.elevations[static_cast<std::size_t>(answer.channel)];
      const dvec3 d =
          std::cos(elevation) * (std::sin(azimuth) * right + std::cos(azimuth) * forward) + std::sin(elevation) * up;
      ASSERT_TRUE(answer);
      ASSERT_LT(d.z, 0);
      const double room = test::room_on_plain(eye.z / -d.z, std::asin(d.z));
      expect_near(answer.position, eye + eye.z / -d.z * d, room);
      EXPECT_NEAR(static_cast<double>(answer.range), eye.z / -d.z, room);
      EXPECT_NEAR(static_cast<double>(answer.scan_angle),
                  std::atan2(d.x * std::cos(heading) - d.y * std::sin(heading), -d.z), 1e-5);
    }
  }
}

// Yaw, pitch and roll of the mounting rotate the scanner as those of the body do.
TEST(LidarScan, MountingRotatesLikeThePose) {
  const Terrain ground = plain();
  Lidar body = scanner(16, {-30, -60});
  body.path[0] = {0, {10000, 10000, 100}, 0.4, 0.1, 0.2};
  Lidar mounted = scanner(16, {-30, -60});
  mounted.path[0].position = {10000, 10000, 100};
  mounted.mounting.yaw = 0.4, mounted.mounting.pitch = 0.1, mounted.mounting.roll = 0.2;
  const auto a = all_of(LidarScan(ground, body)), b = all_of(LidarScan(ground, mounted));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto range = static_cast<double>(a[i].range), elevation = static_cast<double>(a[i].elevation);
    expect_near(a[i].position, b[i].position, 2 * test::room_on_plain(range, elevation));
  }
}

TEST(LidarScan, NorthRotatesHeadingsButNotReportedAzimuths) {
  const Terrain ground = plain();
  Lidar lidar = scanner(8, {-45});
  lidar.path[0].position = {10000, 10000, 100};
  lidar.path[0].heading = kPi / 2;
  lidar.north = 0.1;
  const auto returns = all_of(LidarScan(ground, lidar));
  EXPECT_NEAR(static_cast<double>(returns[0].azimuth), kPi / 2, test::room_of_angle(kPi / 4));
  expect_near(returns[0].position, {10000 + 100 * std::cos(0.1), 10000 - 100 * std::sin(0.1), 0},
              test::room_on_plain(100 * std::sqrt(2), kPi / 4));
}

TEST(LidarScan, MovesLinearlyBetweenPoses) {
  const Terrain ground = plain();
  Lidar lidar = scanner(4, {-90});
  lidar.rate = 1;
  lidar.path = {{10, {9000, 9000, 50}, 0, 0, 0}, {14, {9040, 9000, 50}, 0, 0, 0}, {16, {9040, 9100, 90}, 0, 0, 0}};
  const LidarScan scan(ground, lidar);
  EXPECT_FALSE(scan.by_fans());
  // Four columns per second, from 10 s to 16 s, both included.
  ASSERT_EQ(scan.columns(), 25);
  const auto returns = all_of(scan);
  for (const LidarReturn& answer : returns) {
    const double time = 10 + 0.25 * static_cast<double>(answer.column);
    EXPECT_DOUBLE_EQ(answer.time, time);
    const dvec3 at = time < 14 ? dvec3(9000 + 10 * (time - 10), 9000, 50)
                               : dvec3(9040, 9000 + 50 * (time - 14), 50 + 20 * (time - 14));
    ASSERT_TRUE(answer);
    const double room = test::room_on_plain(at.z, kPi / 2);
    expect_near(answer.position, {at.x, at.y, 0}, room);
    EXPECT_NEAR(static_cast<double>(answer.range), at.z, room);
  }
}

// From heading 350 to 30 degrees: clockwise through north, at constant speed, also for a pitched body.
TEST(LidarScan, TurnsTheShorterWayAtConstantSpeed) {
  const Terrain ground = plain();
  Lidar lidar = scanner(10, {-45});
  lidar.azimuth_step = 1e-9;  // always ahead; a turn has one instant
  lidar.columns = 1;
  lidar.rate = 10;
  lidar.path = {{0, {10000, 10000, 100}, 350 * kDegree, 0, 0}, {1, {10000, 10000, 100}, 30 * kDegree, 0, 0}};
  for (const LidarReturn& answer : all_of(LidarScan(ground, lidar))) {
    const double expected = (350 + 40 * answer.time) * kDegree;
    EXPECT_NEAR(std::remainder(static_cast<double>(answer.azimuth) - expected, 2 * kPi), 0,
                test::room_of_angle(kPi / 4) + lidar.azimuth_step)
        << answer.time;
  }
  // Orientations between two rotations about the same axis are rotations about this axis, too.
  lidar.path[0].heading = lidar.path[1].heading = 0;
  lidar.path[0].pitch = -30 * kDegree, lidar.path[1].pitch = 20 * kDegree;
  for (const LidarReturn& answer : all_of(LidarScan(ground, lidar)))
    EXPECT_NEAR(static_cast<double>(answer.elevation), (-75 + 50 * answer.time) * kDegree, test::room_of_angle())
        << answer.time;
}

TEST(LidarScan, ChannelsFireFromTheirOwnPositions) {
  const Terrain ground = plain();
  Lidar lidar = scanner(1, {-90, -90, -90});
  lidar.azimuth_step = 1e-9;
  lidar.time_offsets = {0.2, 0, 0.05};
  lidar.rate = 1;
  lidar.path = {{0, {9000, 9000, 50}, 0, 0, 0}, {2.1, {9210, 9000, 50}, 0, 0, 0}};
  const LidarScan scan(ground, lidar);
  EXPECT_EQ(scan.columns(), 2) << "that of 2 s would end at 2.2 s";
  for (const LidarReturn& answer : all_of(scan)) {
    const double time =
        static_cast<double>(answer.column) + lidar.time_offsets[static_cast<std::size_t>(answer.channel)];
    EXPECT_DOUBLE_EQ(answer.time, time);
    EXPECT_NEAR(answer.position.x, 9000 + 100 * time, test::room_on_plain(50, kPi / 2));
  }
}

TEST(LidarScan, HeightsAboveGroundFollowTheGround) {
  const Terrain ground = hills();
  Lidar lidar = scanner(1, {-90});
  lidar.azimuth_step = 1e-9;
  lidar.rate = 20;
  lidar.above_ground = true;
  lidar.path = {{0, {300, 300, 2.5}, 0, 0, 0}, {1, {900, 700, 2.5}, 0, 0, 0}};
  const double room = room_over(ground)(2.5);
  for (const LidarReturn& answer : all_of(LidarScan(ground, lidar))) {
    EXPECT_NEAR(static_cast<double>(answer.range), 2.5, room);
    EXPECT_NEAR(answer.position.z, *ground.height(answer.position.x, answer.position.y), room);
  }
  lidar.path[1].position.x = 5000;
  EXPECT_THROW(LidarScan(ground, lidar), Error);
  // A hole between two poses.
  std::vector<float> with_hole(16, 0.0f);
  with_hole[5] = std::numeric_limits<float>::quiet_NaN();
  lidar.path = {{0, {300, 300, 2.5}, 0, 0, 0}, {1, {-300, 300, 2.5}, 0, 0, 0}, {2, {300, 320, 2.5}, 0, 0, 0}};
  EXPECT_THROW(LidarScan(ground, lidar), Error);
  lidar.path[1].position.x = 100;
  EXPECT_NO_THROW(all_of(LidarScan(ground, lidar)));
  const Terrain holed = Terrain::own(with_hole, 4, 4, {.cell_x = 100, .cell_y = 100});
  lidar.path = {{3, {10, 10, 1}, 0, 0, 0}, {5, {290, 290, 1}, 0, 0, 0}};
  EXPECT_EQ(test::refusal([&] { all_of(LidarScan(holed, lidar)); }).find("scanner: no ground below its path at 3."),
            0u);
}

TEST(LidarScan, NearSurfacesBlockAndFarOnesAreNotMeasured) {
  const Terrain ground = plain();
  Lidar lidar = scanner(4, {-90, -30, -2});
  lidar.path[0].position = {10000, 10000, 10};
  lidar.min_range = 15, lidar.max_range = 100;
  for (const LidarWay way : {LidarWay::automatic, LidarWay::batches}) {
    for (const LidarReturn& answer : all_of(LidarScan(ground, lidar, way)))
      EXPECT_EQ(static_cast<bool>(answer), answer.channel == 1) << "ranges are 10, 20 and 287 m";
  }
}

TEST(LidarScan, NoiseIsNormalAndRepeatable) {
  const Terrain ground = plain();
  Lidar lidar = scanner(2000, {-30, -60, -45});
  lidar.path[0].position = {10000, 10000, 10};
  lidar.range_noise = 0.05;
  const LidarScan scan(ground, lidar);
  const auto returns = all_of(scan);
  double sum = 0, squares = 0, fourth = 0;
  int beyond = 0;
  for (const LidarReturn& answer : returns) {
    const double exact = 10 / -std::sin(lidar.elevations[static_cast<std::size_t>(answer.channel)]);
    const double error = (static_cast<double>(answer.range) - exact) / 0.05;
    sum += error, squares += error * error, fourth += error * error * error * error;
    if (std::abs(error) > 2) ++beyond;
    EXPECT_NEAR(length(answer.position - dvec3(10000, 10000, 10)), static_cast<double>(answer.range), 1e-5);
  }
  const auto count = static_cast<double>(returns.size());
  EXPECT_NEAR(sum / count, 0, 0.06);
  EXPECT_NEAR(squares / count, 1, 0.1);
  EXPECT_NEAR(fourth / count, 3, 0.6);
  EXPECT_NEAR(beyond / count, 0.0455, 0.012);
  // In pieces of any size.
  for (const std::int64_t piece : {1, 7, 16, 333}) {
    std::vector<LidarReturn> part;
    scan.cast(piece, piece, part);
    for (std::size_t i = 0; i < part.size(); ++i) {
      const LidarReturn& whole = returns[static_cast<std::size_t>(piece) * 3 + i];
      EXPECT_EQ(part[i].range, whole.range);
      EXPECT_EQ(part[i].position, whole.position);
    }
  }
  lidar.seed = 2;
  int same = 0;
  const auto others = all_of(LidarScan(ground, lidar));
  for (std::size_t i = 0; i < returns.size(); ++i) same += returns[i].range == others[i].range;
  EXPECT_LT(same, 20);
}

TEST(LidarScan, RejectsInvalidScans) {
  const Terrain ground = plain();
  const Lidar good = scanner(4, {-10, -20});
  EXPECT_NO_THROW(LidarScan(ground, good));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  const auto refused = [&](const auto& change) {
    Lidar lidar = good;
    change(lidar);
    EXPECT_THROW(LidarScan(ground, lidar), Error);
  };
  refused([](Lidar& l) { l.elevations.clear(); });
  refused([](Lidar& l) { l.elevations[1] = 1.6; });
  refused([](Lidar& l) { l.elevations[1] = kNan; });
  refused([](Lidar& l) { l.time_offsets = {0}; });
  refused([](Lidar& l) { l.time_offsets = {0, -1}; });
  refused([](Lidar& l) { l.azimuth_offsets = {0, kInf}; });
  refused([](Lidar& l) { l.columns = 0; });
  refused([](Lidar& l) { l.azimuth_step *= 1.01; });
  refused([](Lidar& l) { l.azimuth_step = kNan; });
  refused([](Lidar& l) { l.rate = 0; });
  refused([](Lidar& l) { l.rate = kInf; });
  refused([](Lidar& l) { l.turns = 0; });
  refused([](Lidar& l) { l.max_range = 0; });
  refused([](Lidar& l) { l.min_range = -1; });
  refused([](Lidar& l) { l.range_noise = kNan; });
  refused([](Lidar& l) { l.mounting.up = kInf; });
  refused([](Lidar& l) { l.path.clear(); });
  refused([](Lidar& l) { l.path[0].position.x = kNan; });
  refused([](Lidar& l) { l.path.push_back(l.path[0]); });
  refused([](Lidar& l) { l.path.push_back({.time = 1e12}), l.rate = 1e9; });
  const Terrain endless = Terrain::own(std::vector<float>(16, 0), 4, 4, {.wrap = Wrap::periodic});
  EXPECT_THROW(LidarScan(endless, good), Error);
  Lidar limited = good;
  limited.max_range = 100;
  EXPECT_NO_THROW(all_of(LidarScan(endless, limited)));
  std::vector<LidarReturn> returns;
  const LidarScan scan(ground, good);
  EXPECT_THROW(scan.cast(0, 5, returns), Error);
  EXPECT_THROW(scan.cast(-1, 1, returns), Error);
}

}  // namespace
}  // namespace scarp
