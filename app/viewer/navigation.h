// SPDX-License-Identifier: MIT
// Navigation in a scene by mouse and keys: takes events and time, and returns cameras. Independent of window and
// device.
//
//   orbit  around a point; left drag turns, right or middle drag pans, the wheel moves towards the cursor
//   fly    W A S D Q E move, a drag looks around, the wheel changes the speed, which grows with the height above ground
//   walk   as fly, 1.7 m above the ground; exact rays detect obstacles, so walls are never crossed
//   top    a map, straight down; a drag pans, the wheel zooms towards the cursor
//
// In orbit and fly, exact rays keep the eye above the ground, unless it starts below.
#pragma once

#include <array>
#include <optional>

#include "scarp/render/camera/camera.h"
#include "scarp/scene/scene.h"

namespace scarp::viewer {

enum class MoveMode { orbit, fly, walk, top };

/// Position and view direction. Angles in radians: azimuth of the view direction in the world's axes, counterclockwise
/// from x; its altitude above the horizon.
struct Pose {
  MoveMode mode = MoveMode::orbit;
  dvec3 eye{0.0};
  double azimuth = 0, altitude = 0;
  double distance = 1;  ///< metres from the eye to the point that orbit turns around
  double fov_deg = 30;
  double map_width = 0;  ///< width of the area that a map shows, in metres
};

dvec3 forward_of(const Pose& pose);
/// The pose that shows the same points after all heights are multiplied by a factor.
Pose with_heights_times(const Pose& pose, double factor);
/// The corners of the map of a pose, for a picture of this size: west and south, east and north.
std::array<dvec2, 2> map_corners(const Pose& pose, int width, int height);

/// Azimuth and altitude of the sun in degrees after a drag in a picture of this size: azimuth by x, altitude by y.
dvec2 dragged_sun(const dvec2& sun, const dvec2& drag, const dvec2& size);

enum class MoveKey { forward, back, left, right, up, down, fast };
constexpr std::size_t kMoveKeys = 7;

class Navigator {
 public:
  static constexpr double kEyeHeight = 1.7;               ///< of a walker, in metres above the ground
  static constexpr double kLeastFov = 1, kMostFov = 150;  ///< degrees

  /// `scene` is queried for walkers, and must outlive the navigator; `across` is the extent of the scene in metres.
  Navigator(const Scene& scene, const Camera& first, double fov_deg, double across);

  /// The camera of the pose for a picture of this size.
  Camera camera(int width, int height) const;
  const Pose& pose() const { return pose_; }
  /// The pose of a perspective camera: in `top` straight down, from where the picture shows the same width of the
  /// ground in its middle.
  Pose perspective(const dvec2& size) const;
  /// Sets the pose; a walker is placed on the ground.
  void set_pose(const Pose& pose);
  /// Changes the mode in a picture of this size: a walker starts on the ground at the point that orbit turns around,
  /// or below the eye, and looks ahead; a map shows the whole scene. Returns false, without a change, if there is no
  /// ground to walk on.
  bool set_mode(MoveMode mode, const dvec2& size);
  /// Metres per second of fly and walk.
  double speed() const;
  /// Sets the vertical field of view in degrees, limited to kLeastFov .. kMostFov.
  void set_fov(double degrees);
  /// Whether exact rays keep the eye above the ground; they do at first.
  void keep_above_ground(bool keep) { above_ground_ = keep; }
  bool keeps_above_ground() const { return above_ground_; }

  // Events. `size` is that of the picture; drags and positions are in its pixels, y down.
  void key(MoveKey key, bool down) { keys_[static_cast<std::size_t>(key)] = down; }
  void turn(const dvec2& drag, const dvec2& size);
  void shift(const dvec2& drag, const dvec2& size);
  void wheel(double steps, const dvec2& at, const dvec2& size);
  /// Moves towards a point of the scene that was clicked; orbit then turns around it.
  void go_to(const dvec3& point);
  void release_keys() { keys_ = {}; }

  /// Applies the held keys for `seconds`. Returns whether the pose changed since the last call.
  bool advance(double seconds);
  bool moving() const;
  /// Whether the mode has movements by held keys.
  bool moves_by_keys() const { return pose_.mode == MoveMode::fly || pose_.mode == MoveMode::walk; }

 private:
  dvec3 point() const { return pose_.eye + pose_.distance * forward_of(pose_); }
  double high() const;  // above everything
  std::optional<double> ground_below(const dvec3& at) const;
  void walk(const dvec3& step);
  bool stand();
  void look_at_middle();
  bool is_free(const dvec3& from, const dvec3& to) const;
  void move_eye(const Pose& to);
  std::optional<dvec3> point_under(const dvec2& at, const dvec2& size) const;
  Pose whole_map(const dvec2& size) const;

  const Scene& scene_;
  WorldBox box_;  // area of a map; empty: unbounded
  Pose pose_;
  dvec3 first_eye_{0.0};
  double across_;
  double haste_ = 1;          // factor of the speed, by the wheel
  double usual_fov_deg_ = 0;  // of the other modes, while walking
  bool above_ground_ = true;
  std::array<bool, kMoveKeys> keys_{};
  bool changed_ = true;
};

}  // namespace scarp::viewer
