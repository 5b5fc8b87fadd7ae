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

// Ground with a round hill: rays decide where eyes may be.
Terrain hill() {
  std::vector<float> samples;
  for (int row = 0; row < 101; ++row) {
    for (int col = 0; col < 101; ++col)
      samples.push_back(static_cast<float>(40 * std::exp(-(std::pow(col - 50, 2) + std::pow(row - 50, 2)) / 200.0)));
  }
  return Terrain::own(std::move(samples), 101, 101);
}

TEST(NavigationOnAHill, EyesStayAboveTheGround) {
  const Terrain terrain = hill();
  const Scene scene(terrain);
  const auto above = [&](const Navigator& navigator) {
    const dvec3 eye = navigator.pose().eye;
    const auto ground = scene.height(eye.x, eye.y);
    return !ground || eye.z > *ground;
  };
  Navigator orbits = at(scene, {50, 5, 30}, {50, 40, 20});
  for (int i = 0; i < 400; ++i) {
    const double step = i % 3 == 0 ? 15 : 3;
    switch (i % 5) {
      case 0:
        orbits.wheel(i % 2 ? 2 : -1, {300.0 + i, 350}, kSize);
        break;
      case 1:
        orbits.shift({step, -40}, kSize);
        break;
      default:
        orbits.turn({step, -40}, kSize);
    }
    ASSERT_TRUE(above(orbits)) << i;
  }
  Navigator flies = at(scene, {50, 5, 3}, {50, 50, 3});
  EXPECT_TRUE(flies.set_mode(MoveMode::fly, kSize));
  hold(flies, MoveKey::forward, 60);
  EXPECT_TRUE(above(flies));
  EXPECT_LT(flies.pose().eye.y, 50) << "through the hill";
  flies.keep_above_ground(false);
  hold(flies, MoveKey::forward, 60);
  EXPECT_GT(flies.pose().eye.y, 50);
  // Eyes below the ground get out.
  Navigator buried = at(scene, {50, 50, 10}, {50, 90, 10});
  EXPECT_TRUE(buried.set_mode(MoveMode::fly, kSize));
  hold(buried, MoveKey::up, 60);
  EXPECT_TRUE(above(buried));
}

TEST(NavigationOnAHill, WheelKeepsThePointUnderTheCursor) {
  const Terrain terrain = hill();
  const Scene scene(terrain);
  Navigator navigator = at(scene, {50, -60, 50}, {50, 50, 10});
  const dvec2 cursor(520, 330);
  const auto under = [&] {
    const Ray ray = navigator.camera(800, 600).ray(cursor.x, cursor.y);
    return ray.at(scene.closest_hit(ray).t);
  };
  const dvec3 before = under(), eye = navigator.pose().eye;
  for (const double steps : {2.0, 3.0, -4.0}) navigator.wheel(steps, cursor, kSize);
  EXPECT_LT(length(navigator.pose().eye - before), length(eye - before));
  // Coordinates below 128 m; each step rounds some tens of times.
  EXPECT_LT(length(under() - before), 256 * 0x1p-46);
}

TEST(NavigationOnAHill, WalkersStartAtTheOrbitsPoint) {
  const Terrain terrain = hill();
  const Scene scene(terrain);
  Navigator navigator = at(scene, {50, -60, 50}, {50, 30, 0});
  const Pose before = navigator.pose();
  const dvec3 point = before.eye + before.distance * forward_of(before);
  EXPECT_TRUE(navigator.set_mode(MoveMode::walk, kSize));
  const Pose& pose = navigator.pose();
  EXPECT_EQ(dvec2(pose.eye), dvec2(point));
  EXPECT_NEAR(pose.eye.z, *scene.height(point.x, point.y) + Navigator::kEyeHeight, 8 * 0x1p-46);
  EXPECT_EQ(pose.altitude, 0);
  EXPECT_EQ(pose.fov_deg, 60);
  EXPECT_TRUE(navigator.set_mode(MoveMode::orbit, kSize));
  EXPECT_EQ(pose.fov_deg, before.fov_deg);
  // Bookmarks of a walker, too, end with the usual view.
  Navigator returns = at(scene, {50, -60, 50}, {50, 30, 0});
  Pose walker = before;
  walker.mode = MoveMode::walk, walker.fov_deg = 60;
  returns.set_pose(walker);
  EXPECT_TRUE(returns.set_mode(MoveMode::orbit, kSize));
  EXPECT_EQ(returns.pose().fov_deg, before.fov_deg);
  // Without ground there, nothing changes.
  Navigator away = at(scene, {50, -60, 50}, {50, -160, 60});
  const Pose stays = away.pose();
  EXPECT_FALSE(away.set_mode(MoveMode::walk, kSize));
  EXPECT_EQ(away.pose().mode, MoveMode::orbit);
  EXPECT_EQ(away.pose().eye, stays.eye);
  EXPECT_EQ(away.pose().fov_deg, stays.fov_deg);
}

TEST(NavigationOnAHill, SpeedGrowsWithTheHeightAboveGround) {
  const Terrain terrain = hill();
  const Scene scene(terrain);
  double before = 0;
  for (const double z : {40.1, 42.0, 50.0}) {
    Navigator navigator = at(scene, {50, 50, z}, {50, 90, z});
    EXPECT_TRUE(navigator.set_mode(MoveMode::fly, kSize));
    EXPECT_GT(navigator.speed(), before);
    before = navigator.speed();
    navigator.wheel(1, {400, 300}, kSize);
    EXPECT_GT(navigator.speed(), before);
  }
}

TEST(NavigationOnAHill, MapsShowEverything) {
  const Terrain terrain = hill();
  const Scene scene(terrain);
  for (const dvec2 size : {dvec2(800, 600), dvec2(300, 900)}) {
    Navigator navigator = at(scene, {20, 5, 30}, {20, 50, 0});
    EXPECT_TRUE(navigator.set_mode(MoveMode::top, size));
    const auto [low, high] = map_corners(navigator.pose(), static_cast<int>(size.x), static_cast<int>(size.y));
    EXPECT_TRUE(low.x <= 0 && low.y <= 0 && high.x >= 100 && high.y >= 100);
    EXPECT_TRUE(std::min(high.x - low.x, high.y - low.y) == 100) << "no more than needed";
  }
}

TEST(NavigationOnAHill, PathsLookDownOnWhatTheMapShows) {
  const Terrain terrain = ground_with_wall();
  const Scene scene(terrain);
  Navigator navigator = at(scene, {20, 5, 30}, {20, 50, 0});
  EXPECT_TRUE(navigator.set_mode(MoveMode::top, kSize));
  navigator.shift({-50, 30}, kSize);
  navigator.wheel(4, {400, 300}, kSize);
  const Pose pose = navigator.perspective(kSize);
  const Camera camera = Camera::look_at(pose.eye, pose.eye + forward_of(pose), pose.fov_deg, 800, 600);
  const Camera map = navigator.camera(800, 600);
  for (const dvec2 pixel : {dvec2(0, 300), dvec2(800, 300), dvec2(400, 0), dvec2(400, 600)}) {
    const Ray ray = camera.ray(pixel.x, pixel.y);
    const Hit hit = scene.closest_hit(ray);
    ASSERT_TRUE(hit);
    EXPECT_LT(length(dvec2(ray.at(hit.t)) - dvec2(map.ray(pixel.x, pixel.y).origin)), 64 * 0x1p-46);
  }
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
  EXPECT_TRUE(navigator.set_mode(MoveMode::top, kSize));
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
  EXPECT_TRUE(navigator.set_mode(MoveMode::fly, kSize));
  hold(navigator, MoveKey::forward, kSecond);
  EXPECT_NEAR(navigator.pose().eye.y, 5 + navigator.speed() * kSecond, navigator.speed() * 2 * kFrame);
  EXPECT_FALSE(navigator.moving());
  EXPECT_FALSE(navigator.advance(kFrame)) << "nothing moves";
}

TEST_F(Navigation, WalkerStandsOnTheGroundAndStopsAtWalls) {
  Navigator navigator = at(scene, {10, 20, 30}, {90, 20, 30});
  EXPECT_TRUE(navigator.set_mode(MoveMode::walk, kSize));
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
  EXPECT_TRUE(navigator.set_mode(MoveMode::top, kSize));
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
