// SPDX-License-Identifier: MIT
// Moving through scenes, without a window.
#include "app/viewer/navigation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scarp/scarp.h"

namespace scarp::viewer {
namespace {

constexpr dvec2 kSize{800, 600};
constexpr double kSecond = 1.0, kFrame = 1.0 / 60;

// Level ground of 100 x 100 m with a wall of 20 m at x = 50.
Terrain ground_with_wall() {
  std::vector<float> samples(101 * 101, 0.0f);
  for (std::size_t row = 0; row < 101; ++row) samples[101 * row + 50] = 20.0f;
  return Terrain::own(std::move(samples), 101, 101);
}

Navigator at(const Scene& scene, const dvec3& eye, const dvec3& target) {
  return {scene, Camera::look_at(eye, target, 40, 800, 600), 40, 100};
}

void hold(Navigator& navigator, MoveKey key, double seconds) {
  navigator.key(key, true);
  for (double t = 0; t < seconds; t += kFrame) navigator.advance(kFrame);
  navigator.key(key, false);
}

struct Navigation : testing::Test {
  Terrain terrain = ground_with_wall();
  Scene scene{terrain};
};

TEST_F(Navigation, StartsAtTheGivenCamera) {
  const Navigator navigator = at(scene, {20, 5, 30}, {20, 50, 0});
  const Camera camera = navigator.camera(800, 600);
  EXPECT_EQ(camera.eye(), dvec3(20, 5, 30));
  EXPECT_LT(length(camera.forward() - normalize(dvec3(0, 45, -30))), 1e-12);
  // The camera turns around the ground point in the middle.
  EXPECT_NEAR(navigator.pose().distance, std::hypot(45, 30), 1e-6);
}

TEST_F(Navigation, OrbitKeepsItsPivot) {
  Navigator navigator = at(scene, {20, 5, 30}, {20, 50, 0});
  navigator.turn({120, 35}, kSize);
  navigator.turn({-33, 70}, kSize);
  const Pose& pose = navigator.pose();
  EXPECT_LT(length(pose.eye + pose.distance * forward_of(pose) - dvec3(20, 50, 0)), 1e-6);
  EXPECT_GT(length(pose.eye - dvec3(20, 5, 30)), 1.0);
  // A drag to the right moves the scene along: the eye goes to the left.
  Navigator other = at(scene, {20, 5, 30}, {20, 50, 0});
  other.turn({10, 0}, kSize);
  EXPECT_LT(other.pose().eye.x, 20);
}

TEST_F(Navigation, OrbitDoesNotFlip) {
  Navigator navigator = at(scene, {20, 5, 30}, {20, 50, 0});
  for (int i = 0; i < 50; ++i) navigator.turn({0, 100}, kSize);
  EXPECT_LT(std::abs(navigator.pose().altitude), 1.5707);
  EXPECT_NO_THROW(navigator.camera(80, 60));
}

TEST_F(Navigation, WheelApproachesAndPanKeepsTheDistance) {
  Navigator navigator = at(scene, {20, 5, 30}, {20, 50, 0});
  const double before = navigator.pose().distance;
  navigator.wheel(1, {400, 300}, kSize);
  EXPECT_LT(navigator.pose().distance, before);
  const double near = navigator.pose().distance;
  navigator.shift({50, 20}, kSize);
  EXPECT_EQ(navigator.pose().distance, near);
}

TEST_F(Navigation, MapZoomsTowardsTheCursor) {
  Navigator navigator = at(scene, {20, 5, 30}, {20, 50, 0});
  navigator.set_mode(MoveMode::top);
  const dvec2 cursor(700, 100);
  const auto under = [&] { return navigator.camera(800, 600).ray(cursor.x, cursor.y).origin; };
  const dvec3 before = under();
  navigator.wheel(3, cursor, kSize);
  const dvec3 after = under();
  EXPECT_NEAR(after.x, before.x, 1e-6);
  EXPECT_NEAR(after.y, before.y, 1e-6);
  // A drag moves the ground along.
  navigator.shift({30, -40}, kSize);
  const dvec3 moved = navigator.camera(800, 600).ray(cursor.x + 30, cursor.y - 40).origin;
  EXPECT_NEAR(moved.x, after.x, 1e-6);
  EXPECT_NEAR(moved.y, after.y, 1e-6);
}

TEST_F(Navigation, FlightDistanceFollowsTheSpeed) {
  Navigator navigator = at(scene, {20, 5, 30}, {20, 50, 30});
  navigator.set_mode(MoveMode::fly);
  hold(navigator, MoveKey::forward, kSecond);
  EXPECT_NEAR(navigator.pose().eye.y, 5 + navigator.speed() * kSecond, navigator.speed() * 2 * kFrame);
  EXPECT_FALSE(navigator.moving());
  EXPECT_FALSE(navigator.advance(kFrame)) << "nothing moves";
}

TEST_F(Navigation, WalkerStandsOnTheGroundAndStopsAtWalls) {
  Navigator navigator = at(scene, {10, 20, 30}, {90, 20, 30});
  navigator.set_mode(MoveMode::walk);
  EXPECT_NEAR(navigator.pose().eye.z, Navigator::kEyeHeight, 1e-6);
  // At any speed, and in steps of any length.
  for (const double step : {kFrame, 1.0, 30.0}) {
    for (double t = 0; t < 60; t += step) {
      navigator.key(MoveKey::forward, true);
      navigator.key(MoveKey::fast, true);
      navigator.advance(step);
    }
    EXPECT_LT(navigator.pose().eye.x, 50) << "through the wall";
    EXPECT_GT(navigator.pose().eye.x, 45);
  }
  // Nor does the walker cross the border.
  navigator.key(MoveKey::forward, false);
  for (int i = 0; i < 600; ++i) {
    navigator.key(MoveKey::back, true);
    navigator.advance(1.0);
  }
  EXPECT_GE(navigator.pose().eye.x, 0);
}

TEST_F(Navigation, DoubleClickMovesToThatPoint) {
  Navigator navigator = at(scene, {20, 5, 30}, {20, 50, 0});
  const dvec3 clicked(30, 60, 0);
  const double before = length(clicked - navigator.pose().eye);
  navigator.go_to(clicked);
  const Pose& pose = navigator.pose();
  EXPECT_LT(length(clicked - pose.eye), before / 2);
  EXPECT_LT(length(pose.eye + pose.distance * forward_of(pose) - clicked), 1e-6);
}

TEST_F(Navigation, MapMatchesItsCorners) {
  Navigator navigator = at(scene, {20, 5, 30}, {20, 50, 0});
  navigator.set_mode(MoveMode::top);
  navigator.wheel(3, {200, 100}, kSize);
  navigator.shift({31, -7}, kSize);
  const auto [low, high] = map_corners(navigator.pose(), 800, 600);
  EXPECT_DOUBLE_EQ((high.x - low.x) / (high.y - low.y), 800.0 / 600);
  WorldBox box = scene.box();
  box.low = {low.x, low.y, box.low.z}, box.high = {high.x, high.y, box.high.z};
  const Camera map = Camera::top(box, 800, 600), shown = navigator.camera(800, 600);
  for (const dvec2 pixel : {dvec2(0.5, 0.5), dvec2(400, 300), dvec2(799.5, 12.5)}) {
    EXPECT_EQ(map.ray(pixel.x, pixel.y).origin, shown.ray(pixel.x, pixel.y).origin);
    EXPECT_EQ(map.ray(pixel.x, pixel.y).direction, shown.ray(pixel.x, pixel.y).direction);
  }
}

TEST_F(Navigation, RaisedGroundKeepsTheCentrePoint) {
  const Navigator navigator = at(scene, {20, 5, 30}, {50, 50, 20});
  const Pose before = navigator.pose(), after = with_heights_times(before, 3);
  const dvec3 was = before.eye + before.distance * forward_of(before),
              is = after.eye + after.distance * forward_of(after);
  // Some tens of roundings of coordinates below 1000 m, each at most 2^-44 m.
  constexpr double kRounding = 0x1p-38;
  EXPECT_NEAR(is.x, was.x, kRounding);
  EXPECT_NEAR(is.z, 3 * was.z, kRounding);
  Pose flies = before;
  flies.mode = MoveMode::fly;
  EXPECT_EQ(with_heights_times(flies, 3).eye, dvec3(20, 5, 90));
}

TEST(Sun, FollowsADrag) {
  EXPECT_EQ(dragged_sun({315, 45}, {60, -60}, {800, 600}), dvec2(333, 54));
  EXPECT_EQ(dragged_sun({350, 80}, {60, -600}, {800, 600}), dvec2(8, 90));
  EXPECT_EQ(dragged_sun({5, 10}, {-60, 600}, {800, 600}), dvec2(347, 0));
}

}  // namespace
}  // namespace scarp::viewer
