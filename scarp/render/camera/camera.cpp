// SPDX-License-Identifier: MIT
#include "scarp/render/camera/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <limits>

#include "scarp/base/error.h"
#include "scarp/base/setting.h"
#include "scarp/render/camera/compass.h"

namespace scarp {
namespace {

// Fraction of the picture that automatic framing leaves free on each side.
constexpr double kMargin = 0.03;
// Minimum distance from the box, as a fraction of its diagonal: otherwise a level view would fit flat ground from its
// very border.
constexpr double kLeastDistance = 0.05;

void require_fov(double fov_deg) {
  require_setting("view", fov_deg >= 1 && fov_deg <= 150, "the angle of view", fov_deg, "1 to 150 degrees");
}

bool finite(const dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

// The positions of the eye along one axis of the picture at which all points are inside its two edges: `low` + tangent
// * z to `high` - tangent * z, for an eye at depth z.
struct Across {
  double tangent;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  void include(double across, double depth) {
    low = std::max(low, across - tangent * depth);
    high = std::min(high, across + tangent * depth);
  }
  double nearest_depth() const { return (high - low) / (2 * tangent); }
  // The intervals' middle does not depend on the depth.
  double middle() const { return (high + low) / 2; }
};

}  // namespace

void validate(const ViewSettings& settings) {
  require_setting("view", std::isfinite(settings.azimuth_deg), "the azimuth", settings.azimuth_deg,
                  "a finite number of degrees");
  require_setting("view", settings.elevation_deg >= 0 && settings.elevation_deg <= 90, "the elevation",
                  settings.elevation_deg, "0 to 90 degrees");
  require_setting("view", std::isfinite(settings.distance) && settings.distance > 0, "the distance", settings.distance,
                  "above 0 (1: the whole field just fits)");
  require_fov(settings.fov_deg);
}

Camera Camera::look_at(const dvec3& eye, const dvec3& target, double fov_deg, int width, int height) {
  require_fov(fov_deg);
  if (!finite(eye) || !finite(target)) throw Error("view: eye and target must be finite numbers, in metres");
  const dvec3 line = target - eye;
  if (!(length(line) > 0)) throw Error("view: eye and target are the same point; move one of them");
  Camera camera;
  camera.eye_ = eye;
  camera.forward_ = normalize(line);
  const dvec3 east(1, 0, 0), zenith(0, 0, 1);
  const dvec3 right = cross(camera.forward_, zenith);
  camera.right_ = length(right) > 0 ? normalize(right) : east;
  camera.up_ = cross(camera.right_, camera.forward_);
  camera.half_height_ = std::tan(glm::radians(fov_deg) / 2);
  camera.half_width_ = camera.half_height_ * width / height;
  camera.width_ = width;
  camera.height_ = height;
  return camera;
}

Camera Camera::framed(const WorldBox& box, const ViewSettings& settings, double grid_north_azimuth, int width,
                      int height, const std::optional<dvec3>& focus) {
  validate(settings);
  const double azimuth = glm::radians(settings.azimuth_deg), elevation = glm::radians(settings.elevation_deg);
  Camera camera;
  camera.forward_ = -towards(azimuth, elevation, grid_north_azimuth);
  // A quarter turn anticlockwise from the camera's position: also defined if it looks straight down.
  camera.right_ = towards(azimuth - glm::radians(90.0), 0, grid_north_azimuth);
  camera.up_ = cross(camera.right_, camera.forward_);
  camera.half_height_ = std::tan(glm::radians(settings.fov_deg) / 2);
  camera.half_width_ = camera.half_height_ * width / height;
  camera.width_ = width;
  camera.height_ = height;

  const dvec3 middle = box.middle();
  double nearest_corner = std::numeric_limits<double>::infinity();
  Across sideways{camera.half_width_ * (1 - 2 * kMargin)}, upwards{camera.half_height_ * (1 - 2 * kMargin)};
  for (int i = 0; i < 8; ++i) {
    const dvec3 from_middle = box.corner(i) - middle;
    const double depth = dot(from_middle, camera.forward_);
    nearest_corner = std::min(nearest_corner, depth);
    sideways.include(dot(from_middle, camera.right_), depth);
    upwards.include(dot(from_middle, camera.up_), depth);
  }
  const double depth = std::min({sideways.nearest_depth(), upwards.nearest_depth(),
                                 nearest_corner - kLeastDistance * length(box.high - box.low)});
  camera.eye_ = middle + sideways.middle() * camera.right_ + upwards.middle() * camera.up_ +
                std::max(1.0, settings.distance) * depth * camera.forward_;
  if (settings.distance < 1) {
    // The lateral position is that of an eye with the whole box in front of it.
    const dvec3 near = focus.value_or(middle);
    camera.eye_ = near + settings.distance * (camera.eye_ - near);
  }
  return camera;
}

Camera Camera::top(const WorldBox& box, int width, int height) {
  const dvec3 size = box.high - box.low;
  Camera camera;
  const double metres_per_pixel = std::max(size.x / width, size.y / height);
  camera.half_width_ = metres_per_pixel * width / 2;
  camera.half_height_ = metres_per_pixel * height / 2;
  camera.width_ = width;
  camera.height_ = height;
  camera.orthographic_ = true;
  // Any height above the field is suitable: the rays are parallel.
  camera.eye_ = box.middle() + dvec3(0, 0, size.x + size.y + size.z);
  return camera;
}

Ray Camera::ray(double pixel_x, double pixel_y) const {
  const double x = (2 * pixel_x / width_ - 1) * half_width_, y = (1 - 2 * pixel_y / height_) * half_height_;
  Ray ray;
  ray.origin = eye_;
  ray.direction = forward_;
  ray.t_max = reach_;
  if (orthographic_) {
    ray.origin += x * right_ + y * up_;
  } else {
    ray.direction = normalize(forward_ + x * right_ + y * up_);
  }
  return ray;
}

Camera::PixelRays Camera::pixel_rays() const {
  const dvec3 corner = -half_width_ * right_ + half_height_ * up_;
  const dvec3 right = 2 * half_width_ / width_ * right_, down = -2 * half_height_ / height_ * up_, none(0.0);
  if (orthographic_) return {eye_ + corner, right, down, forward_, none, none};
  return {eye_, none, none, forward_ + corner, right, down};
}

double Camera::footprint(const Ray& ray, double t, const dvec3& normal) const {
  constexpr double kLeastCosine = 0.05;  // as in terrain_frame_ground.glsl.h
  return pixel_width(t) / std::sqrt(std::max(kLeastCosine, -dot(ray.direction, normal)));
}

std::optional<dvec2> Camera::pixel(const dvec3& p_world) const {
  const dvec3 from_eye = p_world - eye_;
  const double depth = dot(from_eye, forward_);
  if (!(depth > 0)) return {};
  const double scale = orthographic_ ? 1.0 : depth;
  const double x = dot(from_eye, right_) / (half_width_ * scale), y = dot(from_eye, up_) / (half_height_ * scale);
  return dvec2((1 + x) * width_ / 2, (1 - y) * height_ / 2);
}

glm::dmat4 Camera::camera_from_world() const {
  // The axes are orthonormal, so the inverse rotation is the transpose. GLM's matrices are listed column by column.
  const dvec3 eye(dot(right_, eye_), dot(up_, eye_), dot(forward_, eye_));
  return {right_.x, up_.x, forward_.x, 0, right_.y, up_.y,  forward_.y, 0,
          right_.z, up_.z, forward_.z, 0, -eye.x,   -eye.y, -eye.z,     1};
}

glm::dmat4 Camera::ndc_from_world() const {
  glm::dmat4 ndc_from_camera(1.0);
  ndc_from_camera[0][0] = 1 / half_width_;
  ndc_from_camera[1][1] = 1 / half_height_;
  if (!orthographic_) {
    ndc_from_camera[2][3] = 1;
    ndc_from_camera[3][2] = -1;
    ndc_from_camera[3][3] = 0;
  }
  return ndc_from_camera * camera_from_world();
}

}  // namespace scarp
