// SPDX-License-Identifier: MIT
// Cameras: pixels to rays, and points to pixels.
//
//   pixel coordinates: (0, 0) is the upper left corner of the picture, x to the right, y down; pixel (i, j) has its
//   centre at (i + 0.5, j + 0.5). World coordinates: metres, x east, y north from the field's south-west sample, z up.
//
// Automatic framing has a closed form. The axes of the camera are given. A point with the camera coordinates (a, b, c)
// is inside the picture seen from an eye at (x, y, z) if |a - x| <= p (c - z) and |b - y| <= q (c - z), where p and q
// are the tangents of half the angles of view. Each corner of a box thus bounds x and y from both sides, linearly in z.
// The nearest eye has the largest z for which neither interval is empty; the middles of the intervals centre the box.
#pragma once

#include <glm/mat4x4.hpp>
#include <limits>
#include <optional>

#include "scarp/base/ray.h"
#include "scarp/base/vec.h"
#include "scarp/base/world_box.h"

namespace scarp {

/// A view of a whole scene, framed automatically.
struct ViewSettings {
  double azimuth_deg = 190;   ///< compass azimuth of the eye as seen from the scene; finite
  double elevation_deg = 35;  ///< angle of the eye above the horizon as seen from the scene, 0..90
  double distance = 1;        ///< as a multiple of the distance at which the scene just fits into the picture, > 0.
                              ///< Below 1 the eye moves straight towards the focus of Camera::framed()
  double fov_deg = 30;        ///< vertical angle of view, 1..150
};

/// Throws Error naming the first setting that is out of range.
void validate(const ViewSettings& settings);

/// A perspective or orthographic camera.
class Camera {
 public:
  /// Returns an upright perspective camera. `width` and `height` are in pixels. If it looks straight down or up, north
  /// is at the top of the picture (down) or at the bottom (up). Throws Error if eye and target are equal or not finite,
  /// or fov_deg is outside 1..150.
  static Camera look_at(const dvec3& eye, const dvec3& target, double fov_deg, int width, int height);
  /// Returns a perspective camera. At distance 1 it shows the whole box as large as possible, with a small margin. At
  /// distances below 1 the eye moves towards `focus`, a point in the box; nullopt: its centre. `grid_north_azimuth` is
  /// the compass azimuth of the world's y axis in radians. Throws Error if a setting is out of range.
  static Camera framed(const WorldBox& box, const ViewSettings& settings, double grid_north_azimuth, int width,
                       int height, const std::optional<dvec3>& focus = {});
  /// Returns an orthographic camera that looks straight down, with grid north at the top and square pixels on the
  /// ground. The box fits exactly: it fills the picture in at least one direction.
  static Camera top(const WorldBox& box, int width, int height);

  /// Returns the ray through a position in the picture. Its direction has length 1, so t is in metres.
  Ray ray(double pixel_x, double pixel_y) const;
  /// All rays in linear form: the ray through (x, y) has the origin `origin + x origin_right + y origin_down` and the
  /// direction `direction + x right + y down`. The direction is not normalised: t is in metres along the view axis.
  struct PixelRays {
    dvec3 origin, origin_right, origin_down;
    dvec3 direction, right, down;
  };
  /// Returns the rays of all pixels.
  PixelRays pixel_rays() const;
  bool orthographic() const { return orthographic_; }
  /// Returns the pixel coordinates of a point, which may lie outside the picture; nullopt if the point is not in front
  /// of the camera.
  std::optional<dvec2> pixel(const dvec3& p_world) const;

  /// Returns the matrix from world to camera coordinates: metres, x to the right, y up, z along the view axis
  /// (left-handed).
  dmat4 camera_from_world() const;
  /// Returns the matrix from world to homogeneous coordinates. After division by w, x and y are in [-1, 1] from left to
  /// right and from bottom to top of the picture. z is 1 - 1 m / depth in perspective, and the depth in metres for an
  /// orthographic camera.
  dmat4 ndc_from_world() const;

  /// Sets t_max of the rays, in metres, > 0; infinite by default. Terrain that wraps requires a finite reach.
  void set_reach(double metres) { reach_ = metres; }
  double reach() const { return reach_; }

  /// Returns the width of the surface with this unit normal that a pixel covers at `t` of one of its rays, in metres:
  /// the mean of length and width, because a pixel is longer than wide on surfaces seen from the side.
  double footprint(const Ray& ray, double t, const dvec3& normal) const;

  /// Returns the width of a pixel at a depth, both in metres.
  double pixel_width(double depth) const { return 2 * half_width_ / width_ * (orthographic_ ? 1 : depth); }

  /// Returns the width and height of the picture in pixels.
  dvec2 size() const { return {width_, height_}; }
  const dvec3& eye() const { return eye_; }
  /// Moves the eye and keeps the view direction.
  void move_eye(const dvec3& eye) { eye_ = eye; }
  const dvec3& forward() const { return forward_; }

 private:
  Camera() = default;

  dvec3 eye_{0.0};
  dvec3 right_{1, 0, 0}, up_{0, 1, 0}, forward_{0, 0, -1};
  // Half the size of the picture: tangents of half the angles of view, or metres for an orthographic camera.
  double half_width_ = 1, half_height_ = 1;
  double width_ = 1, height_ = 1;
  bool orthographic_ = false;
  double reach_ = std::numeric_limits<double>::infinity();
};

}  // namespace scarp
