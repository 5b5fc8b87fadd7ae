// SPDX-License-Identifier: MIT
#include "scarp/render/layers.h"

#include <fmt/format.h>

#include <cstddef>
#include <limits>

#include "scarp/base/error.h"
#include "scarp/march/wall.h"
#include "scarp/render/shader.h"

namespace scarp {

PictureLayers render_layers(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth,
                            const PictureSettings& settings, const Progress& progress) {
  validate(settings);
  if (settings.look != Look::shaded) {
    throw Error(
        fmt::format("picture: layers go with the look 'shaded', not with '{}'; depth, position and steps are "
                    "layers themselves",
                    name_of(settings.look)));
  }
  const HeightField& field = scene.field();
  require_ground(field);
  const Shader shader(scene, camera, grid_north_azimuth, settings);
  const std::optional<Plinth> plinth = plinth_of(field, settings);
  const auto width = static_cast<std::size_t>(settings.width);
  const std::size_t pixels = width * static_cast<std::size_t>(settings.height);
  PictureLayers layers{settings.width,
                       settings.height,
                       std::vector<vec3>(pixels),
                       std::vector<float>(pixels, std::numeric_limits<float>::infinity()),
                       std::vector<vec3>(pixels, vec3(0.0f)),
                       std::vector<vec3>(pixels, vec3(0.0f)),
                       std::vector<std::uint32_t>(pixels)};
  for_each_pixel(
      settings.width, settings.height,
      [&](int x, int y) {
        const std::size_t i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
        layers.colour[i] =
            mean_colour(x, y, settings.aa, [&](const PicturePoint& point) { return shader.colour(point); });
        const Ray ray = camera.ray(x + 0.5, y + 0.5);
        MarchStats stats;
        const Sight sight = look(scene, plinth, ray, &stats);
        layers.steps[i] = stats.steps;
        if (!sight.hit && !sight.wall) return;
        const dvec3 position = ray.at(sight.hit ? sight.hit.t : sight.wall->t);
        layers.depth[i] = static_cast<float>(dot(position - camera.eye(), camera.forward()));
        layers.normal[i] = !sight.hit       ? sight.wall->normal
                           : sight.hit.wall ? wall_normal(ray, sight.hit)
                                            : field.normal(sight.hit.cell, sight.hit.u, sight.hit.v);
        layers.position[i] = position;
      },
      progress);
  return layers;
}

}  // namespace scarp
