// SPDX-License-Identifier: MIT
#include "scarp/render/frame/shader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "scarp/base/error.h"
#include "scarp/march/height/wall.h"
#include "scarp/render/light/sky.h"

namespace scarp {
namespace {

// The cut earth of the plinth and of solid ground, sRGB: flat, and darker on walls that the sun does not see.
constexpr vec3 kEarth(0.64f, 0.58f, 0.53f);
constexpr float kUnlitWall = 0.55f;

double diagonal(const Box& box) { return length(box.high - box.low); }

}  // namespace

void require_ground(const HeightField& field) {
  if (!field.has_cells()) {
    throw Error(fmt::format("picture: the field has {} x {} samples and so no cells; at least 2 x 2 samples are needed",
                            field.cols(), field.rows()));
  }
  if (field.all_nodata()) throw Error("picture: all samples of the field are nodata; there is nothing to see");
}

Shader::Shader(const HeightField& field, const Camera& camera, double grid_north_azimuth,
               const PictureSettings& settings)
    : field_(field),
      settings_(settings),
      camera_(camera),
      // No ray from the ground has a longer way to the end of the field.
      lighting_(settings, grid_north_azimuth, std::min(settings.ao_distance, diagonal(picture_box(field_, false))),
                field.wraps() ? std::optional(field.max_height()) : std::nullopt),
      paint_(settings.ground, field,
             ramp_over(settings, field.min_height(), field.max_height(), field.settings().exaggeration),
             lighting_.to_sun()),
      fog_(settings.fog, lighting_.to_sun()),
      earth_(linear_from_srgb(kEarth)) {
  // Haze lies over the field, not between it and a camera that stands back.
  const Box box = picture_box(field_, settings.plinth);
  const dvec3 nearest = glm::clamp(camera.eye(), box.low, box.high);
  endless_ = field.wraps();
  clear_distance_ = length(nearest - camera.eye());
  if (settings.look == Look::comanche || settings.fog.kind != FogKind::none) return;
  haze_per_metre_ = -std::log(1 - settings.haze) / diagonal(box);
}

vec3 Shader::ground_colour(const Ray& ray, const Hit& hit, const GroundPoint& ground, const LightRays& asked,
                           std::span<const Ray> rays, std::span<const std::uint8_t> blocked) const {
  return in_air(lit_ground(ray, hit, ground, asked, rays, blocked), ray, hit.t);
}

vec3 Shader::lit_ground(const Ray& ray, const Hit& hit, const GroundPoint& ground, const LightRays& asked,
                        std::span<const Ray> rays, std::span<const std::uint8_t> blocked) const {
  // What a pixel covers is longer than it is wide where ground is seen from the side: the mean of both.
  const double cosine = std::max(0.05, -dot(ray.direction, ground.normal));
  const double footprint = camera_.pixel_width(hit.t) / std::sqrt(cosine);
  return paint_(ground.position, ground_height(hit), ground.shading_normal, footprint) *
         lighting_.on(ground, asked, rays, blocked);
}

vec3 Shader::colour_beside_ground(const Ray& ray, const Sight& sight) const {
  if (sight.hit) return in_air(wall_colour(wall_normal(ray, sight.hit)), ray, sight.hit.t);
  if (sight.wall) return in_air(wall_colour(sight.wall->normal), ray, sight.wall->t);
  // Ground that lies farther away than the picture reaches is at the horizon.
  const double z = horizon_below() ? std::max(0.0, ray.direction.z) : ray.direction.z;
  return fog_(ray, std::numeric_limits<double>::infinity(), sky_colour(z));
}

float Shader::unlit_wall() { return kUnlitWall; }

vec3 Shader::wall_colour(const dvec3& normal) const {
  const auto lit = static_cast<float>(std::max(0.0, dot(normal, lighting_.to_sun())));
  return earth_ * (kUnlitWall + (1 - kUnlitWall) * lit);
}

double Shader::ground_height(const Hit& hit) const {
  const CellHeights h = field_.cell_heights(hit.cell).value();
  const double north = h.h00 + hit.u * (h.h10 - h.h00), south = h.h01 + hit.u * (h.h11 - h.h01);
  return field_.height_from_sample(north + hit.v * (south - north));
}

vec3 Shader::in_air(vec3 colour, const Ray& ray, double t) const {
  if (fog_.kind() != FogKind::none) return fog_(ray, t, colour);
  const auto clear = static_cast<float>(std::exp(-haze_per_metre_ * std::max(0.0, t - clear_distance_)));
  return colour * clear + haze_colour() * (1 - clear);
}

}  // namespace scarp
