// SPDX-License-Identifier: MIT
// The colour that a ray of the camera has in the look `shaded`, given what it meets and what is seen from there.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "scarp/render/camera/camera.h"
#include "scarp/render/frame/film.h"
#include "scarp/render/frame/picture.h"
#include "scarp/render/frame/sight.h"
#include "scarp/render/light/fog.h"
#include "scarp/render/light/lighting.h"
#include "scarp/render/light/visibility.h"
#include "scarp/render/surface/ground_paint.h"
#include "scarp/render/surface/ramp.h"

namespace scarp {

/// Throws Error when the field has nothing to see: no cells, no valid samples.
void require_ground(const HeightField& field);

/// Everything that a picture in the look `shaded` needs but rays. Refers to field, camera and settings.
class Shader {
 public:
  Shader(const HeightField& field, const Camera& camera, double grid_north_azimuth, const PictureSettings& settings);

  const HeightField& field() const { return field_; }
  const Lighting& lighting() const { return lighting_; }
  /// Of ground, in linear light; `rays` and their answers are those that `asked` refers to.
  vec3 ground_colour(const Ray& ray, const Hit& hit, const GroundPoint& ground, const LightRays& asked,
                     std::span<const Ray> rays, std::span<const std::uint8_t> blocked) const;
  /// The same before the air between: the ground's colour in its light.
  vec3 lit_ground(const Ray& ray, const Hit& hit, const GroundPoint& ground, const LightRays& asked,
                  std::span<const Ray> rays, std::span<const std::uint8_t> blocked) const;
  /// A colour seen through t metres of haze or fog.
  vec3 in_air(vec3 colour, const Ray& ray, double t) const;
  /// Metres, of the surface, where hit.height is that of the ray: they differ by rounding, and a sea at 0 must not be
  /// speckled.
  double ground_height(const Hit& hit) const;
  const Fog& fog() const { return fog_; }
  const GroundPaint& paint() const { return paint_; }
  const PictureSettings& settings() const { return settings_; }
  /// Haze per metre, and the metres before it begins.
  double haze_per_metre() const { return haze_per_metre_; }
  double clear_distance() const { return clear_distance_; }
  /// Whether what lies below the horizon has its colour: ground farther away than the picture reaches.
  bool horizon_below() const { return endless_ || settings_.look == Look::comanche; }
  /// Of cut earth, in linear light, and the share of it that walls without sun have.
  vec3 earth() const { return earth_; }
  static float unlit_wall();
  const dvec3& to_sun() const { return lighting_.to_sun(); }
  /// Of what is not ground: walls and the sky, in linear light.
  vec3 colour_beside_ground(const Ray& ray, const Sight& sight) const;

 private:
  vec3 wall_colour(const dvec3& normal) const;

  const HeightField& field_;
  const PictureSettings& settings_;
  const Camera& camera_;
  Lighting lighting_;
  GroundPaint paint_;
  Fog fog_;
  vec3 earth_;
  double clear_distance_ = 0;
  double haze_per_metre_ = 0;
  bool endless_ = false;
};

}  // namespace scarp
