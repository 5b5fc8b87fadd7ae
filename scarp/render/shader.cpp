// SPDX-License-Identifier: MIT
#include "scarp/render/shader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "scarp/base/error.h"
#include "scarp/march/wall.h"
#include "scarp/render/sky.h"

namespace scarp {
namespace {

// The cut earth of the plinth and of solid ground, sRGB: flat, and darker on walls that the sun does not see.
constexpr vec3 kEarth(0.64f, 0.58f, 0.53f);
constexpr float kUnlitWall = 0.55f;

// The sine of the lowest sun that casts shadows over endless ground.
constexpr double kLeastSunRise = 1e-3;

// Purposes of a pixel's points.
constexpr std::uint32_t kOfSky = 0, kOfSun = 1;

// Rays over endless ground need an end: above the highest summit nothing is met, and low rays end far away.
void end_above_ground(std::span<Ray> rays, double highest) {
  for (Ray& ray : rays) {
    const double rise = std::max(highest - ray.origin.z, 0.0);
    ray.t_max = rise / std::max(ray.direction.z, kLeastSunRise);
  }
}

double diagonal(const Box& box) { return length(box.high - box.low); }

}  // namespace

std::string_view ramp_of(const PictureSettings& settings) {
  if (!settings.ramp.empty()) return settings.ramp;
  return settings.look == Look::steps ? "viridis" : "hypsometric";
}

Ramp ramp_over(const PictureSettings& settings, double low, double high, double scale) {
  if (settings.ramp_stops) return {*settings.ramp_stops, low, high, scale};
  return {ramp_of(settings), low, high};
}

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
      light_(settings.sun, grid_north_azimuth),
      paint_(settings.ground, field,
             ramp_over(settings, field.min_height(), field.max_height(), field.settings().exaggeration),
             light_.to_sun()),
      fog_(settings.fog, light_.to_sun()),
      pattern_(settings.seed, static_cast<std::uint32_t>(std::max(1, settings.samples * settings.aa * settings.aa))),
      // No ray from the ground has a longer way to the end of the field.
      ao_distance_(std::min(settings.ao_distance, diagonal(picture_box(field_, false)))),
      earth_(linear_from_srgb(kEarth)) {
  // Haze lies over the field, not between it and a camera that stands back.
  const Box box = picture_box(field_, settings.plinth);
  const dvec3 nearest = glm::clamp(camera.eye(), box.low, box.high);
  endless_ = field.wraps();
  clear_distance_ = length(nearest - camera.eye());
  if (settings.look == Look::comanche || settings.fog.kind != FogKind::none) return;
  haze_per_metre_ = -std::log(1 - settings.haze) / diagonal(box);
}

std::size_t Shader::most_light_rays() const { return static_cast<std::size_t>(std::max(1, 2 * settings_.samples)); }

LightRays Shader::ask_light(const GroundPoint& ground, const PicturePoint& point, std::vector<Ray>& rays) const {
  const auto samples = [&](std::uint32_t purpose) {
    const auto count = static_cast<std::uint32_t>(settings_.samples);
    if (count == 0) return PatternRange{};  // a point of a sun needs none
    return PatternRange{pattern_.pixel(point.pixel_x, point.pixel_y, purpose),
                        count * static_cast<std::uint32_t>(point.index), count};
  };
  LightRays asked;
  asked.sun = rays.size();
  if (settings_.shadows) ask_sun(ground, light_.to_sun(), sun_radius(), samples(kOfSun), rays);
  if (endless_) end_above_ground(std::span(rays).subspan(asked.sun), field_.max_height());
  asked.sky = rays.size();
  if (settings_.samples > 0 && ao_distance_ > 0) ask_sky(ground, ao_distance_, samples(kOfSky), rays);
  asked.end = rays.size();
  return asked;
}

vec3 Shader::ground_colour(const Ray& ray, const Hit& hit, const GroundPoint& ground, const LightRays& asked,
                           std::span<const Ray> rays, std::span<const std::uint8_t> blocked) const {
  return in_air(lit_ground(ray, hit, ground, asked, rays, blocked), ray, hit.t);
}

vec3 Shader::lit_ground(const Ray& ray, const Hit& hit, const GroundPoint& ground, const LightRays& asked,
                        std::span<const Ray> rays, std::span<const std::uint8_t> blocked) const {
  double sun = std::max(0.0, dot(ground.shading_normal, light_.to_sun())), sky = 1;
  if (settings_.shadows) {
    const std::size_t count = asked.sky - asked.sun;
    sun = sun_cosine(ground, sun_radius(), static_cast<std::uint32_t>(settings_.samples),
                     rays.subspan(asked.sun, count), blocked.subspan(asked.sun, count));
  }
  if (asked.end > asked.sky) sky = 1 - sky_occlusion(blocked.subspan(asked.sky, asked.end - asked.sky));
  // What a pixel covers is longer than it is wide where ground is seen from the side: the mean of both.
  const double cosine = std::max(0.05, -dot(ray.direction, ground.normal));
  const double footprint = camera_.pixel_width(hit.t) / std::sqrt(cosine);
  return paint_(ground.position, ground_height(hit), ground.shading_normal, footprint) *
         light_.on(ground.shading_normal, sun, sky);
}

vec3 Shader::colour_beside_ground(const Ray& ray, const Sight& sight) const {
  if (sight.hit) return in_air(wall_colour(wall_normal(ray, sight.hit)), ray, sight.hit.t);
  if (sight.wall) return in_air(wall_colour(sight.wall->normal), ray, sight.wall->t);
  // Ground that lies farther away than the picture reaches is at the horizon.
  const double z = endless_ || settings_.look == Look::comanche ? std::max(0.0, ray.direction.z) : ray.direction.z;
  return fog_(ray, std::numeric_limits<double>::infinity(), sky_colour(z));
}

vec3 Shader::wall_colour(const dvec3& normal) const {
  const auto lit = static_cast<float>(std::max(0.0, dot(normal, light_.to_sun())));
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
