// SPDX-License-Identifier: MIT
// Where a picture is seen from: pixels to rays, points to pixels.
//
//   pixel coordinates: (0, 0) is the picture's upper left corner, x to the right, y down; pixel (i, j) has its centre
//   at (i + 0.5, j + 0.5). World coordinates: metres, x east, y north from the field's south-west sample, z up.
//
// Automatic framing has a closed form. With the camera's axes fixed, a point with the camera coordinates (a, b, c) is
// inside the picture of an eye (x, y, z) when |a - x| <= p (c - z) and |b - y| <= q (c - z), p and q being the tangents
// of half the angles of view. The corners of a box thus bound x and y from both sides, linearly in z; the nearest eye
// is the largest z that leaves both intervals something, and the middle of the wider one centres the field.
#pragma once

#include <glm/mat4x4.hpp>
#include <limits>
#include <optional>

#include "scarp/base/ray.h"
#include "scarp/base/vec.h"
#include "scarp/base/world_box.h"

namespace scarp {

/// A view onto a whole field, framed automatically.
struct ViewSettings {
  double azimuth_deg = 190;   ///< compass azimuth at which the camera stands as seen from what it looks at; finite
  double elevation_deg = 35;  ///< its angle above the horizon from there; 0..90
  double distance = 1;        ///< in multiples of the distance at which the field just fits into the picture; > 0.
                              ///< Below 1 the eye goes straight towards the focus of Camera::framed()
  double fov_deg = 30;        ///< vertical angle of view; 1..150
};

/// Throws Error naming the first setting out of its range.
void validate(const ViewSettings& settings);

class Camera {
 public:
  /// A perspective camera of the caller's choice, upright; looking straight down or up, the picture's top is north.
  /// Throws Error: eye and target are one point or not finite, fov_deg outside 1..150. `width`, `height` in pixels.
  static Camera look_at(const dvec3& eye, const dvec3& target, double fov_deg, int width, int height);
  /// A perspective camera that has the whole box in the picture, as large as a small margin lets it be (at distance 1).
  /// What nearer views go towards is `focus`, the middle of the box where none is given; it should lie in the box.
  /// Throws Error for settings out of their range.
  static Camera framed(const WorldBox& box, const ViewSettings& settings, double grid_north_azimuth, int width,
                       int height, const std::optional<dvec3>& focus = {});
  /// An orthographic camera looking straight down, the grid's north up, square pixels on the ground. The box fits in
  /// exactly: its border is the picture's border in one of the two directions.
  static Camera top(const WorldBox& box, int width, int height);

  /// The ray through a place in the picture: unit direction, so t counts in metres.
  Ray ray(double pixel_x, double pixel_y) const;
  /// All rays at once, as sums: the ray through (x, y) goes from origin + x origin_right + y origin_down along
  /// direction + x right + y down, which is not normalised but goes a metre along the view axis per t.
  struct PixelRays {
    dvec3 origin, origin_right, origin_down;
    dvec3 direction, right, down;
  };
  PixelRays pixel_rays() const;
  bool orthographic() const { return orthographic_; }
  /// Where a point appears, inside the picture or not; nothing for points that are not in front of the camera.
  std::optional<dvec2> pixel(const dvec3& p_world) const;

  /// Camera coordinates of world points: x to the right, y up, z metres along the view axis (left-handed).
  glm::dmat4 camera_from_world() const;
  /// Homogeneous coordinates that divide to x and y in [-1, 1] from the picture's left to right and bottom to top. z
  /// divides to 1 - 1 m / depth in perspective, and is the depth in metres of an orthographic camera.
  glm::dmat4 ndc_from_world() const;

  /// Rays end `metres` away; above 0. A picture of a field that wraps round needs an end.
  void set_reach(double metres) { reach_ = metres; }
  double reach() const { return reach_; }

  /// How wide a pixel is at a depth, in metres.
  double pixel_width(double depth) const { return 2 * half_width_ / width_ * (orthographic_ ? 1 : depth); }

  const dvec3& eye() const { return eye_; }
  /// It looks the same way from there.
  void move_eye(const dvec3& eye) { eye_ = eye; }
  const dvec3& forward() const { return forward_; }

 private:
  Camera() = default;

  dvec3 eye_{0.0};
  dvec3 right_{1, 0, 0}, up_{0, 1, 0}, forward_{0, 0, -1};
  // Half the picture: tangents of half the angles of view, or metres for an orthographic camera.
  double half_width_ = 1, half_height_ = 1;
  double width_ = 1, height_ = 1;
  bool orthographic_ = false;
  double reach_ = std::numeric_limits<double>::infinity();
};

}  // namespace scarp
