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
constexpr double kSpeedShare = 0.08;                 // fraction of the scene's size, per second: limit of the speed
constexpr double kSpeedPerHeight = 0.5;              // metres per second and metre above the ground
constexpr double kLeastSpeedShare = 1e-4;            // fraction of the scene's size, per second, on the ground
constexpr double kFast = 5;                          // factor of the speed
constexpr double kWalkSpeed = 5;                     // metres per second
constexpr double kLeastHaste = 1e-3, kMostHaste = 1e3;
constexpr double kWalkFov = 60;                     // degrees
constexpr double kClearance = 1e-4;                 // fraction of the scene's size that eyes keep from the ground
constexpr double kStepHeight = 1.0;                 // metres that a walker can climb in one step
constexpr double kArm = 0.3;                        // metres that a walker keeps from a wall
constexpr double kStride = 0.5;                     // step in metres at which the ground is queried
constexpr double kLeastMap = 1e-6, kMostMap = 100;  // times the size of the scene
constexpr double kFarAbove = 1e6;                   // metres, over endless ground
constexpr int kMostStrides = 500;                   // limit between two frames: each stride traces two rays
constexpr double kFarthest = 1e4;  // times the size of the scene from the first eye, because of rounding

dvec3 right_of(const Pose& pose) { return {std::sin(pose.azimuth), -std::cos(pose.azimuth), 0}; }

}  // namespace

dvec3 forward_of(const Pose& pose) {
  const double flat = std::cos(pose.altitude);
  return {flat * std::cos(pose.azimuth), flat * std::sin(pose.azimuth), std::sin(pose.altitude)};
}

Pose with_heights_times(const Pose& pose, double factor) {
  Pose there = pose;
  if (factor == 1) return there;  // to the bit
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
    : scene_(scene), box_(box_of_map(scene)), across_(across > 0 ? across : 1) {
  pose_.fov_deg = usual_fov_deg_ = fov_deg;
  first_eye_ = pose_.eye = first.eye();
  const dvec3 forward = first.forward();
  pose_.azimuth = std::atan2(forward.y, forward.x);
  pose_.altitude = std::clamp(std::asin(std::clamp(forward.z, -1.0, 1.0)), -kSteepest, kSteepest);
  pose_.map_width = first.orthographic() ? first.pixel_width(0) * first.size().x : across_;
  const dvec2 size = first.size();
  const Ray middle = first.ray(size.x / 2, size.y / 2);
  const Hit hit = scene_.closest_hit(middle);
  pose_.distance = hit ? std::max(hit.t, kLeastMap * across_) : across_;
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

Pose Navigator::perspective(const dvec2& size) const {
  Pose pose = pose_;
  if (pose.mode != MoveMode::top) return pose;
  pose.mode = MoveMode::orbit;
  pose.azimuth = std::numbers::pi / 2, pose.altitude = -std::numbers::pi / 2;
  pose.distance = pose.map_width / 2 * size.y / size.x / std::tan(pose.fov_deg * kDegree / 2);
  pose.eye.z = ground_below({pose.eye.x, pose.eye.y, high()}).value_or(0) + pose.distance;
  return pose;
}

void Navigator::set_pose(const Pose& pose) {
  pose_ = pose;
  if (pose_.mode == MoveMode::walk) (void)stand();
  changed_ = true;
}

Pose Navigator::whole_map(const dvec2& size) const {
  Pose pose = pose_;
  if (box_.empty()) {
    // Endless ground: what the other modes show of it.
    const dvec3 at = point();
    pose.eye = {at.x, at.y, pose_.eye.z};
    pose.map_width = std::max(2 * std::tan(pose_.fov_deg * kDegree / 2) * pose_.distance, kLeastMap * across_);
    return pose;
  }
  const dvec3 middle = 0.5 * (box_.low + box_.high), sides = box_.high - box_.low;
  pose.eye = {middle.x, middle.y, pose_.eye.z};
  pose.map_width = std::max({sides.x, sides.y * size.x / size.y, kLeastMap * across_});
  return pose;
}

bool Navigator::set_mode(MoveMode mode, const dvec2& size) {
  if (mode == pose_.mode) return true;
  const Pose before = pose_;
  if (mode == MoveMode::top) {
    pose_ = whole_map(size);
  } else if (pose_.mode == MoveMode::top) {
    // From a distance at which the picture has about the same width.
    const dvec3 at(pose_.eye.x, pose_.eye.y, 0);
    pose_.distance = pose_.map_width / (2 * std::tan(pose_.fov_deg * kDegree / 2));
    pose_.eye = dvec3(at.x, at.y, ground_below({at.x, at.y, high()}).value_or(0)) - pose_.distance * forward_of(pose_);
  }
  pose_.mode = mode;
  if (mode == MoveMode::walk) {
    if (before.mode != MoveMode::fly) pose_.eye = point();
    bool stands = stand();
    if (!stands) {
      // Looking at the sky, for example: below the eye.
      pose_.eye = before.eye;
      stands = stand();
    }
    if (!stands) {
      pose_ = before;
      return false;
    }
    pose_.altitude = 0;
    usual_fov_deg_ = std::exchange(pose_.fov_deg, kWalkFov);
  } else if (before.mode == MoveMode::walk) {
    pose_.fov_deg = usual_fov_deg_;
  }
  haste_ = 1;
  if (mode == MoveMode::orbit) look_at_middle();
  changed_ = true;
  return true;
}

double Navigator::speed() const {
  if (pose_.mode == MoveMode::walk) return haste_ * kWalkSpeed;
  const std::optional<double> ground = ground_below(pose_.eye);
  if (!ground) return haste_ * kSpeedShare * across_;
  return haste_ *
         std::clamp(kSpeedPerHeight * (pose_.eye.z - *ground), kLeastSpeedShare * across_, kSpeedShare * across_);
}

void Navigator::set_fov(double degrees) {
  pose_.fov_deg = std::clamp(degrees, kLeastFov, kMostFov);
  changed_ = true;
}

void Navigator::turn(const dvec2& drag, const dvec2& size) {
  if (pose_.mode == MoveMode::top) return shift(drag, size);
  const auto turned = [&](double right, double down) {
    Pose pose = pose_;
    pose.azimuth -= kTurnPerHeight * right / size.y;
    pose.altitude = std::clamp(pose.altitude - kTurnPerHeight / 2 * down / size.y, -kSteepest, kSteepest);
    if (pose.mode == MoveMode::orbit) pose.eye = point() - pose.distance * forward_of(pose);
    return pose;
  };
  // Around a hill, one of both may be free.
  move_eye(turned(drag.x, 0));
  move_eye(turned(0, drag.y));
}

void Navigator::shift(const dvec2& drag, const dvec2& size) {
  if (pose_.mode == MoveMode::walk) return;
  Pose pose = pose_;
  if (pose.mode == MoveMode::top) {
    const double pixel = pose.map_width / size.x;
    pose.eye += pixel * dvec3(-drag.x, drag.y, 0);
  } else {
    const double pixel = 2 * pose.distance * std::tan(pose.fov_deg * kDegree / 2) / size.y;
    const dvec3 right = right_of(pose);
    pose.eye += pixel * (-drag.x * right + drag.y * cross(right, forward_of(pose)));
  }
  move_eye(pose);
}

void Navigator::wheel(double steps, const dvec2& at, const dvec2& size) {
  const double nearer = std::pow(kWheelStep, steps);
  Pose pose = pose_;
  if (pose.mode == MoveMode::top) {
    const double pixel = pose.map_width / size.x;
    const dvec2 from_middle = at - 0.5 * size;
    pose.eye += (1 - nearer) * pixel * dvec3(from_middle.x, -from_middle.y, 0);
    pose.map_width = std::clamp(nearer * pose.map_width, kLeastMap * across_, kMostMap * across_);
  } else if (pose.mode == MoveMode::orbit) {
    // The point under the cursor stays there.
    const dvec3 to = point_under(at, size).value_or(point());
    pose.distance = std::clamp(nearer * pose.distance, kLeastMap * across_, kMostMap * across_);
    pose.eye = to + pose.distance / pose_.distance * (pose_.eye - to);
  } else {
    haste_ = std::clamp(haste_ / nearer, kLeastHaste, kMostHaste);
  }
  move_eye(pose);
  if (pose_.mode == MoveMode::orbit) look_at_middle();
}

void Navigator::go_to(const dvec3& at) {
  if (pose_.mode == MoveMode::top) {
    pose_.eye = {at.x, at.y, pose_.eye.z};
  } else if (pose_.mode == MoveMode::walk) {
    pose_.eye = at + dvec3(0, 0, kEyeHeight);
    (void)stand();
  } else {
    const dvec3 way = at - pose_.eye;
    pose_.azimuth = std::atan2(way.y, way.x);
    pose_.distance = std::max(kGoTo * length(way), kLeastMap * across_);
    pose_.altitude = std::clamp(std::atan2(way.z, std::hypot(way.x, way.y)), -kSteepest, kSteepest);
    pose_.eye = at - pose_.distance * forward_of(pose_);
  }
  changed_ = true;
}

bool Navigator::moving() const {
  return moves_by_keys() &&
         std::any_of(keys_.begin(), keys_.begin() + static_cast<int>(MoveKey::fast), [](bool k) { return k; });
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
      const dvec3 step = speed() * seconds * (held(MoveKey::fast) > 0 ? kFast : 1.0) / size * way;
      if (walks) {
        walk(step);
      } else {
        Pose there = pose_;
        there.eye += step;
        move_eye(there);
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
bool Navigator::stand() {
  std::optional<double> ground = ground_below(pose_.eye);
  if (!ground) ground = ground_below({pose_.eye.x, pose_.eye.y, high()});
  if (ground) pose_.eye.z = *ground + kEyeHeight;
  return ground.has_value();
}

std::optional<dvec3> Navigator::point_under(const dvec2& at, const dvec2& size) const {
  const Ray ray = camera(static_cast<int>(size.x), static_cast<int>(size.y)).ray(at.x, at.y);
  const Hit hit = scene_.closest_hit(ray);
  if (!hit || scene_.field_of(hit.object).is_backdrop()) return {};
  return ray.at(hit.t);
}

// Orbit turns around what the middle of the picture shows.
void Navigator::look_at_middle() {
  if (const auto seen = point_under({0.5, 0.5}, {1, 1}))
    pose_.distance = std::max(length(*seen - pose_.eye), kLeastMap * across_);
}

// Whether an eye may move so. Below the ground and inside of objects all ways are free, so that it gets out.
bool Navigator::is_free(const dvec3& from, const dvec3& to) const {
  const std::optional<double> ground = scene_.height(from.x, from.y);
  if (!above_ground_ || from == to || (ground && from.z <= *ground)) return true;
  Ray way;
  way.origin = from;
  way.direction = normalize(to - from);
  way.t_max = length(to - from) + kClearance * across_;
  const Hit hit = scene_.closest_hit(way);
  return !hit || hit.t <= way.t_min;
}

// In walk and top the eye has its own rules.
void Navigator::move_eye(const Pose& to) {
  const bool checked = to.mode == MoveMode::orbit || to.mode == MoveMode::fly;
  if (checked && !is_free(pose_.eye, to.eye)) return;
  pose_ = to;
  changed_ = true;
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
