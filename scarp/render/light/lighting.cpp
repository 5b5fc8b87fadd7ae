// SPDX-License-Identifier: MIT
#include "scarp/render/light/lighting.h"

#include <algorithm>

#include "scarp/render/light/air.glsl.h"
#include "scarp/render/light/sample_pattern.glsl.h"

namespace scarp {
namespace {

// Rays over wrapped ground need an end: there is nothing above the highest summit, and low rays end far away.
void end_above_ground(std::span<Ray> rays, double highest) {
  for (Ray& ray : rays) {
    const double rise = std::max(highest - ray.origin.z, 0.0);
    ray.t_max = rise / std::max(ray.direction.z, double{glsl::kScarpLeastSunRise});
  }
}

}  // namespace

Lighting::Lighting(const LightSettings& settings, double ao_distance, std::optional<double> highest)
    : settings_(settings),
      light_(settings.sun, settings.grid_north_azimuth, settings.sky),
      pattern_(settings.seed, static_cast<std::uint32_t>(std::max(1, samples() * settings.points_per_pixel))),
      ao_distance_(ao_distance),
      highest_(highest) {}

int Lighting::sun_rays() const { return !shadows() ? 0 : sun_radius() > 0 ? samples() : 1; }
int Lighting::sky_rays() const { return ao_distance_ > 0 ? samples() : 0; }

std::size_t Lighting::most_rays() const { return static_cast<std::size_t>(std::max(1, 2 * samples())); }

LightRays Lighting::ask(const LightPoint& at, const PicturePoint& point, std::vector<Ray>& rays) const {
  const auto pattern = [&](std::uint32_t purpose) {
    const auto count = static_cast<std::uint32_t>(samples());
    if (count == 0) return PatternRange{};  // a point sun needs no pattern
    return PatternRange{pattern_.pixel(point.pixel_x, point.pixel_y, purpose),
                        count * static_cast<std::uint32_t>(point.index), count};
  };
  LightRays asked;
  asked.sun = rays.size();
  if (shadows()) ask_sun(at, light_.to_sun(), sun_radius(), pattern(glsl::kScarpPointsOfSun), rays);
  if (highest_) end_above_ground(std::span(rays).subspan(asked.sun), *highest_);
  asked.sky = rays.size();
  if (sky_rays() > 0) ask_sky(at, ao_distance_, pattern(glsl::kScarpPointsOfSky), rays);
  asked.end = rays.size();
  return asked;
}

vec3 Lighting::on(const LightPoint& at, const LightRays& asked, std::span<const Ray> rays,
                  std::span<const std::uint8_t> blocked) const {
  if (settings_.unlit) return vec3(1.0f);
  double sun = std::max(0.0, dot(at.shading_normal, light_.to_sun())), sky = at.openness;
  if (shadows()) {
    const std::size_t count = asked.sky - asked.sun;
    sun = sun_cosine(at, sun_radius(), static_cast<std::uint32_t>(samples()), rays.subspan(asked.sun, count),
                     blocked.subspan(asked.sun, count));
  }
  if (asked.end > asked.sky) sky = 1 - sky_occlusion(blocked.subspan(asked.sky, asked.end - asked.sky));
  return light_.on(at.shading_normal, sun, sky);
}

}  // namespace scarp
