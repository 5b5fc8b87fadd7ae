// SPDX-License-Identifier: MIT
#include "scarp/render/frame/frame_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "scarp/base/error.h"
#include "scarp/render/light/air.glsl.h"

namespace scarp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Cut earth, sRGB: flat, and darker on walls that face away from the sun.
constexpr vec3 kEarth(0.64f, 0.58f, 0.53f);
constexpr float kUnlitWall = 0.55f;

// Rays over wrapped ground need an end: the highest point of the scene.
std::optional<double> ceiling_of(const Scene& scene) {
  if (const HeightField* field = scene.only_heights()) return field->max_height();
  double top = !scene.box().empty() ? scene.box().high.z : -kInfinity;
  for (const SceneObject& object : scene.objects()) {
    const HeightField* field = height_field_of(*scene.fields()[object.field]);
    if (!field || !field->wraps()) continue;
    top = std::max(top, object.placement.world_from_field({0, 0, field->max_height()}).z);
  }
  return scene.wraps() || !scene.endless() ? std::optional(top) : std::nullopt;
}

LightSettings light_of(const PictureSettings& settings) {
  return {.sun = settings.sun,
          .sky = settings.sky,
          .grid_north_azimuth = settings.grid_north_azimuth,
          .shadows = settings.shadows,
          .unlit = settings.unlit,
          .samples = settings.samples,
          .points_per_pixel = settings.aa * settings.aa,
          .seed = settings.seed};
}

// No ray from a surface has a longer path to the end of the scene.
double ao_distance_of(const Scene& scene, const PictureSettings& settings) {
  const WorldBox& box = scene.box();
  return scene.endless() || box.empty() ? settings.ao_distance
                                        : std::min(settings.ao_distance, length(box.high - box.low));
}

// The haze in the settings applies to the scene, not to the space between it and a distant camera.
Haze haze_of(const Scene& scene, const Camera& camera, const PictureSettings& settings) {
  if (settings.look == Look::comanche || settings.fog.kind != FogKind::none) return {};
  if (std::isfinite(settings.haze_distance)) return {1 / settings.haze_distance, 0};
  const WorldBox& box = scene.box();
  if (box.empty()) return {};
  const dvec3 nearest = glm::clamp(camera.eye(), box.low, box.high);
  return {-std::log(1 - settings.haze) / length(box.high - box.low), length(nearest - camera.eye())};
}

}  // namespace

std::optional<StepMarch> step_march_of(const Scene& scene, const Camera& camera, const PictureSettings& settings) {
  const HeightField* field = scene.only_heights();
  if (settings.look != Look::comanche || !field || scene.sampling() != Sampling::fixed_step) return {};
  const double reach = std::isfinite(camera.reach()) ? camera.reach() : default_reach(*field);
  return StepMarch(*field, settings.comanche, reach, camera.forward());
}

FrameView::FrameView(const Scene& scene, const Camera& camera, const PictureSettings& settings)
    : scene_(scene),
      camera_(camera),
      settings_(settings),
      ceiling_(ceiling_of(scene)),
      lighting_(light_of(settings), ao_distance_of(scene, settings), scene.wraps() ? ceiling_ : std::nullopt),
      colours_(settings.materials),
      paint_(settings.ground, paint_extent(scene, settings), ground_ramp(scene, settings), lighting_.to_sun()),
      wall_light_(sky().scatters()
                      ? sky().skylight() + sky().sunlight() * static_cast<float>(std::max(0.0, lighting_.to_sun().z))
                      : vec3(1.0f)),
      fog_(settings.fog, sky()),
      haze_(haze_of(scene, camera, settings)),
      step_march_(step_march_of(scene, camera, settings)) {
  for (const SceneObject& object : scene.objects())
    ramped_.push_back(is_ramped(*scene.fields()[object.field], settings));
  mirrors_ = !settings.unlit && std::any_of(scene.fields().begin(), scene.fields().end(),
                                            [](const SceneFieldPtr& field) { return field->mirrors(); });
  if (settings.water) {
    water_.emplace(*settings.water, scene);
    if (camera.eye().z <= water_->level()) {
      throw Error(fmt::format("water: its level, {} m, is not below the eye, at {} m; pictures are made from above it",
                              water_->level(), camera.eye().z));
    }
  }
}

vec3 FrameView::surface_colour(const Ray& ray, const Hit& hit, const SceneSurface& surface) const {
  const double footprint = camera_.footprint(ray, hit.t, surface.normal);
  const double height = surface.height.value_or(surface.position.z);
  const bool has_material = surface.material < settings_.materials.size();
  const bool painted = !has_material && (settings_.ground.natural || (!surface.colour && ramped_[surface.object]));
  const vec3 own =
      painted ? paint_.ground(surface.position, height, surface.shading_normal, footprint) : colours_(surface);
  return paint_.over(own, surface.position, height, surface.normal, footprint);
}

vec3 FrameView::lit(const Ray& ray, const Hit& hit, const SceneSurface& surface, const LightRays& asked,
                    std::span<const Ray> rays, std::span<const std::uint8_t> blocked) const {
  vec3 light = lighting_.on(light_point(surface, hit), asked, rays, blocked);
  if (!settings_.unlit) light += surface.light.emission;
  return surface_colour(ray, hit, surface) * light;
}

vec3 FrameView::unlit(const Ray& ray, const Hit& hit, const SceneSurface& surface) const {
  if (!hit) {
    // Ground beyond the picture's reach is at the horizon.
    return fog_(ray, kInfinity,
                horizon_below() ? glsl::scarp_sky_beyond(sky().numbers(), ray.direction) : sky().colour(ray.direction));
  }
  if (surface.wall) return in_air(wall_colour(surface.normal), ray, hit.t);
  // The camera is inside: the voxel's colour is all there is to see.
  return surface_colour(ray, hit, surface);
}

vec3 FrameView::in_air(vec3 colour, const Ray& ray, double t) const {
  if (fog_.kind() != FogKind::none) return fog_(ray, t, colour);
  return glsl::scarp_in_haze(colour, sky().numbers(), ray.direction, haze_.per_metre, t - haze_.clear_distance);
}

vec3 FrameView::from_beyond(vec3 light, const Ray& ray) const {
  return light * static_cast<float>(transmittance(fog_.settings(), ray, kInfinity));
}

vec3 FrameView::earth() const { return linear_from_srgb(kEarth) * wall_light_; }
float FrameView::unlit_wall() const { return settings_.unlit ? 1.0f : kUnlitWall; }

vec3 FrameView::wall_colour(const dvec3& normal) const {
  const auto lit = static_cast<float>(std::max(0.0, dot(normal, lighting_.to_sun())));
  return earth() * (unlit_wall() + (1 - unlit_wall()) * lit);
}

}  // namespace scarp
