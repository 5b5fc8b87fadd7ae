// SPDX-License-Identifier: MIT
// Everything that a picture needs besides rays: the light, the air, the water and the colours of a scene.
//
//   scene ──hit──▶ SceneSurface ──colour──▶ × light ──▶ through air and water ──▶ linear light of a point
#pragma once

#include <optional>
#include <span>

#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/picture.h"
#include "scarp/render/light/fog_model.h"
#include "scarp/render/light/lighting.h"
#include "scarp/render/light/sky_model.h"
#include "scarp/render/look/comanche.h"
#include "scarp/render/surface/ground_paint.h"
#include "scarp/render/surface/surface_colour.h"
#include "scarp/render/surface/water.h"
#include "scarp/scene/scene.h"

namespace scarp {

/// Exponential haze over a picture (air.glsl.h).
struct Haze {
  double per_metre = 0;
  double clear_distance = 0;  ///< metres in front of the eye without haze
};

/// Returns the stepped march that traces camera and water rays instead of the scene, in the look `comanche` with the
/// march `fixed-step` over one height field; nullopt otherwise. Refers to the scene.
std::optional<StepMarch> step_march_of(const Scene& scene, const Camera& camera, const PictureSettings& settings);

/// Refers to scene, camera and settings. Settings must be valid.
class FrameView {
 public:
  /// Throws Error if the eye is under the water.
  FrameView(const Scene& scene, const Camera& camera, const PictureSettings& settings);
  FrameView(const FrameView&) = delete;
  FrameView& operator=(const FrameView&) = delete;

  const Scene& scene() const { return scene_; }
  const Camera& camera() const { return camera_; }
  const PictureSettings& settings() const { return settings_; }
  const Lighting& lighting() const { return lighting_; }
  const Sky& sky() const { return lighting_.light().sky(); }
  const Fog& fog() const { return fog_; }
  const Haze& haze() const { return haze_; }
  const GroundPaint& paint() const { return paint_; }
  /// Null without water.
  const Water* water() const { return water_ ? &*water_ : nullptr; }
  /// Whether a surface of the scene may mirror.
  bool mirrors() const { return mirrors_; }
  /// Null without a stepped march; see step_march_of().
  const StepMarch* step_march() const { return step_march_ ? &*step_march_ : nullptr; }
  /// Height above which there is nothing to hit, metres of world z; nullopt if there is none.
  const std::optional<double>& ceiling() const { return ceiling_; }
  /// Whether the horizon's colour fills the sky below the horizon, for ground beyond the picture's reach.
  bool horizon_below() const { return scene_.endless() || settings_.look == Look::comanche; }

  /// Whether the surface needs light rays: walls and the inside of voxels do not.
  static bool is_lit(const SceneSurface& surface) { return !surface.wall && surface.normal != dvec3(0.0); }
  /// The surface's colour without light.
  vec3 surface_colour(const Ray& ray, const Hit& hit, const SceneSurface& surface) const;
  /// The surface's colour, lit and with its emission. `rays` and `blocked` are those that `asked` refers to.
  vec3 lit(const Ray& ray, const Hit& hit, const SceneSurface& surface, const LightRays& asked,
           std::span<const Ray> rays, std::span<const std::uint8_t> blocked) const;
  /// The colour of everything not lit by rays: walls, the inside of voxels, the sky. `surface` is that of the hit.
  vec3 unlit(const Ray& ray, const Hit& hit, const SceneSurface& surface) const;
  /// A colour seen through t metres of haze or fog.
  vec3 in_air(vec3 colour, const Ray& ray, double t) const;
  /// Light from beyond the scene, attenuated by the fog along the ray.
  vec3 from_beyond(vec3 light, const Ray& ray) const;

  /// Colour of walls in linear light, and the fraction of it that walls facing away from the sun have: 1 in unlit
  /// pictures.
  vec3 earth() const;
  float unlit_wall() const;

 private:
  vec3 wall_colour(const dvec3& normal) const;

  const Scene& scene_;
  const Camera& camera_;
  const PictureSettings& settings_;
  std::optional<double> ceiling_;
  Lighting lighting_;
  SurfaceColours colours_;
  GroundPaint paint_;
  vec3 wall_light_;  // light on cut earth: that on level ground
  Fog fog_;
  Haze haze_;
  std::optional<Water> water_;
  std::optional<StepMarch> step_march_;
  std::vector<bool> ramped_;  // by object: whether it is_ramped()
  bool mirrors_ = false;
};

}  // namespace scarp
