// SPDX-License-Identifier: MIT
#include "app/viewer/navigation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "scarp/render/frame/picture.h"

namespace scarp::viewer {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSteepest = 89.5 * kDegree;         // look_at() turns over beyond
constexpr double kTurnPerHeight = std::numbers::pi;  // turn by a drag over the height of the picture
constexpr double kWheelStep = 0.85;                  // factor of the distance per step
constexpr double kGoTo = 0.4;                        // fraction of the distance that remains after a double click
constexpr double kSpeedShare = 0.08;                 // fraction of the scene's size, per second
constexpr double kFast = 5;                          // factor of the speed
constexpr double kWalkSpeed = 5;                     // metres per second
constexpr double kStepHeight = 1.0;                  // metres that a walker can climb in one step
constexpr double kArm = 0.3;                         // metres that a walker keeps from a wall
constexpr double kStride = 0.5;                      // step in metres at which the ground is queried
constexpr double kLeastMap = 1e-6, kMostMap = 100;   // times the size of the scene
constexpr double kFarAbove = 1e6;                    // metres, over endless ground
constexpr int kMostStrides = 500;                    // limit between two frames: each stride traces two rays
constexpr double kFarthest = 1e4;  // times the size of the scene from the first eye, because of rounding

dvec3 right_of(const Pose& pose) { return {std::sin(pose.azimuth), -std::cos(pose.azimuth), 0}; }

}  // namespace

dvec3 forward_of(const Pose& pose) {
  const double flat = std::cos(pose.altitude);
  return {flat * std::cos(pose.azimuth), flat * std::sin(pose.azimuth), std::sin(pose.altitude)};
}

Pose with_heights_times(const Pose& pose, double factor) {
  Pose there = pose;
  // Modes that turn around a point keep turning around it.
  const dvec3 way = pose.mode == MoveMode::orbit ? pose.distance * forward_of(pose) : dvec3(0.0);
  there.eye = pose.eye + way;
  there.eye.z *= factor;
  there.eye -= way;
  return there;
}

std::array<dvec2, 2> map_corners(const Pose& pose, int width, int height) {
  const dvec2 half(pose.map_width / 2, pose.map_width / 2 * height / width);
  return {dvec2(pose.eye) - half, dvec2(pose.eye) + half};
}

dvec2 dragged_sun(const dvec2& sun, const dvec2& drag, const dvec2& size) {
  const double azimuth = sun.x + 180 * drag.x / size.y, altitude = sun.y - 90 * drag.y / size.y;
  return {azimuth - 360 * std::floor(azimuth / 360), std::clamp(altitude, 0.0, 90.0)};
}

namespace {

WorldBox box_of_map(const Scene& scene) {
  const bool endless = scene.box().empty() && !(scene.terrain() && scene.wraps());
  return endless ? WorldBox{} : picture_box(scene);
}

}  // namespace

Navigator::Navigator(const Scene& scene, const Camera& first, double fov_deg, double across)
    : scene_(scene), box_(box_of_map(scene)), across_(across > 0 ? across : 1), speed_(kSpeedShare * across_) {
  pose_.fov_deg = fov_deg;
  first_eye_ = pose_.eye = first.eye();
  const dvec3 forward = first.forward();
  pose_.azimuth = std::atan2(forward.y, forward.x);
  pose_.altitude = std::clamp(std::asin(std::clamp(forward.z, -1.0, 1.0)), -kSteepest, kSteepest);
  pose_.map_width = first.orthographic() ? first.pixel_width(0) * first.size().x : across_;
  const dvec2 size = first.size();
  const Ray middle = first.ray(size.x / 2, size.y / 2);
  const Hit hit = scene_.closest_hit(middle);
  pose_.distance = hit ? hit.t : across_;
  if (first.orthographic()) pose_.mode = MoveMode::top;
}

Camera Navigator::camera(int width, int height) const {
  if (pose_.mode == MoveMode::top) {
    // The camera of `scarp render --top --area`.
    const auto [low, high] = map_corners(pose_, width, height);
    const double bottom = box_.empty() ? pose_.eye.z : box_.low.z, top = box_.empty() ? pose_.eye.z : box_.high.z;
    return Camera::top({dvec3(low, bottom), dvec3(high, top)}, width, height);
  }
  return Camera::look_at(pose_.eye, pose_.eye + forward_of(pose_), pose_.fov_deg, width, height);
}

void Navigator::set_pose(const Pose& pose) {
  pose_ = pose;
  if (pose_.mode == MoveMode::walk) stand();
  changed_ = true;
}

void Navigator::set_mode(MoveMode mode) {
  if (mode == pose_.mode) return;
  const double width_per_distance = 2 * std::tan(pose_.fov_deg * kDegree / 2);
  if (mode == MoveMode::top) {
    pose_.map_width = std::max(width_per_distance * pose_.distance, kLeastMap * across_);
    const dvec3 at = point();
    pose_.eye = {at.x, at.y, pose_.eye.z};
  } else if (pose_.mode == MoveMode::top) {
    // From a distance at which the picture has about the same width.
    const dvec3 at(pose_.eye.x, pose_.eye.y, 0);
    pose_.distance = pose_.map_width / width_per_distance;
    pose_.eye = dvec3(at.x, at.y, ground_below({at.x, at.y, high()}).value_or(0)) - pose_.distance * forward_of(pose_);
  }
  pose_.mode = mode;
  speed_ = mode == MoveMode::walk ? kWalkSpeed : kSpeedShare * across_;
  if (mode == MoveMode::walk) stand();
  changed_ = true;
}

void Navigator::turn(const dvec2& drag, const dvec2& size) {
  if (pose_.mode == MoveMode::top) return shift(drag, size);
  const dvec3 around = point();
  pose_.azimuth -= kTurnPerHeight * drag.x / size.y;
  pose_.altitude = std::clamp(pose_.altitude - kTurnPerHeight / 2 * drag.y / size.y, -kSteepest, kSteepest);
  if (pose_.mode == MoveMode::orbit) pose_.eye = around - pose_.distance * forward_of(pose_);
  changed_ = true;
}

void Navigator::shift(const dvec2& drag, const dvec2& size) {
  if (pose_.mode == MoveMode::walk) return;
  if (pose_.mode == MoveMode::top) {
    const double pixel = pose_.map_width / size.x;
    pose_.eye += pixel * dvec3(-drag.x, drag.y, 0);
  } else {
    const double pixel = 2 * pose_.distance * std::tan(pose_.fov_deg * kDegree / 2) / size.y;
    const dvec3 right = right_of(pose_);
    pose_.eye += pixel * (-drag.x * right + drag.y * cross(right, forward_of(pose_)));
  }
  changed_ = true;
}

void Navigator::wheel(double steps, const dvec2& at, const dvec2& size) {
  const double nearer = std::pow(kWheelStep, steps);
  if (pose_.mode == MoveMode::top) {
    const double pixel = pose_.map_width / size.x;
    const dvec2 from_middle = at - 0.5 * size;
    pose_.eye += (1 - nearer) * pixel * dvec3(from_middle.x, -from_middle.y, 0);
    pose_.map_width = std::clamp(nearer * pose_.map_width, kLeastMap * across_, kMostMap * across_);
  } else if (pose_.mode == MoveMode::orbit) {
    const dvec3 around = point();
    pose_.distance = std::clamp(nearer * pose_.distance, kLeastMap * across_, kMostMap * across_);
    pose_.eye = around - pose_.distance * forward_of(pose_);
  } else {
    speed_ = std::clamp(speed_ / nearer, kLeastMap * across_, kMostMap * across_);
  }
  changed_ = true;
}

void Navigator::go_to(const dvec3& at) {
  if (pose_.mode == MoveMode::top) {
    pose_.eye = {at.x, at.y, pose_.eye.z};
  } else if (pose_.mode == MoveMode::walk) {
    pose_.eye = at + dvec3(0, 0, kEyeHeight);
    stand();
  } else {
    const dvec3 way = at - pose_.eye;
    pose_.azimuth = std::atan2(way.y, way.x);
    pose_.distance = kGoTo * length(way);
    pose_.altitude = std::clamp(std::atan2(way.z, std::hypot(way.x, way.y)), -kSteepest, kSteepest);
    pose_.eye = at - pose_.distance * forward_of(pose_);
  }
  changed_ = true;
}

bool Navigator::moving() const {
  const bool moves = pose_.mode == MoveMode::fly || pose_.mode == MoveMode::walk;
  return moves && std::any_of(keys_.begin(), keys_.begin() + static_cast<int>(MoveKey::fast), [](bool k) { return k; });
}

bool Navigator::advance(double seconds) {
  if (moving() && seconds > 0) {
    const auto held = [&](MoveKey key) { return keys_[static_cast<std::size_t>(key)] ? 1.0 : 0.0; };
    const bool walks = pose_.mode == MoveMode::walk;
    const double ahead = held(MoveKey::forward) - held(MoveKey::back),
                 aside = held(MoveKey::right) - held(MoveKey::left), up = held(MoveKey::up) - held(MoveKey::down);
    const dvec3 level(std::cos(pose_.azimuth), std::sin(pose_.azimuth), 0);
    dvec3 way = ahead * (walks ? level : forward_of(pose_)) + aside * right_of(pose_);
    if (!walks) way += dvec3(0, 0, up);
    if (const double size = length(way); size > 0) {
      const dvec3 step = speed_ * seconds * (held(MoveKey::fast) > 0 ? kFast : 1.0) / size * way;
      if (walks) {
        walk(step);
      } else {
        pose_.eye += step;
      }
      changed_ = true;
    }
  }
  if (changed_) {
    for (int i = 0; i < 3; ++i)
      pose_.eye[i] = std::clamp(pose_.eye[i], first_eye_[i] - kFarthest * across_, first_eye_[i] + kFarthest * across_);
  }
  return std::exchange(changed_, false);
}

double Navigator::high() const { return scene_.box().empty() ? kFarAbove : scene_.box().high.z + 1; }

std::optional<double> Navigator::ground_below(const dvec3& at) const {
  Ray down;
  down.origin = at;
  down.direction = dvec3(0, 0, -1);
  const Hit hit = scene_.closest_hit(down);
  if (!hit || scene_.field_of(hit.object).is_backdrop()) return {};
  return down.at(hit.t).z;
}

// Stands on the highest surface below the eye or, if there is none, above it.
void Navigator::stand() {
  std::optional<double> ground = ground_below(pose_.eye);
  if (!ground) ground = ground_below({pose_.eye.x, pose_.eye.y, high()});
  if (ground) pose_.eye.z = *ground + kEyeHeight;
}

// Walks in small strides, up to walls, and only where there is ground.
void Navigator::walk(const dvec3& step) {
  const double whole = std::min(length(step), kMostStrides * kStride);
  const dvec3 way = step / length(step);
  const int strides = std::max(1, static_cast<int>(std::ceil(whole / kStride)));
  for (int i = 0; i < strides; ++i) {
    Ray ahead;
    ahead.origin = pose_.eye;
    ahead.direction = way;
    ahead.t_max = whole / strides + kArm;
    if (scene_.occluded(ahead)) return;
    const dvec3 to = pose_.eye + whole / strides * way;
    const auto ground = ground_below(to + dvec3(0, 0, kStepHeight));
    if (!ground) return;
    pose_.eye = {to.x, to.y, *ground + kEyeHeight};
  }
}

}  // namespace scarp::viewer
