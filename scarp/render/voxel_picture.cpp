// SPDX-License-Identifier: MIT
#include "scarp/render/voxel_picture.h"

#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/render/ramp.h"
#include "scarp/render/sky.h"
#include "scarp/render/step_look.h"

namespace scarp {
namespace {

vec3 linear_colour(const VoxelColour& colour) {
  return linear_from_srgb(vec3(colour[0], colour[1], colour[2]) / 255.0f);
}

class VoxelShader {
 public:
  VoxelShader(const VoxelScene& scene, const Camera& camera, const PictureSettings& settings)
      : scene_(scene), camera_(camera), light_(settings.sun, 0), shadows_(settings.shadows) {}

  vec3 colour(const PicturePoint& point) const {
    const Ray ray = camera_.ray(point.x, point.y);
    const VoxelSceneHit hit = scene_.closest_hit(ray);
    if (!hit) return sky_colour(ray.direction.z);
    const vec3 colour = linear_colour(scene_.colour(hit));
    // The camera is inside of a voxel: its colour is all there is to see.
    if (hit.hit.face == VoxelFace::inside) return colour;
    const dvec3 normal = scene_.normal(hit);
    Ray to_sun;
    to_sun.origin = ray.at(hit.hit.t);
    to_sun.direction = light_.to_sun();
    const bool faces_sun = dot(normal, light_.to_sun()) > 0;
    return colour * light_.on(normal, faces_sun && !(shadows_ && scene_.occluded_from(hit, to_sun)));
  }

 private:
  const VoxelScene& scene_;
  const Camera& camera_;
  Light light_;
  bool shadows_;
};

// body(points) for the points of each pixel, on all threads.
template <class Body>
void for_each_pixel(const PictureSettings& settings, int aa, const Progress& progress, const Body& body) {
  const PixelTiles tiles(settings.width, settings.height, aa);
  const auto per_pixel = static_cast<std::size_t>(aa) * static_cast<std::size_t>(aa);
  parallel_for(
      tiles.count(), 1,
      [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t tile = begin; tile < end; ++tile) {
          const std::vector<PicturePoint> points = points_of(tiles[tile], aa);
          for (std::size_t i = 0; i < points.size(); i += per_pixel) body(std::span(points).subspan(i, per_pixel));
        }
      },
      progress);
}

}  // namespace

Box picture_box(const VoxelScene& scene) {
  const WorldBox& box = scene.box();
  if (!(box.low.x <= box.high.x)) throw Error("picture: the scene has no solid voxels; there is nothing to see");
  return {box.low, box.high};
}

Picture render_voxels(const VoxelScene& scene, const Camera& camera, const PictureSettings& settings,
                      const Progress& progress) {
  validate(settings);
  if (settings.look == Look::steps) {
    const auto width = static_cast<std::size_t>(settings.width);
    std::vector<std::uint32_t> steps(width * static_cast<std::size_t>(settings.height));
    for_each_pixel(settings, 1, progress, [&](std::span<const PicturePoint> middle) {
      VoxelSceneStats stats;
      scene.closest_hit(camera.ray(middle[0].x, middle[0].y), &stats);
      steps[static_cast<std::size_t>(middle[0].pixel_y) * width + static_cast<std::size_t>(middle[0].pixel_x)] =
          stats.steps;
    });
    return picture_of_steps(settings, steps);
  }
  if (settings.look != Look::shaded) {
    throw Error(fmt::format("look '{}': voxels have none; there are: shaded, steps", name_of(settings.look)));
  }
  const VoxelShader shader(scene, camera, settings);
  Image image(settings.width, settings.height);
  for_each_pixel(settings, settings.aa, progress, [&](std::span<const PicturePoint> points) {
    std::vector<vec3> colours;
    for (const PicturePoint& point : points) colours.push_back(shader.colour(point));
    set_pixel(image, points[0].pixel_x, points[0].pixel_y, mean_colour(colours));
  });
  return {std::move(image), {}, {}};
}

}  // namespace scarp
