// SPDX-License-Identifier: MIT
#include "scarp/render/voxel_picture.h"

#include <fmt/format.h>

#include "scarp/base/error.h"
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
    const auto steps_of = [&](int x, int y) {
      VoxelSceneStats stats;
      scene.closest_hit(camera.ray(x + 0.5, y + 0.5), &stats);
      return stats.steps;
    };
    return picture_of_steps(settings, steps_of, progress);
  }
  if (settings.look != Look::shaded) {
    throw Error(fmt::format("look '{}': voxels have none; there are: shaded, steps", name_of(settings.look)));
  }
  const VoxelShader shader(scene, camera, settings);
  return {develop(
              settings.width, settings.height, settings.aa,
              [&](const PicturePoint& point) { return shader.colour(point); }, progress),
          {},
          {}};
}

}  // namespace scarp
