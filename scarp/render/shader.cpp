// SPDX-License-Identifier: MIT
#include "scarp/render/shader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "scarp/base/error.h"
#include "scarp/march/wall.h"
#include "scarp/render/sky.h"
#include "scarp/render/visibility.h"

namespace scarp {
namespace {

// The cut earth of the plinth and of solid ground, sRGB: flat, and darker on walls that the sun does not see.
constexpr vec3 kEarth(0.64f, 0.58f, 0.53f);
constexpr float kUnlitWall = 0.55f;

// Purposes of a pixel's points.
constexpr std::uint32_t kOfSky = 0, kOfSun = 1;

double diagonal(const Box& box) { return length(box.high - box.low); }

}  // namespace

std::string_view ramp_of(const PictureSettings& settings) {
  if (!settings.ramp.empty()) return settings.ramp;
  return settings.look == Look::steps ? "viridis" : "hypsometric";
}

void require_ground(const HeightField& field) {
  if (!field.has_cells()) {
    throw Error(fmt::format("picture: the field has {} x {} samples and so no cells; at least 2 x 2 samples are needed",
                            field.cols(), field.rows()));
  }
  if (field.all_nodata()) throw Error("picture: all samples of the field are nodata; there is nothing to see");
}

std::optional<Plinth> plinth_of(const HeightField& field, const PictureSettings& settings) {
  if (!settings.plinth) return {};
  return Plinth(field, plinth_base(field));
}

Sight look(const TerrainScene& scene, const std::optional<Plinth>& plinth, Ray ray, MarchStats* stats) {
  Sight sight;
  if (plinth) {
    if (plinth->passes_below(ray)) return sight;
    sight.wall = plinth->intersect(ray);
    if (sight.wall) {
      if (sight.wall->outermost) return sight;
      ray.t_max = sight.wall->t;
    }
  }
  sight.hit = scene.closest_hit(ray, stats);
  return sight;
}

Shader::Shader(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth,
               const PictureSettings& settings)
    : scene_(scene),
      field_(scene.field()),
      camera_(camera),
      settings_(settings),
      ramp_(ramp_of(settings), field_.min_height(), field_.max_height()),
      light_(settings.sun, grid_north_azimuth),
      pattern_(settings.seed, static_cast<std::uint32_t>(std::max(1, settings.samples * settings.aa * settings.aa))),
      // No ray from the ground has a longer way to the end of the field.
      ao_distance_(std::min(settings.ao_distance, diagonal(picture_box(field_, false)))),
      earth_(linear_from_srgb(kEarth)),
      plinth_(plinth_of(field_, settings)) {
  // Haze lies over the field, not between it and a camera that stands back.
  const Box box = picture_box(field_, settings.plinth);
  const dvec3 nearest = glm::clamp(camera.eye(), box.low, box.high);
  clear_distance_ = length(nearest - camera.eye());
  haze_per_metre_ = -std::log(1 - settings.haze) / diagonal(box);
}

vec3 Shader::colour(const PicturePoint& point) const {
  const Ray ray = camera_.ray(point.x, point.y);
  const Sight sight = look(scene_, plinth_, ray);
  if (const Hit& hit = sight.hit) {
    const vec3 colour =
        hit.wall ? wall_colour(wall_normal(ray, hit)) : ramp_(ground_height(hit)) * light_on(ray, hit, point);
    return in_haze(colour, hit.t);
  }
  if (!sight.wall) return sky_colour(ray.direction.z);
  return in_haze(wall_colour(sight.wall->normal), sight.wall->t);
}

vec3 Shader::wall_colour(const dvec3& normal) const {
  const auto lit = static_cast<float>(std::max(0.0, dot(normal, light_.to_sun())));
  return earth_ * (kUnlitWall + (1 - kUnlitWall) * lit);
}

// Of the surface, where hit.height is that of the ray: they differ by rounding, and a sea at 0 must not be speckled.
double Shader::ground_height(const Hit& hit) const {
  const CellHeights h = field_.cell_heights(hit.cell).value();
  const double north = h.h00 + hit.u * (h.h10 - h.h00), south = h.h01 + hit.u * (h.h11 - h.h01);
  return field_.height_from_sample(north + hit.v * (south - north));
}

vec3 Shader::light_on(const Ray& ray, const Hit& hit, const PicturePoint& point) const {
  const GroundPoint ground = ground_point(field_, ray, hit);
  const auto samples = [&](std::uint32_t purpose) {
    const auto count = static_cast<std::uint32_t>(settings_.samples);
    return PatternRange{pattern_.pixel(point.pixel_x, point.pixel_y, purpose),
                        count * static_cast<std::uint32_t>(point.index), count};
  };
  double sun = std::max(0.0, dot(ground.shading_normal, light_.to_sun())), sky = 1;
  if (settings_.shadows && settings_.samples > 0) {
    sun = sun_cosine(scene_, ground, light_.to_sun(), light_.sun_radius(), samples(kOfSun));
  } else if (settings_.shadows && sun > 0 && hidden(scene_, ground, light_.to_sun())) {
    sun = 0;
  }
  if (settings_.samples > 0 && ao_distance_ > 0) {
    sky = 1 - sky_occlusion(scene_, ground, ao_distance_, samples(kOfSky));
  }
  return light_.on(ground.shading_normal, sun, sky);
}

vec3 Shader::in_haze(vec3 colour, double t) const {
  const auto clear = static_cast<float>(std::exp(-haze_per_metre_ * std::max(0.0, t - clear_distance_)));
  return colour * clear + haze_colour() * (1 - clear);
}

}  // namespace scarp
