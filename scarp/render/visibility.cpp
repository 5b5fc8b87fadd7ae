// SPDX-License-Identifier: MIT
#include "scarp/render/visibility.h"

#include <cmath>
#include <limits>

#include "scarp/render/sample_directions.h"

namespace scarp {
namespace {

bool hidden_within(const TerrainScene& scene, const GroundPoint& point, const dvec3& direction, double distance) {
  Ray ray;
  ray.origin = point.position;
  ray.direction = direction;
  ray.t_max = distance;
  ray.start = RayStart::on_surface;
  ray.start_cell = point.cell;
  return scene.occluded(ray);
}

}  // namespace

GroundPoint ground_point(const HeightField& field, const Ray& ray, const Hit& hit) {
  return {ray.at(hit.t), hit.cell, field.normal(hit.cell, hit.u, hit.v), field.shading_normal(hit.cell, hit.u, hit.v)};
}

double sky_occlusion(const TerrainScene& scene, const GroundPoint& point, double distance,
                     const PatternRange& samples) {
  const Frame frame(point.normal);
  int blocked = 0;
  for (std::uint32_t i = samples.first; i < samples.first + samples.count; ++i) {
    const dvec3 direction = frame.to_world(cosine_weighted(samples.points[i]));
    if (hidden_within(scene, point, direction, distance)) ++blocked;
  }
  return blocked / static_cast<double>(samples.count);
}

double sun_cosine(const TerrainScene& scene, const GroundPoint& point, const dvec3& to_sun, double radius,
                  const PatternRange& samples) {
  const dvec3& normal = point.shading_normal;
  if (radius == 0) {
    const double cosine = dot(normal, to_sun);
    return cosine > 0 && !hidden(scene, point, to_sun) ? cosine : 0.0;
  }
  const Frame frame(to_sun);
  double sum = 0;
  for (std::uint32_t i = samples.first; i < samples.first + samples.count; ++i) {
    const dvec3 direction = frame.to_world(in_cap(samples.points[i], radius));
    const double cosine = dot(normal, direction);
    if (cosine > 0 && !hidden(scene, point, direction)) sum += cosine;
  }
  return sum / samples.count;
}

bool hidden(const TerrainScene& scene, const GroundPoint& point, const dvec3& direction) {
  return hidden_within(scene, point, direction, std::numeric_limits<double>::infinity());
}

}  // namespace scarp
