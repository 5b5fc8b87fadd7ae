// SPDX-License-Identifier: MIT
#include "scarp/render/light/visibility.h"

#include <algorithm>
#include <limits>

#include "scarp/render/light/sample_directions.h"

namespace scarp {
namespace {

Ray ray_from(const LightPoint& point, const dvec3& direction, double distance) {
  Ray ray;
  ray.origin = point.position;
  ray.direction = direction;
  ray.t_max = distance;
  ray.start = RayStart::on_surface;
  ray.start_cell = point.cell;
  ray.start_object = point.object;
  return ray;
}

void ask_far(const LightPoint& point, const dvec3& direction, std::vector<Ray>& rays) {
  if (dot(point.shading_normal, direction) > 0) {
    rays.push_back(ray_from(point, direction, std::numeric_limits<double>::infinity()));
  }
}

}  // namespace

LightPoint light_point(const SceneSurface& surface, const Hit& hit) {
  return {surface.position, surface.normal, surface.shading_normal, surface.openness, hit.object, hit.cell};
}

void ask_sky(const LightPoint& point, double distance, const PatternRange& samples, std::vector<Ray>& rays) {
  const Frame frame(point.normal);
  for (std::uint32_t i = samples.first; i < samples.first + samples.count; ++i) {
    rays.push_back(ray_from(point, frame.to_world(cosine_weighted(samples.points[i])), distance));
  }
}

double sky_occlusion(std::span<const std::uint8_t> blocked) {
  const auto hidden = blocked.size() - static_cast<std::size_t>(std::count(blocked.begin(), blocked.end(), 0));
  return static_cast<double>(hidden) / static_cast<double>(blocked.size());
}

void ask_sun(const LightPoint& point, const dvec3& to_sun, double radius, const PatternRange& samples,
             std::vector<Ray>& rays) {
  if (radius == 0) return ask_far(point, to_sun, rays);
  const Frame frame(to_sun);
  for (std::uint32_t i = samples.first; i < samples.first + samples.count; ++i) {
    ask_far(point, frame.to_world(in_cap(samples.points[i], radius)), rays);
  }
}

double sun_cosine(const LightPoint& point, double radius, std::uint32_t count, std::span<const Ray> rays,
                  std::span<const std::uint8_t> blocked) {
  double sum = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!blocked[i]) sum += dot(point.shading_normal, rays[i].direction);
  }
  return radius == 0 ? sum : sum / count;
}

}  // namespace scarp
